// `peelray info` and `peelray devices`.
#include "cli/program_fixture.h"
#include "image/image.h"

namespace peelray {
namespace {

class InfoCommand : public ProgramTest {
  protected:
    /// Every part stands in the text; runs of blanks count as one.
    static void expect_says(const std::string& text, const std::vector<std::string>& parts) {
        std::string plain;
        for (const char c : text)
            if (c != ' ' || plain.empty() || plain.back() != ' ') plain += c;
        for (const std::string& part : parts)
            EXPECT_NE(plain.find(part), std::string::npos) << part << "\nin:\n" << plain;
    }
};

TEST_F(InfoCommand, CountsOfAMesh) {
    put("cube.obj", kCube);
    const Outcome run = this->run({"info", in("cube.obj")});
    expect_done(run, {});
    expect_says(run.out, {"triangles 12 (0 without area)", "bounds 0 0 0 to 1 1 1", "meshes 1", "materials 1",
                          "cameras 0", "animations 0", "lights 0"});
}

TEST_F(InfoCommand, EverythingAGltfHolds) {
    auto gltf = square_gltf();
    gltf["nodes"][0]["translation"] = {0, 0, 2};
    gltf["nodes"].push_back({{"camera", 0}});
    gltf["scenes"][0]["nodes"] = {0, 1};
    gltf["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.0471976}, {"znear", 0.1}}}, {"name", "front\nrow"}}};
    gltf["materials"] = {
        {{"name", "amber"},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1.55}}}}}}};
    gltf["meshes"][0]["name"] = "pane";
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    gltf["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_ior", "KHR_xmp_json_ld"};
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    const Outcome run = this->run({"info", in("square.gltf")});
    EXPECT_EQ(run.status, 0) << run.err;
    expect_says(run.out, {"triangles 2 (0 without area)", "bounds -1 -1 2 to 1 1 2", "pane: 2 triangles", "amber:",
                          "transmission 1", "1.55", "0 front row: eye 0 0 0, vertical field of view 60.0 degrees",
                          "extensions used KHR_materials_ior, KHR_materials_transmission, KHR_xmp_json_ld",
                          "extensions without effect KHR_xmp_json_ld"});
}

TEST_F(InfoCommand, Variants) {
    auto gltf = square_gltf();
    gltf["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "at night"}}};
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    expect_says(run({"info", in("square.gltf")}).out, {"variants day, at night"});
}

TEST_F(InfoCommand, ClearCoat) {
    auto gltf = square_gltf();
    gltf["extensionsUsed"] = {"KHR_materials_clearcoat"};
    gltf["images"] = {{{"uri", "a.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {nlohmann::json::parse(R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5,
        "clearcoatRoughnessFactor": 0.25, "clearcoatTexture": {"index": 0}, "clearcoatRoughnessTexture": {"index": 0},
        "clearcoatNormalTexture": {"index": 0}}}})")};
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    write_png(in("a.png"), Image8{1, 1, {0xffffffffu}});
    const Outcome run = this->run({"info", in("square.gltf")});
    EXPECT_EQ(run.status, 0) << run.err;
    expect_says(run.out, {"coat texture 0", "coat roughness texture 0", "coat normal texture 0",
                          "clear coat 0.5 of roughness 0.25"});
}

TEST_F(InfoCommand, SheenFilmsAnisotropyDispersionAndDiffuseTransmission) {
    auto gltf = square_gltf();
    gltf["materials"] = nlohmann::json::parse(R"([{"extensions": {
        "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.25, 0], "sheenRoughnessFactor": 0.75},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 1.75},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.25, "anisotropyRotation": 0.785398},
        "KHR_materials_dispersion": {"dispersion": 0.36},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
            "diffuseTransmissionColorFactor": [1, 0.5, 0.25]}}},
        {"name": "plain"}])");
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    const Outcome run = this->run({"info", in("square.gltf")});
    EXPECT_EQ(run.status, 0) << run.err;
    expect_says(run.out, {"sheen 0.5 0.25 0 of roughness 0.75", "iridescence 0.5 by a film of index 1.75, 400 nm",
                          "anisotropy 0.25 turned by 45 degrees", "dispersion 0.36",
                          "diffuse transmission 0.5 of colour 1 0.5 0.25",
                          "plain: colour 1 1 1, metallic 1, roughness 1, front only"});
}

TEST_F(InfoCommand, MasksAndBlending) {
    auto gltf = square_gltf();
    gltf["materials"] = {
        {{"name", "leaf"}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}},
        {{"name", "veil"}, {"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}};
    put("square.bin", square_bytes());
    put("square.gltf", gltf.dump());
    const Outcome run = this->run({"info", in("square.gltf")});
    EXPECT_EQ(run.status, 0) << run.err;
    expect_says(run.out, {"holes where alpha is below 0.25", "blended by its alpha of 0.5"});
    EXPECT_EQ(run.out.find("MASK"), std::string::npos) << run.out;
}

TEST_F(InfoCommand, FullDiskIsReported) {
    put("cube.obj", kCube);
    std::filesystem::remove(folder / "scratch" / "stdout");
    std::filesystem::create_symlink("/dev/full", folder / "scratch" / "stdout");
    const Outcome run = this->run({"info", in("cube.obj")});
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("cannot write to the standard output"), std::string::npos) << run.err;
}

TEST_F(InfoCommand, Devices) {
    const Outcome run = this->run({"devices"});
    expect_done(run, {});
    expect_says(run.out, {"0: ", "Vulkan 1."});
    // On a machine whose only driver is Mesa's software one, and in the tests' own set-up, that is llvmpipe.
    if (run.out.find("CPU") != std::string::npos) {
        expect_says(run.out, {"llvmpipe"});
        put("cube.obj", kCube);
        expect_done(render(in("cube.obj"), {"--device", "LLVMpipe"}), {"a.png"});
    }
}

}  // namespace
}  // namespace peelray
