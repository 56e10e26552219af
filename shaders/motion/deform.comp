// Vertices of what changes its shape, in the world: morph targets, then the skin's joints or the node (glTF 2.0, section
// 3.7.2.2 and 3.7.3.3). The bodies' bounds grow with them. A workgroup's vertices are of one piece.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool with_tangents = false;
PARAMS(DeformParams)
BUFFER(readonly, 0, DeformPiece, pieces)
BUFFER(readonly, 1, vec3, rest_positions)
BUFFER(readonly, 2, vec3, rest_normals)
BUFFER(readonly, 3, JointInfluence, influences)
BUFFER(readonly, 4, vec3, targets)
BUFFER(readonly, 5, float, target_weights)
BUFFER(readonly, 6, GpuTransform, joints)
BUFFER(writeonly, 7, vec3, positions)
BUFFER(writeonly, 8, vec3, normals)
BUFFER(, 9, uvec3, body_lower)
BUFFER(, 10, uvec3, body_upper)
BUFFER(readonly, 11, vec4, rest_tangents)
BUFFER(writeonly, 12, vec2, tangents)  // behind the texture coordinates
#include "common/grow_bounds.glsl"

/// The piece of this workgroup.
uint findPiece() {
    uint first = 0u, count = params.pieces;
    while (count > 1u) {
        const uint half_count = count / 2u;
        const bool upper = pieces[first + half_count].first_group <= GROUP_INDEX;
        first += upper ? half_count : 0u;
        count = upper ? count - half_count : half_count;
    }
    return first;
}

void morph(DeformPiece piece, uint vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent) {
    const uint kinds = with_tangents ? 3u : 2u;
    for (uint i = 0u; i < piece.targets; i++) {
        const float weight = target_weights[piece.first_weight + i];
        if (weight == 0.0) continue;
        const uint first = piece.first_target + kinds * i * piece.vertices + vertex;
        position += weight * targets[first];
        normal += weight * targets[first + piece.vertices];
        if (with_tangents) tangent += weight * targets[first + 2u * piece.vertices];
    }
}

/// The mean of the joints that pull at the vertex; the node's own where none does.
GpuTransform transformOf(DeformPiece piece, uint vertex) {
    GpuTransform sum = GpuTransform(mat3(0), vec3(0));
    float all = 0.0;
    for (uint i = 0u; i < piece.influences; i++) {
        const JointInfluence influence = influences[piece.first_influence + vertex * piece.influences + i];
        if (influence.weight == 0.0) continue;
        const GpuTransform joint = joints[piece.first_joint + 1u + influence.joint];
        sum.linear += influence.weight * joint.linear;
        sum.position += influence.weight * joint.position;
        all += influence.weight;
    }
    if (all > 0.0) return sum;
    return joints[piece.first_joint];
}

vec3 unitOr(vec3 v, vec3 otherwise) {
    const float longest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    return longest > 0.0 && longest < 1e30 ? normalize(v / longest) : otherwise;
}

void main() {
    const DeformPiece piece = pieces[findPiece()];
    const uint vertex = (GROUP_INDEX - piece.first_group) * 64u + gl_LocalInvocationIndex;
    const bool valid = GROUP_INDEX < params.groups && vertex < piece.vertices;
    vec3 position = vec3(0);
    if (valid) {
        const uint rest = piece.first_rest + vertex, at = piece.first_vertex + vertex;
        const vec3 own_normal = rest_normals[rest];
        vec3 normal = own_normal;
        position = rest_positions[rest];
        const vec4 own_tangent = with_tangents ? rest_tangents[rest] : vec4(0);
        vec3 tangent = own_tangent.xyz;
        morph(piece, vertex, position, normal, tangent);
        const GpuTransform to_world = transformOf(piece, vertex);
        position = to_world.linear * position + to_world.position;
        // Cofactors: the inverse transpose times the determinant, finite where there is no inverse.
        const mat3 m = to_world.linear;
        const vec3 x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
        const float side = dot(m[0], x) < 0.0 ? -1.0 : 1.0;
        normal = side * (x * normal.x + y * normal.y + z * normal.z);
        if (with_tangents) {
            tangent = unitOr(m * tangent, vec3(0));
            const uint place = params.first_tangent + 2u * at;
            tangents[place] = tangent.xy;
            tangents[place + 1u] = vec2(tangent.z, tangent == vec3(0) ? 0.0 : side * own_tangent.w);
        }
        positions[at] = position;
        normals[at] = unitOr(normal, own_normal);
    }
    growBounds(piece.body, position, valid);
}
