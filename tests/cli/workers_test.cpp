// Frames are written by other threads than the one that renders: interrupts at any moment, errors, formats.
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <sched.h>

#include <random>
#include <regex>

#include "cli/sequence_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

class Workers : public SequenceTest {
  protected:
    Words frames(const std::string& name, const Words& more = {}) const {
        Words all = words(name, {"--frames", "0:60", "--tracer", "cpu"});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

/// One core or all: the same files.
TEST_F(Workers, FilesAreTheSameOnAnyCores) {
    std::map<std::string, std::string> all;
    cpu_set_t before, one;
    ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
    for (const bool alone : {false, true}) {
        remove_outputs();
        if (alone) ::sched_setaffinity(0, sizeof one, &one);
        const Outcome run = this->run(frames("f%02d.exr", {"--aov", "depth,normal", "--exr-layers"}));
        ::sched_setaffinity(0, sizeof before, &before);
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(outputs().size(), 61u);
        if (!alone) all = contents();
    }
    EXPECT_TRUE(contents() == all);
}

TEST_F(Workers, InterruptsAtAnyMomentLoseNothing) {
    ASSERT_EQ(run(frames("f%02d.png")).status, 0);
    const auto whole = contents();
    std::mt19937 random(5);
    size_t early = 0;
    for (const int signal : {SIGINT, SIGKILL, SIGTERM, SIGINT, SIGKILL, SIGINT, SIGTERM, SIGKILL}) {
        remove_outputs();
        const Running running = start(frames("f%02d.png"));
        wait_for(out("f%02d.png.json"));
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 120));
        ::kill(running.process, signal);
        const Outcome cut = running.wait();
        size_t there = 0;
        for (const auto& [name, bytes] : contents()) {
            if (name.starts_with(".peelray-")) {
                EXPECT_EQ(signal, SIGKILL) << name;
                continue;
            }
            there += name.ends_with(".png");
            EXPECT_TRUE(whole.at(name) == bytes) << name;
        }
        early += there < 60;
        std::smatch said;
        if (cut.status == 1) {
            ASSERT_TRUE(std::regex_match(cut.err, said,
                                         std::regex("peelray: interrupted after (\\d+) of 60 frames: the "
                                                    "same command with --resume goes on\n")))
                << cut.err;
            EXPECT_EQ(size_t(std::stoi(said[1])), there);
        }
        const Outcome rest = run(frames("f%02d.png", {"--resume"}));
        EXPECT_EQ(rest.status, 0) << rest.err;
        auto after = contents();
        std::erase_if(after, [](const auto& entry) { return entry.first.starts_with(".peelray-"); });
        EXPECT_TRUE(after == whole);
    }
    EXPECT_GE(early, 2u) << "most were to be caught in the middle";
}

TEST_F(Workers, AnErrorIsOneLineThatNamesTheFile) {
    fs::create_directory(out("f07.png"));
    const Outcome run = this->run(frames("f%02d.png"));
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.out, "");
    ASSERT_EQ(run.complaints().size(), 1u) << run.err;
    EXPECT_NE(run.err.find("f07.png: it is a folder"), std::string::npos) << run.err;
    for (const std::string& name : outputs()) {
        EXPECT_FALSE(name.starts_with(".peelray-")) << name;
        if (name.ends_with(".png") && name != "f07.png") {
            EXPECT_EQ(read_ldr(out(name)).width, 64u) << name;
        }
    }
    EXPECT_TRUE(fs::exists(out("f00.png")));
    EXPECT_FALSE(fs::exists(out("f59.png")));
}

TEST_F(Workers, FramesInTheStatsAreInOrder) {
    ASSERT_EQ(run(frames("f%02d.png", {"--stats", in("s.json")})).status, 0);
    const auto stats = nlohmann::json::parse(get(in("s.json")));
    ASSERT_EQ(stats["frames"].size(), 60u);
    for (size_t i = 0; i < 60; i++) EXPECT_EQ(stats["frames"][i]["frame"], i);
    EXPECT_EQ(stats["totals"]["frames"], 60);
}

/// What a device hands over differs by format, what it shows does not.
TEST_F(Workers, FormatsShowTheSamePicture) {
    for (const std::string tracer : {"none", "cpu"}) {
        const auto render_to = [&](const std::string& name, const Words& more = {}) {
            Words all = {"--tracer", tracer, "--time", "0.3", "--spp", "3", "--aov", "depth"};
            all.insert(all.end(), more.begin(), more.end());
            const Outcome run = render(in("moving.gltf"), all, name);
            ASSERT_EQ(run.status, 0) << run.err;
            ASSERT_EQ(run.complaints().size(), 0u) << run.err;
        };
        render_to("a.png");
        render_to("b.exr", {"--preview", out("c.png")});
        render_to("d.exr", {"--half", "no", "--exr-compression", "none"});
        render_to("e.png", {"--preview", out("f.exr")});
        EXPECT_TRUE(get(out("a.png")) == get(out("c.png")));
        EXPECT_TRUE(get(out("a.png")) == get(out("e.png")));
        EXPECT_TRUE(get(out("b.exr")) == get(out("f.exr")));
        const Image half = read_hdr(out("b.exr")), full = read_hdr(out("d.exr"));
        Imf::InputFile file(out("d.exr").c_str()), depth(out("d.depth.exr").c_str());
        EXPECT_EQ(file.header().channels().findChannel("R")->type, Imf::FLOAT);
        EXPECT_EQ(file.header().compression(), Imf::NO_COMPRESSION);
        EXPECT_EQ(depth.header().compression(), Imf::NO_COMPRESSION);
        EXPECT_EQ(depth.header().channels().findChannel("Z")->type, Imf::FLOAT);
        EXPECT_EQ(Imf::InputFile(out("b.exr").c_str()).header().channels().findChannel("R")->type, Imf::HALF);
        for (size_t i = 0; i < full.pixels.size(); i++)
            for (int c = 0; c < 4; c++) ASSERT_EQ(half.pixels[i][c], float(Imath::half(full.pixels[i][c]))) << i;
        remove_outputs();
    }
}

TEST_F(Workers, ValuesBeyondHalvesAreTold) {
    const Words bright = {"--tracer", "none", "--background", "100000,1,1", "--effects", "none"};
    const Outcome run = render(in("moving.gltf"), bright, "a.exr");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(
        std::regex_search(run.err, std::regex("peelray: note: \\d+ values were brighter than half floats reach and "
                                              "became 65504: --half no keeps them\n")))
        << run.err;
    Words sequence_words = words("f%d.exr", {"--turntable", "3"});
    sequence_words.insert(sequence_words.end(), bright.begin(), bright.end());
    const Outcome several = this->run(sequence_words);
    size_t notes = 0;
    for (size_t at = 0; (at = several.err.find("brighter than half", at)) != std::string::npos; at++) notes++;
    EXPECT_EQ(notes, 1u) << several.err;
    Words full = bright;
    full.insert(full.end(), {"--half", "no"});
    const Outcome kept = render(in("moving.gltf"), full, "b.exr");
    EXPECT_EQ(kept.err.find("half"), std::string::npos) << kept.err;
    float most = 0;
    for (const glm::vec4& pixel : read_hdr(out("b.exr")).pixels) most = std::max(most, pixel.x);
    EXPECT_NEAR(most, 100000, 1);
}

TEST_F(Workers, HalfIsForExr) {
    for (const std::string name : {"a.png", "a.hdr"})
        expect_refused(render(in("moving.gltf"), {"--half"}, name), 1, "name it .exr, or leave --half out");
    expect_refused(render(in("moving.gltf"), {"--exr-compression", "none"}), 1, "or leave --exr-compression out");
    expect_refused(render(in("moving.gltf"), {"--half", "maybe"}, "a.exr"), 2, "");
}

}  // namespace
}  // namespace peelray
