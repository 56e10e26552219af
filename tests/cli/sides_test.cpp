// Single-sided faces of glTF files: --double-sided, and the note where the camera is behind what it looks at.
#include <fstream>
#include <sstream>

#include "cli/hits.h"
#include "cli/program_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

class SidesCommand : public ProgramTest {
  protected:
    /// A cube from -1 to 1; `inwards`: its fronts are inside. Grey: a white one is invisible before a background that
    /// is the same all around.
    std::string cube(bool inwards, nlohmann::json material = nlohmann::json::object()) {
        if (!material.contains("pbrMetallicRoughness"))
            material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
        std::vector<float> corners;
        for (int i = 0; i < 8; i++)
            for (int k = 0; k < 3; k++) corners.push_back(i >> k & 1 ? 1.f : -1.f);
        std::vector<uint16_t> indices;
        const uint16_t sides[6][4] = {{4, 5, 7, 6}, {0, 2, 3, 1}, {1, 3, 7, 5},
                                      {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}};
        for (const auto& side : sides)
            for (const int k : {0, 1, 2, 0, 2, 3}) indices.push_back(side[inwards ? (4 - k) % 4 : k]);
        auto gltf = square_gltf();
        gltf["buffers"][0] = {{"uri", "cube.bin"}, {"byteLength", 96 + 72}};
        gltf["bufferViews"][0]["byteLength"] = 96;
        gltf["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}};
        gltf["accessors"][0]["count"] = 8;
        gltf["accessors"][0]["min"] = {-1, -1, -1};
        gltf["accessors"][0]["max"] = {1, 1, 1};
        gltf["accessors"][1]["count"] = 36;
        gltf["materials"] = {material};
        gltf["meshes"][0]["primitives"][0]["material"] = 0;
        put("cube.bin", bytes_of(corners) + bytes_of(indices));
        put("cube.gltf", gltf.dump());
        return in("cube.gltf");
    }

    /// How many notes speak of sides.
    static size_t notes_of(const Outcome& run) {
        size_t notes = 0;
        std::istringstream stream(run.err);
        for (std::string line; std::getline(stream, line);)
            notes += line.starts_with("peelray: note: ") && line.find("--double-sided") != std::string::npos;
        return notes;
    }
    /// The share of the last picture's pixels that are not its (red) background.
    double covered() {
        const Image image = read_hdr(out("a.exr"));
        size_t count = 0;
        for (const glm::vec4& pixel : image.pixels) count += !(pixel.x == 9 && pixel.y == 0);
        return double(count) / double(image.pixels.size());
    }
    Outcome shot(const std::string& scene, const std::string& eye, const std::string& tracer,
                 const std::vector<std::string>& more = {}) {
        std::vector<std::string> options = {"--eye", eye,     "--look", "0,0,0.01",     "--tracer",
                                            tracer,  "--fov", "70",     "--background", "9,0,0"};
        options.insert(options.end(), more.begin(), more.end());
        const Outcome run = render(scene, options, "a.exr");
        EXPECT_EQ(run.status, 0) << run.err;
        return run;
    }
};

TEST_F(SidesCommand, ACameraInARoomOfBacksIsToldSo) {
    for (const std::string tracer : {"ldc", "none", "cubemap", "reference"}) {
        SCOPED_TRACE(tracer);
        const std::string room = cube(false);
        const Outcome inside = shot(room, "0.1,0.2,-0.6", tracer);
        EXPECT_EQ(notes_of(inside), 1u) << inside.err;
        EXPECT_NE(inside.err.find("100 % of the picture is empty"), std::string::npos) << inside.err;
        EXPECT_EQ(covered(), 0);
        const Outcome shown = shot(room, "0.1,0.2,-0.6", tracer, {"--double-sided"});
        EXPECT_EQ(notes_of(shown), 0u) << shown.err;
        EXPECT_EQ(covered(), 1);
        const Outcome outside = shot(room, "0.1,0.2,-6", tracer);
        EXPECT_EQ(notes_of(outside), 0u) << outside.err;
        EXPECT_GT(covered(), 0.02);
        const std::string turned = cube(true);
        EXPECT_EQ(notes_of(shot(turned, "0.1,0.2,-0.6", tracer)), 0u);
        EXPECT_EQ(covered(), 1);
        const std::string said = cube(false, {{"doubleSided", true}});
        EXPECT_EQ(notes_of(shot(said, "0.1,0.2,-0.6", tracer)), 0u);
        EXPECT_EQ(covered(), 1);
    }
}

TEST_F(SidesCommand, APictureThatIsEmptyForAnotherReasonGetsNoNote) {
    const std::string room = cube(false);
    EXPECT_EQ(notes_of(render(room, {"--eye", "0,0,-6", "--look", "0,0,-9"}, "a.exr")), 0u)
        << "the cube is behind the camera";
    EXPECT_EQ(notes_of(shot(room, "0,0,-300", "ldc")), 0u) << "it is small, and seen from the front";
    // Wholly of holes it shows neither side.
    const std::string holes =
        cube(false, {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.2}}}}});
    EXPECT_EQ(notes_of(shot(holes, "0.1,0.2,-0.6", "ldc")), 0u);
}

TEST_F(SidesCommand, AnOrthographicCameraAmongBacksIsToldSo) {
    auto gltf = nlohmann::json::parse(std::ifstream(cube(false)));
    gltf["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 0.5}, {"ymag", 0.5}, {"znear", 0}, {"zfar", 9}}}}};
    gltf["nodes"].push_back({{"camera", 0}});
    gltf["scenes"][0]["nodes"] = {0, 1};
    put("ortho.gltf", gltf.dump());
    const Outcome inside = render(in("ortho.gltf"), {"--background", "9,0,0"}, "a.exr");
    EXPECT_EQ(notes_of(inside), 1u) << inside.err;
    EXPECT_EQ(covered(), 0);
}

TEST_F(SidesCommand, OneMaterialForAllKeepsTheSides) {
    const std::string room = cube(false);
    EXPECT_EQ(notes_of(shot(room, "0.1,0.2,-0.6", "ldc", {"--material", "clay"})), 1u);
    EXPECT_EQ(covered(), 0);
    // A volume that transmits has both.
    EXPECT_EQ(notes_of(shot(room, "0.1,0.2,-0.6", "ldc", {"--material", "glass"})), 0u);
}

TEST_F(SidesCommand, RaysFromBehindPass) {
    const std::string room = cube(false);
    // From the middle, from outside, and from outside without the near wall.
    put("rays.npy",
        rays_npy({0.1f, 0.2f, 0, 0, 0, 0, 1, 9, 0.1f, 0.2f, 5, 0, 0, 0, -1, 9, 0.1f, 0.2f, 5, 4.5f, 0, 0, -1, 9}));
    for (const std::string hit : {"exact", "planar", "tolerance"})
        for (const std::string traversal : {"voxel", "two-level", "mipmap"})
            for (const bool both : {false, true}) {
                SCOPED_TRACE(hit + " " + traversal + (both ? " --double-sided" : ""));
                std::vector<std::string> arguments = {
                    "trace", room,          "--rays",  in("rays.npy"), "--out", out("hits.npy"), "--hit",
                    hit,     "--traversal", traversal, "--tolerance",  "0.02",  "--ldc",         "64"};
                if (both) arguments.push_back("--double-sided");
                ASSERT_EQ(run(arguments).status, 0);
                const std::vector<HitRecord> hits = hits_of(get(out("hits.npy")), 3);
                EXPECT_EQ(hits[0].triangle != kMiss, both);
                EXPECT_NEAR(hits[1].t, 4, 0.05) << "its front";
                EXPECT_EQ(hits[2].triangle != kMiss, both);
            }
}

TEST_F(SidesCommand, InfoTellsTheSides) {
    for (const bool both : {false, true}) {
        const std::string text = run({"info", cube(false, {{"doubleSided", both}, {"name", "paint"}})}).out;
        const std::string line =
            text.substr(text.find("  paint: "), text.find('\n', text.find("  paint: ")) - text.find("  paint: "));
        EXPECT_EQ(line.find("front only") == std::string::npos, both) << line;
    }
}

}  // namespace
}  // namespace peelray
