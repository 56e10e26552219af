// Hits as HITS.npy has them: triangles by their place in the file, weights of its second and third corner.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "common/ray.h"
#include "ldc/trace_params.h"
layout(local_size_x = 64) in;
PARAMS(uint)
BUFFER(readonly, 0, Hit, hits)
BUFFER(readonly, 1, GpuInstance, instances)
BUFFER(readonly, 2, uint, triangle_ids)
BUFFER(writeonly, 3, FileHit, file_hits)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params) return;
    const Hit hit = hits[i];
    FileHit out_hit = FileHit(hit.t, NO_TRIANGLE, 0.0, 0.0);
    if (hit.triangle != NO_TRIANGLE) {
        const bool mirrored = instances[hit.instance].mirrored != 0u;
        out_hit.triangle = instances[hit.instance].info.first_id + triangle_ids[hit.triangle];
        out_hit.u = mirrored ? hit.v : hit.u;
        out_hit.v = mirrored ? hit.u : hit.v;
    }
    file_hits[i] = out_hit;
}
