// Places the cubes in the world: of each instance the way into its cube, and the box that holds it.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "ldc/ldc_params.h"
#include "ldc/tree_params.h"
#include "common/bounds.glsl"
#include "peelray/precise.glsl"
#include "ldc/tree.glsl"
layout(local_size_x = 64) in;
PARAMS(InstanceParams)
BUFFER(readonly, 0, GpuTransform, transforms)
BUFFER(readonly, 1, InstanceInfo, infos)
BUFFER(readonly, 2, LdcBody, bodies)
BUFFER(readonly, 3, uvec3, body_lower)
BUFFER(readonly, 4, uvec3, body_upper)
BUFFER(writeonly, 5, GpuInstance, instances)
BUFFER(writeonly, 6, PeelrayBox, instance_boxes)
BUFFER(writeonly, 7, PeelrayInstance, instance_cubes)
layout(constant_id = 0) const bool merging = false;  // some instances are merged
BUFFER(readonly, 8, InstanceRole, roles)

/// a*b - c*d with one rounding's error.
float difference(float a, float b, float c, float d) {
    const vec2 r = peelrayAdd(peelrayTwoProduct(a, b), -peelrayTwoProduct(c, d));
    return r.x + r.y;
}
vec3 crossProduct(vec3 a, vec3 b) {
    return vec3(difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x));
}

/// The box of the body's box, a little larger: rays are in it wherever rounding puts them into the cube.
PeelrayBox boxOf(uint index, uint body, GpuTransform to_world, float voxel, bool tight) {
    const vec3 lower = orderedFloats(body_lower[body]), upper = orderedFloats(body_upper[body]);
    if (!(lower.x <= upper.x)) return NO_BOX;
    // Nothing is rounded: a ray that leaves the body, which may be flat, does not meet its box again.
    if (tight) return PeelrayBox(lower, index, upper, 0u);
    const vec3 middle = 0.5 * lower + 0.5 * upper, half_size = 0.5 * upper - 0.5 * lower + 0.5 * voxel;
    const mat3 size = mat3(abs(to_world.linear[0]), abs(to_world.linear[1]), abs(to_world.linear[2]));
    const vec3 at = to_world.linear * middle + to_world.position;
    const vec3 reach = size * half_size + 1e-6 * (size * (abs(middle) + half_size) + abs(to_world.position));
    const PeelrayBox box = PeelrayBox(at - reach, index, at + reach, 0u);
    return isBounded(box.lower) && isBounded(box.upper) ? box : NO_BOX;  // a transform may hold anything
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.count) {
        const uint empty = params.boxes + i - params.count;
        if (empty < params.padded) instance_boxes[empty] = NO_BOX;
        return;
    }
    const uint box = merging ? roles[i].box : i;  // its number among those that have one
    const bool merged = box == INSTANCE_MERGED;
    const GpuTransform to_world = transforms[i];
    const InstanceInfo info = infos[i];
    const CubeGrid grid = bodies[info.body].grid;
    const vec3 x = to_world.linear[0], y = to_world.linear[1], z = to_world.linear[2];
    // Rows of the inverse are cross products of the columns by the determinant, of a matrix of size 1: no power of a small
    // scale is lost.
    const float size = sqrt(max(dot(x, x), max(dot(y, y), dot(z, z))));
    const vec3 u = x / size, v = y / size, w = z / size;
    const vec3 row_u = crossProduct(v, w), row_v = crossProduct(w, u), row_w = crossProduct(u, v);
    const float determinant = dot(u, row_u), inverse = 1.0 / (determinant * size);
    PeelrayInstance cube;
    cube.x = row_u * inverse;
    cube.y = row_v * inverse;
    cube.z = row_w * inverse;
    cube.voxel = grid.voxel;
    cube.inv_voxel = grid.inv_voxel;
    const uvec3 tops = grid.dims >> 4u;
    cube.tops = tops.x | tops.y << 10u | tops.z << 20u;
    cube.first_cell = bodies[info.body].first_cell;
    const bool bare = (bodies[info.body].resolution & LDC_BARE) != 0u;
    if (bare) {
        cube.tops |= PEELRAY_BARE;
        cube.first_cell = bodies[info.body].first_triangle | (bodies[info.body].triangles - 1u) << 30u;
    }
    if (merged) {
        cube.tops |= PEELRAY_MERGED;
        cube.first_cell = roles[i].copies;
    }
    cube.corner = to_world.linear * grid.origin + to_world.position;
    cube.origin = grid.origin;
    cube.moved = to_world.linear == mat3(1) && to_world.position == vec3(0) ? 0u : 1u;
    instance_cubes[i] = cube;
    GpuInstance instance;
    instance.to_world = to_world;
    instance.info = info;
    instance.moved = cube.moved;
    instance.mirrored = determinant < 0.0 ? 1u : 0u;
    instance.voxel = grid.voxel * size;
    instances[i] = instance;
    if (merged) return;
    const uint slot = params.padded == 8u ? params.slots >> 4u * box & 15u : box;
    instance_boxes[slot] = boxOf(i, info.body, to_world, grid.voxel, bare && cube.moved == 0u);
}
