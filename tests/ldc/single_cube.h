// Bodies with their cubes and an instance of each where it is: what most tests of cubes need.
#pragma once

#include "ldc/cube_builder.h"
#include "ldc/tracer.h"

namespace peelray::test {

/// One body, built once.
struct SingleCube {
    TriangleBuffers triangles;
    Cubes cubes;
    CubeBuilder builder;
    Instances instances;
    CubeGrid grid{};

    SingleCube(Device& device, Commands& commands, std::span<const glm::vec3> positions,
               std::span<const glm::uvec3> indices, const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution,
               Sampling sampling, const CubeLayout& layout = {}, float tolerance = 0,
               const BaseColorBuffers* masks = nullptr, const Refinement& refinement = {})
        : triangles(device, positions, indices),
          cubes(device, {{0, uint32_t(indices.size()), resolution, lower, upper, tolerance}}, sampling, layout),
          builder(device, commands, cubes, 0, 1, {}, refinement),
          instances(device, {{0, 0, 0}}) {
        triangles.masks = masks;
        const GpuTransform here{glm::mat3(1), glm::vec3(0)};
        instances.place(commands, std::span<const GpuTransform>(&here, 1));
        build(commands);
    }

    void build(Commands& commands) {
        builder.build(commands, triangles);
        instances.record(commands, cubes.table);
        commands.submit();
        grid = cubes.table.download(commands)[0].grid;
    }
    const BuildCounts& counts() const { return builder.counts(); }
    TracedScene traced() const { return {cubes, instances, triangles}; }
};

}  // namespace peelray::test
