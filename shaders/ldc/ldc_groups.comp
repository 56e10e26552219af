// Workgroups of the passes whose work is counted on the GPU.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 1) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(writeonly, 1, uvec3, groups)

uvec3 rows(uint count) { return uvec3(min(count, DISPATCH_ROW), (count + DISPATCH_ROW - 1u) / DISPATCH_ROW, 1u); }

void main() {
    const uint cells = counters[0].cells <= params.cell_capacity ? counters[0].cells : 0u;
    groups[LDC_GROUPS_BLOCKS] = rows(min(counters[0].blocks, params.block_capacity));
    groups[LDC_GROUPS_FRAGMENTS] = rows((min(counters[0].fragments, params.fragment_capacity) + 127u) / 128u);
    groups[LDC_GROUPS_LONG] = rows(min(counters[0].long_lists, params.long_capacity));
    groups[LDC_GROUPS_CELLS] = rows((cells + 255u) / 256u);
}
