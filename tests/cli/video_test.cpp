// Videos: what ffmpeg is told and given, what happens when it fails, and what comes out of the real one.
#include <sys/stat.h>

#include "cli/sequence_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

class Video : public SequenceTest {
  protected:
    /// A program "ffmpeg" that is a shell script; the folder of the test is $FOLDER.
    std::map<std::string, std::string> fake(const std::string& script) const {
        fs::create_directory(folder / "bin");
        put("bin/ffmpeg", "#!/bin/sh\nFOLDER='" + folder.string() + "'\n" + script);
        ::chmod(in("bin/ffmpeg").c_str(), 0755);
        return {{"PATH", in("bin") + ":/usr/bin:/bin"}};
    }
    Outcome video(const std::string& script, const Words& more = {}, const std::string& name = "v.mp4") const {
        Words all = {"--frames", "0:3", "--tracer", "cpu"};
        all.insert(all.end(), more.begin(), more.end());
        return sequence(name, all, "moving.gltf", fake(script));
    }
    static bool has_ffmpeg() { return std::system("command -v ffmpeg > /dev/null") == 0; }
    std::string shell(const std::string& line) const {
        const std::string file = folder / "scratch/shell";
        EXPECT_EQ(std::system((line + " > '" + file + "'").c_str()), 0) << line;
        return get(file);
    }
};

/// Notes its arguments, one a line, and what it is given, and writes "video" to the file that is named last.
const std::string kRecorder =
    "for word; do echo \"$word\"; done > $FOLDER/arguments\n"
    "cat > $FOLDER/bytes\n"
    "for last; do :; done\n"
    "printf video > \"${last#file:}\"\n";

TEST_F(Video, FfmpegGetsTheFramesAndTheSettings) {
    for (const std::string name : {"v.mp4", "V.WebM"}) {
        remove_outputs();
        const Outcome run = video(kRecorder, {"--fps", "12.5"}, name);
        expect_done(run, {name});
        EXPECT_EQ(get(out(name)), "video");
        for (const std::string& part :
             Words{name + ": 0.24 s at 12.5 frames/s; 3 frames of 0 to 2, 64x48; ", " in all"})
            EXPECT_NE(run.out.find(part), std::string::npos) << run.out;
        const std::string arguments = "\n" + get(in("arguments"));
        const auto expect_pair = [&](const std::string& option, const std::string& value) {
            EXPECT_NE(arguments.find("\n" + option + "\n" + value + "\n"), std::string::npos) << arguments << option;
        };
        EXPECT_NE(arguments.find("\n-xerror\n"), std::string::npos) << arguments;
        expect_pair("-f", "rawvideo");
        expect_pair("-pix_fmt", "rgb0");
        expect_pair("-video_size", "64x48");
        expect_pair("-framerate", "12.5");
        expect_pair("-pix_fmt", "yuv420p");
        if (name == "v.mp4") {
            expect_pair("-c:v", "libx264");
            expect_pair("-crf", "18");
        } else {
            expect_pair("-c:v", "libvpx-vp9");
        }
        // The pixels of the same frames as pictures.
        const std::string bytes = get(in("bytes"));
        ASSERT_EQ(bytes.size(), 3u * 64 * 48 * 4);
        ASSERT_EQ(sequence("f%d.png", {"--frames", "0:3", "--tracer", "cpu", "--fps", "12.5"}).status, 0);
        for (size_t k = 0; k < 3; k++) {
            const Image8 frame = read_ldr(out(fmt::format("f{}.png", k)));
            const std::string pixels = bytes_of(frame.pixels);
            EXPECT_TRUE(bytes.substr(k * pixels.size(), pixels.size()) == pixels) << k;
        }
    }
}

TEST_F(Video, WhenFfmpegFails) {
    const auto refused = [&](const std::string& script, const std::string& says) {
        SCOPED_TRACE(script);
        expect_refused(video(script), 1, says);
    };
    refused("echo first >&2; echo \"Unknown encoder 'libx264'\" >&2; echo >&2; exit 1",
            "ffmpeg failed (exit status 1): Unknown encoder 'libx264'; no video was written");
    refused("head -c 9000 > /dev/null; echo 'out of ink' >&2; exit 3", "ffmpeg failed (exit status 3): out of ink");
    refused("cat > /dev/null; for last; do :; done; echo half > \"${last#file:}\"; echo 'No space left' >&2; exit 1",
            "ffmpeg failed (exit status 1): No space left");
    refused("kill -9 $$", "ffmpeg failed (ended by signal 9): it does not say why");
    refused("exec 0<&-", "ffmpeg failed (exit status 0): it does not say why");
    refused("exec 0<&-; exec sleep 30", "ffmpeg failed (it reads no more)");
    refused("cat > /dev/null", "ffmpeg wrote nothing");
    fs::remove(in("bin/ffmpeg"));
    put("bin/ffmpeg", "this is no program");
    ::chmod(in("bin/ffmpeg").c_str(), 0755);
    expect_refused(sequence("v.mp4", {"--frames", "0:3"}, "moving.gltf", {{"PATH", in("bin")}}), 1, "cannot start");
}

TEST_F(Video, AFailureLeavesAnOldVideoAlone) {
    put("out/v.mp4", "old");
    EXPECT_EQ(video("exit 1").status, 1);
    EXPECT_EQ(get(out("v.mp4")), "old");
    EXPECT_EQ(outputs(), Words{"v.mp4"});
    EXPECT_EQ(video(kRecorder).status, 0);
    EXPECT_EQ(get(out("v.mp4")), "video");
}

TEST_F(Video, WithoutFfmpegNothingIsRendered) {
    // The scene is missing, too: it is not even looked for.
    expect_refused(
        sequence("v.mp4", {"--frames", "0:3"}, "gone.gltf", {{"PATH", in("bin")}}), 1,
        "there is no ffmpeg on the PATH, which encodes videos: install it (apt-get install ffmpeg), or write "
        "pictures with -o NAME_%05d.png");
    fs::create_directory(folder / "bin");
    fs::create_directory(folder / "bin/ffmpeg");
    expect_refused(sequence("v.mp4", {"--frames", "0:3"}, "moving.gltf", {{"PATH", in("bin")}}), 1,
                   "there is no ffmpeg");
}

TEST_F(Video, WhatAVideoCannotDo) {
    const auto variables = fake("exit 1\n");  // refused before it starts, and whether or not a real one is installed
    const auto refused = [&](const Words& more, const std::string& says, const std::string& name = "v.mp4") {
        Words all = words(name, {"--frames", "0:3"});
        if (more[0] == "--size") all.erase(all.begin() + 4, all.begin() + 6);
        all.insert(all.end(), more.begin(), more.end());
        expect_refused(run(all, variables), 1, says);
    };
    refused({"--resume"}, "--resume needs a file for each frame, a video is one: render pictures (-o NAME_%05d.png)");
    refused({"--shard", "0/2"}, "--shard needs a file for each frame");
    refused({"--aov", "depth"}, "--aov writes pictures");
    refused({"--size", "65x48"}, "use --size 66x48");
    refused({"--size", "64x47"}, "use --size 64x48");
    refused({"--size", "1x1"}, "use --size 2x2", "v.webm");
    refused({"--spp", "1"}, "a video is one file: leave it out", "v%d.mp4");
    refused({"--stats", out("v.mp4")}, "written twice");
}

TEST_F(Video, AnInterruptEndsFfmpegToo) {
    // It neither reads nor ends.
    const auto variables = fake("echo $$ > $FOLDER/pid.tmp; mv $FOLDER/pid.tmp $FOLDER/pid; exec sleep 60");
    const Running running = start(words("v.mp4", {"--frames", "0:90", "--tracer", "cpu"}), variables);
    ASSERT_TRUE(wait_for(in("pid")));
    const pid_t ffmpeg = std::stoi(get(in("pid")));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_EQ(::kill(ffmpeg, 0), 0);
    const auto start = std::chrono::steady_clock::now();
    ::kill(running.process, SIGINT);
    const Outcome run = running.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(run.err.starts_with("peelray: interrupted after ")) << run.err;
    EXPECT_TRUE(run.err.ends_with(" of 90 frames: no video was written; run it again\n")) << run.err;
    EXPECT_EQ(outputs(), Words());
    EXPECT_NE(::kill(ffmpeg, 0), 0);
}

TEST_F(Video, ACtrlCIsForUs) {
    // A terminal sends it to the whole process group. It must not look like an ffmpeg that fails.
    const auto variables = fake("trap 'echo > $FOLDER/hit; exit 255' INT\necho > $FOLDER/started\ncat > /dev/null");
    const Running running = start(words("v.mp4", {"--frames", "0:100000", "--tracer", "cpu"}), variables, "", true);
    ASSERT_TRUE(wait_for(in("started")));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::kill(-running.process, SIGINT);
    const Outcome run = running.wait();
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(run.err.starts_with("peelray: interrupted after ")) << run.err;
    EXPECT_TRUE(run.err.ends_with(" of 100000 frames: no video was written; run it again\n")) << run.err;
    EXPECT_FALSE(fs::exists(in("hit")));
    EXPECT_EQ(outputs(), Words());
}

TEST_F(Video, TheRealFfmpegMakesThem) {
    if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg: apt-get install ffmpeg";
    for (const std::string name : {"v.mp4", "v.webm"}) {
        SCOPED_TRACE(name);
        remove_outputs();
        Words away = {"--frames", "0:7", "--fps", "24", "--tracer", "none", "--tonemap", "none"};
        away.insert(away.end(), {"--background", "0.5,0.1,0.8", "--eye", "0,0,50", "--look", "0,0,100"});
        expect_done(sequence(name, away), {name});
        const std::string about = shell(
            "ffprobe -v error -count_frames -select_streams v -show_entries "
            "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames,color_space "
            "-of default=nw=1 '" +
            out(name) + "'");
        for (const std::string line : {name == "v.mp4" ? "codec_name=h264" : "codec_name=vp9", "width=64", "height=48",
                                       "pix_fmt=yuv420p", "r_frame_rate=24/1", "nb_read_frames=7", "color_space=bt709"})
            EXPECT_NE(about.find(line), std::string::npos) << about << line;
        // sRGB of the background: 188, 89, 231.
        const std::string rgb =
            shell("ffmpeg -v error -i '" + out(name) +
                  "' -frames:v 1 -vf scale=in_color_matrix=bt709:in_range=limited:flags=accurate_rnd+"
                  "full_chroma_int -f rawvideo -pix_fmt rgb24 -");
        ASSERT_EQ(rgb.size(), 64u * 48 * 3);
        const int want[] = {188, 89, 231};
        for (size_t c = 0; c < 3; c++) EXPECT_NEAR(int(uint8_t(rgb[(24 * 64 + 32) * 3 + c])), want[c], 3) << c;
    }
}

TEST_F(Video, TheRealFfmpegOnAFullDisk) {
    if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg: apt-get install ffmpeg";
    // As good as full: files may have no more than 512 bytes. Left to itself ffmpeg says of a .webm that all is well.
    const auto variables = fake("ulimit -f 1\nPATH=/usr/bin:/bin exec ffmpeg \"$@\"");
    for (const std::string name : {"v.mp4", "v.webm"}) {
        const Outcome run = sequence(name, {"--frames", "0:3", "--tracer", "cpu"}, "moving.gltf", variables);
        expect_refused(run, 1, "ffmpeg failed (exit status 1)");
        EXPECT_NE(run.err.find("File too large"), std::string::npos) << run.err;
    }
}

}  // namespace
}  // namespace peelray
