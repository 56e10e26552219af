// Writing a sample to its final place in its list, counted from the build's first sample.
#include "ldc_projected.glsl"

void placeSample(uint at, uint id, uint voxel, bool last) {
    const uint cell = node_cells[voxel >> 6u].x;
    const CubeGrid grid = bodies[node_cells[voxel >> 6u].y].grid;
    const uvec3 position = uvec3(cell & 1023u, cell >> 10u & 1023u, cell >> 20u) * 4u + ldcCell64(voxel & 63u);
    uvec2 data = ldcPackSample(ldcProjected(grid, id), position, id & 3u, params.sampling);
    if (last) data.y |= 1u << 30u;
    samples[params.first_sample + at] = data;
    sample_ids[params.first_sample + at] = id;
}
