// The vertices of a sheet of cloth in this moment: a uniform cubic B-spline surface over its net of control points.
#version 460
#include "common/common.glsl"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
PARAMS(ClothParams)
BUFFER(readonly, 0, vec3, net)
BUFFER(writeonly, 1, vec3, positions)
BUFFER(writeonly, 2, vec3, normals)
BUFFER(, 3, uvec3, body_lower)
BUFFER(, 4, uvec3, body_upper)
#include "common/grow_bounds.glsl"

/// Weights of four neighbours in a row of the net, and of the derivative.
struct Basis {
    uint first;
    vec4 weights, slopes;
};

/// Beyond an end the net goes straight on: what a point there would weigh goes to the two before it.
void foldBelow(inout vec4 w) {
    w = vec4(w.y + 2 * w.x, w.z - w.x, w.w, 0);
}

void foldAbove(inout vec4 w) {
    w = vec4(0, w.x, w.y - w.w, w.z + 2 * w.w);
}

/// At vertex `i` of `cells` cells.
Basis basisAt(uint i, uint cells) {
    const float at = float(i) * float(params.points - 1u) / float(cells);
    const uint piece = min(uint(at), params.points - 2u);
    const float t = at - float(piece), s = 1 - t;
    Basis b;
    b.weights = vec4(s * s * s, 4 + t * t * (3 * t - 6), 4 + s * s * (3 * s - 6), t * t * t) / 6;
    b.slopes = vec4(-s * s, t * (3 * t - 4), s * (4 - 3 * s), t * t) / 2;
    b.first = max(piece, 1u) - 1u;
    if (piece == 0u) {
        foldBelow(b.weights);
        foldBelow(b.slopes);
    } else if (piece == params.points - 2u) {
        foldAbove(b.weights);
        foldAbove(b.slopes);
        b.first--;
    }
    return b;
}

void main() {
    const uint row = params.across + 1u, i = GLOBAL_INDEX;
    const bool valid = i < row * (params.along + 1u);
    vec3 position = vec3(0);
    if (valid) {
        const Basis u = basisAt(i % row, params.across), v = basisAt(i / row, params.along);
        vec3 along_u = vec3(0), along_v = vec3(0);
        for (uint j = 0u; j < 4u; j++) {
            vec3 point = vec3(0), slope = vec3(0);
            for (uint k = 0u; k < 4u; k++) {
                const vec3 control = net[(v.first + j) * params.points + u.first + k];
                point += u.weights[k] * control;
                slope += u.slopes[k] * control;
            }
            position += v.weights[j] * point;
            along_u += v.weights[j] * slope;
            along_v += v.slopes[j] * point;
        }
        positions[params.first_vertex + i] = position;
        normals[params.first_vertex + i] = normalize(cross(along_v, along_u));
    }
    growBounds(params.body, position, valid);
}
