// Names with a frame's number in them.
#include "cli/frame_pattern.h"

#include "image/temp_folder.h"

namespace peelray {
namespace {

using Found = std::optional<uint32_t>;

TEST(FramePattern, NumbersAreAsLongAsTheyMustBe) {
    EXPECT_EQ(FramePattern("a/frame_%05d.exr").file(42), "a/frame_00042.exr");
    EXPECT_EQ(FramePattern("frame_%05d.exr").file(1234567), "frame_1234567.exr");
    EXPECT_EQ(FramePattern("%d.png").file(0), "0.png");
    EXPECT_EQ(FramePattern("%01d.png").file(12), "12.png");
    EXPECT_EQ(FramePattern("100%%_%03d%%.png").file(7), "100%_007%.png");
    EXPECT_EQ(FramePattern("{}_%d.png").file(7), "{}_7.png");
    EXPECT_EQ(FramePattern("f%d.png").file(4294967295u), "f4294967295.png");
}

TEST(FramePattern, AFoldersPercentSignIsAPercentSign) {
    EXPECT_EQ(FramePattern("50%d/%d.png").file(3), "50%d/3.png");
    EXPECT_FALSE(has_frame_number("50%d/a.png"));
}

TEST(FramePattern, WhatIsNoPatternIsSaid) {
    expect_error([] { FramePattern("a.png"); }, "'a.png' is one file");
    expect_error([] { FramePattern("100%%.png"); }, "'100%%.png' is one file");
    expect_error([] { FramePattern("%d_%02d.png"); }, "has two numbers");
    expect_error([] { FramePattern("a_%5d.png"); }, "'%5d' in 'a_%5d.png' is no place for a frame's number");
    expect_error([] { FramePattern("a_%s.png"); }, "'%s' in");
    expect_error([] { FramePattern("a_%00d.png"); }, "'%00d' in");
    expect_error([] { FramePattern("a_%012d.png"); }, "'%012d' in");
    expect_error([] { FramePattern("a_%lld.png"); }, "'%lld' in");
    expect_error([] { FramePattern("a_%"); }, "'%' in");
}

TEST(FramePattern, IsToldFromOneFile) {
    for (const char* name : {"%d", "a%d.png", "a%09d.png", "%%%d.png", "%x%d"}) EXPECT_TRUE(has_frame_number(name));
    for (const char* name : {"", "a.png", "%%d.png", "%", "%5d.png", "%0d.png"}) EXPECT_FALSE(has_frame_number(name));
}

TEST(FramePattern, FindsTheFrameOfAFile) {
    const FramePattern pattern("a/f_%03d.png");
    for (const uint32_t frame : {0u, 7u, 999u, 1000u, 4294967295u})
        EXPECT_EQ(pattern.frame_of(pattern.file(frame)), frame);
    for (const char* other : {"a/f_7.png", "a/f_0007.png", "a/f_.png", "a/f_-07.png", "a/f_007.exr", "f_007.png",
                              "b/f_007.png", "a/g_007.png", "a/f_4294967296.png", "a/f_0 7.png", "a/f_"})
        EXPECT_EQ(pattern.frame_of(other), Found()) << other;
    // Before and after the number stands the same: they must not be counted twice.
    EXPECT_EQ(FramePattern("aa%daa").frame_of("aaa"), Found());
    EXPECT_EQ(FramePattern("aa%daa").frame_of("aa5aa"), Found(5));
}

class FramePatternInAFolder : public TempFolder {};

TEST_F(FramePatternInAFolder, KnowsItByOtherNames) {
    std::filesystem::create_directory(folder / "a");
    std::filesystem::create_directory_symlink(folder / "a", folder / "link");
    const FramePattern pattern(folder / "a" / "f_%03d.png");
    EXPECT_EQ(pattern.frame_of(folder / "a" / ".." / "a" / "f_007.png"), Found(7));
    EXPECT_EQ(pattern.frame_of(folder / "link" / "f_007.png"), Found(7));
    EXPECT_EQ(pattern.frame_of(folder / "f_007.png"), Found());
}

}  // namespace
}  // namespace peelray
