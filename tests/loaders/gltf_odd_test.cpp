// glTF files that are odd or invalid and drawn all the same: a note says so.
#include <cmath>

#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

TEST(GltfOdd, WholeNumbersMayHaveAPoint) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][0]["count"] = 4.0;
    gltf["bufferViews"][0]["byteLength"] = 48.0;
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(GltfOdd, BuffersThatNothingReadsNeedNoData) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"].push_back({{"byteLength", 4000000000u}});
    gltf["bufferViews"].push_back({{"buffer", gltf["buffers"].size() - 1}, {"byteLength", 100}});
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
    gltf["accessors"][0]["bufferView"] = gltf["bufferViews"].size() - 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "no data");
}

TEST(GltfOdd, InvalidFilesThatAreDrawnSaySo) {
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

TEST(GltfOdd, OddValuesOfMaterialsAndLightsSaySo) {
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

TEST(GltfOdd, OddMeshesAndNodesSaySo) {
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
TEST(GltfOdd, AccessorsOfUnknownTypesThatNothingReads) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"].push_back({{"componentType", 5126}, {"count", 1}, {"type", "VEC9"}});
    gltf["accessors"].push_back({{"componentType", 5130}, {"count", 1}, {"type", "VEC3"}});
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
    primitive(gltf)["attributes"]["POSITION"] = gltf["accessors"].size() - 2;
    EXPECT_MENTIONS(error_of(folder, gltf), "the type \"VEC9\" is unknown");
    primitive(gltf)["attributes"]["POSITION"] = gltf["accessors"].size() - 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "the component type 5130 is unknown");
}

TEST(GltfOdd, BrokenNormalsAreReplaced) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["attributes"]["NORMAL"] =
        add_accessor(gltf, pack<float>({0, 0, 0, 0, NAN, 0, 0, 3, 0, 0, 0, 1}), 5126, "VEC3", 4);
    const Scene scene = load(folder, gltf);
    const Primitive& p = only_primitive(scene);
    expect_near(p.normals[0], {0, 0, 1});
    expect_near(p.normals[1], {0, 0, 1});
    expect_near(p.normals[2], {0, 1, 0});
    EXPECT_TRUE(has_note(scene, "2 normals"));
}

}  // namespace
}  // namespace peelray::testing
