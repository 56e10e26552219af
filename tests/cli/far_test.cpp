// Scenes far from the world's origin, from the command line: pictures, rays and numbers.
#include <cmath>

#include "cli/channels.h"
#include "cli/hits.h"
#include "cli/program_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

using Words = std::vector<std::string>;
using nlohmann::json;

/// Two squares, one a mirror in front of nothing, a camera and a lamp, all moved.
class FarCommand : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        put("square.bin", square_bytes());
        put("near.gltf", scene({0, 0, 0}).dump());
        put("far.gltf", scene({431000.125, 71.5, -5412000.75}).dump());
    }

    static json scene(const std::vector<double>& by) {
        json gltf = square_gltf();
        gltf["materials"] = json::parse(R"([
            {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.3, 0.2, 1], "metallicFactor": 0}},
            {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}}])");
        json mirror = gltf["meshes"][0];
        mirror["primitives"][0]["material"] = 1;
        gltf["meshes"][0]["primitives"][0]["material"] = 0;
        gltf["meshes"].push_back(mirror);
        gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
        gltf["extensionsUsed"] = {"KHR_lights_punctual"};
        gltf["extensions"] =
            json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 20}]}})");
        gltf["nodes"] = json::parse(R"([
            {"mesh": 0, "translation": [0.3, 0.1, 0.2], "rotation": [0, 0.2, 0, 0.98]},
            {"mesh": 1, "translation": [0, -1, 0.5], "rotation": [-0.70710678, 0, 0, 0.70710678]},
            {"camera": 0, "translation": [0.4, 0.7, 3.5], "rotation": [-0.1, 0.05, 0.01, 0.9937]},
            {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"children": [0, 1, 2, 3]}])");
        gltf["nodes"][4]["translation"] = by;
        gltf["scenes"][0]["nodes"] = {4};
        return gltf;
    }

    Image picture(const std::string& scene, Words more) const {
        const Outcome run = render(in(scene), more, "a.exr");
        EXPECT_EQ(run.status, 0) << run.err;
        return read_hdr(out("a.exr"));
    }

    /// Pixels that differ by more than rounding.
    static size_t different(const Image& a, const Image& b) {
        size_t count = 0;
        for (size_t i = 0; i < a.pixels.size(); i++) {
            const glm::vec3 d = glm::abs(glm::vec3(a.pixels[i] - b.pixels[i]));
            count += std::max({d.x, d.y, d.z}) > 2e-3f;
        }
        return count;
    }
};

TEST_F(FarCommand, PicturesAreThoseOfTheOrigin) {
    for (const char* tracer : {"ldc", "none", "cubemap", "reference"}) {
        const Words words = {"--background", "0.2,0.3,0.4", "--tracer", tracer};
        EXPECT_LE(different(picture("near.gltf", words), picture("far.gltf", words)), 2u) << tracer;
    }
    // A camera of the user's own, and a floor.
    const Words near_by = {"--eye", "2,1,4", "--look", "0.1,0,0.25", "--floor"};
    const Words far_off = {"--eye", "431002.125,72.5,-5411996.75", "--look", "431000.225,71.5,-5412000.5", "--floor"};
    EXPECT_LE(different(picture("near.gltf", near_by), picture("far.gltf", far_off)), 2u);
    EXPECT_LE(different(picture("near.gltf", {"--look", "0.1,0,0.25", "--fov", "50"}),
                        picture("far.gltf", {"--look", "431000.225,71.5,-5412000.5", "--fov", "50"})),
              2u);
}

TEST_F(FarCommand, NumbersAreThoseOfTheWorld) {
    picture("near.gltf", {"--aov", "position,depth", "--tracer", "ldc"});
    const std::vector<float> here = channels_of(out("a.position.exr"));
    picture("far.gltf", {"--aov", "position,depth,box", "--stats", out("a.json"), "--tracer", "ldc"});
    const std::vector<float> there = channels_of(out("a.position.exr")), depth = channels_of(out("a.depth.exr"));
    const double by[] = {431000.125, 71.5, -5412000.75}, coarse[] = {0.04, 1e-4, 0.6};
    size_t seen = 0;
    for (size_t i = 0; i < depth.size(); i++)
        for (size_t k = 0; k < 3; k++) {
            const size_t at = k * depth.size() + i;
            if (std::isinf(depth[i])) {
                EXPECT_EQ(there[at], 0);
            } else {
                seen++;
                EXPECT_NEAR(there[at], by[k] + double(here[at]), coarse[k]) << i;
            }
        }
    EXPECT_GT(seen, 1500u);
    const json box = json::parse(get(out("a.json")))["ldc"]["box"];
    EXPECT_NEAR(box["lower"][1].get<double>(), 71.5 - 1, 1e-6);
    EXPECT_NEAR(box["lower"][0].get<double>(), 431000.125 - 1, 1e-6);
    EXPECT_NEAR(box["upper"][2].get<double>(), -5412000.75 + 1.5, 1e-6);
    const Outcome info = run({"info", in("far.gltf")});
    const auto number_after = [&](const std::string& words) {
        const size_t at = info.out.find(words);
        return at == std::string::npos ? NAN : std::stod(info.out.substr(at + words.size()));
    };
    EXPECT_NEAR(number_after("bounds"), 431000.125 - 1, 1e-6);
    EXPECT_NEAR(number_after(": eye"), 431000.125 + 0.4, 1e-6);
    EXPECT_NE(info.out.find("(0 without area)"), std::string::npos) << info.out;
}

TEST_F(FarCommand, RaysAreThoseOfTheWorld) {
    // A cube of one centimetre at (65536, 0, 65536), where floats are 1/128 apart; of its own it needs doubles.
    std::string cube =
        "f 5 6 7\nf 5 7 8\nf 2 1 4\nf 2 4 3\nf 6 2 3\nf 6 3 7\nf 1 5 8\nf 1 8 4\nf 8 7 3\nf 8 3 4\nf 1 2 "
        "6\nf 1 6 5\n";
    const char* corners[][3] = {{"65536", "0", "65536"},          {"65536.01", "0", "65536"},
                                {"65536.01", "0.01", "65536"},    {"65536", "0.01", "65536"},
                                {"65536", "0", "65536.01"},       {"65536.01", "0", "65536.01"},
                                {"65536.01", "0.01", "65536.01"}, {"65536", "0.01", "65536.01"}};
    std::string text;
    for (const auto& c : corners) text += std::string("v ") + c[0] + " " + c[1] + " " + c[2] + "\n";
    put("cube.obj", text + cube);
    const float x = 65536.0078125f;                                             // 0.78 of the cube's edge
    put("rays.npy", rays_npy({x,     0.0025f, 65538,          0, 0,  0, -1, 9,  //
                              x,     0.0125f, 65538,          0, 0,  0, -1, 9,  // above it
                              65537, 0.0025f, 65536.0078125f, 0, -2, 0, 0,  9}));
    expect_done(
        run({"trace", in("cube.obj"), "--rays", in("rays.npy"), "--out", out("hits.npy"), "--stats", out("t.json")}),
        {"hits.npy", "t.json"});
    const std::vector<HitRecord> hits = hits_of(get(out("hits.npy")), 3);
    EXPECT_NEAR(hits[0].t, 1.99, 1e-6);
    EXPECT_EQ(hits[0].triangle, 0u);
    EXPECT_NEAR(hits[0].u + hits[0].v, 0.78125, 1e-4);
    EXPECT_NEAR(hits[0].v, 0.25, 1e-4);
    EXPECT_TRUE(std::isinf(hits[1].t));
    EXPECT_NEAR(hits[2].t, 0.495, 1e-6);
    EXPECT_EQ(hits[2].triangle / 2, 2u);
    const json box = json::parse(get(out("t.json")))["ldc"]["box"];
    EXPECT_NEAR(box["upper"][0].get<double>(), 65536.01, 1e-9);
}

}  // namespace
}  // namespace peelray
