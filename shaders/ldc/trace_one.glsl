// Traces a queue of rays in the cubes, one ray per thread.
#include "common/common.glsl"
#include "common/ray.h"
#include "ldc/trace_params.h"
#include "ldc/trace_queue.glsl"
#include "ldc/cube_trace.glsl"
layout(constant_id = 6) const uint batch = 0u;  // PEELRAY_ONE, ...
layout(constant_id = 7) const uint instance_count = 0u;  // up to 8; 0: any number
layout(constant_id = 9) const uint bare_count = 0u;      // of up to 8 instances

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= queueLength()) return;
    const Ray ray = rays[i];
    const PeelrayOptions options = PeelrayOptions(any_hit, hit_test, traversal, params.tolerance, params.block, batch, instance_count, bare_count,
                                                  refined);
    countNothing();
    queueStore(i, ray, cubeTrace(PeelrayRay(ray.origin, ray.tmin, ray.direction, ray.tmax), queueSkip(i), options));
    countRay(COUNT_TRACED, 0u, i);
}
