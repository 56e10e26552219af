// Wrong usage (status 2), impossible values and what is not built yet (status 1), help.
#include "cli/program_fixture.h"

namespace peelray {
namespace {

using Words = std::vector<std::string>;

struct Case {
    Words arguments;
    std::string says;
};

class Usage : public ProgramTest {
  protected:
    /// Every case is refused with `status` when added to a render of the cube.
    void expect_each(int status, const std::vector<Case>& cases) const {
        put("cube.obj", kCube);
        for (const Case& c : cases) {
            SCOPED_TRACE(testing::PrintToString(c.arguments));
            expect_refused(render(in("cube.obj"), c.arguments), status, c.says);
        }
    }
};

TEST_F(Usage, CommandMissingOrUnknown) {
    expect_refused(run({}), 2, "name a command: render, compare, trace, bench, info, devices or doctor");
    expect_refused(run({"rendr", "x"}), 2, "unknown command 'rendr'");
    expect_refused(run({"--colour"}), 2, "unknown option '--colour'");
}

TEST_F(Usage, ArgumentsMissing) {
    expect_refused(run({"render"}), 2, "SCENE is required");
    expect_refused(run({"render", "builtin:glass"}), 2, "--output is required");
    expect_refused(run({"render", "-o", out("a.png")}), 2, "SCENE is required");
    expect_refused(run({"compare"}), 2, "SCENE is required");
    expect_refused(run({"compare", "builtin:glass"}), 2, "--output is required");
    expect_refused(run({"trace", "builtin:glass", "--out", out("a.npy")}), 2, "--rays is required");
    expect_refused(run({"trace", "builtin:glass", "--rays", in("r.npy")}), 2, "--out is required");
    expect_refused(run({"info"}), 2, "SCENE is required");
}

TEST_F(Usage, UnknownFlagsAndSurplusArguments) {
    expect_each(2, {{{"--sise", "1x1"}, "unknown option '--sise'"},
                    {{"-x"}, "unknown option '-x'"},
                    {{"more"}, "'more' is one argument too many"}});
    expect_refused(run({"info", "builtin:glass", "--size", "1x1"}), 2, "unknown option '--size'");
    expect_refused(run({"devices", "0"}), 2, "'0' is one argument too many");
    expect_refused(run({"trace", "--any"}), 2, "unknown option '--any'");
}

TEST_F(Usage, MalformedValues) {
    put("cube.obj", kCube);
    for (const std::string size :
         {"abc", "64", "64x", "x48", "64x48x2", "-64x48", "6.4x48", "64 x 48", "", "99999999999x1"})
        expect_refused(run({"render", in("cube.obj"), "-o", out("a.png"), "--size", size}), 2,
                       "'" + size + "' is not a picture size");
    expect_each(2,
                {{{"--hit", "sometimes"}, "'sometimes' is not one of auto|exact|planar|tolerance"},
                 {{"--builder", "x"}, "--builder"},
                 {{"--traversal", "x"}, "--traversal"},
                 {{"--tracer", "x"}, "--tracer"},
                 {{"--tonemap", "x"}, "--tonemap"},
                 {{"--material", "wood"}, "mirror|glass|clay"},
                 {{"--ldc", "many"}, "'many' is not auto or a number"},
                 {{"--block", "x"}, "--block"},
                 {{"--tolerance", "x"}, "--tolerance: 'x' is not a number"},
                 {{"--spp", "-1"}, "'-1' is not a whole number"},
                 {{"--spp", "1.5"}, "whole number"},
                 {{"--bounces", "1e1"}, "whole number"},
                 {{"--repeat", "x"}, "--repeat"},
                 {{"--fov", "wide"}, "'wide' is not a number"},
                 {{"--exposure", "1e"}, "'1e' is not a number"},
                 {{"--eye", "1,2"}, "'1,2' is not three numbers X,Y,Z"},
                 {{"--look", "1,2,3,4"}, "--look"},
                 {{"--up", "a,b,c"}, "--up"},
                 {{"--background", "blue"}, "three numbers R,G,B"},
                 {{"--effects", "magic"}, "'magic' is not a list out of reflection,refraction,shadow,ambient, or none"},
                 {{"--effects", ""}, "--effects"},
                 {{"--aov", "depth,colour"}, "--aov"},
                 {{"--time", "x"}, "--time"},
                 {{"--fps", "x"}, "--fps"},
                 {{"--spp"}, "--spp"},
                 {{"--spp", "1", "--spp", "x"}, "--spp: 'x' is not a whole number"}});
}

TEST_F(Usage, OfAnOptionGivenTwiceTheLastCounts) {
    put("cube.obj", kCube);
    const auto bytes = [&](const Words& more, const std::string& name) {
        const Outcome run = render(in("cube.obj"), more, name);
        EXPECT_EQ(run.status, 0) << run.err;
        return get(out(name));
    };
    const Words eye = {"--eye", "3,2,4", "--background", "1,0,0", "--exposure", "1"};
    const std::string once = bytes(eye, "once.png");
    EXPECT_EQ(bytes({"--eye", "9,9,9", "--background", "0,0,0", "--exposure", "-3", "--eye", "3,2,4", "--exposure", "1",
                     "--background", "1,0,0"},
                    "twice.png"),
              once);
    EXPECT_NE(bytes({"--eye", "3,2,4", "--background", "1,0,0", "--exposure", "1", "--exposure", "-3"}, "other.png"),
              once);
    for (const std::string& name : outputs()) std::filesystem::remove(out(name));
    expect_done(render(in("cube.obj"), {"--output", out("last.png"), "--sky", "--sky"}, "first.png"), {"last.png"});
    put("rays.npy", rays_npy({0.5f, 0.5f, 3, 0, 0, 0, -1, 9}));
    std::filesystem::remove(out("last.png"));
    expect_done(run({"trace", in("cube.obj"), "--out", out("a.npy"), "--rays", in("gone.npy"), "--out", out("b.npy"),
                     "--rays", in("rays.npy")}),
                {"b.npy"});
}

TEST_F(Usage, WhatAMessageSuggestsWorks) {
    put("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string scene = in("triangle.obj"), begin = "choose at most ";
    const Outcome coarse = render(scene, {"--hit", "tolerance", "--tolerance", "5"});
    const size_t at = coarse.err.find(begin);
    ASSERT_NE(at, std::string::npos) << coarse.err;
    const std::string most =
        coarse.err.substr(at + begin.size(), coarse.err.find(' ', at + begin.size()) - at - begin.size());
    expect_done(render(scene, {"--hit", "tolerance", "--tolerance", most}), {"a.png"});
    std::filesystem::remove(out("a.png"));
    expect_refused(render(scene, {"--depth", "16"}), 1,
                   "use --depth 16 with --traversal two-level or mipmap, and with --hit tolerance or planar");
    expect_done(render(scene, {"--depth", "16", "--traversal", "mipmap", "--hit", "planar", "--ldc", "64"}), {"a.png"});
    std::filesystem::remove(out("a.png"));
    expect_refused(run({"info", in("")}), 1, "not a regular file but a folder; name a scene in it");
}

TEST_F(Usage, ASceneWithoutACommand) {
    put("cube.obj", kCube);
    put("my notes.txt", "x");
    std::filesystem::create_directory(folder / "models");
    put("models/b.glb", "x");
    put("models/a.gltf", "x");
    std::filesystem::create_directory(folder / "empty");
    const auto says = [&](const Words& words, const std::string& advice) {
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refused(run(words), 2, "name a command before the scene: peelray render " + advice + " (see");
    };
    says({"model.glb"}, "model.glb -o picture.png");
    says({"./x.obj"}, "./x.obj -o picture.png");
    says({in("cube.obj")}, in("cube.obj") + " -o picture.png");
    says({"gone/MODEL.GLTF"}, "gone/MODEL.GLTF -o picture.png");
    says({"builtin:teapots"}, "builtin:teapots -o picture.png");
    says({in("my notes.txt")}, "'" + in("my notes.txt") + "' -o picture.png");
    says({in("models")}, in("models/a.gltf") + " -o picture.png");
    says({in("empty")}, in("empty/MODEL.glb") + " -o picture.png");
    says({"model.glb", "--size", "64x48"}, "model.glb --size 64x48 -o picture.png");
    says({"model.glb", "-o", "a.exr"}, "model.glb -o a.exr");
    says({"model.glb", "--output=a.exr"}, "model.glb --output=a.exr");
    expect_refused(run({in("cube.obj"), "info"}), 2,
                   "the command comes before the scene: peelray info " + in("cube.obj"));
    expect_refused(run({"x.obj", "render", "-o", "a.png"}), 2, "peelray render x.obj -o a.png");
}

TEST_F(Usage, ACommandIsNoFolderOfItsName) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::create_directory(folder / "bench");
    std::filesystem::current_path(folder / ".");
    const Outcome wrong = run({"bench", "--size", "x"});
    std::filesystem::current_path(before);
    expect_refused(wrong, 2, "is not a picture size");
}

TEST_F(Usage, OptionsThatExcludeEachOther) {
    expect_each(2, {{{"--env", "e.hdr", "--sky"}, "excludes"}});
}

TEST_F(Usage, ImpossibleValues) {
    put("cube.obj", kCube);
    for (const std::string size : {"0x0", "64x0", "100000x100000", "4294967295x4294967295"})
        expect_refused(run({"render", in("cube.obj"), "-o", out("a.png"), "--size", size}), 1, "a picture of " + size);
    expect_each(1, {{{"--fov", "0"}, "field of view"},
                    {{"--fov", "180"}, "field of view"},
                    {{"--fov", "nan"}, "field of view"},
                    {{"--ldc", "15"}, "16 to 2048"},
                    {{"--ldc", "0"}, "16 to 2048"},
                    {{"--ldc", "2049"}, "16 to 2048"},
                    {{"--bounces", "17"}, "0 to 16"},
                    {{"--spp", "0"}, "1 to 65536"},
                    {{"--spp", "65537"}, "1 to 65536"},
                    {{"--repeat", "0"}, "1 to 10000"},
                    {{"--exposure", "65"}, "-64 to 64"},
                    {{"--exposure", "nan"}, "-64 to 64"},
                    {{"--tolerance", "0"}, "above 0"},
                    {{"--block", "0"}, "2 to 32"},
                    {{"--block", "33x8"}, "2 to 32"},
                    {{"--depth", "24"}, "16 or 32"},
                    {{"--batch", "rays"}, "--traversal two-level"},
                    {{"--depth", "16"}, "--traversal two-level"},
                    {{"--depth", "16", "--traversal", "mipmap", "--hit", "exact"}, "--hit tolerance"},
                    {{"--background", "-1,0,0"}, "darker than black"},
                    {{"--background", "inf,0,0"}, "finite"},
                    {{"--eye", "nan,0,0"}, "finite"},
                    {{"--look", "inf,0,0"}, "finite"},
                    {{"--up", "0,0,nan"}, "finite"},
                    {{"--eye", "0,0,5", "--look", "0,0,5"}, "must differ"},
                    {{"--eye", "0,0,5", "--look", "0,0,0", "--up", "0,0,1"}, "another --up"},
                    {{"--up", "0,0,0"}, "up"},
                    {{"--camera", "7"}, "no cameras"},
                    {{"--animation", "0"}, "no animation"},
                    {{"--time", "-1"}, "0 to 1000000"},
                    {{"--time", "nan"}, "0 to 1000000"},
                    {{"--device", "no such device"}, "peelray devices"},
                    {{"--device", "99"}, "peelray devices"},
                    {{"--stats", out("a.png")}, "written twice"},
                    {{"--stats", in("cube.obj")}, "is an input"}});
}

TEST_F(Usage, NotBuiltYet) {
    expect_refused(run({"view", in("cube.obj")}), 1, "'view' is not built into this version");
}

TEST_F(Usage, RayTracingByTheDeviceWhereItHasIt) {
    put("cube.obj", kCube);
    put("rays.npy", rays_npy({0.5f, 0.5f, 3, 0, 0, 0, -1, 9}));
    const std::vector<std::string> render = {"render", in("cube.obj"), "-o",  out("a.png"), "--size",
                                             "16x16",  "--tracer",     "khr", "--stats",    out("a.json")},
                                   trace = {"trace",         in("cube.obj"), "--rays", in("rays.npy"), "--out",
                                            out("hits.npy"), "--tracer",     "khr",    "--stats",      out("t.json")},
                                   compare = {"compare", in("cube.obj"), "-o",        out("r.html"),
                                              "--size",  "16x16",        "--tracers", "khr,ldc"};
    if (run(render).status != 0) {
        for (const auto& command : {render, trace, compare})
            expect_refused(run(command), 1, "lacks VK_KHR_acceleration_structure: use --tracer ldc");
        return;
    }
    for (const auto& command : {render, trace, compare}) {
        const Outcome done = run(command);
        EXPECT_EQ(done.status, 0) << done.err;
    }
    for (const char* file : {"a.json", "t.json"}) {
        const auto stats = nlohmann::json::parse(get(out(file)));
        EXPECT_EQ(stats["tracer"], "khr");
        EXPECT_EQ(stats["khr"]["structures"], 1);
        EXPECT_EQ(stats["khr"]["built"], "once");
        EXPECT_GT(stats["khr"]["bytes"], 0);
        EXPECT_FALSE(stats.contains("ldc"));
    }
}

TEST_F(Usage, CubeMapsTraceNoRays) {
    put("cube.obj", kCube);
    put("rays.npy", rays_npy({0.5f, 0.5f, 3, 0, 0, 0, -1, 9}));
    expect_refused(
        run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy"), "--tracer", "cubemap"}), 1,
        "--tracer cubemap traces no rays from files: use --tracer ldc");
}

TEST_F(Usage, HelpMentionsEveryOption) {
    const Words tracing = {"--builder", "--hit", "--tolerance", "--traversal", "--block",    "--routing", "--depth",
                           "--batch",   "--ldc", "--tracer",    "--device",    "--validate", "--stats"};
    std::vector<std::pair<Words, Words>> pages = {
        {{"--help"}, {"render", "trace", "info", "devices", "doctor", "compare", "bench", "view", "--version"}},
        {{"render", "--help"},
         {"SCENE",           "-o,",           "--size",          "--eye",           "--look",         "--up",
          "--fov",           "--camera",      "--env",           "--sky",           "--background",   "--exposure",
          "--tonemap",       "--bounces",     "--spp",           "--effects",       "--time",         "--animation",
          "--frames",        "--fps",         "--aov",           "--turntable",     "--shard",        "--resume",
          "--material",      "--floor",       "--repeat",        "builtin:teapots", "builtin:blob:N", "1280x1024",
          "--counters",      "cost_steps",    "--visibility",    "--frame-moment",  "--exr-layers",   "--env-rotation",
          "--env-intensity", "--env-visible", "--shadow-catcher"}},
        {{"trace", "--help"}, {"SCENE", "--rays", "--out", "--any-hit", "--repeat", "--counters"}},
        {{"info", "--help"}, {"SCENE"}},
        {{"devices", "--help"}, {}},
        {{"doctor", "--help"}, {"--json"}},
        {{"compare", "--help"},
         {"SCENE", "-o,", "--tracers", "--hit", "--picture", "--json", "--strip", "--worst", "--size", "--env"}},
        {{"bench", "--help"},
         {"--paper", "--models", "--scenes", "--size", "--repeat", "--builders", "--traversals", "--hits", "--all",
          "--ldc", "--block", "--tolerance", "--out", "--markdown", "--device", "--validate"}},
        {{"view", "--help"}, {}}};
    for (int i : {1, 2}) pages[size_t(i)].second.insert(pages[size_t(i)].second.end(), tracing.begin(), tracing.end());
    for (const auto& [arguments, words] : pages) {
        const Outcome help = run(arguments);
        SCOPED_TRACE(testing::PrintToString(arguments));
        expect_done(help, {});
        for (const std::string& word : words) EXPECT_NE(help.out.find(word), std::string::npos) << word;
    }
    const Outcome version = run({"--version"});
    expect_done(version, {});
    EXPECT_TRUE(version.out.starts_with("peelray ")) << version.out;
}

}  // namespace
}  // namespace peelray
