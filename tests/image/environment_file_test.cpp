// Environment maps that hold what is no radiance, or more than pictures show.
#include <algorithm>
#include <limits>

#include "image/image.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using EnvironmentFile = TempFolder;

TEST_F(EnvironmentFile, WhatIsNoRadianceIsCountedAndBlack) {
    const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    // Negative channels alone are black, the rest of their texel stays: other primaries make such.
    write_hdr(folder / "a.exr",
              Image{3,
                    2,
                    {{1, 2, 3, 0.5f},
                     {nan, 2, 3, 1},
                     {1, -2, 3, 1},
                     {1, 2, infinite, 1},
                     {-infinite, 2, 3, 1},
                     {1e13f, 0, 0, 1}}},
              {.half = false});
    std::vector<std::string> notes;
    const Image image = read_environment(folder / "a.exr", notes);
    EXPECT_EQ(image.pixels, (std::vector<glm::vec4>{
                                {1, 2, 3, 1}, {0, 0, 0, 1}, {1, 0, 3, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0], "a.exr: 5 texels are negative, infinite or not a number: what is wrong of them counts as 0");
    write_hdr(folder / "b.exr", Image{2, 1, {{1, 2, 3, 1}, {0, -1, 0, 1}}}, {.half = false});
    notes.clear();
    read_environment(folder / "b.exr", notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0], "b.exr: 1 texel is negative, infinite or not a number: what is wrong of it counts as 0");
    write_hdr(folder / "c.exr", Image{1, 1, {{0, 0, 0, 0}}}, {.half = false});
    notes.clear();
    EXPECT_EQ(read_environment(folder / "c.exr", notes).pixels, (std::vector<glm::vec4>{{0, 0, 0, 1}}));
    EXPECT_TRUE(notes.empty());
    expect_error([&] { read_environment(folder / "none.hdr", notes); }, "No such file");
}

TEST_F(EnvironmentFile, WideOnesAreHalved) {
    Image wide{4 * kWidestEnvironment, 5, {}};
    for (uint32_t y = 0; y < wide.height; y++)
        for (uint32_t x = 0; x < wide.width; x++) wide.pixels.emplace_back(float(x % 4 + 4 * (y % 4)), 1, 0, 1);
    for (const std::string name : {"wide.exr", "wide.hdr"}) {
        SCOPED_TRACE(name);
        write_hdr(folder / name, wide);
        std::vector<std::string> notes;
        const Image image = read_environment(folder / name, notes);
        EXPECT_EQ(image.width, kWidestEnvironment);
        EXPECT_EQ(image.height, 1u);
        for (const glm::vec4& pixel : image.pixels) {
            ASSERT_NEAR(pixel.x, 7.5f, 0.05f);
            ASSERT_NEAR(pixel.y, 1, 0.01f);
        }
        ASSERT_EQ(notes.size(), 1u);
        EXPECT_EQ(notes[0], name + ": its 32768x5 texels are reduced to 8192x1");
    }
}

}  // namespace
}  // namespace peelray
