// `peelray render` where all is well: every option, at 64x48.

#include <cmath>
#include <map>

#include "cli/channels.h"
#include "cli/program_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

class RenderCommand : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("cube.obj", kCube);
    }
    /// Renders and reads the linear picture back.
    Image radiance(std::vector<std::string> more) const {
        expect_done(render(in("cube.obj"), more, "a.exr"), {"a.exr"});
        return read_hdr(out("a.exr"));
    }
    std::string bytes(const std::string& scene, const std::vector<std::string>& more = {}) const {
        expect_done(render(scene, more), {"a.png"});
        return get(out("a.png"));
    }
};

const std::vector<std::string> kAway = {"--eye", "0,0,5", "--look", "0,0,10"};

std::vector<std::string> away(std::vector<std::string> more) {
    more.insert(more.end(), kAway.begin(), kAway.end());
    return more;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST_F(RenderCommand, EveryBuiltinScene) {
    for (const std::string scene : {"builtin:teapots", "builtin:glass", "builtin:tree", "builtin:blob:1000"}) {
        SCOPED_TRACE(scene);
        const Outcome run = render(scene);
        expect_done(run, {"a.png"});
        EXPECT_NE(run.out.find("64x48"), std::string::npos) << run.out;
        const Image8 picture = read_ldr(out("a.png"));
        EXPECT_EQ(picture.width, 64u);
        EXPECT_EQ(picture.height, 48u);
        std::vector<uint32_t> colours = picture.pixels;
        std::sort(colours.begin(), colours.end());
        EXPECT_GT(std::unique(colours.begin(), colours.end()) - colours.begin(), 100);
    }
}

TEST_F(RenderCommand, Formats) {
    expect_done(render(in("cube.obj"), {}, "a.PNG"), {"a.PNG"});
    expect_done(render(in("cube.obj"), {}, "b.exr"), {"a.PNG", "b.exr"});
    expect_done(render(in("cube.obj"), {}, "c.hdr"), {"a.PNG", "b.exr", "c.hdr"});
    EXPECT_EQ(read_ldr(out("a.PNG")).width, 64u);
    const Image exr = read_hdr(out("b.exr")), hdr = read_hdr(out("c.hdr"));
    ASSERT_EQ(exr.pixels.size(), 64u * 48u);
    ASSERT_EQ(hdr.pixels.size(), exr.pixels.size());
    for (size_t i = 0; i < exr.pixels.size(); i++)
        for (int c = 0; c < 3; c++)
            ASSERT_NEAR(exr.pixels[i][c], hdr.pixels[i][c],
                        0.02 * std::max({exr.pixels[i].x, exr.pixels[i].y, exr.pixels[i].z}));
}

TEST_F(RenderCommand, AuxiliaryPictures) {
    expect_done(render(in("cube.obj"), {"--aov", "all", "--eye", "0.5,0.5,3", "--look", "0.5,0.5,0"}),
                {"a.albedo.exr", "a.depth.exr", "a.instance.exr", "a.material.exr", "a.motion.exr", "a.normal.exr",
                 "a.png", "a.position.exr", "a.triangle.exr"});
    // The pixel right of and above the centre sees the near face at a distance of 2.
    EXPECT_NEAR(read_hdr(out("a.depth.exr")).at(32, 23).x, 2, 0.01);
    EXPECT_EQ(read_hdr(out("a.material.exr")).at(32, 23).x, 0);
    EXPECT_LE(read_hdr(out("a.triangle.exr")).at(33, 22).x, 1);
    EXPECT_EQ(read_hdr(out("a.instance.exr")).at(32, 23).x, 0);
    EXPECT_EQ(channels_of(out("a.motion.exr")), std::vector<float>(2 * 64 * 48, 0)) << "nothing moves";
}

TEST_F(RenderCommand, WhatThePaperSetsUpForMirrorRays) {
    const std::vector<std::string> view = {"--aov",    "reflection,box,directions", "--eye", "0.5,0.5,3", "--look",
                                           "0.5,0.5,0"};
    const std::vector<std::string> written = {"a.box.exr", "a.directions.exr", "a.png", "a.reflection.exr"};
    expect_done(render(in("cube.obj"), view), written);
    const std::vector<std::string> names = {"reflection", "box", "directions"};
    std::map<std::string, std::vector<float>> ours;
    for (const std::string& name : names) ours[name] = channels_of(out("a." + name + ".exr"));
    expect_done(render(in("cube.obj"), joined(view, {"--tracer", "reference"})), written);
    double most = 0;
    for (const std::string& name : names) {
        const std::vector<float> theirs = channels_of(out("a." + name + ".exr"));
        ASSERT_EQ(theirs.size(), ours[name].size()) << name;
        for (size_t i = 0; i < theirs.size(); i++)
            most = std::max(most, std::abs(double(theirs[i]) - double(ours[name][i])));
    }
    EXPECT_LT(most, 1e-4);
}

TEST_F(RenderCommand, AuxiliaryPicturesByName) {
    expect_done(render(in("cube.obj"), {"--aov", "normal,depth"}, "p.hdr"), {"p.depth.exr", "p.hdr", "p.normal.exr"});
}

TEST_F(RenderCommand, Stats) {
    expect_done(render("builtin:teapots", {"--stats", out("s.json"), "--ldc", "64", "--hit", "exact"}),
                {"a.png", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    for (const char* key : {"device", "driver", "api_version", "commit", "passes", "ldc", "rays", "mrays_per_second",
                            "triangles", "image"})
        EXPECT_TRUE(stats.contains(key)) << key;
    EXPECT_EQ(stats["image"], nlohmann::json({64, 48}));
    EXPECT_GT(stats["triangles"], 1000);
    ASSERT_FALSE(stats["passes"].empty());
    for (const auto& pass : stats["passes"]) {
        EXPECT_TRUE(pass["name"].is_string());
        EXPECT_GE(pass["ms"], 0);
    }
    EXPECT_EQ(stats["ldc"]["n"], 64);
    EXPECT_EQ(stats["ldc"]["builder"], "compute");
    EXPECT_EQ(stats["hit"], "exact");
    for (const char* key : {"samples", "layers", "bytes"}) EXPECT_GT(stats["ldc"][key], 0) << key;
    for (int c = 0; c < 3; c++) EXPECT_LT(stats["ldc"]["box"]["lower"][c], stats["ldc"]["box"]["upper"][c]);
    EXPECT_EQ(stats["rays"]["primary"], 64 * 48);
    for (const char* key : {"reflection", "shadow"}) EXPECT_GT(stats["rays"][key], 0) << key;
}

TEST_F(RenderCommand, Counters) {
    const Outcome run = render("builtin:teapots", {"--stats", out("s.json"), "--ldc", "64", "--hit", "exact", "--aov",
                                                   "cost_steps", "--counters"});
    expect_done(run, {"a.cost_steps.exr", "a.cost_steps.png", "a.png", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    const auto& counters = stats["counters"];
    EXPECT_TRUE(counters["times"].is_string());
    EXPECT_EQ(counters["shadow"]["rays"], stats["rays"]["shadow"]);
    for (const char* kind : {"reflection_and_refraction", "shadow"})
        for (const char* field : {"steps", "cells", "samples", "triangles"}) {
            EXPECT_GT(counters[kind]["mean"][field], 0) << kind << " " << field;
            EXPECT_GE(counters[kind]["largest"][field], counters[kind]["mean"][field]) << kind << " " << field;
        }
    float most = 0;
    for (const glm::vec4& pixel : read_hdr(out("a.cost_steps.exr")).pixels) most = std::max(most, pixel.x);
    EXPECT_EQ(counters["largest_of_a_pixel"]["steps"], most);
    EXPECT_NE(run.err.find(fmt::format("to {}, light yellow", most)), std::string::npos) << run.err;
}

TEST_F(RenderCommand, CountersNeedCubesAndStats) {
    expect_refused(render(in("cube.obj"), {"--counters"}), 1, "--stats");
    for (const std::string tracer : {"none", "cubemap", "reference"})
        expect_refused(render(in("cube.obj"), {"--aov", "cost_cells", "--tracer", tracer}), 1, "--tracer ldc");
}

TEST_F(RenderCommand, MemoryByPartAndBuffer) {
    expect_done(render(in("cube.obj"), {"--stats", out("s.json"), "--tracer", "ldc"}), {"a.png", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    for (const auto& memory : {stats["memory"], stats["memory"]["peak"]}) {
        uint64_t all = 0;
        for (const auto& part : memory["parts"]) {
            uint64_t sum = 0;
            for (const auto& bytes : part["buffers"]) sum += bytes.get<uint64_t>();
            EXPECT_EQ(part["bytes"], sum);
            all += sum;
        }
        EXPECT_EQ(memory["bytes"], all);
    }
    EXPECT_EQ(stats["memory"]["peak"]["bytes"], stats["memory_bytes"]["peak"]);
    EXPECT_GE(stats["memory"]["peak"]["bytes"], stats["memory"]["bytes"]);
    for (const char* part : {"triangles", "cubes", "scene", "frame", "images"})
        EXPECT_TRUE(stats["memory"]["parts"].contains(part)) << part;
}

TEST_F(RenderCommand, StatsWithoutSecondaryRays) {
    expect_done(render(in("cube.obj"), {"--stats", out("s.json"), "--tracer", "none"}), {"a.png", "s.json"});
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    EXPECT_FALSE(stats.contains("ldc"));
    for (const char* key : {"reflection", "refraction", "shadow", "ambient"}) EXPECT_EQ(stats["rays"][key], 0) << key;
}

TEST_F(RenderCommand, CubeMaps) {
    const Outcome run = render("builtin:teapots", {"--stats", out("s.json"), "--tracer", "cubemap", "--bounces", "1",
                                                   "--effects", "reflection,refraction,shadow,ambient", "--validate"});
    expect_done(run, {"a.png", "s.json"});
    EXPECT_NE(run.err.find("peelray: note: --tracer cubemap has no ambient"), std::string::npos) << run.err;
    const auto stats = nlohmann::json::parse(get(out("s.json")));
    EXPECT_EQ(stats["tracer"], "cubemap");
    EXPECT_FALSE(stats.contains("ldc"));
    EXPECT_EQ(stats["cubemap"]["probes"]["count"], 3);  // the floor and two teapots
    EXPECT_EQ(stats["cubemap"]["probes"]["rounds"], 1);
    EXPECT_GE(stats["cubemap"]["probes"]["face"], 16);
    EXPECT_GT(stats["cubemap"]["probes"]["bytes"], 0);
    EXPECT_EQ(stats["cubemap"]["shadow_maps"]["count"], 1);
    EXPECT_GT(stats["cubemap"]["shadow_maps"]["bytes"], 0);
    std::vector<std::string> names;
    for (const auto& pass : stats["passes"]) names.push_back(pass["name"]);
    for (const std::string name :
         {"probe/map_visibility", "probe/cubemap_scatter", "shadow_map/shadow_depth", "cubemap_scatter"})
        EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST_F(RenderCommand, SameInputSameFile) {
    // Linear half floats: 8 bits of a .png would hide small differences.
    for (const std::string scene : {"builtin:teapots", "builtin:glass"})
        for (const std::string spp : {"1", "2"})
            for (const std::string tracer : {"ldc", "cpu"}) {
                if (tracer == "ldc" && spp == "1") continue;  // two samples draw all that one does
                std::string files[2];
                for (std::string& file : files) {
                    expect_done(render(scene, {"--spp", spp, "--tracer", tracer}, "a.exr"), {"a.exr"});
                    file = get(out("a.exr"));
                }
                EXPECT_TRUE(files[0] == files[1])
                    << scene << " by " << tracer << " with --spp " << spp << " differs from run to run";
            }
}

TEST_F(RenderCommand, CamerasByNameAndNumber) {
    auto gltf = square_gltf();
    gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}, {"name", "near"}},
                       {{"type", "orthographic"},
                        {"orthographic", {{"xmag", 3}, {"ymag", 3}, {"znear", 0.1}, {"zfar", 10}}},
                        {"name", "flat"}}};
    gltf["nodes"] = {
        {{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 3}}}, {{"camera", 1}, {"translation", {0, 0, 4}}}};
    gltf["scenes"][0]["nodes"] = {0, 1, 2};
    put("square.bin", square_bytes());
    put("cameras.gltf", gltf.dump());
    const std::string scene = in("cameras.gltf"), first = bytes(scene), flat = bytes(scene, {"--camera", "flat"});
    EXPECT_EQ(bytes(scene, {"--camera", "near"}), first);
    EXPECT_EQ(bytes(scene, {"--camera", "0"}), first);
    EXPECT_EQ(bytes(scene, {"--camera", "1"}), flat);
    EXPECT_NE(first, flat);
    EXPECT_NE(bytes(scene, {"--fov", "80"}), first);
    std::filesystem::remove(out("a.png"));
    expect_refused(render(scene, {"--camera", "far"}), 1, "0: near, 1: flat");
}

TEST_F(RenderCommand, CamerasAreNumberedAsTheFileDoes) {
    auto gltf = square_gltf();
    const auto lens = [](double yfov) {
        return nlohmann::json{{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}};
    };
    gltf["cameras"] = {lens(0.9), lens(0.5), lens(0.7), lens(1.1)};
    gltf["cameras"][2]["name"] = "tele";
    // Camera 2 is met first; 1 is shown twice; 0 by no node.
    gltf["nodes"] = {{{"mesh", 0}},
                     {{"camera", 2}, {"translation", {0, 0, 4}}, {"name", "post"}},
                     {{"camera", 1}, {"translation", {0, 0, 3}}, {"name", "left"}},
                     {{"camera", 1}, {"translation", {0.5, 0, 3}}, {"name", "right"}},
                     {{"camera", 3}, {"translation", {0, 0, 5}}}};
    gltf["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    put("square.bin", square_bytes());
    put("cameras.gltf", gltf.dump());
    const std::string scene = in("cameras.gltf");
    const auto by_hand = [&](const std::string& eye, const std::string& look, double yfov) {
        return bytes(scene, {"--eye", eye, "--look", look, "--fov", std::to_string(yfov * 180 / 3.14159265358979)});
    };
    const std::string left = by_hand("0,0,3", "0,0,0", 0.5), right = by_hand("0.5,0,3", "0.5,0,0", 0.5),
                      post = by_hand("0,0,4", "0,0,0", 0.7), last = by_hand("0,0,5", "0,0,0", 1.1);
    EXPECT_EQ(bytes(scene), left) << "the first that a node shows, as the file counts";
    for (const char* name : {"1", "1.0", "left"}) EXPECT_EQ(bytes(scene, {"--camera", name}), left) << name;
    for (const char* name : {"1.1", "right"}) EXPECT_EQ(bytes(scene, {"--camera", name}), right) << name;
    for (const char* name : {"2", "tele", "post"}) EXPECT_EQ(bytes(scene, {"--camera", name}), post) << name;
    EXPECT_EQ(bytes(scene, {"--camera", "3"}), last);
    std::filesystem::remove(out("a.png"));
    expect_refused(
        render(scene, {"--camera", "0"}), 1,
        "shows its camera 0 ((no name)) on no node, so that it has no place: there is 1.0: left, 1.1: right, "
        "2: tele, 3: (no name)");
    expect_refused(render(scene, {"--camera", "4"}), 1, "has no camera '4': there is 1.0: left");
    const Outcome info = run({"info", scene});
    EXPECT_NE(info.out.find("  1.1 right: eye 0.5 0 3, "), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("  2 tele (node post): eye 0 0 4, "), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("  0 (no name): on no node, without a place; "), std::string::npos) << info.out;
}

TEST_F(RenderCommand, FoldersOfOutputsAreMade) {
    expect_done(render(in("cube.obj"), {"--aov", "depth", "--stats", out("numbers/of/a.json")}, "pictures/a.png"),
                {"numbers", "pictures"});
    EXPECT_TRUE(std::filesystem::exists(out("numbers/of/a.json")));
    EXPECT_TRUE(std::filesystem::exists(out("pictures/a.depth.exr")));
    EXPECT_TRUE(std::filesystem::exists(out("pictures/a.png")));
}

TEST_F(RenderCommand, EyeLookUpFov) {
    const auto half_height = [](double distance, double size) {
        return 2 * std::atan(size / 2 / distance) * 180 / 3.14159265358979;
    };
    // The near face, at a distance of 2, fills exactly the middle half of the picture's height.
    const std::string fov = std::to_string(half_height(2, 2));
    expect_done(render(in("cube.obj"),
                       {"--aov", "depth", "--eye", "0.5,0.5,3", "--look", "0.5,0.5,0", "--up", "0,1,0", "--fov", fov}),
                {"a.depth.exr", "a.png"});
    const Image depth = read_hdr(out("a.depth.exr"));
    for (uint32_t y = 0; y < 48; y++) EXPECT_EQ(depth.at(32, y).x < 100, y >= 12 && y < 36) << y;
    // Turned by a right angle the world's +y points to the right.
    expect_done(render(in("cube.obj"), {"--aov", "position", "--eye", "0.5,0.5,3", "--look", "0.5,0.5,0", "--up",
                                        "-1,0,0", "--fov", fov}),
                {"a.depth.exr", "a.png", "a.position.exr"});
    const std::vector<float> position = channels_of(out("a.position.exr"));
    const auto y_at = [&](size_t column, size_t row) { return position[(48 + row) * 64 + column]; };
    EXPECT_GT(y_at(40, 24), y_at(26, 24));
}

TEST_F(RenderCommand, BackgroundAndEnvironment) {
    const Image background = radiance(away({"--background", "0.25,0.5,2"}));
    for (const glm::vec4& pixel : background.pixels) ASSERT_EQ(glm::vec3(pixel), glm::vec3(0.25f, 0.5f, 2));
    Image map{16, 8, std::vector<glm::vec4>(128, glm::vec4(0.5f, 0.25f, 4, 1))};
    for (const std::string name : {"map.hdr", "map.exr"}) {
        write_hdr(in(name), map);
        const Image environment = radiance(away({"--env", in(name)}));
        for (const glm::vec4& pixel : environment.pixels)
            for (int c = 0; c < 3; c++) ASSERT_NEAR(pixel[c], map.pixels[0][c], 0.01f * map.pixels[0][c]);
    }
    const Image sky = radiance(away({"--sky"}));
    EXPECT_GT(sky.at(32, 24).z, 0);
}

TEST_F(RenderCommand, ExposureAndToneCurve) {
    const auto grey = [&](const std::string& level, const std::string& stops, const std::string& curve) {
        bytes(in("cube.obj"),
              away({"--background", level + "," + level + "," + level, "--exposure", stops, "--tonemap", curve}));
        return int(read_ldr(out("a.png")).pixels.front() & 255);
    };
    EXPECT_EQ(grey("0.5", "0", "none"), 188);  // sRGB of one half
    EXPECT_EQ(grey("0.25", "1", "none"), 188);
    EXPECT_EQ(grey("1", "-1", "none"), 188);
    EXPECT_EQ(grey("8", "0", "none"), 255);
    EXPECT_EQ(grey("0", "0", "aces"), 0);
    EXPECT_LT(grey("1", "0", "aces"), 255);
    EXPECT_LT(grey("1", "0", "neutral"), 255);
}

TEST_F(RenderCommand, EffectsBouncesSamplesMaterials) {
    const std::string scene = "builtin:teapots", plain = bytes(scene);
    const std::string none = bytes(scene, {"--effects", "none"});
    EXPECT_NE(none, plain);
    EXPECT_NE(bytes(scene, {"--effects", "shadow"}), plain);
    EXPECT_EQ(bytes(scene, {"--effects", "reflection,refraction,shadow"}), plain);
    EXPECT_NE(bytes(scene, {"--bounces", "0"}), plain);
    EXPECT_NE(bytes(scene, {"--spp", "4"}), plain);
    EXPECT_NE(bytes(scene, {"--tracer", "none"}), plain);
    EXPECT_NE(bytes(scene, {"--effects", "reflection,refraction,shadow,ambient"}), plain);
    const std::string cube = bytes(in("cube.obj"));
    for (const std::string material : {"mirror", "glass", "clay"})
        EXPECT_NE(bytes(in("cube.obj"), {"--material", material}), cube) << material;
    EXPECT_NE(bytes(in("cube.obj"), {"--floor"}), cube);
}

TEST_F(RenderCommand, VariantsOfMaterials) {
    auto gltf = square_gltf();
    gltf["materials"] = nlohmann::json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
                                                  {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}}])");
    gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    auto& primitive = gltf["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] =
        nlohmann::json::parse(R"([{"material": 1, "variants": [1]}])");
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    const std::string plain = bytes(in("square.gltf"));
    EXPECT_EQ(bytes(in("square.gltf"), {"--variant", "day"}), plain);
    const std::string night = bytes(in("square.gltf"), {"--variant", "night"});
    EXPECT_NE(night, plain);
    primitive["material"] = 1;
    put("square.gltf", gltf.dump());
    EXPECT_EQ(bytes(in("square.gltf")), night);
}

TEST_F(RenderCommand, HitTestsAndResolutions) {
    for (const std::string hit : {"exact", "planar"})
        for (const std::string n : {"16", "128"})
            bytes(in("cube.obj"), {"--hit", hit, "--ldc", n, "--builder", "compute", "--traversal", "voxel",
                                   "--material", "mirror", "--floor"});
}

const std::vector<std::vector<std::string>> kByPixel = {{"--traversal", "two-level"},
                                                        {"--traversal", "two-level", "--block", "3x16"},
                                                        {"--traversal", "two-level", "--batch", "rays"},
                                                        {"--traversal", "mipmap"}};

TEST_F(RenderCommand, EveryTraversalMakesTheSamePicture) {
    const std::string voxels = bytes("builtin:glass", {"--hit", "exact", "--ldc", "64"});
    for (const auto& options : kByPixel)
        EXPECT_TRUE(bytes("builtin:glass", joined({"--hit", "exact", "--ldc", "64"}, options)) == voxels)
            << options.back();
    const std::vector<std::string> all = {"--hit", "tolerance", "--ldc", "128", "--tolerance", "0.06"};
    const std::string first = bytes("builtin:glass", joined(all, kByPixel.front()));
    EXPECT_TRUE(bytes("builtin:glass", joined(all, kByPixel.back())) == first);
    EXPECT_TRUE(bytes("builtin:glass", joined(joined(all, kByPixel.front()), {"--depth", "16"})) != first)
        << "coarser depths change something";
}

TEST_F(RenderCommand, MovingThingsInTheOrderByPixel) {
    const std::vector<std::string> moment = {"--time", "0.7", "--hit", "exact", "--ldc", "64"};
    for (const std::string scene : {"builtin:walker", "builtin:particles:20"})
        EXPECT_TRUE(bytes(scene, joined(moment, kByPixel[0])) == bytes(scene, moment)) << scene;
}

TEST_F(RenderCommand, AToleranceBelowThePixelsIsNoted) {
    // Without refraction: rays that would go on through more glass have a note of their own.
    const std::vector<std::string> options = {"--hit",     "tolerance",         "--ldc",      "128",
                                              "--effects", "reflection,shadow", "--tolerance"};
    const Outcome fine = render("builtin:glass", joined(options, {"0.1"}));
    EXPECT_EQ(fine.status, 0);
    EXPECT_EQ(fine.err, "");
    const Outcome coarse = render("builtin:glass", joined(options, {"0.001"}));
    EXPECT_EQ(coarse.status, 0);
    EXPECT_NE(coarse.err.find("rays slip through"), std::string::npos) << coarse.err;
    std::filesystem::remove(out("a.png"));
    // By voxel a sample's depth is kept near its voxel.
    expect_refused(render("builtin:glass", {"--hit", "tolerance", "--ldc", "512", "--tolerance", "0.5"}), 1,
                   "--traversal two-level");
}

TEST_F(RenderCommand, ValidationLayersAreSilent) {
    expect_done(render("builtin:glass", {"--validate", "--aov", "all", "--spp", "2", "--effects",
                                         "reflection,refraction,shadow,ambient"}),
                {"a.albedo.exr", "a.depth.exr", "a.instance.exr", "a.material.exr", "a.motion.exr", "a.normal.exr",
                 "a.png", "a.position.exr", "a.triangle.exr"});
}

TEST_F(RenderCommand, TrianglesWithoutAreaAreCounted) {
    put("flat.obj", std::string(kCube) + "f 1 1 2\nf 3 3 3\n");
    const Outcome run = render(in("flat.obj"));
    expect_done(run, {"a.png"});
    EXPECT_NE(run.err.find("peelray: note: 2 of 14 triangles have no area"), std::string::npos) << run.err;
}

TEST_F(RenderCommand, RepeatedFramesAreTheSamePicture) {
    const std::string once = bytes(in("cube.obj"), {"--floor", "--tracer", "ldc"});
    EXPECT_EQ(bytes(in("cube.obj"), {"--floor", "--repeat", "3"}), once);
}

TEST_F(RenderCommand, OldPictureIsReplacedAndCacheMayBeUnwritable) {
    put("out/a.png", "old");
    expect_done(run({"render", in("cube.obj"), "-o", out("a.png"), "--size", "1x1", "--tracer", "ldc"},
                    {{"XDG_CACHE_HOME", "/proc/none"}, {"MESA_SHADER_CACHE_DISABLE", "true"}}),
                {"a.png"});
    EXPECT_EQ(read_ldr(out("a.png")).width, 1u);
}

}  // namespace
}  // namespace peelray
