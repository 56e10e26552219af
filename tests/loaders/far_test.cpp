// Scenes that stand far from the world's origin: what they show is as exact as at the origin.
#include <fmt/format.h>
#include <cmath>

#include "loaders/animated_files.h"
#include "scene/picture.h"

namespace peelray::testing {
namespace {

constexpr glm::dvec3 away(431234.25, 71.5, -5412345.75);  // as map coordinates in metres are

json translation(const glm::dvec3& by) {
    return {by.x, by.y, by.z};
}

/// Hangs all roots of the default scene under one node; returns its index.
size_t hang_under(json& gltf, const json& node) {
    json parent = node;
    parent["children"] = gltf["scenes"][0]["nodes"];
    gltf["nodes"].push_back(parent);
    const size_t index = gltf["nodes"].size() - 1;
    gltf["scenes"][0]["nodes"] = {index};
    return index;
}

json moved(json gltf, const glm::dvec3& by) {
    hang_under(gltf, {{"translation", translation(by)}});
    return gltf;
}

/// Vertices of both scenes are at the same places of the world, but for `by`.
void expect_same(const Geometry& near_by, const Scene& far_off, const Geometry& there, const glm::dvec3& by,
                 double tolerance = 2e-6) {
    ASSERT_EQ(near_by.positions.size(), there.positions.size());
    EXPECT_EQ(near_by.triangles, there.triangles);
    EXPECT_EQ(near_by.zero_area, there.zero_area);
    for (size_t i = 0; i < near_by.positions.size(); ++i) {
        const glm::dvec3 at = glm::dvec3(there.positions[i]) + far_off.origin;
        EXPECT_LT(glm::length(at - by - glm::dvec3(near_by.positions[i])), tolerance) << i;
        EXPECT_LT(glm::length(near_by.normals[i] - there.normals[i]), 1e-5f) << i;
    }
}

/// A strip of small steps, of which floats near `away` leave nothing.
std::vector<float> steps() {
    std::vector<float> corners;
    for (int i = 0; i < 4; ++i) {
        const float x = 0.01f * float(i);
        corners.insert(corners.end(), {x, 0, 0.005f * float(i % 2), x, 0.02f, 0.005f * float(i % 2)});
    }
    return corners;
}

json stairs() {
    json gltf = square();
    primitive(gltf)["attributes"]["POSITION"] = add_accessor(gltf, pack(steps()), 5126, "VEC3", 8);
    primitive(gltf)["indices"] =
        add_accessor(gltf, pack<uint16_t>({0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5, 4, 6, 5, 5, 6, 7}), 5123, "SCALAR", 18);
    return gltf;
}

TEST(Far, ScenesNearTheOriginAreLeftAlone) {
    const TempFolder folder;
    for (const glm::dvec3 by : {glm::dvec3(0), glm::dvec3(0, 0, 15), glm::dvec3(-3, 8, 2)}) {
        const Scene scene = load(folder, moved(square(), by));
        EXPECT_EQ(scene.origin, glm::dvec3(0));
        EXPECT_FALSE(scene.precise);
    }
    EXPECT_NE(load(folder, moved(square(), {0, 0, 17})).origin, glm::dvec3(0)) << "sixteen times its longest side";
}

TEST(Far, NodesOfGltfFiles) {
    const TempFolder folder;
    const Geometry here = flatten(load(folder, stairs()));
    EXPECT_EQ(here.zero_area, 0u);
    const Scene scene = load(folder, moved(stairs(), away));
    EXPECT_TRUE(scene.precise);
    EXPECT_LT(glm::length(scene.origin - away), 0.1);
    expect_same(here, scene, flatten(scene), away, 1e-8);
    // A matrix instead of parts.
    json gltf = stairs();
    hang_under(gltf, {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, away.x, away.y, away.z, 1}}});
    const Scene by_matrix = load(folder, gltf);
    expect_same(here, by_matrix, flatten(by_matrix), away, 1e-8);
}

TEST(Far, WaysThatLeadFarAwayAndBack) {
    const TempFolder folder;
    const Geometry here = flatten(load(folder, stairs()));
    // There and back: nothing is far from the origin but a node in between, which turns, too.
    json gltf = moved(moved(stairs(), -away), away + glm::dvec3(0.125, 0, 0));
    const Scene back = load(folder, gltf);
    EXPECT_TRUE(back.precise);
    EXPECT_EQ(back.origin, glm::dvec3(0));
    expect_same(here, back, flatten(back), {0.125, 0, 0}, 1e-8);
    // Two quarter turns about the far origin make a half turn about the near one.
    json turning = stairs();
    hang_under(turning, {{"translation", translation({-1000000, 0, 0})}});
    const double half = std::sqrt(0.5);
    hang_under(turning, {{"rotation", {0, half, 0, half}}});
    hang_under(turning, {{"translation", translation({0, 0, -1000000})}});
    const Scene turned = load(folder, turning);
    const Geometry there = flatten(turned);
    for (size_t i = 0; i < here.positions.size(); ++i) {
        const glm::vec3& p = here.positions[i];
        EXPECT_LT(glm::length(glm::vec3(p.z, p.y, -p.x) - there.positions[i]), 1e-8f) << i;
    }
}

TEST(Far, PositionsThatAreFarInTheirMesh) {
    const TempFolder folder;
    // On a quarter of a metre, which floats hold there.
    const glm::vec3 by(4000000, 250000.25f, -300000.5f);
    std::vector<float> corners;
    for (size_t i = 0; i < unit_square.size(); ++i) corners.push_back(unit_square[i] + by[int(i % 3)]);
    json gltf = square();
    primitive(gltf)["attributes"]["POSITION"] = add_accessor(gltf, pack(corners), 5126, "VEC3", 4);
    gltf["nodes"][0]["rotation"] = {0, 0.6, 0, 0.8};
    gltf["nodes"][0]["children"] = {1};
    gltf["nodes"].push_back({{"name", "child"}, {"mesh", 0}});
    const Scene scene = load(folder, gltf);
    const Geometry there = flatten(scene);
    ASSERT_EQ(there.triangles.size(), 4u);
    EXPECT_EQ(there.zero_area, 0u);
    const auto rotated = [](const glm::dvec3& p) {
        return glm::dvec3(0.28 * p.x + 0.96 * p.z, p.y, -0.96 * p.x + 0.28 * p.z);
    };
    // Without normals each triangle has corners of its own.
    const std::vector<size_t> order = {0, 1, 2, 0, 2, 3};
    ASSERT_EQ(there.positions.size(), 12u);
    for (size_t i = 0; i < 6; ++i) {
        const float* corner = &corners[3 * order[i]];
        const glm::dvec3 right = rotated({corner[0], corner[1], corner[2]});
        EXPECT_LT(glm::length(glm::dvec3(there.positions[i]) + scene.origin - right), 1e-6) << i;
        EXPECT_EQ(there.positions[i], there.positions[6 + i]) << "the child stands where its parent does";
    }
}

TEST(Far, Instances) {
    const TempFolder folder;
    json gltf = square();
    const size_t places = add_accessor(gltf, pack<float>({0, 0, 0, 0.5f, 0.25f, 0.125f}), 5126, "VEC3", 2);
    gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    gltf["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const Geometry here = flatten(load(folder, gltf));
    ASSERT_EQ(here.triangles.size(), 4u);
    const Scene scene = load(folder, moved(gltf, away));
    expect_same(here, scene, flatten(scene), away, 1e-7);
}

TEST(Far, SkinsAndAnimations) {
    const TempFolder folder;
    for (const json& gltf : {lifted(), [] {
                                 json g = square();
                                 animate_node(g, 0, "translation", {0, 1}, {0, 0, 0, 3, 1, 2}, "VEC3");
                                 return g;
                             }()}) {
        const Scene near_by = load(folder, gltf), scene = load(folder, moved(gltf, away));
        EXPECT_TRUE(scene.precise);
        for (const double time : {0.0, 0.37, 1.0})
            expect_same(flatten(near_by, moment_of(near_by, "0", time)), scene,
                        flatten(scene, moment_of(scene, "0", time)), away);
    }
    // Keys that move a node far away: a moment is as exact as the keys.
    json gltf = square();
    const auto x = float(away.x), z = float(away.z);
    animate_node(gltf, 0, "translation", {0, 1}, {x, 0, z, x + 2, 0, z}, "VEC3");
    gltf["nodes"][0]["translation"] = {x, 0, z};
    const Scene scene = load(folder, gltf);
    const Geometry there = flatten(scene, moment_of(scene, "0", 0.5));
    EXPECT_LT(glm::length(glm::dvec3(there.positions[2]) + scene.origin - glm::dvec3(x + 2, 1, z)), 1e-6);
}

TEST(Far, MorphedSkinnedMeshWithFarPositions) {
    const TempFolder folder;
    const glm::vec3 by(2000000, 0, -1000000);
    std::vector<float> corners;
    for (size_t i = 0; i < unit_square.size(); ++i) corners.push_back(unit_square[i] + by[int(i % 3)]);
    json gltf = skinned();
    primitive(gltf)["attributes"]["POSITION"] = add_accessor(gltf, pack(corners), 5126, "VEC3", 4);
    primitive(gltf)["targets"] = {
        {{"POSITION", add_accessor(gltf, pack<float>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1}), 5126, "VEC3", 4)}}};
    animate_node(gltf, 0, "weights", {0, 1}, {0, 1}, "SCALAR");
    const Scene bound = load(folder, gltf);
    const size_t nodes = bound.nodes.size();
    EXPECT_EQ(nodes, 4u) << "a node of its own shows the moved mesh";
    Scene scene = bound;
    complete_targets(scene);
    const Geometry there = flatten(scene, moment_of(scene, "0", 1));
    const std::vector<size_t> order = {0, 1, 2, 0, 2, 3};
    ASSERT_EQ(there.positions.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        const float* corner = &corners[3 * order[i]];
        const glm::dvec3 right(corner[0], corner[1], corner[2] + float(order[i] >= 2));
        EXPECT_LT(glm::length(glm::dvec3(there.positions[i]) + scene.origin - right), 1e-6) << i;
    }
}

TEST(Far, CamerasAndLights) {
    const TempFolder folder;
    json gltf = square();
    gltf["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}])");
    gltf["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})");
    gltf["nodes"].push_back(
        json::parse(R"({"camera": 0, "translation": [0.4, 0.7, 3], "rotation": [0.05, -0.1, 0.02, 0.99353]})"));
    gltf["nodes"].push_back(
        json::parse(R"({"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    gltf["scenes"][0]["nodes"] = {0, 1, 2};
    animate_node(gltf, 1, "translation", {0, 1}, {0.4f, 0.7f, 3, 1.4f, 0.2f, 4}, "VEC3");
    const Scene near_by = load(folder, gltf), scene = load(folder, moved(gltf, away));
    for (const double time : {0.0, 0.6}) {
        const Moment here = moment_of(near_by, "0", time), there = moment_of(scene, "0", time);
        const glm::vec3 box(4);
        const View a = make_view(here.cameras[0], 1.5f, -box, box), b = make_view(there.cameras[0], 1.5f, -box, box);
        EXPECT_LT(glm::length(a.forward - b.forward), 2e-7f);
        EXPECT_LT(glm::length(a.right - b.right), 2e-7f);
        EXPECT_LT(glm::length(there.cameras[0].eye + scene.origin - away - here.cameras[0].eye), 3e-7);
        EXPECT_LT(glm::length(there.cameras[0].look + scene.origin - away - here.cameras[0].look), 3e-6);
        EXPECT_LT(glm::length(glm::dvec3(there.lights[0].position) + scene.origin - away -
                              glm::dvec3(here.lights[0].position)),
                  1e-6);
    }
    // Only the camera is far away: its direction is that of its node.
    gltf["nodes"][1]["translation"] = {20000, 0, -7000};
    gltf.erase("animations");
    const Scene alone = load(folder, gltf);
    const View view = make_view(alone.cameras[0], 1, glm::vec3(0), glm::vec3(1));
    const View right = make_view(near_by.cameras[0], 1, glm::vec3(0), glm::vec3(1));
    EXPECT_LT(glm::length(view.forward - right.forward), 2e-7f);
}

/// The steps as text of four formats, at a place.
struct MeshFiles {
    std::string obj, ply, off, stl;

    explicit MeshFiles(const glm::dvec3& by, const std::string& stray = "") {
        const std::vector<float> corners = steps();
        const std::vector<glm::uvec3> faces = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 6, 5}, {5, 6, 7}};
        const auto at = [&](size_t i) {
            return fmt::format("{:.9f} {:.9f} {:.9f}", by.x + double(corners[3 * i]), by.y + double(corners[3 * i + 1]),
                               by.z + double(corners[3 * i + 2]));
        };
        const size_t count = 8 + (stray.empty() ? 0 : 1);
        ply = fmt::format(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
            "element face 6\nproperty list uchar int vertex_indices\nend_header\n",
            count);
        off = fmt::format("OFF\n{} 6 0\n", count);
        stl = "solid s\n";
        for (size_t i = 0; i < 8; ++i) {
            obj += "v " + at(i) + "\n";
            ply += at(i) + "\n";
            off += at(i) + "\n";
        }
        if (!stray.empty()) {
            obj += "v " + stray + "\n";
            ply += stray + "\n";
            off += stray + "\n";
        }
        for (const glm::uvec3& f : faces) {
            obj += fmt::format("f {} {} {}\n", f.x + 1, f.y + 1, f.z + 1);
            ply += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
            off += fmt::format("3 {} {} {}\n", f.x, f.y, f.z);
            stl += fmt::format("facet normal 0 0 1\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n",
                               at(f.x), at(f.y), at(f.z));
        }
        stl += "endsolid s\n";
    }
};

TEST(Far, MeshFilesAreReadInDoublePrecision) {
    const TempFolder folder;
    const MeshFiles here(glm::dvec3(0)), there(away), with_stray(away, "0 0 0");
    const auto compare = [&](const std::string& end, const std::string& near_by, const std::string& far_off) {
        SCOPED_TRACE(end);
        const Scene scene = load_scene(folder.write("far." + end, far_off));
        EXPECT_TRUE(scene.precise);
        expect_same(flatten(load_scene(folder.write("near." + end, near_by))), scene, flatten(scene), away, 3e-9);
    };
    compare("obj", here.obj, there.obj);
    compare("ply", here.ply, there.ply);
    compare("off", here.off, there.off);
    compare("stl", here.stl, there.stl);
    // A vertex that nothing uses says nothing about where the surface is.
    compare("obj", here.obj, with_stray.obj);
    compare("ply", here.ply, with_stray.ply);
    compare("off", here.off, with_stray.off);
}

TEST(Far, BinaryPlyOfDoubles) {
    const TempFolder folder;
    std::string body;
    for (size_t i = 0; i < 4; ++i)
        body += pack<double>(
            {away.x + 0.001 * double(unit_square[3 * i]), away.y + 0.001 * double(unit_square[3 * i + 1]), away.z});
    body += std::string("\x03", 1) + pack<int32_t>({0, 1, 2}) + std::string("\x03", 1) + pack<int32_t>({0, 2, 3});
    const Scene scene = load_scene(folder.write("far.ply",
                                                "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty "
                                                "double x\nproperty double y\nproperty double z\n"
                                                "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
                                                    body));
    const Geometry g = flatten(scene);
    EXPECT_EQ(g.zero_area, 0u);
    EXPECT_NEAR(g.upper.x - g.lower.x, 0.001, 2e-9);
    EXPECT_NEAR(g.upper.y - g.lower.y, 0.001, 2e-9);
}

}  // namespace
}  // namespace peelray::testing
