// KHR_mesh_quantization: every type of every attribute means what the extension says.

#include <algorithm>
#include <cmath>

#include "loaders/animated_files.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

struct ComponentType {
    int type;
    size_t bytes;
    double least, largest;
};
constexpr ComponentType byte{5120, 1, -128, 127}, unsigned_byte{5121, 1, 0, 255}, short_{5122, 2, -32768, 32767},
    unsigned_short{5123, 2, 0, 65535};

/// Whole numbers, each element padded to a multiple of four bytes as the format asks for.
size_t add_quantized(json& gltf, const std::vector<double>& values, size_t per_element, const ComponentType& type,
                     bool normalized) {
    std::string bytes;
    for (size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<int32_t>(values[i]);
        bytes.append(reinterpret_cast<const char*>(&value), type.bytes);
        if ((i + 1) % per_element == 0) bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    }
    const size_t count = values.size() / per_element;
    const std::string shape = "VEC" + std::to_string(per_element);
    const size_t accessor = add_accessor(gltf, bytes, type.type, shape.c_str(), count, normalized);
    gltf["bufferViews"].back()["byteStride"] = bytes.size() / count;
    return accessor;
}

json quantized_square() {
    json gltf = square();
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
    return gltf;
}

/// What the extension makes of a whole number.
double meant(double value, const ComponentType& type, bool normalized) {
    return normalized ? std::max(value / type.largest, -1.0) : value;
}

TEST(GltfQuantization, PositionsOfEveryType) {
    const TempFolder folder;
    for (const ComponentType& type : {byte, unsigned_byte, short_, unsigned_short})
        for (const bool normalized : {false, true}) {
            const std::vector<double> values = {type.least, 0, 0, type.largest, 0, 1, type.largest, 100, 0, 0, 77, 3};
            json gltf = quantized_square();
            primitive(gltf)["attributes"]["POSITION"] = add_quantized(gltf, values, 3, type, normalized);
            const Scene scene = load(folder, gltf);
            EXPECT_EQ(all_notes(scene), "");
            const Primitive& p = only_primitive(scene);
            for (size_t i = 0; i < 3; ++i)  // flat normals: the first triangle's corners come first
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(p.positions[i][axis], meant(values[3 * i + size_t(axis)], type, normalized),
                                1e-6 * type.largest)
                        << type.type << normalized;
        }
}

TEST(GltfQuantization, NormalsAndTextureCoordinates) {
    const TempFolder folder;
    for (const ComponentType& type : {byte, short_}) {
        const double one = type.largest;
        json gltf = quantized_square();
        primitive(gltf)["attributes"]["NORMAL"] = add_quantized(
            gltf, {0, 0, one, 0, one, 0, -one, 0, 0, 0, std::round(one * 0.6), std::round(one * 0.8)}, 3, type, true);
        const Primitive p = only_primitive(load(folder, gltf));
        EXPECT_LT(glm::distance(p.normals.at(2), glm::vec3(-1, 0, 0)), 1e-6f);
        EXPECT_LT(glm::distance(p.normals.at(3), glm::vec3(0, 0.6f, 0.8f)), 0.01f);
    }
    for (const ComponentType& type : {byte, unsigned_byte, short_, unsigned_short})
        for (const bool normalized : {false, true}) {
            const std::vector<double> values = {type.least, 1, type.largest, 2, 50, 3, 0, 4};
            json gltf = quantized_square();
            primitive(gltf)["attributes"]["NORMAL"] =
                add_quantized(gltf, {0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}, 3, byte, true);
            primitive(gltf)["attributes"]["TEXCOORD_0"] = add_quantized(gltf, values, 2, type, normalized);
            const Primitive p = only_primitive(load(folder, gltf));
            for (size_t i = 0; i < 4; ++i)
                for (int axis = 0; axis < 2; ++axis)
                    EXPECT_NEAR(p.uvs.at(i)[axis], meant(values[2 * i + size_t(axis)], type, normalized),
                                1e-6 * type.largest)
                        << type.type << normalized;
        }
}

TEST(GltfQuantization, MorphTargets) {
    const TempFolder folder;
    for (const ComponentType& type : {byte, short_})
        for (const bool normalized : {false, true}) {
            const std::vector<double> moves = {0, 0, type.largest, 0, 0, type.least, 5, -5, 0, 0, 0, 0},
                                      turns = {0, 0, 0, type.largest, 0, 0, 0, 0, 0, 0, 0, 0};
            json gltf = quantized_square();
            primitive(gltf)["attributes"]["NORMAL"] =
                add_quantized(gltf, {0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}, 3, byte, true);
            primitive(gltf)["targets"] = {{{"POSITION", add_quantized(gltf, moves, 3, type, normalized)},
                                           {"NORMAL", add_quantized(gltf, turns, 3, type, true)}}};
            const MorphTarget target = only_primitive(load(folder, gltf)).targets.at(0);
            EXPECT_NEAR(target.positions.at(0).z, meant(type.largest, type, normalized), 1e-3);
            EXPECT_NEAR(target.positions.at(1).z, meant(type.least, type, normalized), 1e-3);
            EXPECT_NEAR(target.positions.at(2).y, meant(-5, type, normalized), 1e-6);
            EXPECT_NEAR(target.normals.at(1).x, 1, 1e-6);
        }
}

TEST(GltfQuantization, SkinsUndoTheScaleInTheirMatrices) {
    const TempFolder folder;
    json gltf = lifted();
    const std::vector<glm::vec3> right = positions_at(load(folder, gltf), 0.5);
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
    // Positions in steps of 1/1000 from 0 to 1; the matrices of the joints bring them back to metres.
    primitive(gltf)["attributes"]["POSITION"] =
        add_quantized(gltf, {0, 0, 0, 1000, 0, 0, 1000, 1000, 0, 0, 1000, 0}, 3, unsigned_short, false);
    primitive(gltf)["attributes"]["WEIGHTS_0"] =
        add_quantized(gltf, {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, 4, unsigned_byte, true);
    const float s = 1e-3f;
    gltf["skins"][0]["inverseBindMatrices"] =
        add_accessor(gltf, pack<float>({s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 0, 0,  0, 1,  //
                                        s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 0, -1, 0, 1}),
                     5126, "MAT4", 2);
    const std::vector<glm::vec3> quantized = positions_at(load(folder, gltf), 0.5);
    ASSERT_EQ(quantized.size(), right.size());
    for (size_t i = 0; i < right.size(); ++i) EXPECT_LT(glm::distance(quantized[i], right[i]), 1e-5f);
}

TEST(GltfQuantization, SamplesLookLikeTheirTwins) {
    const std::filesystem::path models = PEELRAY_MODELS;
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "no models at " << models << "; see shared/models/README.md";
    const Scene quantized =
                    load_scene((models / "skinned/AnimatedMorphCube-Quantized/AnimatedMorphCube.gltf").string()),
                plain = load_scene((models / "skinned/AnimatedMorphCube.glb").string());
    EXPECT_EQ(all_notes(quantized), "");
    for (const double time : {0.0, 0.7, 1.5, 3.0}) {
        const Geometry a = flatten(quantized, moment_of(quantized, "all", time)),
                       b = flatten(plain, moment_of(plain, "all", time));
        EXPECT_EQ(a.triangles.size(), b.triangles.size());
        const float size = glm::distance(b.lower, b.upper);
        EXPECT_LT(glm::distance(a.lower, b.lower) + glm::distance(a.upper, b.upper), 1e-3f * size) << time;
    }
    EXPECT_EQ(flatten(load_scene((models / "gltf/triangle_mesh_quantized.gltf").string())).triangles.size(), 1u);
}

}  // namespace
}  // namespace peelray::testing
