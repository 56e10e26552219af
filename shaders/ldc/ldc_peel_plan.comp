// How many layers there are to peel, and what each of the recorded passes draws: nothing beyond the last layer, and nothing at
// all if there are more layers than passes.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 64) in;
PARAMS(PeelPlanParams)
BUFFER(, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, layer_counts)
BUFFER(writeonly, 2, uint, complexities)
BUFFER(writeonly, 3, DrawArguments, draws)
BUFFER(writeonly, 4, uvec3, groups)

void main() {
    const uint pass = GLOBAL_INDEX, layers = layer_counts[params.value];
    if (pass == 0u) {
        complexities[params.body] = layers;
        atomicMax(counters[0].complexity, layers);
        if (layers <= params.passes) atomicAdd(counters[0].passes, layers);
    }
    if (pass >= params.passes) return;
    const bool made = layers <= params.passes && pass < layers;
    for (uint k = 0u; k < params.draws; k++) draws[pass * params.draws + k] = DrawArguments(made ? params.vertices : 0u, 1u, 0u, k);
    const uint count = made ? (params.texels + 63u) / 64u : 0u;
    groups[pass] = uvec3(min(count, DISPATCH_ROW), (count + DISPATCH_ROW - 1u) / DISPATCH_ROW, 1u);
}
