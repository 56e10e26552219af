// Skins of glTF files: what bad ones say, and what odd ones mean.
#include "loaders/animated_files.h"
#include "motion/animation.h"

namespace peelray::testing {
namespace {

TEST(GltfSkin, FollowsItsJoints) {
    const TempFolder folder;
    const Scene scene = load(folder, lifted());
    EXPECT_TRUE(scene.notes.empty());
    std::vector<glm::vec3> p = positions_at(scene, 0.5);
    float top = 0;
    for (const glm::vec3& v : p) top = std::max(top, v.y);
    EXPECT_FLOAT_EQ(top, 2);
}

TEST(GltfSkin, Hierarchies) {
    const TempFolder folder;
    json gltf = lifted();
    gltf["nodes"][2]["children"] = {1};
    EXPECT_MENTIONS(error_of(folder, gltf), "nodes[1]: the node is reached twice");
    gltf = lifted();
    gltf["nodes"][2]["children"] = {2};
    EXPECT_MENTIONS(error_of(folder, gltf), "reached twice");
    gltf = lifted();
    gltf["scenes"][0]["nodes"] = {0, 1, 2};
    EXPECT_MENTIONS(error_of(folder, gltf), "reached twice");
    gltf = lifted();
    gltf["scenes"][0]["nodes"] = {0};
    EXPECT_MENTIONS(error_of(folder, gltf), "skins[0]: joint 0 is not part of the scene");
    // A joint twice in one skin is odd, but says what it means.
    gltf = lifted();
    gltf["skins"][0]["joints"] = {2, 2};
    EXPECT_NO_THROW(positions_at(load(folder, gltf), 0.5));
}

TEST(GltfSkin, JointsOutOfRange) {
    const TempFolder folder;
    json gltf = lifted();
    gltf["skins"][0]["joints"] = {1, 9};
    EXPECT_MENTIONS(error_of(folder, gltf), "skins[0].joints: 9 is out of range, the file has 3 nodes");
    gltf["skins"][0]["joints"] = {1, -1};
    EXPECT_MENTIONS(error_of(folder, gltf), "skins[0].joints");
    gltf = lifted();
    gltf["nodes"][0]["skin"] = 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "nodes[0].skin: 1 is out of range, the file has 1 skin");
    gltf = lifted();
    auto& attributes = primitive(gltf)["attributes"];
    attributes["JOINTS_0"] =
        add_accessor(gltf, pack<uint16_t>({0, 0, 0, 0, 0, 0, 0, 0, 700, 0, 0, 0, 1, 0, 0, 0}), 5123, "VEC4", 4);
    EXPECT_MENTIONS(error_of(folder, gltf), "follows joint 700, the skin has 2");
    // With a weight of 0 the number means nothing.
    attributes["JOINTS_0"] =
        add_accessor(gltf, pack<uint16_t>({0, 700, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5123, "VEC4", 4);
    EXPECT_NO_THROW(positions_at(load(folder, gltf), 0.5));
}

TEST(GltfSkin, WithoutJoints) {
    const TempFolder folder;
    json gltf = skinned();
    gltf["skins"][0]["joints"] = json::array();
    EXPECT_MENTIONS(error_of(folder, gltf), "follows joint 0, the skin has 0");
    gltf["skins"][0].erase("joints");
    EXPECT_MENTIONS(error_of(folder, gltf), "skins[0]: \"joints\" is missing");
}

TEST(GltfSkin, MeshWithoutSkinAndSkinWithoutMesh) {
    const TempFolder folder;
    json gltf = lifted();
    gltf["nodes"][0].erase("skin");
    gltf["nodes"][0]["translation"] = {5, 0, 0};
    const Scene unskinned = load(folder, gltf);
    expect_near(positions_at(unskinned, 0.5)[0], {5, 0, 0});  // follows its node
    EXPECT_EQ(positions_at(unskinned, 0.5), positions_at(unskinned, 0));
    gltf = lifted();
    gltf["nodes"][0]["translation"] = {5, 0, 0};
    primitive(gltf)["attributes"].erase("JOINTS_0");
    primitive(gltf)["attributes"].erase("WEIGHTS_0");
    expect_near(positions_at(load(folder, gltf), 0.5)[0], {5, 0, 0});
    gltf = lifted();
    gltf["nodes"][1]["skin"] = 0;  // a node without a mesh
    EXPECT_NO_THROW(positions_at(load(folder, gltf), 0.5));
}

TEST(GltfSkin, SetsWithoutTheirOtherHalf) {
    const TempFolder folder;
    for (const char* missing : {"JOINTS_0", "WEIGHTS_0"}) {
        json gltf = lifted();
        primitive(gltf)["attributes"].erase(missing);
        const Scene scene = load(folder, gltf);
        EXPECT_TRUE(has_note(scene, "lack their other half"));
        EXPECT_EQ(positions_at(scene, 0.5), positions_at(scene, 0)) << "not skinned";
    }
    json gltf = lifted();
    auto& attributes = primitive(gltf)["attributes"];
    attributes["JOINTS_1"] = attributes["JOINTS_0"];
    attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
    attributes.erase("JOINTS_0");
    attributes.erase("WEIGHTS_0");
    EXPECT_TRUE(has_note(load(folder, gltf), "lack their other half"));
    // Two whole sets are read; a third one is beyond eight weights.
    gltf = lifted();
    auto& both = primitive(gltf)["attributes"];
    both["JOINTS_1"] = both["JOINTS_0"];
    both["WEIGHTS_1"] = both["WEIGHTS_0"];
    const Scene two = load(folder, gltf);
    EXPECT_FALSE(has_note(two, "lack their other half"));
    EXPECT_TRUE(has_note(two, "4 vertices whose joint weights do not sum to one rescaled"));
    EXPECT_EQ(positions_at(two, 0.5), positions_at(load(folder, lifted()), 0.5));
    both["JOINTS_2"] = both["JOINTS_0"];
    both["WEIGHTS_2"] = both["WEIGHTS_0"];
    EXPECT_TRUE(has_note(load(folder, gltf), "beyond eight a vertex"));
}

TEST(GltfSkin, JointsOfTheWrongKind) {
    const TempFolder folder;
    const auto with = [&](const char* name, size_t count, const std::string& bytes, int type, const char* shape,
                          bool normalized = false) {
        json gltf = lifted();
        primitive(gltf)["attributes"][name] = add_accessor(gltf, bytes, type, shape, count, normalized);
        return error_of(folder, gltf);
    };
    const std::string zeros(64, '\0');
    EXPECT_MENTIONS(with("JOINTS_0", 4, zeros, 5126, "VEC4"), "JOINTS_0 must be unsigned integers");
    EXPECT_MENTIONS(with("JOINTS_0", 4, zeros, 5120, "VEC4"), "JOINTS_0 must be unsigned integers");
    EXPECT_MENTIONS(with("JOINTS_0", 4, zeros, 5121, "VEC4", true), "JOINTS_0 must be unsigned integers");
    EXPECT_MENTIONS(with("JOINTS_0", 4, zeros, 5121, "VEC3"), "JOINTS_0 needs 4 components");
    EXPECT_MENTIONS(with("JOINTS_0", 3, zeros, 5121, "VEC4"), "JOINTS_0 has 3 elements, POSITION has 4");
    EXPECT_MENTIONS(with("WEIGHTS_0", 4, zeros, 5126, "SCALAR"), "WEIGHTS_0 needs 4 components");
    EXPECT_MENTIONS(with("WEIGHTS_0", 2, zeros, 5126, "VEC4"), "WEIGHTS_0 has 2 elements, POSITION has 4");
}

/// The skinned square with other weights for its first vertex, (0, 0, 0), of the lower and the upper joint.
json weighted(float lower, float upper) {
    json gltf = lifted();
    auto& attributes = primitive(gltf)["attributes"];
    attributes["JOINTS_0"] =
        add_accessor(gltf, pack<uint8_t>({0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        add_accessor(gltf, pack<float>({lower, upper, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC4", 4);
    return gltf;
}

TEST(GltfSkin, OddWeights) {
    const TempFolder folder;
    // At the end of the animation the upper joint has risen by 2.
    const auto height = [&](float lower, float upper, const char* note) {
        const Scene scene = load(folder, weighted(lower, upper));
        EXPECT_TRUE(*note ? has_note(scene, note) : scene.notes.empty()) << lower << " " << upper;
        return positions_at(scene, 1)[0].y;
    };
    EXPECT_FLOAT_EQ(height(0.25f, 0.75f, ""), 1.5f);
    EXPECT_FLOAT_EQ(height(0.5f, 1.5f, "1 vertex whose joint weights do not sum to one rescaled"), 1.5f);
    EXPECT_FLOAT_EQ(height(1e-30f, 3e-30f, "1 vertex whose joint weights do not sum to one rescaled"), 1.5f);
    EXPECT_FLOAT_EQ(height(1e38f, 3e38f, "1 vertex whose joint weights do not sum to one rescaled"), 1.5f);
    EXPECT_FLOAT_EQ(height(-1, 1, "1 joint weight that is negative or not finite counts as 0"), 2);
    EXPECT_FLOAT_EQ(height(NAN, 1, "1 joint weight that is negative or not finite counts as 0"), 2);
    EXPECT_FLOAT_EQ(height(INFINITY, 1, "1 joint weight that is negative or not finite counts as 0"), 2);
    EXPECT_FLOAT_EQ(height(0, 0, "1 vertex that no joint holds follows its node"), 0);
    EXPECT_FLOAT_EQ(height(NAN, -2, "1 vertex that no joint holds follows its node"), 0);
    json gltf = weighted(0, 0);
    gltf["nodes"][0]["translation"] = {0, 7, 0};
    EXPECT_FLOAT_EQ(positions_at(load(folder, gltf), 1)[0].y, 7);
}

TEST(GltfSkin, QuantizedWeights) {
    const TempFolder folder;
    json gltf = weighted(1, 0);
    primitive(gltf)["attributes"]["WEIGHTS_0"] = add_accessor(
        gltf, pack<uint8_t>({64, 191, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}), 5121, "VEC4", 4, true);
    Scene scene = load(folder, gltf);
    EXPECT_NEAR(positions_at(scene, 1)[0].y, 2 * 191 / 255.0, 1e-5);
    EXPECT_TRUE(scene.notes.empty());
    primitive(gltf)["attributes"]["WEIGHTS_0"] =
        add_accessor(gltf, pack<uint16_t>({16384, 49151, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}), 5123,
                     "VEC4", 4, true);
    EXPECT_NEAR(positions_at(load(folder, gltf), 1)[0].y, 2 * 49151 / 65535.0, 1e-5);
}

TEST(GltfSkin, InverseBindMatrices) {
    const TempFolder folder;
    const auto with = [&](const std::vector<float>& numbers, const char* shape, size_t count) {
        json gltf = lifted();
        gltf["skins"][0]["inverseBindMatrices"] = add_accessor(gltf, pack(numbers), 5126, shape, count);
        return gltf;
    };
    std::vector<float> numbers(32, 0.f);
    EXPECT_MENTIONS(error_of(folder, with(numbers, "MAT4", 1)), "needs a 4x4 matrix for each of 2 joints");
    EXPECT_MENTIONS(error_of(folder, with(numbers, "MAT3", 2)), "needs a 4x4 matrix for each of 2 joints");
    json bytes = lifted();
    bytes["skins"][0]["inverseBindMatrices"] = add_accessor(bytes, std::string(32, '\1'), 5121, "MAT4", 2);
    EXPECT_MENTIONS(error_of(folder, bytes), "inverseBindMatrices must be floats");
    numbers[20] = NAN;
    EXPECT_MENTIONS(error_of(folder, with(numbers, "MAT4", 2)), "the inverse bind matrix 1 is not finite");
    // All zero has no inverse: everything lies in one point, and that is no error.
    Scene flat = load(folder, with(std::vector<float>(32, 0.f), "MAT4", 2));
    expect_defined(flat);
    EXPECT_EQ(flatten(flat, moment_of(flat, "0", 0.5)).zero_area, 2u);
    // Without any the joints' own places are those of the mesh.
    json none = lifted();
    none["skins"][0].erase("inverseBindMatrices");
    EXPECT_NO_THROW(positions_at(load(folder, none), 0.5));
}

}  // namespace
}  // namespace peelray::testing
