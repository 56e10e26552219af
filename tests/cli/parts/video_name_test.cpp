// Which files are videos, of which sizes, and who makes them.
#include "cli/video.h"
#include "image/temp_folder.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

TEST(Video, IsToldByItsName) {
    for (const char* name : {"a.mp4", "a.webm", "x/a.MP4", "a_%d.WebM"}) EXPECT_TRUE(is_video(name)) << name;
    for (const char* name : {"a.png", "mp4", "a.mp4.png", "a.mov", ""}) EXPECT_FALSE(is_video(name)) << name;
}

TEST(Video, HasEvenSides) {
    EXPECT_NO_THROW(check_video_size({2, 4}));
    expect_error([] { check_video_size({3, 4}); }, "use --size 4x4");
    expect_error([] { check_video_size({4, 7}); }, "use --size 4x8");
    expect_error([] { check_video_size({1, 1}); }, "use --size 2x2");
}

class FindFfmpeg : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        if (const char* path = std::getenv("PATH")) old_ = path;
        fs::create_directory(folder / "first");
        fs::create_directory(folder / "second");
        ::setenv("PATH", (folder / "first").string().append(":").append((folder / "second").string()).c_str(), 1);
    }
    void TearDown() override {
        ::setenv("PATH", old_.c_str(), 1);
        TempFolder::TearDown();
    }
    void make_program(const fs::path& path) const {
        put(path, "#!/bin/sh\n");
        fs::permissions(folder / path, fs::perms::owner_all);
    }

  private:
    std::string old_;
};

TEST_F(FindFfmpeg, TheFirstProgramOnThePathIsTaken) {
    expect_error([] { find_ffmpeg(); }, "there is no ffmpeg on the PATH");
    make_program("second/ffmpeg");
    EXPECT_EQ(find_ffmpeg(), folder / "second" / "ffmpeg");
    fs::create_directory(folder / "first" / "ffmpeg");
    EXPECT_EQ(find_ffmpeg(), folder / "second" / "ffmpeg") << "a folder is no program";
    fs::remove(folder / "first" / "ffmpeg");
    put("first/ffmpeg", "");
    EXPECT_EQ(find_ffmpeg(), folder / "second" / "ffmpeg") << "nor is what may not be executed";
    make_program("first/ffmpeg");
    EXPECT_EQ(find_ffmpeg(), folder / "first" / "ffmpeg");
    ::unsetenv("PATH");
    expect_error([] { find_ffmpeg(); }, "apt-get install ffmpeg");
}

}  // namespace
}  // namespace peelray
