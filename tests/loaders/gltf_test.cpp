// What a correct glTF file must give.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "loaders/load.h"
#include "loaders/scene_files.h"
#include "motion/animation.h"
#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray::testing {
namespace {

constexpr float pi = 3.14159265f;

void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-5f)
        << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

const Primitive& first_primitive(const Scene& scene) {
    return scene.meshes.at(0).primitives.at(0);
}

bool has_note(const Scene& scene, const std::string& words) {
    return std::any_of(scene.notes.begin(), scene.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string glb(const std::string& text, const std::string& binary) {
    const auto chunk = [](std::string bytes, uint32_t type, char filler) {
        while (bytes.size() % 4) bytes += filler;
        return pack<uint32_t>({static_cast<uint32_t>(bytes.size()), type}) + bytes;
    };
    const std::string body = chunk(text, 0x4E4F534A, ' ') + (binary.empty() ? "" : chunk(binary, 0x004E4942, '\0'));
    return "glTF" + pack<uint32_t>({2, static_cast<uint32_t>(body.size() + 12)}) + body;
}

TEST(Gltf, SquareHasFlatNormalsPerFace) {
    const TempFolder folder;
    const Scene scene = load(folder, square());
    const Primitive& p = first_primitive(scene);
    ASSERT_EQ(p.triangles.size(), 2u);
    ASSERT_EQ(p.positions.size(), 6u);  // split: flat normals belong to faces, not to vertices
    for (const glm::vec3& n : p.normals) expect_near(n, {0, 0, 1});
    EXPECT_EQ(scene.nodes.at(0).source, 0);
    EXPECT_EQ(scene.materials.at(p.material).metallic, 1.f);  // the format's default material
}

TEST(Gltf, NonIndexedStripsFansAndPoints) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf).erase("indices");
    primitive(gltf)["mode"] = 5;
    const Primitive strip = first_primitive(load(folder, gltf));
    ASSERT_EQ(strip.triangles.size(), 2u);
    expect_near(strip.positions[strip.triangles[1].x], {1, 0, 0});
    expect_near(strip.positions[strip.triangles[1].y], {0, 1, 0});  // every second triangle turns round
    primitive(gltf)["mode"] = 6;
    const Primitive fan = first_primitive(load(folder, gltf));
    ASSERT_EQ(fan.triangles.size(), 2u);
    for (const glm::vec3& n : fan.normals) expect_near(n, {0, 0, 1});
    gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    const Scene with_points = load(folder, gltf);
    EXPECT_EQ(with_points.meshes[0].primitives.size(), 1u);
    EXPECT_TRUE(has_note(with_points, "1 primitive of points or lines"));
}

TEST(Gltf, PointsAndLinesOfASize) {
    const TempFolder folder;
    json gltf = square();
    gltf["materials"] = {{{"name", "red"}}};
    primitive(gltf)["material"] = 0;
    gltf["nodes"][0]["scale"] = {10, 10, 10};
    gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}, {"material", 0}});
    gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 2}});
    const std::string file = folder.write("points.gltf", gltf.dump());
    EXPECT_EQ(load_scene(file).meshes[0].primitives.size(), 1u);
    const Scene scene = load_scene(file, {.point_size = 0.5f});
    EXPECT_EQ(all_notes(scene), "");
    const std::vector<Primitive>& primitives = scene.meshes[0].primitives;
    ASSERT_EQ(primitives.size(), 3u);
    EXPECT_EQ(primitives[1].triangles.size(), 4u * 20);
    EXPECT_EQ(primitives[2].triangles.size(), 4u * 20 + 4u * 12);
    // World units, wherever the node's scale leads; without normals they are not lit, what else has the material is.
    const Geometry all = flatten(scene);
    EXPECT_NEAR(all.upper.x, 10.25f, 0.05f);
    EXPECT_NEAR(all.lower.z, -0.25f, 0.05f);
    EXPECT_FALSE(scene.materials[primitives[0].material].unlit);
    EXPECT_TRUE(scene.materials[primitives[1].material].unlit);
    EXPECT_EQ(scene.materials[primitives[1].material].name, "red");
    EXPECT_TRUE(scene.materials[primitives[2].material].unlit);
    EXPECT_EQ(scene.materials[primitives[2].material].name, "default");
}

TEST(Gltf, EveryIndexType) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["indices"] = add_accessor(gltf, pack<uint8_t>({0, 1, 2, 0, 2, 3}), 5121, "SCALAR", 6);
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
    primitive(gltf)["indices"] = add_accessor(gltf, pack<uint32_t>({0, 1, 2, 0, 2, 3}), 5125, "SCALAR", 6);
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, QuantizedPositionsAndNormals) {
    const TempFolder folder;
    json gltf = square();
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
    auto& attributes = primitive(gltf)["attributes"];
    attributes["POSITION"] =
        add_accessor(gltf, pack<int16_t>({0, 0, 0, 32767, 0, 0, 32767, 32767, 0, 0, -32768, 0}), 5122, "VEC3", 4, true);
    attributes["NORMAL"] =
        add_accessor(gltf, pack<int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}), 5120, "VEC3", 4, true);
    const Primitive p = first_primitive(load(folder, gltf));
    expect_near(p.positions.at(1), {1, 0, 0});
    expect_near(p.positions.at(3), {0, -1, 0});  // -32768 counts as -1
    expect_near(p.normals.at(0), {0, 0, 1});
    attributes.erase("NORMAL");
    attributes["POSITION"] = add_accessor(gltf, pack<uint8_t>({0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0}), 5121, "VEC3", 4);
    expect_near(first_primitive(load(folder, gltf)).positions.at(1), {9, 0, 0});
}

TEST(Gltf, InterleavedAndSparse) {
    const TempFolder folder;
    json gltf = square();
    std::vector<float> interleaved;
    for (int i = 0; i < 4; ++i) {
        interleaved.insert(interleaved.end(), unit_square.begin() + 3 * i, unit_square.begin() + 3 * i + 3);
        interleaved.insert(interleaved.end(), {0, 0, 1});
    }
    const size_t positions = add_accessor(gltf, pack(interleaved), 5126, "VEC3", 4);
    gltf["bufferViews"].back()["byteStride"] = 24;
    gltf["accessors"].push_back(gltf["accessors"][positions]);
    gltf["accessors"].back()["byteOffset"] = 12;
    primitive(gltf)["attributes"] = {{"POSITION", positions}, {"NORMAL", positions + 1}};
    const Primitive p = first_primitive(load(folder, gltf));
    ASSERT_EQ(p.positions.size(), 4u);
    expect_near(p.positions[2], {1, 1, 0});
    expect_near(p.normals[2], {0, 0, 1});

    add_accessor(gltf, pack<uint8_t>({2}), 5121, "SCALAR", 1);
    const size_t index_view = gltf["bufferViews"].size() - 1;
    add_accessor(gltf, pack<float>({5, 6, 7}), 5126, "VEC3", 1);
    gltf["accessors"][positions]["sparse"] = {{"count", 1},
                                              {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                              {"values", {{"bufferView", index_view + 1}}}};
    expect_near(first_primitive(load(folder, gltf)).positions[2], {5, 6, 7});
    // Without a buffer view the rest is zero.
    gltf["accessors"][positions].erase("bufferView");
    expect_near(first_primitive(load(folder, gltf)).positions[1], {0, 0, 0});
}

TEST(Gltf, GlbWithAndWithoutPadding) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"][0].erase("uri");
    const Scene scene = load_scene(folder.write("scene.glb", glb(gltf.dump(), pack(unit_square) + "xyz")));
    EXPECT_EQ(first_primitive(scene).triangles.size(), 2u);
}

TEST(Gltf, ExternalBufferMayBeLongerThanSaid) {
    const TempFolder folder;
    folder.write("a b\xC3\xA9.bin", pack(unit_square) + "more");
    json gltf = square();
    gltf["buffers"][0]["uri"] = "a%20b%C3%A9.bin";
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
    gltf["buffers"][0]["uri"] = "a b\xC3\xA9.bin";
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, DataUrisOfAnyMediaType) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"][0]["uri"] = "data:application/x-own;v=1;base64," + base64(pack(unit_square) + "more");
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, IndicesWithoutBufferViewAreZeros) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][1].erase("bufferView");
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, WholeNumbersMayHaveAPoint) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][0]["count"] = 4.0;
    gltf["bufferViews"][0]["byteLength"] = 48.0;
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, MissingImagesWithoutTexelsInThePictureAreNoted) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "gone.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"normalTexture": {"index": 0}, "emissiveTexture": {"index": 0},
        "emissiveFactor": [1, 2, 3], "pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}])");
    const Scene scene = load(folder, gltf);
    expect_near(scene.materials.at(0).emissive, {1, 2, 3});
    EXPECT_TRUE(has_note(scene, "3 textures other than of the base colour left out"));
    EXPECT_FALSE(has_note(scene, "replaced by their mean"));
}

TEST(Gltf, ImagesOfOtherTypesAreNoted) {
    const TempFolder folder;
    const std::pair<const char*, std::string> images[] = {{"KTX2", "\xABKTX 20\xBB\r\n\x1A\n"},
                                                          {"DDS", std::string("DDS |\0\0\0", 8)},
                                                          {"AVIF", std::string("\0\0\0\x1C"
                                                                               "ftypavif",
                                                                               12)},
                                                          {"DDS", "DDS |"}};
    for (const auto& [type, bytes] : images)
        for (const char* material : {R"([{"normalTexture": {"index": 0}}])",
                                     R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])",
                                     R"([{"emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1]}])"}) {
            json gltf = square();
            gltf["images"] = {{{"uri", data_uri(bytes)}}};
            gltf["textures"] = {{{"source", 0}}};
            gltf["materials"] = json::parse(material);
            const Scene scene = load(folder, gltf);
            EXPECT_EQ(scene.materials[0].base_color_texture, -1);
            EXPECT_TRUE(has_note(scene, std::string("of the type ") + type)) << type << material;
        }
}

TEST(Gltf, BuffersThatNothingReadsNeedNoData) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"].push_back({{"byteLength", 4000000000u}});
    gltf["bufferViews"].push_back({{"buffer", gltf["buffers"].size() - 1}, {"byteLength", 100}});
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
    gltf["accessors"][0]["bufferView"] = gltf["bufferViews"].size() - 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "no data");
}

TEST(Gltf, InvalidFilesThatAreDrawnSaySo) {
    const TempFolder folder;
    const auto note = [&](const json& gltf, const char* code) {
        EXPECT_TRUE(has_note(load(folder, gltf), code)) << code;
    };
    json gltf = square();
    EXPECT_TRUE(load(folder, gltf).notes.empty());
    gltf["nodes"][0]["rotation"] = {0, 0, 0, 2};
    note(gltf, "ROTATION_NON_UNIT");
    gltf["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    note(gltf, "NODE_MATRIX_TRS");
    gltf["nodes"][0].erase("rotation");
    EXPECT_TRUE(load(folder, gltf).notes.empty());
    gltf["nodes"][0]["matrix"][4] = 1;  // a shear
    note(gltf, "NODE_MATRIX_NON_TRS");
    gltf["nodes"][0].erase("matrix");
    gltf["nodes"][0]["weights"] = {1};
    note(gltf, "NODE_WEIGHTS_INVALID");
    gltf["nodes"][0].erase("weights");
    gltf["meshes"][0]["weights"] = {0.5};
    note(gltf, "MESH_INVALID_WEIGHTS_COUNT");
    primitive(gltf)["targets"] = json::array({{{"POSITION", 0}}});
    EXPECT_TRUE(load(folder, gltf).notes.empty());
    gltf["meshes"][0]["primitives"].push_back(primitive(gltf));
    gltf["meshes"][0]["primitives"][1].erase("targets");
    note(gltf, "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT");
    json restart = square();
    std::vector<float> line;
    for (int i = 0; i < 256; ++i) line.insert(line.end(), {float(i), float(i % 3), 0});
    primitive(restart)["attributes"]["POSITION"] = add_accessor(restart, pack(line), 5126, "VEC3", 256);
    primitive(restart)["indices"] = add_accessor(restart, pack<uint8_t>({0, 1, 255}), 5121, "SCALAR", 3);
    note(restart, "ACCESSOR_INDEX_PRIMITIVE_RESTART");
}

TEST(Gltf, OddValuesOfMaterialsAndLightsSaySo) {
    const TempFolder folder;
    const auto material = [&](const char* text) {
        json gltf = square();
        primitive(gltf)["material"] = 0;
        gltf["materials"] = {json::parse(text)};
        gltf["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_transmission"};
        return load(folder, gltf);
    };
    const char* good = R"({"emissiveFactor": [0, 1, 1], "pbrMetallicRoughness": {"metallicFactor": 1},
                           "extensions": {"KHR_materials_ior": {"ior": 1}}})";
    EXPECT_TRUE(material(good).notes.empty());
    for (const char* bad :
         {R"({"emissiveFactor": [0, 2, 1]})", R"({"pbrMetallicRoughness": {"baseColorFactor": [1, -1, 0, 1]}})",
          R"({"pbrMetallicRoughness": {"metallicFactor": 1.5}})",
          R"({"pbrMetallicRoughness": {"roughnessFactor": -1}})",
          R"({"extensions": {"KHR_materials_ior": {"ior": 0.5}}})",
          R"({"extensions": {"KHR_materials_ior": {"ior": -1}}})",
          R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 2}}})"})
        EXPECT_TRUE(has_note(material(bad), "VALUE_NOT_IN_RANGE")) << bad;
    EXPECT_TRUE(has_note(material(R"({"extensions": {"KHR_materials_volume": {"thicknessFactor": 1}}})"),
                         "KHR_materials_volume: read all the same (UNDECLARED_EXTENSION)"));
    EXPECT_TRUE(has_note(material(R"({"extensions": {"ACME_{}_paint": {}}})"), "ACME_{}_paint: without effect"));

    const auto light = [&](const char* text) {
        json gltf = square();
        gltf["extensionsUsed"] = {"KHR_lights_punctual"};
        gltf["extensions"]["KHR_lights_punctual"]["lights"] = {json::parse(text)};
        gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
        return load(folder, gltf);
    };
    EXPECT_TRUE(light(R"({"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}})").notes.empty());
    EXPECT_TRUE(has_note(light(R"({"type": "point", "intensity": -1})"), "VALUE_NOT_IN_RANGE"));
    EXPECT_TRUE(has_note(light(R"({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.2}})"),
                         "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES"));
    const Scene dark = light(R"({"type": "laser"})");
    EXPECT_TRUE(dark.lights.empty());
    EXPECT_TRUE(has_note(dark, "VALUE_NOT_IN_LIST"));
}

TEST(Gltf, OddMeshesAndNodesSaySo) {
    const TempFolder folder;
    const auto noted = [&](const json& gltf, const char* code) {
        EXPECT_TRUE(has_note(load(folder, gltf), code)) << code;
    };
    json gltf = square();
    primitive(gltf)["attributes"]["COLOR_0"] = add_accessor(gltf, std::string(16, '\x7F'), 5121, "VEC4", 4);
    noted(gltf, "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT");
    gltf["accessors"].back()["normalized"] = true;
    EXPECT_TRUE(load(folder, gltf).notes.empty());
    gltf = square();
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 0, 2, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
    noted(gltf, "1 normal of other than unit length");
    gltf = square();
    primitive(gltf)["targets"] = json::array({{{"NORMAL", 0}}});
    noted(gltf, "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR");
    gltf = square();
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"].erase("TEXCOORD_0");
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 3}}}])");
    noted(gltf, "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS");
    gltf["materials"][0] = json::object();  // which needs none
    EXPECT_TRUE(load(folder, gltf).notes.empty());

    gltf = square();
    gltf["skins"] = {{{"joints", {0}}}};
    gltf["nodes"][0]["skin"] = 0;
    noted(gltf, "NODE_SKIN_WITH_NON_SKINNED_MESH");
    gltf = square();
    gltf["nodes"].push_back({{"children", {0}}, {"translation", {5, 0, 0}}});
    noted(gltf, "SCENE_NON_ROOT_NODE");
    gltf["nodes"].push_back({{"children", {0}}});
    gltf["scenes"][0]["nodes"] = {1};
    noted(gltf, "NODE_PARENT_OVERRIDE");
    gltf = square();
    for (const char* camera :
         {R"({"type": "fisheye"})", R"({"type": "perspective", "perspective": {"yfov": 4, "znear": 1}})"}) {
        gltf["cameras"] = {json::parse(camera)};
        gltf["nodes"][0]["camera"] = 0;
        const Scene scene = load(folder, gltf);
        EXPECT_TRUE(scene.cameras.empty());
        EXPECT_TRUE(has_note(scene, "1 camera of an unknown type")) << camera;
    }
}

/// What a later version of the format may have is no reason to refuse a file that does not use it.
TEST(Gltf, AccessorsOfUnknownTypesThatNothingReads) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"].push_back({{"componentType", 5126}, {"count", 1}, {"type", "VEC9"}});
    gltf["accessors"].push_back({{"componentType", 5130}, {"count", 1}, {"type", "VEC3"}});
    EXPECT_EQ(first_primitive(load(folder, gltf)).triangles.size(), 2u);
    primitive(gltf)["attributes"]["POSITION"] = gltf["accessors"].size() - 2;
    EXPECT_MENTIONS(error_of(folder, gltf), "the type \"VEC9\" is unknown");
    primitive(gltf)["attributes"]["POSITION"] = gltf["accessors"].size() - 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "the component type 5130 is unknown");
}

TEST(Gltf, HierarchyIsDepthFirstAndTransforms) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"] = {{{"mesh", 0}, {"translation", {0, 0, 1}}},
                     {{"children", {2, 0}}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
                     {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}}};
    gltf["scenes"][0]["nodes"] = {1};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].source, 1);
    EXPECT_EQ(scene.nodes[1].source, 2);
    EXPECT_EQ(scene.nodes[2].source, 0);
    EXPECT_EQ(scene.nodes[2].parent, 0);
    const Geometry geometry = flatten(scene);
    ASSERT_EQ(geometry.triangles.size(), 4u);
    expect_near(geometry.positions[geometry.triangles[0].x], {0, 20, 0});  // x turned to y, then twice as far
    expect_near(geometry.positions[geometry.triangles[2].y], {0, 2, 2});
}

TEST(Gltf, InstancesOfANode) {
    const TempFolder folder;
    json gltf = square();
    const size_t translation = add_accessor(gltf, pack<float>({1, 2, 3, 4, 5, 6}), 5126, "VEC3", 2);
    const size_t rotation = add_accessor(gltf, pack<int8_t>({0, 0, 0, 127, 0, 0, 127, 0}), 5120, "VEC4", 2);
    gltf["accessors"][rotation]["normalized"] = true;
    const size_t scale = add_accessor(gltf, pack<float>({1, 1, 1, 2, 2, 2}), 5126, "VEC3", 2);
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    gltf["nodes"][0]["translation"] = {10, 0, 0};
    json& attributes = gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 0}};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].mesh, -1);
    const Geometry g = flatten(scene);
    ASSERT_EQ(g.triangles.size(), 4u);
    expect_near(g.positions[g.triangles[0].y], glm::vec3(1, 2, 3) + glm::vec3(10, 0, 0) + glm::vec3(1, 0, 0));
    expect_near(g.positions[g.triangles[2].y], glm::vec3(4, 5, 6) + glm::vec3(10, 0, 0) + glm::vec3(-2, 0, 0));

    json bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = rotation;
    EXPECT_MENTIONS(error_of(folder, bad), "SCALE needs 3 numbers an instance");
    bad = gltf;
    bad["accessors"][scale]["count"] = 1;
    EXPECT_MENTIONS(error_of(folder, bad), "another attribute");
    bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 99;
    EXPECT_MENTIONS(error_of(folder, bad), "99 is out of range");
    bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"].erase("attributes");
    EXPECT_MENTIONS(error_of(folder, bad), "attributes");
}

TEST(Gltf, SceneChoice) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}};
    gltf["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    EXPECT_EQ(load(folder, gltf).nodes.at(0).name, "a");
    gltf["scene"] = 1;
    EXPECT_EQ(load(folder, gltf).nodes.at(0).name, "b");
    gltf.erase("scene");
    gltf.erase("scenes");
    EXPECT_EQ(load(folder, gltf).nodes.size(), 2u);
}

TEST(Gltf, DeepHierarchyNeedsNoCallStack) {
    const TempFolder folder;
    json gltf = square();
    constexpr int depth = 100000;
    for (int i = 0; i < depth; ++i) gltf["nodes"][i] = {{"children", {i + 1}}};
    gltf["nodes"][depth] = {{"mesh", 0}};
    EXPECT_EQ(load(folder, gltf).nodes.size(), depth + 1u);
}

TEST(Gltf, Materials) {
    const TempFolder folder;
    json gltf = square();
    gltf["materials"] = json::parse(
        R"([{"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6},
        "emissiveFactor": [1, 0.5, 0], "alphaMode": "BLEND", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.7},
        "KHR_materials_ior": {"ior": 1.4}, "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3, "attenuationColor": [0.5, 0.6, 0.7]},
        "KHR_materials_emissive_strength": {"emissiveStrength": 10}, "KHR_materials_unlit": {}, "KHR_materials_clearcoat": {}}}])");
    gltf["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_clearcoat"};
    primitive(gltf)["material"] = 0;
    const Scene scene = load(folder, gltf);
    const Material& m = scene.materials.at(0);
    expect_near(m.base_color, {0.1f, 0.2f, 0.3f});
    EXPECT_FLOAT_EQ(m.alpha, 0.4f);
    EXPECT_FLOAT_EQ(m.metallic, 0.5f);
    EXPECT_FLOAT_EQ(m.roughness, 0.6f);
    expect_near(m.emissive, {10, 5, 0});
    EXPECT_FLOAT_EQ(m.transmission, 0.7f);
    EXPECT_FLOAT_EQ(m.ior, 1.4f);
    EXPECT_FLOAT_EQ(m.thickness, 2);
    EXPECT_FLOAT_EQ(m.attenuation_distance, 3);
    expect_near(m.attenuation_color, {0.5f, 0.6f, 0.7f});
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(scene.extensions_unsupported, std::vector<std::string>{"KHR_materials_clearcoat"});
    EXPECT_EQ(scene.extensions_used.size(), 2u);
    EXPECT_TRUE(has_note(scene, "BLEND"));
}

TEST(Gltf, ReflectanceOfDielectrics) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    const auto with = [&](const json& extensions) {
        gltf["materials"] = {{{"extensions", extensions}}};
        gltf["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_specular"};
        return load(folder, gltf);
    };
    const auto ior = [&](double value) { return with({{"KHR_materials_ior", {{"ior", value}}}}); };
    EXPECT_FLOAT_EQ(with(json::object()).materials[0].ior, 1.5f);
    EXPECT_EQ(with(json::object()).materials[0].specular, 1);
    EXPECT_EQ(with(json::object()).materials[0].specular_color, glm::vec3(1));
    EXPECT_EQ(ior(0).materials[0].ior, 0) << "stands for an infinite one";
    EXPECT_TRUE(ior(0).notes.empty());
    EXPECT_EQ(ior(1000).materials[0].ior, 1000);
    EXPECT_EQ(ior(1e30).materials[0].ior, 0) << "as good as infinite";
    for (double impossible : {0.5, -2.0}) {
        EXPECT_EQ(ior(impossible).materials[0].ior, 1);
        EXPECT_TRUE(has_note(ior(impossible), "index of refraction below 1"));
    }
    const Scene scene = with(
        {{"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", json::array({0.25, 2, -1})}}}});
    EXPECT_EQ(scene.materials[0].specular, 0.5f);
    EXPECT_EQ(scene.materials[0].specular_color, glm::vec3(0.25f, 2, 0));
    EXPECT_TRUE(scene.extensions_unsupported.empty());
    EXPECT_EQ(with({{"KHR_materials_specular", {{"specularFactor", 7}}}}).materials[0].specular, 1);
}

/// Shares of alpha that are there, at the corners of the square: (0, 0), (1, 0), (1, 1) of its first triangle.
std::array<bool, 3> corners_present(const Scene& scene) {
    const Geometry geometry = flatten(scene);
    const AlphaTest alpha(scene, geometry);
    return {alpha.is_present(0, 0, 0), alpha.is_present(0, 1, 0), alpha.is_present(0, 0, 1)};
}

TEST(Gltf, AlphaModes) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    const auto with = [&](const json& material) {
        gltf["materials"] = {material};
        return load(folder, gltf);
    };
    const json factor = {{"baseColorFactor", {1, 1, 1, 0.4}}};
    const auto all = [](bool present) { return std::array<bool, 3>{present, present, present}; };

    Scene scene = with({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", factor}});
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha, 0.4f);
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.5f) << "the format's default";
    EXPECT_EQ(corners_present(scene), all(false));
    EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    scene = with({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"pbrMetallicRoughness", factor}});
    EXPECT_FLOAT_EQ(scene.materials.at(0).alpha_cutoff, 0.25f);
    EXPECT_EQ(corners_present(scene), all(true));
    // An alpha that equals the cutoff is there; a cutoff of 0 leaves nothing out, one above 1 leaves nothing.
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 0.4}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 0}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 1}})), all(true));
    EXPECT_EQ(corners_present(with({{"alphaMode", "MASK"}, {"alphaCutoff", 1.01}})), all(false));

    EXPECT_EQ(corners_present(with({{"alphaMode", "OPAQUE"}, {"alphaCutoff", 0.9}, {"pbrMetallicRoughness", factor}})),
              all(true));
    EXPECT_EQ(corners_present(with({{"alphaCutoff", 0.9}, {"pbrMetallicRoughness", factor}})), all(true));
    scene = with({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", factor}});
    EXPECT_EQ(scene.materials.at(0).alpha_cutoff, 0);
    EXPECT_EQ(corners_present(scene), all(true));
    EXPECT_TRUE(has_note(scene, "1 material with alphaMode BLEND drawn opaque"));
}

TEST(Gltf, MasksMultiplyFactorTextureAndVertexAlpha) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["material"] = 0;
    gltf["materials"] = json::parse(
        R"([{"alphaMode": "MASK", "alphaCutoff": 0.3, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}])");
    primitive(gltf)["attributes"]["COLOR_0"] =
        add_accessor(gltf, pack<float>({1, 1, 1, 0.5f, 1, 1, 1, 0.7f, 1, 1, 1, 1, 1, 1, 1, 1}), 5126, "VEC4", 4);
    EXPECT_EQ(corners_present(load(folder, gltf)), (std::array<bool, 3>{false, true, true}));
    // A texture of 2×1 texels: opaque, then an alpha of 204/255.
    gltf["images"] = {
        {{"uri",
          "data:image/"
          "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADElEQVR42mP4DwFnACOyB8axSYLdAAAAAElFTkSuQmCC"}}};
    gltf["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 1, 1, 0, 1}), 5126, "VEC2", 4);
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(scene.textures.at(0).texels.at(0) >> 24, 255u);
    EXPECT_EQ(scene.textures.at(0).texels.at(1) >> 24, 204u);
    EXPECT_EQ(corners_present(scene), (std::array<bool, 3>{false, false, true}));
}

TEST(Gltf, BaseColorTextureWithTransformAndSampler) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf["materials"] =
        json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0, "extensions":
        {"KHR_texture_transform": {"texCoord": 1, "offset": [10, 20], "scale": [2, 3], "rotation": 1.5707963}}}}}])");
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"]["TEXCOORD_1"] =
        add_accessor(gltf, pack<uint8_t>({0, 0, 255, 0, 255, 255, 0, 255}), 5121, "VEC2", 4, true);
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.textures.size(), 1u);
    const Texture& texture = scene.textures[0];
    EXPECT_EQ(texture.width, 2u);
    EXPECT_EQ(texture.height, 1u);
    EXPECT_EQ(texture.texels, (std::vector<uint32_t>{0xFF0000FFu, 0xFF00FF00u}));
    EXPECT_EQ(texture.wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(texture.wrap_v, Texture::Wrap::mirror);
    EXPECT_TRUE(texture.nearest);
    const Primitive& p = first_primitive(scene);
    EXPECT_EQ(p.uvs.at(p.triangles[0].y), glm::vec2(1, 0));
    EXPECT_TRUE(p.more_uvs.empty());  // the first set that is used, not the file's first
    const MaterialTexture& use = scene.materials[0].base_color_texture;
    EXPECT_EQ(use.uv_set, 0u);
    // Scaled to (2, 0), turned counter-clockwise in an image whose v runs down.
    const glm::vec2 uv = use.place({1, 0});
    EXPECT_NEAR(uv.x, 10, 1e-4);
    EXPECT_NEAR(uv.y, 18, 1e-4);
}

TEST(Gltf, EveryTextureOfAMaterial) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["samplers"] = {{{"wrapS", 33071}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
    gltf["materials"] = json::parse(R"([{
        "pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0.25,
            "baseColorTexture": {"index": 0, "texCoord": 2}, "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 1, "texCoord": 2, "scale": -0.5},
        "occlusionTexture": {"index": 1, "strength": 0.75,
            "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}}},
        "emissiveTexture": {"index": 1, "texCoord": 5}, "emissiveFactor": [1, 0.5, 0.25],
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": {"index": 1,
                           "extensions": {"KHR_texture_transform": {"texCoord": 2}}}},
                       "KHR_materials_volume": {"thicknessFactor": 2, "thicknessTexture": {"index": 0}}}}])");
    primitive(gltf)["material"] = 0;
    for (const char* set : {"TEXCOORD_0", "TEXCOORD_2"})
        primitive(gltf)["attributes"][set] =
            add_accessor(gltf, pack<float>({0, 1, set[9] == '2' ? 3.f : 1.f, 1, 1, 0, 0, 0}), 5126, "VEC2", 4);
    const Scene scene = load(folder, gltf);
    const Material& m = scene.materials.at(0);
    ASSERT_EQ(scene.textures.size(), 2u);  // one image, two samplers
    const Primitive& p = first_primitive(scene);
    ASSERT_EQ(p.more_uvs.size(), 2u);  // sets 2, 0, 5 in the order of their use; there is no set 5
    EXPECT_EQ(p.uvs.at(p.triangles[0].y), glm::vec2(3, 1));
    EXPECT_EQ(p.more_uvs[0].at(p.triangles[0].y), glm::vec2(1, 1));
    EXPECT_TRUE(p.more_uvs[1].empty());
    EXPECT_TRUE(has_note(scene, "1 primitive without the texture coordinates"));
    const auto expect_use = [](const MaterialTexture& use, int texture, uint32_t set, uint32_t channel) {
        EXPECT_EQ(use.texture, texture);
        EXPECT_EQ(use.uv_set, set);
        EXPECT_EQ(use.channel, channel);
    };
    expect_use(m.base_color_texture, 0, 0, 0);
    expect_use(m.roughness_texture, 0, 1, 1);
    expect_use(m.metallic_texture, 0, 1, 2);
    expect_use(m.emissive_texture, 1, 2, 0);
    expect_use(m.normal_texture, 1, 0, 0);
    expect_use(m.occlusion_texture, 1, 1, 0);
    expect_use(m.transmission_texture, 1, 0, 0);
    expect_use(m.thickness_texture, 0, 1, 1);
    EXPECT_EQ(m.occlusion_texture.place({1, 1}), glm::vec2(2.5f, 4.25f));
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.normal_scale, -0.5f);
    EXPECT_EQ(m.occlusion_strength, 0.75f);
    EXPECT_EQ(p.tangents.size(), p.positions.size());  // made, since the file has none
}

TEST(Gltf, TangentsAreReadWhereTheyAreRight) {
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri", "data:image/png;base64," + base64(tiny_png())}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"normalTexture": {"index": 0}}])");
    primitive(gltf)["material"] = 0;
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4);
    primitive(gltf)["attributes"]["TEXCOORD_0"] =
        add_accessor(gltf, pack<float>({0, 1, 1, 1, 1, 0, 0, 0}), 5126, "VEC2", 4);
    json right = gltf;
    primitive(right)["attributes"]["TANGENT"] =
        add_accessor(right, pack<float>({0, 2, 0, -1, 0, 2, 0, -1, 0, 2, 0, -1, 0, 2, 0, -1}), 5126, "VEC4", 4);
    const Scene given = load(folder, right);
    EXPECT_EQ(first_primitive(given).tangents, std::vector<glm::vec4>(4, glm::vec4(0, 1, 0, -1)));
    for (const float bad : {0.f, 0.5f, NAN}) {
        json wrong = gltf;
        primitive(wrong)["attributes"]["TANGENT"] =
            add_accessor(wrong, pack<float>({0, 1, 0, -1, 0, 1, 0, bad, 0, 1, 0, 1, 0, 1, 0, 1}), 5126, "VEC4", 4);
        const Scene scene = load(folder, wrong);
        EXPECT_TRUE(has_note(scene, "1 primitive whose tangents have no direction or no side")) << bad;
        for (const glm::vec4& t : first_primitive(scene).tangents) EXPECT_NEAR(t.x, 1, 1e-6) << bad;
    }
    primitive(gltf)["attributes"].erase("NORMAL");  // flat normals: the file's tangents would not belong to them
    primitive(gltf)["attributes"]["TANGENT"] = primitive(right)["attributes"]["TANGENT"];
    right = gltf;
    primitive(right)["attributes"]["TANGENT"] =
        add_accessor(right, pack<float>({0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}), 5126, "VEC4", 4);
    const Scene flat = load(folder, right);
    EXPECT_FALSE(first_primitive(flat).tangents.empty());
    for (const glm::vec4& t : first_primitive(flat).tangents) EXPECT_NEAR(t.x, 1, 1e-6);
}

TEST(Gltf, SixteenBitImagesKeepTheirDepth) {
    // 2×1 texels of 16 bits, RGB: (0x1234, 0x5678, 0x9ABC) and (0xFFFF, 0, 1).
    const TempFolder folder;
    json gltf = square();
    gltf["images"] = {{{"uri",
                        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR4nGMQMgmrmLXn/"
                        "38GBgZGAB+fBGrbFwuVAAAAAElFTkSuQmCC"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = json::parse(R"([{"occlusionTexture": {"index": 0}}])");
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_TRUE(scene.textures[0].texels.empty());
    EXPECT_EQ(scene.textures[0].deep_texels, (std::vector<uint64_t>{0xFFFF9ABC56781234ull, 0xFFFF00010000FFFFull}));
}

TEST(Gltf, VertexColors) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["attributes"]["COLOR_0"] =
        add_accessor(gltf, pack<uint16_t>({65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}), 5123, "VEC3", 4, true);
    const Primitive p = first_primitive(load(folder, gltf));
    ASSERT_EQ(p.colors.size(), p.positions.size());
    EXPECT_EQ(p.colors[p.triangles[0].y], glm::vec4(0, 1, 0, 1));
}

TEST(Gltf, CamerasAndLights) {
    const TempFolder folder;
    json gltf = square();
    gltf["cameras"] = json::parse(R"([{"type": "perspective", "name": "p", "perspective": {"yfov": 0.5, "znear": 0.1}},
                                      {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 2, "zfar": 9, "znear": 0}}])");
    gltf["extensions"] = json::parse(
        R"({"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 3, "color": [1, 0.5, 0], "range": 7,
        "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}, {"type": "directional"}]}})");
    gltf["nodes"] = json::parse(
        R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5], "name": "front"}, {"camera": 1, "translation": [5, 0, 0]},
        {"translation": [1, 2, 3], "rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}}])");
    gltf["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.cameras.size(), 2u);
    expect_near(scene.cameras[0].eye, {0, 0, 5});
    expect_near(scene.cameras[0].look, {0, 0, 0});  // on its axis, next to the middle of the square
    expect_near(scene.cameras[0].up, {0, 1, 0});
    EXPECT_EQ(scene.cameras[0].name, "p");
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, 0.5f);
    EXPECT_FLOAT_EQ(scene.cameras[1].orthographic_height, 4);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::spot);
    expect_near(scene.lights[0].color, {3, 1.5f, 0});
    expect_near(scene.lights[0].position, {1, 2, 3});
    expect_near(scene.lights[0].direction, {0, -1, 0});
    EXPECT_FLOAT_EQ(scene.lights[0].range, 7);
    EXPECT_FLOAT_EQ(scene.lights[0].outer_cone, 0.2f);
    expect_near(scene.lights[1].direction, {0, 0, -1});
    EXPECT_EQ(scene.nodes[3].light, 0);
}

/// A square with a skin of one joint, a morph target, and an animation of its node.
json moving_square() {
    json gltf = square();
    const size_t times = add_accessor(gltf, pack<float>({0, 0.5f, 2.5f}), 5126, "SCALAR", 3);
    const size_t places = add_accessor(gltf, pack<float>({0, 0, 0, 1, 0, 0, 3, 0, 0}), 5126, "VEC3", 3);
    const size_t joints = add_accessor(gltf, std::string(16, '\0'), 5121, "VEC4", 4);
    const size_t weights =
        add_accessor(gltf, pack<float>({2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0}), 5126, "VEC4", 4);
    gltf["animations"] = {{{"name", "walk"},
                           {"samplers", {{{"input", times}, {"output", places}}}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    gltf["skins"] = {{{"joints", {1}}}};
    gltf["nodes"][0]["skin"] = 0;
    gltf["nodes"].push_back({{"name", "bone"}});
    gltf["scenes"][0]["nodes"].push_back(1);
    primitive(gltf)["attributes"]["JOINTS_0"] = joints;
    primitive(gltf)["attributes"]["WEIGHTS_0"] = weights;
    primitive(gltf)["targets"] = json::array({{{"POSITION", 0}}});
    gltf["meshes"][0]["weights"] = {1};
    return gltf;
}

TEST(Gltf, AnimationsSkinsAndMorphTargets) {
    const TempFolder folder;
    Scene scene = load(folder, moving_square());
    ASSERT_EQ(scene.animations.size(), 1u);
    EXPECT_EQ(scene.animations[0].name, "walk");
    EXPECT_FLOAT_EQ(scene.animations[0].duration, 2.5f);
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_TRUE(has_note(scene, "4 vertices whose joint weights do not sum to one rescaled"));
    const std::vector<glm::vec3> bound = scene.meshes[0].primitives[0].positions;
    const Geometry rest = flatten(scene);
    const Geometry moved = flatten(scene, moment_of(scene, "walk", 1.5));
    for (size_t i = 0; i < bound.size(); i++) {
        expect_near(rest.positions[i], 2.f * bound[i]);  // the target of weight 1 is the square itself
        expect_near(moved.positions[i], 2.f * bound[i] + glm::vec3(2, 0, 0));
    }
}

TEST(Gltf, BadAnimationsAndSkinsAreRefused) {
    const TempFolder folder;
    const auto refuse = [&](const std::function<void(json&)>& spoil, const std::string& part) {
        json gltf = moving_square();
        spoil(gltf);
        EXPECT_MENTIONS(error_of(folder, gltf), part);
    };
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["input"] =
                add_accessor(g, pack<float>({0, 0.5f, 0.5f}), 5126, "SCALAR", 3);
        },
        "key 2 is not after the one before");
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["input"] = add_accessor(g, pack<float>({0, NAN, 1}), 5126, "SCALAR", 3);
        },
        "of key 1 is no number of seconds");
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["output"] = add_accessor(g, pack<float>({0, 0, 0}), 5126, "VEC3", 1);
        },
        "3 keys need 9 numbers, the output has 3");
    refuse([](json& g) { g["animations"][0]["samplers"][0]["interpolation"] = "BEZIER"; }, "\"BEZIER\" is unknown");
    refuse([](json& g) { g["animations"][0]["channels"][0]["sampler"] = 3; }, "sampler 3 is out of range");
    refuse([](json& g) { g["animations"][0]["channels"][0]["target"]["node"] = 9; }, "9 is out of range");
    refuse(
        [](json& g) {
            primitive(g)["attributes"]["JOINTS_0"] = add_accessor(g, std::string(16, '\1'), 5121, "VEC4", 4);
        },
        "follows joint 1, the skin has 1");
    refuse([](json& g) { g["skins"][0]["joints"] = {7}; }, "7 is out of range");
    refuse([](json& g) { g["scenes"][0]["nodes"] = {0}; }, "joint 0 is not part of the scene");
    refuse([](json& g) { g["skins"][0]["inverseBindMatrices"] = 0; }, "inverseBindMatrices needs a 4x4 matrix");
    refuse([](json& g) { g["nodes"][1]["children"] = {1}; }, "reached twice");
}

TEST(Gltf, MirroredAndFlattenedNodes) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"][0] = {{"mesh", 0}, {"scale", {-1, 1, 1}}};
    const Geometry mirrored = flatten(load(folder, gltf));
    const glm::uvec3 t = mirrored.triangles[0];
    const glm::vec3 face = glm::cross(mirrored.positions[t.y] - mirrored.positions[t.x],
                                      mirrored.positions[t.z] - mirrored.positions[t.x]);
    expect_near(mirrored.normals[t.x], {0, 0, 1});
    expect_near(glm::normalize(face), {0, 0, 1});
    for (const auto& scale : {json{1, 1, 0}, json{0, 0, 0}, json{1, 0, 1}}) {
        gltf["nodes"][0]["scale"] = scale;
        for (const glm::vec3& n : flatten(load(folder, gltf)).normals) EXPECT_NEAR(glm::length(n), 1, 1e-5);
    }
}

TEST(Gltf, BrokenNormalsAreReplaced) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 0, 0, NAN, 0, 0, 3, 0, 0, 0, 1}), 5126, "VEC3", 4);
    const Scene scene = load(folder, gltf);
    const Primitive& p = first_primitive(scene);
    expect_near(p.normals[0], {0, 0, 1});
    expect_near(p.normals[1], {0, 0, 1});
    expect_near(p.normals[2], {0, 1, 0});
    EXPECT_TRUE(has_note(scene, "2 normals"));
}

TEST(Gltf, RotationOfPi) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"][0] = {{"mesh", 0}, {"rotation", {0, std::sin(pi / 2), 0, std::cos(pi / 2)}}};
    const Geometry geometry = flatten(load(folder, gltf));
    expect_near(geometry.positions[geometry.triangles[0].y], {-1, 0, 0});
}

TEST(Gltf, MaterialsAreSingleSidedUnlessTheFileSaysOtherwise) {
    const TempFolder folder;
    json gltf = square();
    json glass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                  {"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
                    {"KHR_materials_volume", {{"thicknessFactor", 0.1}}}}}};
    json wall = glass, opaque = glass, metal = glass, unlit = glass;
    wall["extensions"].erase("KHR_materials_volume");
    opaque["extensions"].erase("KHR_materials_transmission");
    metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
    unlit["extensions"]["KHR_materials_unlit"] = json::object();
    gltf["materials"] = {json::object(), {{"doubleSided", false}}, {{"doubleSided", true}}, wall, glass, opaque, metal,
                         unlit};
    const Scene scene = load(folder, gltf);
    // The last one is the default material, of primitives without any.
    const std::vector<bool> single = {true, true, false, true, false, true, true, true, true};
    ASSERT_EQ(scene.materials.size(), single.size());
    for (size_t i = 0; i < single.size(); i++) EXPECT_EQ(is_single_sided(scene.materials[i]), single[i]) << i;
    EXPECT_TRUE(has_single_sided(scene, {2, 8}));
    EXPECT_FALSE(has_single_sided(scene, {2, 4}));
}

}  // namespace
}  // namespace peelray::testing
