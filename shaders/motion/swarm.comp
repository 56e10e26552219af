// Where the bodies of a swarm are.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "motion/motion_params.h"
#include "motion/swarm_motion.h"
layout(local_size_x = 64) in;
PARAMS(SwarmParams)
BUFFER(readonly, 0, uint, swarm_instances)
BUFFER(writeonly, 1, GpuTransform, transforms)

void main() {
    const uint body = GLOBAL_INDEX;
    if (body >= params.bodies) return;
    const SwarmPlace place = swarmPlace(body, params.phase);
    transforms[swarm_instances[body]] = GpuTransform(place.linear, place.position);
}
