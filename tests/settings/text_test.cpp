// Text to values and back.
#include "base/text.h"
#include "settings/text.h"

#include <gtest/gtest.h>

namespace peelray {
namespace {

TEST(Text, NumbersAreWhole) {
    EXPECT_EQ(parse_number<uint32_t>("17"), 17u);
    EXPECT_EQ(parse_number<float>("-2.5"), -2.5f);
    EXPECT_EQ(parse_number<double>("1e3"), 1000);
    for (const char* text : {"", " 1", "1 ", "+1", "1x", "1,2", "0x10", "4294967296", "-1"})
        EXPECT_FALSE(parse_number<uint32_t>(text)) << text;
    for (const char* text : {"", " 1", "1.0f", "+1", "1,5"}) EXPECT_FALSE(parse_number<float>(text)) << text;
}

TEST(Text, Sizes) {
    EXPECT_EQ(parse_size("640x480"), glm::uvec2(640, 480));
    EXPECT_EQ(parse_size("640X480"), glm::uvec2(640, 480));
    for (const char* text : {"", "640", "x", "640x", "x480", "640x480x3", "-1x2", "1.5x2", "640 x 480"})
        EXPECT_FALSE(parse_size(text)) << text;
    EXPECT_EQ(parse_block("8"), glm::uvec2(8));
    EXPECT_EQ(parse_block("8x4"), glm::uvec2(8, 4));
    EXPECT_FALSE(parse_block("8x"));
    EXPECT_EQ(print_text(glm::uvec2(8, 4)), "8x4");
}

TEST(Text, Vectors) {
    EXPECT_EQ(parse_vector("1,2.5,-3"), glm::vec3(1, 2.5f, -3));
    for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "1, 2,3", "a,b,c"}) EXPECT_FALSE(parse_vector(text)) << text;
    EXPECT_EQ(print_text(glm::vec3(1, 2.5f, -3)), "1,2.5,-3");
}

TEST(Text, RangesAndShards) {
    const auto frames = parse_as<FrameRange>("10:20");
    ASSERT_TRUE(frames);
    EXPECT_EQ(print_text(*frames), "10:20");
    const auto shard = parse_as<Shard>("2/8");
    ASSERT_TRUE(shard);
    EXPECT_EQ(print_text(*shard), "2/8");
    EXPECT_FALSE(parse_as<FrameRange>("10-20"));
    EXPECT_FALSE(parse_as<FrameRange>("10:"));
    EXPECT_FALSE(parse_as<Shard>("2:8"));
}

TEST(Text, Lists) {
    EXPECT_EQ(split("a,,b"), (std::vector<std::string>{"a", "", "b"}));
    using Tracers = std::vector<Tracer>;
    EXPECT_EQ(parse_as<Tracers>("ldc,cubemap"), (Tracers{Tracer::ldc, Tracer::cubemap}));
    EXPECT_FALSE(parse_as<Tracers>("ldc,ldc"));
    EXPECT_FALSE(parse_as<Tracers>("ldc,"));
    EXPECT_FALSE(parse_as<Tracers>(""));
    EXPECT_EQ(print_text(Tracers{Tracer::ldc, Tracer::cubemap}), "ldc,cubemap");
    EXPECT_EQ(print_text(ChoiceSet<Effect>{Effect::shadow, Effect::reflection}), "reflection,shadow");
}

TEST(Text, CountsChooseTheirWords) {
    EXPECT_EQ(counted("{} vert{ex|ices} that {is|are} no one's", 1), "1 vertex that is no one's");
    EXPECT_EQ(counted("{} vert{ex|ices} that {is|are} no one's", 2), "2 vertices that are no one's");
    EXPECT_EQ(counted("{} node{|s}", 0), "0 nodes");
    EXPECT_EQ(counted("{{a|b}} of {} {x} {", 1), "{a|b} of 1 {x} {");
}

TEST(Text, NamesOutOfFilesAreNoPlacesToFill) {
    for (const std::string name : {"{}", "{a|b}", "a}}{", "%d {{x}}"})
        EXPECT_EQ(counted("{} node{|s} of " + escaped(name), 2), "2 nodes of " + name);
    EXPECT_EQ(counted(escaped("a\n{b}"), 1), "a {b}");
    EXPECT_EQ(counted(escaped("{|}{|}", 4), 1), "{|}{...");
}

}  // namespace
}  // namespace peelray
