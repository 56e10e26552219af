// Small glTF files with a skin and animations, for the tests.
#pragma once

#include <cmath>

#include "loaders/scene_files.h"
#include "motion/animation.h"

namespace peelray::testing {

/// A unit square that a skin of two joints holds: its lower edge the first, its upper edge the second, a child of the
/// first at (0, 1, 0). Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 inverse bind matrices.
inline json skinned() {
    json gltf = square();
    gltf["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"name", "shown"}},
                     {{"children", {2}}, {"name", "lower"}},
                     {{"translation", {0, 1, 0}}, {"name", "upper"}}};
    gltf["scenes"][0]["nodes"] = {0, 1};
    auto& attributes = primitive(gltf)["attributes"];
    attributes["JOINTS_0"] =
        add_accessor(gltf, pack<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        add_accessor(gltf, pack<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC4", 4);
    const size_t matrices = add_accessor(gltf, pack<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}),
                                         5126, "MAT4", 2);
    gltf["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
    return gltf;
}

/// Adds an animation of one channel.
inline json& animate_node(json& gltf, int node, const char* path, const std::vector<float>& times,
                          const std::vector<float>& values, const char* type, const char* interpolation = "LINEAR") {
    const size_t per_element = type == std::string("SCALAR") ? 1 : type == std::string("VEC3") ? 3 : 4;
    const size_t input = add_accessor(gltf, pack(times), 5126, "SCALAR", times.size()),
                 output = add_accessor(gltf, pack(values), 5126, type, values.size() / per_element);
    gltf["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    return gltf["animations"].back();
}

inline json lifted() {
    json gltf = skinned();
    animate_node(gltf, 2, "translation", {0, 1}, {0, 1, 0, 0, 3, 0}, "VEC3");
    return gltf;
}

inline std::vector<glm::vec3> positions_at(const Scene& scene, double time) {
    return flatten(scene, moment_of(scene, "all", time)).positions;
}

/// At some moments: every vertex and normal is a number, or one line says what is wrong.
inline void expect_defined(const Scene& scene) {
    for (size_t i = 0; i < scene.animations.size(); ++i)
        for (const double time : {0.0, 0.25, 0.5, 1.0, 7.3}) try {
                const Geometry g = flatten(scene, moment_of(scene, std::to_string(i), time));
                for (const glm::vec3& p : g.positions)
                    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
                for (const glm::vec3& n : g.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3);
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            }
}

}  // namespace peelray::testing
