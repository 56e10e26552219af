// A scene on the device in some moment, looked at vertex by vertex.
#pragma once

#include <pictures.h>

#include "motion/animation.h"
#include "motion/simulation.h"
#include "render/gpu_scene.h"
#include "render/scene_cubes.h"

namespace peelray {

/// What the GPU made of a moment, as a file would have it.
struct MovedScene {
    const Scene& scene;
    std::string which;
    Moment moment;
    Simulation simulation;
    Assembly assembly;
    GpuScene gpu;
    SceneCubes cubes;
    Commands commands;

    MovedScene(Device& device, const Scene& source, const std::string& animation, const CubeChoice& choice = {})
        : scene(source),
          which(animation),
          moment(moment_of(source, animation, 0)),
          assembly(assemble(source, moment, motion_of(source, animation))),
          gpu(device, source, moment, assembly, color_environment(glm::vec3(1))),
          cubes(device, assembly, choice, assembly.fixed, std::vector<float>(assembly.bodies.size(), 1.0f)),
          commands(device) {}

    /// Vertices, bounds and instances of the moment.
    void pose(double time) {
        moment = moment_of(scene, which, time);
        gpu.pose(commands, scene, moment);
        gpu.record_animation(commands, cubes.cubes().table);
        gpu.instances.record(commands, cubes.cubes().table);
        commands.submit();
    }

    /// All triangles as they stand in the world, compared with flatten() after Simulation::place(): corners by at most
    /// `tolerance`, normals by their angle. Returns the largest distances.
    struct Difference {
        double position = 0, normal = 0;
    };
    Difference compare() {
        simulation.place(scene, moment);
        const Geometry geometry = flatten(scene, moment);
        const auto positions = commands.download<glm::vec3>(gpu.triangles.positions, assembly.positions.size()),
                   normals = commands.download<glm::vec3>(gpu.normals, assembly.positions.size());
        const auto triangles = commands.download<glm::uvec3>(gpu.triangles.triangles, assembly.triangles.size());
        const auto instances = commands.download<GpuInstance>(gpu.instances.table(), assembly.instances.size());
        Difference worst;
        std::vector<int> seen(geometry.triangles.size());
        for (const GpuInstance& instance : instances) {
            const Assembly::Body& body = assembly.bodies[instance.info.body];
            const glm::dmat3 m(instance.to_world.linear);
            const double sign = glm::determinant(m) < 0 ? -1 : 1;
            EXPECT_EQ(instance.mirrored, sign < 0 ? 1u : 0u);
            const glm::dmat3 cofactors =
                sign * glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
            for (uint32_t t = body.first_triangle; t < body.first_triangle + body.triangles; t++) {
                const uint32_t id = instance.info.first_id + assembly.ids[t];
                seen[id]++;
                glm::uvec3 corners = triangles[t];
                if (sign < 0) std::swap(corners.y, corners.z);
                for (int k = 0; k < 3; k++) {
                    const uint32_t other = geometry.triangles[id][k];
                    const glm::dvec3 p = m * glm::dvec3(positions[corners[k]]) + glm::dvec3(instance.to_world.position);
                    worst.position = std::max(worst.position, glm::length(p - glm::dvec3(geometry.positions[other])));
                    const glm::dvec3 n = cofactors * glm::dvec3(normals[corners[k]]);
                    if (glm::length(n) > 1e-12)
                        worst.normal = std::max(worst.normal,
                                                glm::length(glm::normalize(n) - glm::dvec3(geometry.normals[other])));
                }
            }
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), ptrdiff_t(seen.size()));
        return worst;
    }
};

}  // namespace peelray
