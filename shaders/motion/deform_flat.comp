// Normals of deformed triangles that are flat-shaded: the triangles' own. No vertex of theirs is shared.
#version 460
#include "common/common.glsl"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
PARAMS(DeformParams)
BUFFER(readonly, 0, DeformPiece, pieces)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(writeonly, 3, vec3, normals)

uint findPiece(uint triangle) {
    uint first = 0u, count = params.pieces;
    while (count > 1u) {
        const uint half_count = count / 2u;
        const bool upper = pieces[first + half_count].first_triangle <= triangle;
        first += upper ? half_count : 0u;
        count = upper ? count - half_count : half_count;
    }
    return first;
}

void main() {
    if (GLOBAL_INDEX >= params.triangles) return;
    const uint triangle = params.first_triangle + GLOBAL_INDEX;
    if (pieces[findPiece(triangle)].flat_shaded == 0u) return;
    const uvec3 t = triangles[triangle];
    const vec3 normal = cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
    const float longest = max(abs(normal.x), max(abs(normal.y), abs(normal.z)));
    if (!(longest > 0.0 && longest < 1e30)) return;  // the vertices keep theirs
    const vec3 unit = normalize(normal / longest);
    normals[t.x] = unit;
    normals[t.y] = unit;
    normals[t.z] = unit;
}
