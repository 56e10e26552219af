// What is seen of the environment, and transparent pictures, as files.
#include <cmath>

#include "cli/program_fixture.h"
#include "image/image.h"
#include "scene/encoding.h"

namespace peelray {
namespace {

class Backdrops : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("cube.obj", kCube);
        std::vector<glm::vec4> pixels;
        for (int i = 0; i < 32 * 16; i++) pixels.emplace_back(i % 32 < 16 ? 0.5f : 2.f, 1, 0.25f, 1);
        write_hdr(in("map.exr"), Image{32, 16, pixels});
    }
    Image radiance(std::vector<std::string> more) const {
        more.insert(more.end(), {"--env", in("map.exr")});
        expect_done(render(in("cube.obj"), more, "a.exr"), {"a.exr"});
        return read_hdr(out("a.exr"));
    }
    void expect_wrong(std::vector<std::string> more, const std::string& says, const std::string& name = "a.png") const {
        SCOPED_TRACE(says);
        expect_refused(render(in("cube.obj"), more, name), 1, says);
    }
};

const std::vector<std::string> kTracers = {"ldc", "reference", "cubemap", "none"};

TEST_F(Backdrops, ABackgroundBesideAnEnvironmentIsSeenAndLightsNothing) {
    for (const std::string& tracer : kTracers) {
        SCOPED_TRACE(tracer);
        const Image plain = radiance({"--tracer", tracer}),
                    seen = radiance({"--tracer", tracer, "--background", "4,0,0"}),
                    hidden = radiance({"--tracer", tracer, "--env-visible", "no"});
        int open = 0;
        for (size_t i = 0; i < plain.pixels.size(); i++) {
            ASSERT_EQ(seen.pixels[i].w, plain.pixels[i].w);
            if (plain.pixels[i].w == 1) {
                ASSERT_EQ(seen.pixels[i], plain.pixels[i]);
                ASSERT_EQ(hidden.pixels[i], plain.pixels[i]);
            } else {
                open++;
                ASSERT_EQ(glm::vec3(seen.pixels[i]), glm::vec3(4, 0, 0));
                ASSERT_EQ(glm::vec3(hidden.pixels[i]), glm::vec3(0));
            }
        }
        EXPECT_GT(open, 500);
    }
}

TEST_F(Backdrops, WithoutAnEnvironmentAColorLightsUnlessItIsOnlySeen) {
    const auto middle = [&](std::vector<std::string> more) {
        expect_done(render(in("cube.obj"), more, "a.exr"), {"a.exr"});
        return glm::vec3(read_hdr(out("a.exr")).at(32, 24));
    };
    const glm::vec3 studio = middle({});
    EXPECT_EQ(middle({"--background", "0,0,0"}), glm::vec3(0));
    EXPECT_EQ(middle({"--background", "0,0,0", "--env-visible", "no"}), studio);
    EXPECT_EQ(middle({"--background", "transparent"}), studio);
}

TEST_F(Backdrops, AlphaIsStraightInPngAndPremultipliedInExr) {
    for (const std::string& tracer : kTracers) {
        SCOPED_TRACE(tracer);
        const std::vector<std::string> words = {"--tracer",    tracer,  "--env", in("map.exr"), "--background",
                                                "transparent", "--spp", "8",     "--tonemap",   "none"};
        EXPECT_EQ(render(in("cube.obj"), words, "a.exr").status, 0);
        EXPECT_EQ(render(in("cube.obj"), words, "a.png").status, 0);
        const Image linear = read_hdr(out("a.exr"));
        const Image8 encoded = read_ldr(out("a.png"));
        int parts = 0;
        for (size_t i = 0; i < linear.pixels.size(); i++) {
            const glm::vec4 p = linear.pixels[i];
            const uint32_t e = encoded.pixels[i];
            ASSERT_NEAR(int(e >> 24), 255 * p.w, 0.75);
            if (p.w == 0) {
                ASSERT_EQ(e, 0u);
                ASSERT_EQ(p, glm::vec4(0));
                continue;
            }
            parts += p.w < 1;
            for (int c = 0; c < 3; c++) {
                const double want = 255 * linear_to_srgb(std::min(double(p[c]) / double(p.w), 1.0));
                ASSERT_NEAR(int(e >> (8 * c) & 255), want, 1.0);  // halves round
            }
        }
        EXPECT_GT(parts, 40) << "edges";
        std::filesystem::remove_all(folder / "out");
        std::filesystem::create_directory(folder / "out");
    }
}

TEST_F(Backdrops, LayersAndSequencesKeepTheAlpha) {
    const std::vector<std::string> clear = {"--background", "transparent"};
    std::vector<std::string> layers = clear;
    layers.insert(layers.end(), {"--aov", "depth", "--exr-layers"});
    expect_done(render(in("cube.obj"), layers, "a.exr"), {"a.exr"});
    EXPECT_EQ(read_hdr(out("a.exr")).at(0, 0), glm::vec4(0));
    std::filesystem::remove(out("a.exr"));
    std::vector<std::string> turn = clear;
    turn.insert(turn.end(), {"--turntable", "2"});
    expect_done(render(in("cube.obj"), turn, "t%d.png"), {"t%d.png.json", "t0.png", "t1.png"});
    EXPECT_EQ(read_ldr(out("t1.png")).pixels[0], 0u);
    const auto manifest = nlohmann::json::parse(get(out("t%d.png.json")));
    EXPECT_EQ(manifest["settings"]["--background"], "transparent");
    EXPECT_EQ(manifest["settings"]["--env-rotation"], "0");
    EXPECT_EQ(manifest["settings"]["--env-visible"], nullptr);
}

TEST_F(Backdrops, ComparisonsTakeTransparentPictures) {
    const std::vector<std::string> clear = {"--background", "transparent", "--tonemap", "none"};
    EXPECT_EQ(render(in("cube.obj"), clear, "given.png").status, 0);
    EXPECT_EQ(render(in("cube.obj"), clear, "given.exr").status, 0);
    std::vector<std::string> words = {"compare",   in("cube.obj"),   "-o",        out("r.html"),
                                      "--size",    "64x48",          "--tracers", "ldc",
                                      "--picture", out("given.png"), "--picture", out("given.exr"),
                                      "--json",    out("r.json"),    "--strip",   out("s.png")};
    words.insert(words.end(), clear.begin(), clear.end());
    const Outcome done = run(words);
    ASSERT_EQ(done.status, 0) << done.err;
    const auto json = nlohmann::json::parse(get(out("r.json")));
    for (int i = 0; i < 2; i++)
        EXPECT_LT(json["pictures"][i]["difference"]["flip"], 2e-3) << json["pictures"][i]["name"];
    EXPECT_EQ(read_ldr(out("s.png")).pixels[0], 0xff000000u) << "on black";
}

TEST_F(Backdrops, RotationAndIntensity) {
    for (const std::string tracer : {"ldc", "reference"}) {
        SCOPED_TRACE(tracer);
        // Ahead, at -z, the map's halves meet: turned by a right angle to the left, all of its right is to be seen.
        const std::vector<std::string> ahead = {"--tracer", tracer, "--eye", "0,0,-5", "--look", "0,0,-10"};
        const auto at = [&](std::vector<std::string> more, uint32_t x) {
            more.insert(more.end(), ahead.begin(), ahead.end());
            return radiance(more).at(x, 24).x;
        };
        EXPECT_NEAR(at({"--env-rotation", "90"}, 2), 2, 1e-3);
        EXPECT_NEAR(at({"--env-rotation", "-450", "--env-intensity", "3"}, 61), 1.5, 1e-2);
        if (tracer == "ldc") continue;
        EXPECT_NEAR(at({}, 2), 0.5, 1e-3);
        EXPECT_NEAR(at({}, 61), 2, 1e-3);
        EXPECT_EQ(at({"--env-intensity", "0"}, 61), 0);
        const Image plain = radiance({"--tracer", tracer}),
                    twice = radiance({"--tracer", tracer, "--env-intensity", "2"});
        for (size_t i = 0; i < plain.pixels.size(); i++)
            for (int c = 0; c < 3; c++)
                ASSERT_NEAR(twice.pixels[i][c], 2 * plain.pixels[i][c], 2e-3 * plain.pixels[i][c]);
    }
}

TEST_F(Backdrops, ShadowCatchers) {
    for (const std::string tracer : {"ldc", "reference"}) {
        SCOPED_TRACE(tracer);
        const Outcome done = render(in("cube.obj"),
                                    {"--sky", "--shadow-catcher", "--background", "transparent", "--tracer", tracer,
                                     "--eye", "-0.8,4,-0.8", "--look", "0.3,0,0.3"},
                                    "a.exr");
        expect_done(done, {"a.exr"});
        EXPECT_EQ(done.err.find("casts shadows"), std::string::npos) << done.err;
        int shadow = 0, mirrored = 0, clear = 0, covered = 0;
        for (const glm::vec4& p : read_hdr(out("a.exr")).pixels) {
            const bool black = glm::vec3(p) == glm::vec3(0);
            (p.w == 0 ? clear : p.w == 1 ? covered : black ? shadow : mirrored)++;
        }
        EXPECT_GT(clear, 500);
        EXPECT_GT(covered, 100);
        EXPECT_GT(shadow, 100);
        EXPECT_GT(mirrored, 20);
    }
    const Outcome studio = render(in("cube.obj"), {"--shadow-catcher", "--env-mode", "open"}, "a.exr");
    EXPECT_NE(studio.err.find("nothing that casts shadows lights the floor of --shadow-catcher"), std::string::npos)
        << studio.err;
    std::filesystem::remove(out("a.exr"));
    expect_wrong({"--shadow-catcher", "--tracer", "cubemap"}, "--tracer cubemap has no --shadow-catcher");
}

TEST_F(Backdrops, WhatContradictsItselfIsRefused) {
    expect_wrong({"--env-rotation", "nan"}, "finite");
    expect_wrong({"--env-rotation", "inf"}, "finite");
    expect_wrong({"--env-intensity", "-1"}, "0 to 1000000");
    expect_wrong({"--env-intensity", "nan"}, "0 to 1000000");
    expect_wrong({"--env-intensity", "inf"}, "0 to 1000000");
    expect_wrong({"--background", "transparent"}, "name it .png or .exr", "a.hdr");
    expect_wrong({"--background", "transparent", "--turntable", "4"}, "a video has none", "a.mp4");
    expect_wrong({"--background", "transparent", "--env-visible", "yes"}, "--env-visible yes shows that");
    expect_wrong({"--background", "1,1,1", "--sky", "--env-visible", "blurred"}, "--env-visible blurred shows that");
    expect_refused(render(in("cube.obj"), {"--env-visible", "maybe"}), 2, "yes|no|blurred");
    expect_refused(render(in("cube.obj"), {"--background", "clear"}), 2, "transparent");
}

TEST_F(Backdrops, OddEnvironmentsMakePictures) {
    const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    write_hdr(
        in("odd.exr"),
        Image{3, 2, {{1, 2, 3, 1}, {nan, 2, 3, 1}, {1, -2, 3, 1}, {1, 2, infinite, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}}},
        {.half = false});
    write_hdr(in("one.exr"), Image{1, 1, {{1, 2, 3, 1}}});
    write_hdr(in("black.exr"), Image{8, 4, std::vector<glm::vec4>(32, glm::vec4(0, 0, 0, 1))});
    for (const std::string tracer : {"ldc", "reference"})
        for (const std::string name : {"odd.exr", "one.exr", "black.exr"}) {
            SCOPED_TRACE(name + tracer);
            const Outcome done = render(
                in("cube.obj"),
                {"--env", in(name), "--tracer", tracer, "--env-rotation", "50", "--env-visible", "blurred"}, "a.exr");
            expect_done(done, {"a.exr"});
            const bool noted =
                done.err.find("odd.exr: 3 texels are negative, infinite or not a number") != std::string::npos;
            EXPECT_EQ(noted, name == "odd.exr") << done.err;
            for (const glm::vec4& pixel : read_hdr(out("a.exr")).pixels) {
                ASSERT_TRUE(pixel.x >= 0 && pixel.x < 10);
                if (name == "black.exr") {
                    ASSERT_EQ(glm::vec3(pixel), glm::vec3(0));
                }
            }
        }
}

}  // namespace
}  // namespace peelray
