// Writes every fragment's sample to its list, in the order in which the atomics happened to run: what a ray hits does not depend on it.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_table)
BUFFER(readonly, 2, LdcFragment, fragments)
BUFFER(readonly, 3, uint, voxel_counts)
BUFFER(readonly, 4, uvec2, node_cells)
BUFFER(readonly, 5, vec3, positions)
BUFFER(readonly, 6, uvec3, triangles)
BUFFER_ALIGNED(writeonly, 7, uvec2, samples)
BUFFER(writeonly, 8, uint, sample_ids)
BUFFER(readonly, 9, LdcBody, bodies)
BUFFER_ALIGNED(writeonly, 10, uvec4, patches)
BUFFER_ALIGNED(readonly, 11, LdcCorners, corners)
BUFFER(writeonly, 12, LdcCounters, readback)
#include "ldc/ldc_corners.glsl"
#include "ldc/ldc_projected.glsl"

void main() {
    if (GLOBAL_INDEX == 0u) readback[0] = counters[0];  // all of them are final by now
    // Everything is redone when it did not fit: then nothing here may be trusted.
    if (!LDC_FITS(counters[0])) return;
    const uint i = GLOBAL_INDEX;
    if (i >= min(counters[0].fragments, params.fragment_capacity)) return;
    const uint voxel = fragments[i].cell, id = fragments[i].id, slot = fragments[i].local;
    const uint cell = node_cells[voxel >> 6u].x;
    const CubeGrid grid = bodies[node_cells[voxel >> 6u].y].grid;
    const uvec3 position = uvec3(cell & 1023u, cell >> 10u & 1023u, cell >> 20u) * 4u + ldcCell64(voxel & 63u);
    const bool last = slot + 1u == voxel_counts[voxel];
    const uint at = (voxel_table[params.first_node * 64u + voxel] & PEELRAY_FIRST) + slot;
    if (params.sampling == LDC_CONSERVATIVE) {
        vec3 a, b, c;
        const LdcCorners packed = corners[id >> 2u];
        ldcCornersOf(packed, a, b, c);
        // The normal by which the rasteriser chose the axis.
        patches[at] = ldcPackPatch(ldcProjectFrom(grid.inv_voxel, a, b, c, ldcNormalOf(packed), id & 3u), position, id, 1.0, PEELRAY_MARGIN, last);
        return;
    }
    samples[at] = ldcPackSample(ldcProjected(grid, id), position, id & 3u, params.sampling, last);
    sample_ids[at] = id;
}
