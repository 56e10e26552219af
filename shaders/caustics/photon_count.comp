// How many photons are in each bucket of the grid.
#version 460
#include "common/common.glsl"
#include "caustics/photon_params.h"
#include "caustics/photon_grid.glsl"
layout(local_size_x = 64) in;
PARAMS(PhotonGridParams)
BUFFER(readonly, 0, Photon, photons)
BUFFER(, 1, uvec2, photon_buckets)  // x: how many

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.count || photons[i].direction == vec3(0)) return;
    atomicAdd(photon_buckets[photonBucket(photonCell(photons[i].position, params.lower, params.inverse_cell), params.mask)].x, 1u);
}
