// Stores the photons bucket by bucket. Threads decide their order in a bucket, which nothing depends on.
#version 460
#include "common/common.glsl"
#include "caustics/photon_params.h"
#include "caustics/photon_grid.glsl"
layout(local_size_x = 64) in;
PARAMS(PhotonGridParams)
BUFFER(readonly, 0, Photon, photons)
BUFFER(, 1, uvec2, photon_buckets)  // x: the first photon, y: how many are stored
BUFFER(writeonly, 2, Photon, sorted_photons)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.count) return;
    const Photon photon = photons[i];
    if (photon.direction == vec3(0)) return;
    const uint bucket = photonBucket(photonCell(photon.position, params.lower, params.inverse_cell), params.mask);
    sorted_photons[photon_buckets[bucket].x + atomicAdd(photon_buckets[bucket].y, 1u)] = photon;
}
