// `peelray render` of several frames: names, moments, turntables, stats, the terminal.
#include <fcntl.h>
#include <stdlib.h>

#include <set>

#include "cli/sequence_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

TEST_F(SequenceTest, FramesAreNamedByThePattern) {
    const Outcome run = sequence("f_%03d.png", {"--frames", "9:11"});
    expect_done(run, {"f_%03d.png.json", "f_009.png", "f_010.png"});
    for (const std::string part : {"f_%03d.png: 2 frames of 9 to 10", "64x48", " s in all", " frames/s on "})
        EXPECT_NE(run.out.find(part), std::string::npos) << run.out << part;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
    remove_outputs();
    expect_done(sequence("100%%_%d.x.EXR", {"--frames", "9:11"}),
                {"100%%_%d.x.EXR.json", "100%_10.x.EXR", "100%_9.x.EXR"});
    remove_outputs();
    expect_done(sequence("%01d.hdr", {"--frames", "99:101", "--fps", "1000"}), {"%01d.hdr.json", "100.hdr", "99.hdr"});
}

/// Frame k is the picture of --time k/F, to the last bit, whatever was rendered before it.
struct MomentsCase {
    std::string name;
    Words words;  ///< the scene and options
};

class Moments : public SequenceTest, public testing::WithParamInterface<MomentsCase> {};

TEST_P(Moments, EqualPicturesRenderedAlone) {
    const Words& options = GetParam().words;
    const auto with = [&](Words more) {
        more.insert(more.end(), options.begin() + 1, options.end());
        return more;
    };
    const std::string scene = options[0];
    if (scene.starts_with("/") && !std::filesystem::exists(scene))
        GTEST_SKIP() << "the test models are not here: " << scene;
    const Outcome run = sequence("f%d.exr", with({"--frames", "5:8", "--fps", "7", "--aov", "depth"}), scene);
    ASSERT_EQ(run.status, 0) << run.err;
    for (const int k : {5, 7}) {
        // In full precision, as a user would copy it.
        ASSERT_EQ(sequence("one.exr", with({"--time", fmt::format("{}", k / 7.0), "--aov", "depth"}), scene).status, 0);
        EXPECT_EQ(get(out("one.exr")), get(out(fmt::format("f{}.exr", k)))) << k;
        EXPECT_EQ(get(out("one.depth.exr")), get(out(fmt::format("f{}.depth.exr", k)))) << k;
    }
    EXPECT_NE(get(out("f5.exr")), get(out("f7.exr")));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Moments,
    testing::Values(
        MomentsCase{"ldc", {"moving.gltf", "--floor", "--material", "mirror"}},
        MomentsCase{"cubemap", {"moving.gltf", "--floor", "--tracer", "cubemap"}},
        MomentsCase{"none", {"moving.gltf", "--tracer", "none"}},
        MomentsCase{"reference", {"moving.gltf", "--floor", "--tracer", "reference", "--material", "glass"}},
        MomentsCase{"camera", {"camera.gltf", "--floor"}}, MomentsCase{"all", {"camera.gltf", "--animation", "all"}},
        MomentsCase{"skin", {PEELRAY_MODELS "/skinned/CesiumMan.glb", "--floor"}},
        MomentsCase{"morph", {PEELRAY_MODELS "/skinned/AnimatedMorphCube.glb", "--floor", "--tracer", "none"}}),
    [](const auto& info) { return info.param.name; });

TEST_F(SequenceTest, TheCameraAndTheFloorDoNotMove) {
    ASSERT_EQ(sequence("f%d.png", {"--frames", "0:5", "--fps", "4", "--floor", "--aov", "depth,triangle"}).status, 0);
    // Triangles 0 and 1 stand, 2 and 3 move, the floor's are the last: 4 and 5.
    const Image first_id = read_hdr(out("f0.triangle.exr")), first = read_hdr(out("f0.depth.exr"));
    std::set<float> seen;
    for (const uint32_t x : {0u, 32u, 63u}) EXPECT_GE(first_id.at(x, 47).x, 4) << x;
    for (const int k : {1, 2, 3, 4}) {
        const Image id = read_hdr(out(fmt::format("f{}.triangle.exr", k)));
        const Image depth = read_hdr(out(fmt::format("f{}.depth.exr", k)));
        for (size_t i = 0; i < id.pixels.size(); i++) {
            const float a = first_id.pixels[i].x, b = id.pixels[i].x;
            seen.insert(b);
            if (a == b && a != 2 && a != 3) {
                EXPECT_EQ(first.pixels[i].x, depth.pixels[i].x) << k;
            }
        }
    }
    for (const float triangle : {0, 1, 2, 3, 4, 5}) EXPECT_TRUE(seen.count(triangle)) << triangle;
}

TEST_F(SequenceTest, EverythingIsInSightAllTheTime) {
    // The square leaves the box of the rest pose far behind; the frame is made for all moments.
    for (const std::string time : {"0", "0.5", "1"}) {
        expect_done(sequence("a.png", {"--time", time, "--aov", "triangle"}), {"a.png", "a.triangle.exr"});
        const Image id = read_hdr(out("a.triangle.exr"));
        for (uint32_t i = 0; i < 64; i++)
            EXPECT_EQ(std::max(id.at(i, 0).x, id.at(i, 47).x), 0) << time;  // none: -1 → 0
        const auto moving = std::count_if(id.pixels.begin(), id.pixels.end(),
                                          [](const glm::vec4& pixel) { return pixel.x == 2 || pixel.x == 3; });
        EXPECT_GT(moving, 30) << time;
    }
}

TEST_F(SequenceTest, AMomentWithoutAnySurfaceIsAPicture) {
    auto gltf = moving_gltf();
    gltf["scenes"][0]["nodes"] = {1};
    put("grow.gltf", gltf.dump());
    for (const std::string tracer : {"ldc", "cubemap", "none", "reference"}) {
        SCOPED_TRACE(tracer);
        const Outcome run = sequence(
            "f%d.exr", {"--frames", "0:2", "--fps", "4", "--animation", "grow", "--tracer", tracer}, "grow.gltf");
        expect_done(run, {"f%d.exr.json", "f0.exr", "f1.exr"});
        for (const glm::vec4& pixel : read_hdr(out("f0.exr")).pixels) ASSERT_EQ(pixel.w, 0);
        EXPECT_GT(read_hdr(out("f1.exr")).at(32, 24).w, 0);
        remove_outputs();
    }
}

TEST_F(SequenceTest, WithoutAnAnimationAllFramesAreAlike) {
    put("cube.obj", kCube);
    const Outcome run = sequence("f%d.png", {"--frames", "0:2"}, "cube.obj");
    expect_done(run, {"f%d.png.json", "f0.png", "f1.png"});
    EXPECT_NE(run.err.find("peelray: note: the scene has no animation: everything stands at rest"), std::string::npos);
    EXPECT_EQ(get(out("f0.png")), get(out("f1.png")));
}

TEST_F(SequenceTest, NotesAreSaidOnce) {
    const Outcome run =
        sequence("f%d.png", {"--frames", "0:3", "--tracer", "cubemap", "--effects", "reflection,ambient"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

// ---- turntables

size_t different_pixels(const std::string& a, const std::string& b) {
    const Image8 first = read_ldr(a), second = read_ldr(b);
    size_t count = 0;
    for (size_t i = 0; i < first.pixels.size(); i++) count += first.pixels[i] != second.pixels[i];
    return count;
}

TEST_F(SequenceTest, TheTurntableGoesRound) {
    const Words view = {"--look", "0,0,0.5", "--floor"};
    const auto seen_from = [&](const std::string& name, const std::string& eye) {
        Words more = view;
        more.insert(more.end(), {"--eye", eye});
        EXPECT_EQ(sequence(name, more).status, 0);
    };
    Words turn = view;
    turn.insert(turn.end(), {"--eye", "1,2,4.5", "--turntable", "4"});
    expect_done(sequence("t%d.png", turn), {"t%d.png.json", "t0.png", "t1.png", "t2.png", "t3.png"});
    seen_from("0.png", "1,2,4.5");
    seen_from("1.png", "4,2,-0.5");  // counter-clockwise from above
    seen_from("2.png", "-1,2,-3.5");
    seen_from("3.png", "-4,2,1.5");
    EXPECT_EQ(get(out("t0.png")), get(out("0.png")));
    // Sines and cosines round: an edge may fall to the other side of a pixel's centre.
    for (const int k : {1, 2, 3}) {
        const std::string frame = out(fmt::format("t{}.png", k));
        EXPECT_LE(different_pixels(frame, out(fmt::format("{}.png", k))), 10u) << k;
        EXPECT_GT(different_pixels(frame, out("0.png")), 500u) << k;
    }
}

TEST_F(SequenceTest, TheTurntableStandsUnlessToldOtherwise) {
    const auto times = [&](Words more) {
        more.insert(more.end(), {"--turntable", "8", "--frames", "6:8", "--stats", out("s.json"), "--tracer", "cpu"});
        const Outcome run = sequence("t%d.png", more);
        EXPECT_EQ(run.status, 0) << run.err;
        nlohmann::json times;
        const auto stats = nlohmann::json::parse(get(out("s.json")));
        for (const auto& frame : stats["frames"]) {
            times.push_back(frame["time"]);
            EXPECT_EQ(frame["turn_degrees"], 45 * frame["frame"].get<int>());
        }
        return times;
    };
    EXPECT_EQ(times({}), nlohmann::json({nullptr, nullptr}));
    expect_done(sequence("t%d.png", {"--turntable", "8", "--frames", "6:8", "--tracer", "cpu"}),
                {"s.json", "t%d.png.json", "t6.png", "t7.png"});
    EXPECT_EQ(times({"--time", "0.25"}), nlohmann::json({0.25, 0.25}));
    EXPECT_EQ(times({"--time", "0.25", "--animation", "grow"}), nlohmann::json({0.25, 0.25}));
    EXPECT_EQ(times({"--fps", "8"}), nlohmann::json({0.75, 0.875}));
    EXPECT_EQ(times({"--animation", "grow"}), nlohmann::json({6 / 30.0, 7 / 30.0}));
}

TEST_F(SequenceTest, NothingLeavesTheTurntablesPicture) {
    // A bar that is nearly twice as long from the side as it is wide at first.
    put("bar.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 9\nv 1 0 9\nv 1 1 9\nv 0 1 9\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n");
    ASSERT_EQ(sequence("t%d.exr", {"--turntable", "8", "--tracer", "none"}, in("bar.obj")).status, 0);
    uint32_t least = 64;
    for (int k = 0; k < 8; k++) {
        const Image frame = read_hdr(out(fmt::format("t{}.exr", k)));
        for (uint32_t y = 0; y < 48; y++)
            for (uint32_t x = 0; x < 64; x++)
                if (frame.at(x, y).w > 0) least = std::min({least, x, 63 - x, y, 47 - y});
    }
    EXPECT_GE(least, 2u) << "5 % of 48 pixels stay free";
    EXPECT_LE(least, 5u);
}

// ---- stats and the terminal

TEST_F(SequenceTest, StatsTellOfEveryFrame) {
    expect_done(sequence("f%d.png", {"--frames", "3:6", "--fps", "10", "--stats", out("s.json"), "--material", "mirror",
                                     "--tracer", "ldc"}),
                {"f%d.png.json", "f3.png", "f4.png", "f5.png", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    ASSERT_EQ(stats["frames"].size(), 3u);
    double frame_ms = 0;
    uint64_t reflection = 0;
    for (int i = 0; i < 3; i++) {
        const auto& frame = stats["frames"][size_t(i)];
        EXPECT_EQ(frame["frame"], 3 + i);
        EXPECT_EQ(frame["time"], (3 + i) / 10.0);
        EXPECT_FALSE(frame.contains("turn_degrees"));
        for (const char* key : {"device", "driver", "commit", "passes", "ldc", "rays", "triangles", "image"})
            EXPECT_TRUE(frame.contains(key)) << key;
        frame_ms += frame["frame_ms"].get<double>();
        reflection += frame["rays"]["reflection"].get<uint64_t>();
    }
    EXPECT_GT(reflection, 0u);
    const auto& totals = stats["totals"];
    EXPECT_EQ(totals["frames"], 3);
    EXPECT_EQ(totals["frames_left_alone"], 0);
    EXPECT_EQ(totals["rays"]["primary"], 3 * 64 * 48);
    EXPECT_EQ(totals["rays"]["reflection"], reflection);
    EXPECT_NEAR(totals["frame_ms"].get<double>(), frame_ms, 1e-6 * frame_ms);
    EXPECT_GT(totals["seconds"], 0);
    EXPECT_NEAR(totals["frames_per_second"].get<double>() * totals["seconds"].get<double>(), 3, 1e-6);
}

/// What the program writes to a terminal that is its standard error.
std::string on_a_terminal(const Words& arguments) {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) return "";
    const int terminal = ::open(::ptsname(master), O_RDWR | O_NOCTTY);
    Words copies = arguments;
    std::vector<char*> argv;
    std::string program = PEELRAY_PROGRAM;
    argv.push_back(program.data());
    for (std::string& word : copies) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::setenv("XDG_CACHE_HOME", PEELRAY_CACHE, 1);
        ::dup2(::open("/dev/null", O_WRONLY), 1);
        ::dup2(terminal, 2);
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
    ::close(terminal);
    std::string text;
    char block[4096];
    for (ssize_t count; (count = ::read(master, block, sizeof block)) > 0;) text.append(block, size_t(count));
    ::close(master);
    ::waitpid(child, nullptr, 0);
    return text;
}

TEST_F(SequenceTest, ATerminalShowsHowFarItGot) {
    const Words arguments = words("f%d.png", {"--frames", "0:60", "--floor", "--spp", "4"});
    const std::string text = on_a_terminal(arguments);
    EXPECT_NE(text.find("rendering ["), std::string::npos) << text;
    EXPECT_NE(text.find("/60 frames, "), std::string::npos) << text;
    EXPECT_NE(text.find(" frames/s, "), std::string::npos) << text;
    EXPECT_NE(text.find(" s left"), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
    EXPECT_EQ(text.find('%'), std::string::npos) << "the bar of a single picture: " << text;
    EXPECT_EQ(run(arguments).err, "");  // a file is no terminal
}

// ---- refusals

TEST_F(SequenceTest, NamesThatDoNotFit) {
    const auto refused = [&](const std::string& name, const Words& more, const std::string& says, int status = 1) {
        SCOPED_TRACE(name);
        expect_refused(sequence(name, more), status, says);
    };
    const Words frames = {"--frames", "0:3"};
    for (const std::string name : {"f%d.png", "f_%05d.exr", "v.mp4", "v.WEBM"})
        refused(name, {}, "say which frames with --frames A:B or --turntable N");
    for (const Words& more : {frames, Words{"--turntable", "3"}}) refused("f.png", more, "such as frame_%05d.exr");
    refused("%d/f.png", frames, "such as frame_%05d.exr");
    refused("f%%d.png", frames, "such as frame_%05d.exr");
    refused("f%d_%d.png", frames, "two numbers");
    for (const std::string part : {"%s", "%5d", "%i", "%x", "%00d", "%0123d", "%ld", "% d", "%f", "%-5d", "%+d"})
        refused("f" + part + ".png", frames, "'" + part + "' in ");
    refused("f%d.png%", frames, "'%' in ");
    refused("f%d.jpg", frames, "name it .png, .exr or .hdr");
    refused("f%d", frames, "name it .png, .exr or .hdr");
    expect_refused(run({"render", in("moving.gltf"), "-o", "/proc/f%d.png", "--frames", "0:3"}), 1, "cannot write");
}

TEST_F(SequenceTest, RangesThatMakeNoSense) {
    const auto refused = [&](const Words& more, const std::string& says, int status = 1) {
        SCOPED_TRACE(testing::PrintToString(more));
        expect_refused(sequence("f%d.png", more), status, says);
    };
    for (const std::string text : {"3", "3:", ":3", "-1:3", "1.5:3", "a:b", "0:3:1", "0-3", "", "0:4294967296"})
        refused({"--frames", text}, "'" + text + "' is not a range of frames A:B", 2);
    refused({"--frames", "3:3"}, "--frames 3:3 holds no frame");
    refused({"--frames", "5:3"}, "--frames 5:3 holds no frame");
    refused({"--frames", "0:10000001"}, "10000001 frames are too many");
    refused({"--frames", "999999999:1000000000", "--fps", "30"}, "beyond 1000000 seconds");
    for (const std::string fps : {"0", "-1", "nan", "inf", "1001"})
        refused({"--frames", "0:3", "--fps", fps}, "frames per second are out of range");
    refused({"--turntable", "0"}, "a turntable of 0 frames");
    refused({"--turntable", "-3"}, "'-3' is not a whole number", 2);
    refused({"--turntable", "4", "--frames", "2:5"}, "beyond the 4 frames of the turntable");
    for (const std::string shard : {"3/3", "0/0", "7/2"})
        refused({"--frames", "0:3", "--shard", shard}, "there is no shard " + shard);
    for (const std::string shard : {"x", "1", "1/", "/2", "-1/2", "1:2", "1/2/3", ""})
        refused({"--frames", "0:3", "--shard", shard}, "'" + shard + "' is not a part i/n", 2);
    refused({"--frames", "0:3", "--time", "1"}, "leave one of them out");
    refused({"--frames", "0:3", "--frame-moment"}, "--frame-moment would frame each of many moments anew");
    refused({"--frames", "0:3", "--repeat", "2"}, "--repeat measures one picture");
    refused({"--frames", "0:3", "--animation", "swim"}, "no animation 'swim': there is 0: fly, 1: grow");
    refused({"--frames", "0:3", "--stats", out("f2.png")}, "written twice");
    refused({"--frames", "0:3", "--stats", out("f%d.png.json")}, "written twice");
}

TEST_F(SequenceTest, OptionsOfSequencesWithoutOne) {
    for (const Words& more : {Words{"--fps", "30"}, Words{"--shard", "0/2"}, Words{"--resume"}})
        expect_refused(sequence("a.png", more), 1, more[0] + " is for several frames: add --frames A:B");
    for (const Words& more : {Words{"--frames", "0:3"}, Words{"--turntable", "9"}, Words{"--fps", "30"},
                              Words{"--shard", "0/2"}, Words{"--resume"}}) {
        Words all = {"compare", in("moving.gltf"), "-o", out("r.html")};
        all.insert(all.end(), more.begin(), more.end());
        expect_refused(run(all), 2, "a comparison shows one moment");
    }
    put("cube.obj", kCube);
    expect_refused(sequence("f%d.png", {"--frames", "0:3", "--animation", "fly"}, "cube.obj"), 1, "no animation");
}

TEST_F(SequenceTest, InputsAreNotOverwritten) {
    write_hdr(in("f2.hdr"), Image{2, 1, {glm::vec4(1), glm::vec4(1)}});
    const std::string before = get(in("f2.hdr"));
    expect_refused(run({"render", in("moving.gltf"), "-o", in("f%d.hdr"), "--frames", "0:3", "--env", in("f2.hdr")}), 1,
                   "f2.hdr is an input and would be overwritten");
    // A texture is an input, too.
    auto gltf = moving_gltf();
    gltf["images"] = {{{"uri", "t1.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    put("textured.gltf", gltf.dump());
    write_png(in("t1.png"), Image8{1, 1, {0xff0000ffu}});
    expect_refused(run({"render", in("textured.gltf"), "-o", in("t%d.png"), "--frames", "0:3"}), 1,
                   "t1.png is an input and would be overwritten");
    EXPECT_EQ(get(in("f2.hdr")), before);
    EXPECT_EQ(read_ldr(in("t1.png")).width, 1u);
}

}  // namespace
}  // namespace peelray
