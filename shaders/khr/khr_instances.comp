// The instances as an acceleration structure takes them.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "khr/khr_params.h"
layout(local_size_x = 64) in;
PARAMS(uint)
BUFFER(readonly, 0, GpuInstance, instances)
BUFFER(readonly, 1, KhrBody, khr_bodies)
BUFFER(writeonly, 2, KhrInstance, khr_instances)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params) return;
    const GpuTransform to_world = instances[i].to_world;
    const KhrBody body = khr_bodies[instances[i].info.body];
    const mat3 rows = transpose(to_world.linear);
    KhrInstance instance;
    instance.row_x = vec4(rows[0], to_world.position.x);
    instance.row_y = vec4(rows[1], to_world.position.y);
    instance.row_z = vec4(rows[2], to_world.position.z);
    instance.part_and_mask = body.first_part | 0xff000000u;
    instance.offset_and_flags = 0u;
    // A transform may hold anything. Written so that a NaN fails.
    const float volume = abs(determinant(to_world.linear));
    const vec3 at = abs(to_world.position);
    const bool stands = volume > 0.0 && volume < 3e38 && at.x < 3e38 && at.y < 3e38 && at.z < 3e38;
    instance.structure = stands ? body.structure : uvec2(0);
    khr_instances[i] = instance;
}
