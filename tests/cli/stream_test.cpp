// -o -: pictures and videos on the standard output, and what happens when nobody takes them.
#include <sys/stat.h>

#include <regex>

#include "cli/sequence_fixture.h"
#include "image/image.h"
#include "image/y4m.h"

namespace peelray {
namespace {

class Stream : public SequenceTest {
  protected:
    /// `peelray render moving.gltf -o - --size 64x48 --tracer none …`
    Words words_to(const Words& more) const {
        Words all = {"render", in("moving.gltf"), "-o", "-", "--size", "64x48", "--tracer", "none"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome stream(const Words& more) const { return run(words_to(more)); }

    /// Runs a script in which $P is a program: this one with words_to(). Returns what the script says.
    Outcome shell(const std::string& script, const Words& more) const {
        std::string line = "exec '" PEELRAY_PROGRAM "'";
        for (const std::string& word : words_to(more)) line += " '" + word + "'";
        put("program", "#!/bin/sh\nexport XDG_CACHE_HOME='" PEELRAY_CACHE "'\n" + line + "\n");
        ::chmod(in("program").c_str(), 0755);
        put("script", "P='" + in("program") + "'\n" + script + "\n");
        const std::string err = folder / "scratch/err", out_file = folder / "scratch/out";
        const int status = std::system(("bash '" + in("script") + "' > '" + out_file + "' 2> '" + err + "'").c_str());
        return {WEXITSTATUS(status), get(out_file), get(err)};
    }
};

TEST_F(Stream, OnePictureIsAPng) {
    const Outcome run = stream({"--time", "0.2"});
    EXPECT_EQ(run.status, 0) << run.err;
    ASSERT_EQ(this->run({"render", in("moving.gltf"), "-o", out("a.png"), "--size", "64x48", "--tracer", "none",
                         "--time", "0.2"})
                  .status,
              0);
    EXPECT_TRUE(run.out == get(out("a.png")));
    EXPECT_TRUE(std::regex_match(run.err, std::regex("standard output: 64x48, 4 triangles, .* in all on .*\n")))
        << run.err;
    EXPECT_EQ(outputs(), Words{"a.png"}) << "no file is called -";
}

TEST_F(Stream, SeveralFramesAreAVideo) {
    const Words frames = {"--frames", "0:5", "--fps", "29.97"};
    const Outcome run = stream(frames);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(
        std::regex_match(run.err, std::regex("standard output: 0\\.17 s at 29\\.97 frames/s; 5 frames of 0 to 4, "
                                             "64x48; .*\n")))
        << run.err;
    ASSERT_EQ(sequence("f%d.png", {"--tracer", "none", "--frames", "0:5", "--fps", "29.97"}).status, 0);
    std::string whole = "YUV4MPEG2 W64 H48 F2997:100 Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n";
    for (int k = 0; k < 5; k++) whole += y4m_frame(read_ldr(out(fmt::format("f{}.png", k))));
    EXPECT_TRUE(run.out == whole);
    // A turntable, and stats beside it.
    const Outcome turn = stream({"--turntable", "3", "--stats", out("s.json")});
    EXPECT_EQ(turn.status, 0) << turn.err;
    EXPECT_EQ(turn.out.size(),
              std::string("YUV4MPEG2 W64 H48 F30:1 Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n").size() +
                  3 * (6 + 64 * 48 * 3 / 2));
    EXPECT_EQ(nlohmann::json::parse(get(out("s.json")))["frames"].size(), 3u);
}

TEST_F(Stream, AReaderThatGoesIsSaidInOneLine) {
    for (const Words& more :
         {Words{"--frames", "0:300", "--size", "256x192"}, Words{"--turntable", "300", "--size", "256x192"}}) {
        const Outcome run = shell("$P | head -c 1 > /dev/null\necho ${PIPESTATUS[0]}", more);
        EXPECT_EQ(run.out, "1\n");
        EXPECT_EQ(run.err,
                  "peelray: the program that read the standard output has closed it: what it got is not whole\n");
    }
}

TEST_F(Stream, AFullDiskIsSaidInOneLine) {
    const Outcome run = shell("$P > /dev/full; echo $?", {"--frames", "0:30"});
    EXPECT_EQ(run.out, "1\n");
    EXPECT_EQ(run.err, "peelray: cannot write to the standard output: No space left on device\n");
    const Outcome picture = shell("$P > /dev/full; echo $?", {});
    EXPECT_EQ(picture.out, "1\n");
    EXPECT_EQ(picture.err, "peelray: cannot write to the standard output: No space left on device\n");
}

/// Nobody reads, the pipe is full: it ends all the same.
TEST_F(Stream, AnInterruptEndsItWhileTheReaderSleeps) {
    const Outcome run = shell("cd '" + folder.string() +
                                  "'; mkfifo pipe; sleep 60 < pipe & reader=$!\n"
                                  "$P > pipe & program=$!\n"
                                  "sleep 4; kill -TERM $program; wait $program; echo $?; kill $reader",
                              {"--frames", "0:1000", "--size", "320x240"});
    EXPECT_EQ(run.out, "1\n");
    EXPECT_TRUE(std::regex_match(run.err, std::regex("peelray: interrupted after \\d+ of 1000 frames: the video on the "
                                                     "standard output ends there; run it again\n")))
        << run.err;
}

TEST_F(Stream, WhatCannotBeIsRefused) {
    const auto refused = [&](const Words& more, const std::string& says) {
        SCOPED_TRACE(testing::PrintToString(more));
        expect_refused(stream(more), 1, says);
    };
    const auto frames = [](Words more) {
        more.insert(more.end(), {"--frames", "0:3"});
        return more;
    };
    refused(frames({"--size", "63x48"}), "use --size 64x48");
    refused(frames({"--resume"}), "--resume needs a file for each frame");
    refused(frames({"--shard", "0/2"}), "--shard needs a file for each frame");
    refused(frames({"--aov", "depth"}), "--aov writes pictures and a video is none");
    refused(frames({"--background", "transparent"}), "an alpha channel and a video has none");
    refused(frames({"--half"}), "--half is for .exr files and a video is none");
    refused({"--aov", "depth"}, "the standard output has none: name the picture (-o NAME.png)");
    refused({"--half"}, "--half is about the channels of an .exr, and '-' is none");
    refused({"--preview", "-"}, "cannot tell the picture's format from '-'");
    refused({"--exr-compression", "none"}, "--exr-compression is for .exr files, and '-' is none");
}

TEST_F(Stream, ATerminalIsRefused) {
    if (std::system("command -v script > /dev/null") != 0)
        GTEST_SKIP() << "there is no script: apt-get install bsdutils";
    const Outcome run = shell("script -qec $P /dev/null", {});
    EXPECT_NE(run.out.find("the standard output is a terminal: pipe it into a program or a file"), std::string::npos)
        << run.out << run.err;
}

TEST_F(Stream, TransparentPicturesAreTransparent) {
    const Outcome run = stream({"--background", "transparent"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(read_ldr(put("a.png", run.out)).pixels[0] >> 24, 0u);
}

}  // namespace
}  // namespace peelray
