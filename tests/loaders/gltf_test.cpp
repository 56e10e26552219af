// What a correct glTF file must give: triangles, accessors, buffers.
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

TEST(Gltf, SquareHasFlatNormalsPerFace) {
    const TempFolder folder;
    const Scene scene = load(folder, square());
    const Primitive& p = only_primitive(scene);
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
    const Primitive strip = only_primitive(load(folder, gltf));
    ASSERT_EQ(strip.triangles.size(), 2u);
    expect_near(strip.positions[strip.triangles[1].x], {1, 0, 0});
    expect_near(strip.positions[strip.triangles[1].y], {0, 1, 0});  // every second triangle turns round
    primitive(gltf)["mode"] = 6;
    const Primitive fan = only_primitive(load(folder, gltf));
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
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
    primitive(gltf)["indices"] = add_accessor(gltf, pack<uint32_t>({0, 1, 2, 0, 2, 3}), 5125, "SCALAR", 6);
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
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
    const Primitive p = only_primitive(load(folder, gltf));
    expect_near(p.positions.at(1), {1, 0, 0});
    expect_near(p.positions.at(3), {0, -1, 0});  // -32768 counts as -1
    expect_near(p.normals.at(0), {0, 0, 1});
    attributes.erase("NORMAL");
    attributes["POSITION"] = add_accessor(gltf, pack<uint8_t>({0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0}), 5121, "VEC3", 4);
    expect_near(only_primitive(load(folder, gltf)).positions.at(1), {9, 0, 0});
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
    const Primitive p = only_primitive(load(folder, gltf));
    ASSERT_EQ(p.positions.size(), 4u);
    expect_near(p.positions[2], {1, 1, 0});
    expect_near(p.normals[2], {0, 0, 1});

    add_accessor(gltf, pack<uint8_t>({2}), 5121, "SCALAR", 1);
    const size_t index_view = gltf["bufferViews"].size() - 1;
    add_accessor(gltf, pack<float>({5, 6, 7}), 5126, "VEC3", 1);
    gltf["accessors"][positions]["sparse"] = {{"count", 1},
                                              {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                              {"values", {{"bufferView", index_view + 1}}}};
    expect_near(only_primitive(load(folder, gltf)).positions[2], {5, 6, 7});
    // Without a buffer view the rest is zero.
    gltf["accessors"][positions].erase("bufferView");
    expect_near(only_primitive(load(folder, gltf)).positions[1], {0, 0, 0});
}

TEST(Gltf, GlbWithAndWithoutPadding) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"][0].erase("uri");
    const Scene scene = load_scene(folder.write("scene.glb", glb(gltf.dump(), pack(unit_square) + "xyz")));
    EXPECT_EQ(only_primitive(scene).triangles.size(), 2u);
}

TEST(Gltf, ExternalBufferMayBeLongerThanSaid) {
    const TempFolder folder;
    folder.write("a b\xC3\xA9.bin", pack(unit_square) + "more");
    json gltf = square();
    gltf["buffers"][0]["uri"] = "a%20b%C3%A9.bin";
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
    gltf["buffers"][0]["uri"] = "a b\xC3\xA9.bin";
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, DataUrisOfAnyMediaType) {
    const TempFolder folder;
    json gltf = square();
    gltf["buffers"][0]["uri"] = "data:application/x-own;v=1;base64," + base64(pack(unit_square) + "more");
    EXPECT_EQ(only_primitive(load(folder, gltf)).triangles.size(), 2u);
}

TEST(Gltf, IndicesWithoutBufferViewAreZeros) {
    const TempFolder folder;
    json gltf = square();
    gltf["accessors"][1].erase("bufferView");
    const Primitive p = only_primitive(load(folder, gltf));
    ASSERT_EQ(p.triangles.size(), 2u);
    for (const glm::uvec3& t : p.triangles)
        for (int k = 0; k < 3; ++k) expect_near(p.positions.at(t[k]), {0, 0, 0});  // thrice the first corner
}

TEST(Gltf, VertexColors) {
    const TempFolder folder;
    json gltf = square();
    primitive(gltf)["attributes"]["COLOR_0"] =
        add_accessor(gltf, pack<uint16_t>({65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}), 5123, "VEC3", 4, true);
    const Primitive p = only_primitive(load(folder, gltf));
    ASSERT_EQ(p.colors.size(), p.positions.size());
    EXPECT_EQ(p.colors[p.triangles[0].y], glm::vec4(0, 1, 0, 1));
}

}  // namespace
}  // namespace peelray::testing
