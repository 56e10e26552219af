// Morph targets of glTF files: what bad ones say, and what odd ones mean.
#include "loaders/animated_files.h"

namespace peelray::testing {
namespace {

/// A square whose first target lifts it by 1, the second moves it by 1 along x.
json morphing() {
    json gltf = square();
    const auto shift = [&](float x, float y) {
        std::vector<float> values;
        for (int i = 0; i < 4; ++i) values.insert(values.end(), {x, y, 0});
        return add_accessor(gltf, pack(values), 5126, "VEC3", 4);
    };
    const size_t up = shift(0, 1), aside = shift(1, 0);
    primitive(gltf)["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
    return gltf;
}

TEST(GltfMorph, BadTargets) {
    const TempFolder folder;
    const auto with = [&](const std::vector<float>& numbers, const char* type, size_t count, const char* what) {
        json gltf = morphing();
        primitive(gltf)["targets"][1][what] = add_accessor(gltf, pack(numbers), 5126, type, count);
        return error_of(folder, gltf);
    };
    std::vector<float> twelve(12, 0.f);
    EXPECT_MENTIONS(with(twelve, "VEC3", 3, "POSITION"), "targets[1].POSITION has 3 elements, POSITION has 4");
    EXPECT_MENTIONS(with(twelve, "VEC4", 3, "POSITION"), "POSITION needs 3 components");
    EXPECT_MENTIONS(with(twelve, "VEC3", 3, "NORMAL"), "targets[1].NORMAL has 3 elements, POSITION has 4");
    twelve[5] = NAN;
    EXPECT_MENTIONS(with(twelve, "VEC3", 4, "POSITION"), "targets[1].POSITION is not finite");
    json gltf = morphing();
    primitive(gltf)["targets"][0]["POSITION"] = 77;
    EXPECT_MENTIONS(error_of(folder, gltf), "out of range");
    // Others than positions and normals have no effect here.
    gltf = morphing();
    primitive(gltf)["targets"][0] = {{"TANGENT", 0}};
    EXPECT_NO_THROW(load(folder, gltf));
}

TEST(GltfMorph, MoreAndFewerWeightsThanTargets) {
    const TempFolder folder;
    const auto first = [&](const json& gltf) { return flatten(load(folder, gltf)).positions[0]; };
    json gltf = morphing();
    expect_near(first(gltf), {0, 0, 0});
    gltf["meshes"][0]["weights"] = {0.5};
    expect_near(first(gltf), {0, 0.5f, 0});
    gltf["meshes"][0]["weights"] = {0.5, 2, 9, 9};
    expect_near(first(gltf), {2, 0.5f, 0});
    gltf["nodes"][0]["weights"] = {0, 1, 5};  // the node's own win
    expect_near(first(gltf), {1, 0, 0});
    gltf["nodes"][0]["weights"] = {3};
    expect_near(first(gltf), {0, 3, 0});
    gltf["nodes"][0]["weights"] = {1e39};
    EXPECT_MENTIONS(error_of(folder, gltf), "weights");
    gltf = square();
    gltf["meshes"][0]["weights"] = {1, 2};
    EXPECT_NO_THROW(first(gltf));  // no targets at all
}

TEST(GltfMorph, AnimatedWeights) {
    const TempFolder folder;
    json gltf = morphing();
    animate_node(gltf, 0, "weights", {0, 1}, {0, 0, 1, 4}, "SCALAR");
    expect_near(positions_at(load(folder, gltf), 0.5)[0], {2, 0.5f, 0});
    for (const size_t count : {2u, 3u, 6u}) {
        json bad = morphing();
        animate_node(bad, 0, "weights", {0, 1}, std::vector<float>(count, 0.f), "SCALAR");
        EXPECT_MENTIONS(error_of(folder, bad), "2 keys need 4 numbers");
    }
    json bad = morphing();
    animate_node(bad, 0, "weights", {0, 1}, std::vector<float>(8, 0.f), "VEC4");
    EXPECT_MENTIONS(error_of(folder, bad), "its values need 1 components");
    // Quantised, as the format allows.
    gltf["animations"][0]["samplers"][0]["output"] =
        add_accessor(gltf, pack<uint8_t>({0, 0, 255, 51}), 5121, "SCALAR", 4, true);
    expect_near(positions_at(load(folder, gltf), 1)[0], {0.2f, 1, 0});
    gltf["animations"][0]["samplers"][0]["output"] =
        add_accessor(gltf, pack<int16_t>({0, 0, -32767, 32767}), 5122, "SCALAR", 4, true);
    expect_near(positions_at(load(folder, gltf), 1)[0], {1, -1, 0});
}

TEST(GltfMorph, SparseAndQuantizedTargets) {
    const TempFolder folder;
    json gltf = morphing();
    // Only the third vertex moves; there is no buffer view below.
    add_accessor(gltf, pack<uint8_t>({2}), 5121, "SCALAR", 1);
    const size_t index_view = gltf["bufferViews"].size() - 1;
    add_accessor(gltf, pack<float>({5, 6, 7}), 5126, "VEC3", 1);
    gltf["accessors"].push_back({{"componentType", 5126},
                                 {"type", "VEC3"},
                                 {"count", 4},
                                 {"sparse",
                                  {{"count", 1},
                                   {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
                                   {"values", {{"bufferView", index_view + 1}}}}}});
    primitive(gltf)["targets"][0]["POSITION"] = gltf["accessors"].size() - 1;
    gltf["nodes"][0]["weights"] = {1, 0};
    const Geometry sparse = flatten(load(folder, gltf));
    // The square without normals is flat: its two triangles share no vertex.
    ASSERT_EQ(sparse.positions.size(), 6u);
    expect_near(sparse.positions[0], {0, 0, 0});
    expect_near(sparse.positions[2], {6, 7, 7});
    gltf["accessors"].back()["sparse"]["count"] = 5;
    EXPECT_MENTIONS(error_of(folder, gltf), "5 sparse elements, the accessor has 4");

    json quantized = morphing();
    quantized["extensionsUsed"] = quantized["extensionsRequired"] = {"KHR_mesh_quantization"};
    primitive(quantized)["targets"][0]["POSITION"] =
        add_accessor(quantized, pack<int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, -127}), 5120, "VEC3", 4, true);
    quantized["nodes"][0]["weights"] = {2, 0};
    expect_near(flatten(load(folder, quantized)).positions[0], {0, 0, 2});
    primitive(quantized)["targets"][0]["POSITION"] =
        add_accessor(quantized, pack<int16_t>({0, 0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3}), 5122, "VEC3", 4);
    expect_near(flatten(load(folder, quantized)).positions[0], {0, 0, 6});
}

TEST(GltfMorph, PrimitivesMayHaveDifferentlyManyTargets) {
    const TempFolder folder;
    json gltf = morphing();
    json second = primitive(gltf);
    second["targets"].erase(1);
    gltf["meshes"][0]["primitives"].push_back(second);
    animate_node(gltf, 0, "weights", {0, 1}, {0, 0, 1, 4}, "SCALAR");
    const std::vector<glm::vec3> p = positions_at(load(folder, gltf), 1);
    expect_near(p[0], {4, 1, 0});
    expect_near(p[6], {0, 1, 0});
}

}  // namespace
}  // namespace peelray::testing
