// KHR_draco_mesh_compression: what was compressed comes back, and nothing else does.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "loaders/compressed_files.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// A triangle by where its corners are, in steps that are coarser than the quantisation; beginning with the least.
using Placed = std::array<std::array<int, 3>, 3>;
std::multiset<Placed> placed_triangles(const Primitive& p) {
    std::multiset<Placed> out;
    for (const glm::uvec3& t : p.triangles) {
        Placed corners;
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                corners[k][axis] = static_cast<int>(std::lround(p.positions[t[k]][axis] * 1000));
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        out.insert(corners);
    }
    return out;
}

void expect_same_surface(const Primitive& a, const Primitive& b) {
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    EXPECT_EQ(placed_triangles(a), placed_triangles(b));
}

TEST(GltfDraco, SequentialDataIsTheMeshItself) {
    const TempFolder folder;
    const DracoWriter writer = grid_writer(Grid(9), 0);
    const Scene plain = load(folder, writer.plain()),
                scene = load(folder, writer.file(writer.stream(DracoMethod::sequential)));
    const Primitive &a = only_primitive(scene), &b = only_primitive(plain);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(all_notes(scene), "");
}

TEST(GltfDraco, EdgebreakerKeepsTheSurfaceInAnotherOrder) {
    const TempFolder folder;
    const Grid grid(20);
    const DracoWriter writer = grid_writer(grid, 16);
    const Scene plain = load(folder, writer.plain());
    for (const DracoMethod method : {DracoMethod::edgebreaker, DracoMethod::valence}) {
        const Scene scene = load(folder, writer.file(writer.stream(method)));
        const Primitive& p = only_primitive(scene);
        EXPECT_NE(p.triangles, only_primitive(plain).triangles);
        ASSERT_EQ(p.uvs.size(), p.positions.size());
        float worst = 0;
        for (size_t i = 0; i < p.positions.size(); ++i)
            worst = std::max(worst, glm::distance(glm::vec2(p.positions[i]), p.uvs[i]));
        EXPECT_LT(worst, 1e-4f);  // the attributes went with their vertices
        const Geometry a = flatten(scene), b = flatten(plain);
        EXPECT_LT(glm::distance(a.lower, b.lower) + glm::distance(a.upper, b.upper), 1e-4f);
        EXPECT_EQ(all_notes(scene), "");
    }
    const DracoWriter fine = grid_writer(Grid(9), 20);
    expect_same_surface(only_primitive(load(folder, fine.file(fine.stream(DracoMethod::edgebreaker)))),
                        only_primitive(load(folder, fine.plain())));
}

TEST(GltfDraco, DegenerateTrianglesAreLeftOutWithANote) {
    const TempFolder folder;
    Grid grid(5);
    grid.corners.insert(grid.corners.begin() + 3, {7, 7, 8});
    const DracoWriter writer = grid_writer(grid, 14);
    EXPECT_EQ(only_primitive(load(folder, writer.file(writer.stream(DracoMethod::sequential)))).triangles.size(), 33u);
    const Scene scene = load(folder, writer.file(writer.stream(DracoMethod::edgebreaker)));
    EXPECT_EQ(only_primitive(scene).triangles.size(), 32u);
    EXPECT_MENTIONS(all_notes(scene), "other numbers of vertices or triangles");
}

/// Joints, weights and colours in several types; the values follow from the vertex's number.
DracoWriter rigged(const Grid& grid) {
    DracoWriter writer(grid.corners);
    writer.add("POSITION", 5126, "VEC3", grid.positions);
    std::vector<uint16_t> joints;
    std::vector<float> weights;
    std::vector<uint8_t> colors;
    std::vector<uint16_t> uvs;
    std::vector<int8_t> normals;
    for (size_t i = 0; i < grid.vertices(); ++i) {
        const auto k = static_cast<uint16_t>(i);
        joints.insert(joints.end(), {k, uint16_t(k + 300), 0, 0});
        const float w = float(i % 7) / 8.f;
        weights.insert(weights.end(), {1 - w, w, 0, 0});
        colors.insert(colors.end(), {uint8_t(i), uint8_t(255 - i), 51, 204});
        uvs.insert(uvs.end(), {uint16_t(65535 * (i % 3) / 2), 13107});
        normals.insert(normals.end(), {0, 0, 127});
    }
    writer.add("JOINTS_0", 5123, "VEC4", joints);
    writer.add("WEIGHTS_0", 5126, "VEC4", weights, false, 12);
    writer.add("COLOR_0", 5121, "VEC4", colors, true);
    writer.add("TEXCOORD_0", 5123, "VEC2", uvs, true);
    writer.add("NORMAL", 5120, "VEC3", normals, true);
    return writer;
}

TEST(GltfDraco, IntegersAndGenericAttributes) {
    const TempFolder folder;
    const Grid grid(6);
    const DracoWriter writer = rigged(grid);
    const Scene scene = load(folder, writer.file(writer.stream(DracoMethod::sequential)));
    const Primitive& p = only_primitive(scene);
    ASSERT_EQ(p.joints.size(), grid.vertices());
    for (size_t i = 0; i < grid.vertices(); ++i) {
        EXPECT_EQ(p.joints[i].joints[0], i);
        EXPECT_EQ(p.joints[i].joints[1], i + 300);
        EXPECT_NEAR(p.joints[i].weights[1], float(i % 7) / 8.f, 1e-3f);
        EXPECT_NEAR(p.joints[i].weights[0] + p.joints[i].weights[1], 1, 1e-6f);
        EXPECT_NEAR(p.colors[i].y, float(255 - i) / 255.f, 1e-6f);
        EXPECT_NEAR(p.colors[i].w, 0.8f, 1e-6f);
        EXPECT_NEAR(p.uvs[i].x, float(i % 3) / 2, 1e-4f);
        EXPECT_NEAR(p.uvs[i].y, 0.2f, 1e-6f);
        EXPECT_EQ(p.normals[i], glm::vec3(0, 0, 1));
    }
    const Scene edgebreaker = load(folder, writer.file(writer.stream(DracoMethod::edgebreaker)));
    ASSERT_EQ(only_primitive(edgebreaker).joints.size(), grid.vertices());
    for (const JointWeights& vertex : only_primitive(edgebreaker).joints)
        EXPECT_EQ(vertex.joints[1], vertex.joints[0] + 300);
}

TEST(GltfDraco, AlphaStaysWithinOne) {
    const TempFolder folder;
    const Grid grid(6);
    DracoWriter writer(grid.corners);
    writer.add("POSITION", 5126, "VEC3", grid.positions);
    std::vector<float> colors;
    for (size_t i = 0; i < grid.vertices(); ++i)
        colors.insert(colors.end(), {0.1f, float(i) / 40, 0.7f, i % 2 ? 1.03f : 1.f});
    writer.add("COLOR_0", 5126, "VEC4", colors, false, 8);
    const Scene scene = load(folder, writer.file(writer.stream(DracoMethod::edgebreaker)));
    for (const glm::vec4& color : only_primitive(scene).colors) {
        EXPECT_GT(color.w, 0.98f);
        EXPECT_LE(color.w, 1.f);
    }
}

TEST(GltfDraco, AttributesOutsideOfTheData) {
    const TempFolder folder;
    const Grid grid(4);
    const DracoWriter writer = grid_writer(grid, 0);
    json gltf = writer.file(writer.stream(DracoMethod::sequential));
    const std::vector<float> red(grid.vertices() * 3, 0.5f);
    primitive(gltf)["attributes"]["COLOR_0"] = add_accessor(gltf, pack(red), 5126, "VEC3", grid.vertices());
    EXPECT_EQ(only_primitive(load(folder, gltf)).colors.at(15), glm::vec4(0.5f, 0.5f, 0.5f, 1));
    gltf["accessors"].back()["count"] = 15;
    EXPECT_MENTIONS(error_of(folder, gltf), "COLOR_0 has 15 elements, POSITION has 16");
    gltf["accessors"].back()["count"] = 16;
    // What the stream does not say is told as of the accessor.
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("NORMAL");
    EXPECT_FALSE(load(folder, gltf).meshes[0].primitives[0].normals.empty());
}

TEST(GltfDraco, MorphTargetsOfTheSameOrder) {
    const TempFolder folder;
    const Grid grid(4);
    const DracoWriter writer = grid_writer(grid, 0);
    json gltf = writer.file(writer.stream(DracoMethod::sequential));
    const size_t target = add_accessor(gltf, pack(grid.normals), 5126, "VEC3", grid.vertices());
    primitive(gltf)["targets"] = {{{"POSITION", target}}};
    EXPECT_EQ(only_primitive(load(folder, gltf)).targets.at(0).positions.size(), grid.vertices());
}

/// The stream's bytes exchanged in a file whose accessors hold an uncompressed copy.
json with_fallback(const DracoWriter& writer, const std::string& stream) {
    json gltf = writer.plain(), compressed = writer.file(stream);
    gltf["buffers"].push_back({{"byteLength", stream.size()}, {"uri", data_uri(stream)}});
    gltf["bufferViews"].push_back({{"buffer", gltf["buffers"].size() - 1}, {"byteLength", stream.size()}});
    primitive(gltf)["extensions"] = primitive(compressed)["extensions"];
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = gltf["bufferViews"].size() - 1;
    gltf["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    return gltf;
}

TEST(GltfDraco, TheDataCountsBeforeTheFallback) {
    const TempFolder folder;
    const DracoWriter small = grid_writer(Grid(4), 12), large = grid_writer(Grid(5), 12);
    const std::string stream = small.stream(DracoMethod::edgebreaker);
    EXPECT_EQ(only_primitive(load(folder, with_fallback(large, stream))).triangles.size(), 18u);
    const Scene damaged = load(folder, with_fallback(large, stream.substr(0, stream.size() / 2)));
    EXPECT_EQ(only_primitive(damaged).triangles.size(), 32u);
    EXPECT_MENTIONS(all_notes(damaged), "1 primitive whose Draco data cannot be decoded");
}

TEST(GltfDraco, DamagedDataGivesOneLine) {
    const TempFolder folder;
    const DracoWriter writer = grid_writer(Grid(6), 11);
    for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker, DracoMethod::valence}) {
        const std::string good = writer.stream(method);
        for (size_t length = 1; length + 1 < good.size(); length += 1 + good.size() / 40) {
            const std::string line = error_of(folder, writer.file(good.substr(0, length)));
            EXPECT_MENTIONS(line, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression");
        }
    }
    EXPECT_MENTIONS(error_of(folder, writer.file("what is this, then?")), "no stream of Draco's");
    std::string old = writer.stream(DracoMethod::edgebreaker);
    old[6] = 1;
    EXPECT_MENTIONS(error_of(folder, writer.file(old)), "version is 2.1");
    std::string cloud = writer.stream(DracoMethod::edgebreaker);
    cloud[7] = 0;
    EXPECT_MENTIONS(error_of(folder, writer.file(cloud)), "no mesh of triangles");
}

TEST(GltfDraco, ClaimsAreCheckedBeforeAnythingIsAllocated) {
    const TempFolder folder;
    const DracoWriter writer = grid_writer(Grid(6), 11);
    // Of the edgebreaker's stream: the header's 11 bytes, the kind of traversal, 36 vertices, 50 triangles.
    std::string stream = writer.stream(DracoMethod::edgebreaker);
    ASSERT_EQ(stream[12], 36);
    ASSERT_EQ(stream[13], 50);
    stream.replace(12, 2, "\xFF\xFF\xFF\xFF\x04\xD5\xAA\xD5\xAA\x05");  // 2^32 / 3 triangles
    EXPECT_MENTIONS(error_of(folder, writer.file(stream)), "they claim 1431655765 triangles");
    json gltf = writer.file(stream);
    for (json& accessor : gltf["accessors"]) accessor["count"] = 4294967295u;
    EXPECT_MENTIONS(error_of(folder, gltf), "they claim 1431655765 triangles");
}

TEST(GltfDraco, WrongDescriptionsOfTheData) {
    const TempFolder folder;
    const DracoWriter writer = grid_writer(Grid(6), 11);
    const json good = writer.file(writer.stream(DracoMethod::edgebreaker));
    const auto attributes = [](json& gltf) -> json& {
        return primitive(gltf)["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    };
    json gltf = good;
    attributes(gltf)["NORMAL"] = 99;
    EXPECT_MENTIONS(error_of(folder, gltf), "NORMAL is attribute 99");
    gltf = good;
    attributes(gltf)["NORMAL"] = attributes(gltf)["TEXCOORD_0"];
    EXPECT_MENTIONS(error_of(folder, gltf), "NORMAL needs 3 components");
    gltf = good;
    attributes(gltf).erase("POSITION");
    EXPECT_MENTIONS(error_of(folder, gltf), "no POSITION");
    gltf = good;
    attributes(gltf)["NORMAL"] = "1";
    EXPECT_MENTIONS(error_of(folder, gltf), "attributes.NORMAL");
    gltf = good;
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 1;
    EXPECT_MENTIONS(error_of(folder, gltf), "out of range");
    gltf = good;
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"].erase("attributes");
    EXPECT_MENTIONS(error_of(folder, gltf), "\"attributes\" is missing");
}

TEST(GltfDraco, SampleLooksLikeItsTwin) {
    expect_like_box("Box-Draco/Box.gltf", PEELRAY_MODELS "/gltf");
}

}  // namespace
}  // namespace peelray::testing
