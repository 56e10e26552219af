// Watertight ray-triangle intersection, without bindings.
#ifndef PEELRAY_INTERSECT_GLSL
#define PEELRAY_INTERSECT_GLSL

#include "peelray/precise.glsl"

/// a*b - c*d
vec2 peelrayMinor(vec2 a, vec2 b, vec2 c, vec2 d) { return peelrayAdd(peelrayMultiply(a, b), -peelrayMultiply(c, d)); }
/// The triple product d . (p x q): twice the signed area between a ray of direction `d` and the edge from q to p.
vec2 peelrayTriple(vec3 d, vec2 px, vec2 py, vec2 pz, vec2 qx, vec2 qy, vec2 qz) {
    const vec2 x = peelrayMultiply(vec2(d.x, 0), peelrayMinor(py, qz, pz, qy));
    const vec2 y = peelrayMultiply(vec2(d.y, 0), peelrayMinor(pz, qx, px, qz));
    const vec2 z = peelrayMultiply(vec2(d.z, 0), peelrayMinor(px, qy, py, qx));
    return peelrayAdd(peelrayAdd(x, y), z);
}

/// Is the point where the edges' areas are `edges` inside? Edges count as inside, so that no ray slips between triangles.
bool peelrayInside(vec3 edges) { return all(greaterThanEqual(edges, vec3(0))) || all(lessThanEqual(edges, vec3(0))); }

/// Ray against triangle with twice the precision, in world space; the ray's origin is the sum of two vectors.
bool peelrayIntersectPrecise(vec3 origin, vec3 origin_low, vec3 direction, vec3 a, vec3 b, vec3 c, out float t, out vec2 uv) {
#define PEELRAY_RELATIVE(corner, axis) peelrayAdd(peelrayTwoSum(corner.axis, -origin.axis), vec2(-origin_low.axis, 0))
    const vec2 ax = PEELRAY_RELATIVE(a, x), ay = PEELRAY_RELATIVE(a, y), az = PEELRAY_RELATIVE(a, z);
    const vec2 bx = PEELRAY_RELATIVE(b, x), by = PEELRAY_RELATIVE(b, y), bz = PEELRAY_RELATIVE(b, z);
    const vec2 cx = PEELRAY_RELATIVE(c, x), cy = PEELRAY_RELATIVE(c, y), cz = PEELRAY_RELATIVE(c, z);
#undef PEELRAY_RELATIVE
    const vec2 u = peelrayTriple(direction, cx, cy, cz, bx, by, bz);
    const vec2 v = peelrayTriple(direction, ax, ay, az, cx, cy, cz);
    const vec2 w = peelrayTriple(direction, bx, by, bz, ax, ay, az);
    // An area of 0 comes out as a few 2^-46 of its terms: a ray through a corner could then miss every triangle around it.
    const vec3 reach = max(max(abs(vec3(ax.x, ay.x, az.x)), abs(vec3(bx.x, by.x, bz.x))), abs(vec3(cx.x, cy.x, cz.x)));
    const float zero = 1.2e-13 * dot(abs(direction), reach.yzx * reach.zxy);
    const vec3 edges = mix(vec3(u.x, v.x, w.x), vec3(0), lessThanEqual(abs(vec3(u.x, v.x, w.x)), vec3(zero)));
    const float det = edges.x + edges.y + edges.z;
    t = 0.0;
    uv = vec2(0);
    if (!peelrayInside(edges) || det == 0.0) return false;
    const vec3 weights = edges / det;
    // Along the largest component of the direction: the weights are exact enough, and so is the sum of the corners.
    const vec3 size = abs(direction);
    const uint axis = size.x >= size.y && size.x >= size.z ? 0u : (size.y >= size.z ? 1u : 2u);
    const vec3 along = axis == 0u ? vec3(ax.x, bx.x, cx.x) : (axis == 1u ? vec3(ay.x, by.x, cy.x) : vec3(az.x, bz.x, cz.x));
    t = dot(weights, along) / direction[axis];
    uv = weights.yz;
    return true;
}

/// What peelrayIntersect found; uncertain ones carry what single precision says in their lowest bit.
const uint PEELRAY_OUTSIDE = 0u, PEELRAY_INSIDE = 1u, PEELRAY_UNCERTAIN = 2u;

/// What peelrayIntersectSheared needs of a direction: the axis of its largest component, and how far the others go along it.
struct PeelrayShear {
    uint axis;
    vec2 slope;
    float inv;  ///< 1 / the largest component
};

/// Cyclic permutation that brings the largest component to z.
vec3 peelrayPermute(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

PeelrayShear peelrayShear(vec3 direction) {
    const vec3 size = abs(direction);
    PeelrayShear shear;
    shear.axis = size.x >= size.y && size.x >= size.z ? 0u : (size.y >= size.z ? 1u : 2u);
    const vec3 d = peelrayPermute(direction, shear.axis);
    shear.inv = 1.0 / d.z;
    shear.slope = d.xy * shear.inv;
    return shear;
}

/// Ray against triangle in single precision (Woop, Benthin, Wald: Watertight Ray/Triangle Intersection, JCGT 2013); `origin` and
/// corners relative to one point near all of them. At least PEELRAY_UNCERTAIN where rounding could decide, if that is asked for
/// (`decides`, a constant): peelrayIntersectPrecise knows. An edge is seen the same way from both of its triangles, so that the low
/// bit alone is watertight too.
uint peelrayIntersectSheared(vec3 origin, PeelrayShear shear, vec3 a, vec3 b, vec3 c, bool decides, out float t, out vec2 uv) {
    precise vec3 A = peelrayPermute(a - origin, shear.axis);
    precise vec3 B = peelrayPermute(b - origin, shear.axis);
    precise vec3 C = peelrayPermute(c - origin, shear.axis);
    precise vec2 p = A.xy - shear.slope * A.z;
    precise vec2 q = B.xy - shear.slope * B.z;
    precise vec2 r = C.xy - shear.slope * C.z;
    precise vec3 edges = vec3(r.x * q.y - r.y * q.x, p.x * r.y - p.y * r.x, q.x * p.y - q.y * p.x);
    t = 0.0;
    uv = vec2(0);
    uint certain = 0u;
    if (decides) {
        // Corners are off by a few roundings of their coordinates, areas by that times the triangle's size.
        const vec2 span = max(abs(p), max(abs(q), abs(r)));
        const float flat_size = max(span.x, span.y);
        const float reach = max(max(abs(A.x), max(abs(B.x), abs(C.x))), max(max(abs(A.y), max(abs(B.y), abs(C.y))),
                                max(abs(A.z), max(abs(B.z), abs(C.z)))));
        // The subtraction of the origin rounds relative to the operands, which may be larger than the difference.
        const vec3 far = max(abs(origin), max(abs(a), max(abs(b), abs(c))));
        const float bound = 1e-6 * flat_size * max(reach, max(far.x, max(far.y, far.z)));
        if (any(greaterThan(edges, vec3(bound))) && any(lessThan(edges, vec3(-bound)))) return PEELRAY_OUTSIDE;
        certain = all(greaterThan(abs(edges), vec3(bound))) ? 0u : PEELRAY_UNCERTAIN;
    }
    const float det = edges.x + edges.y + edges.z;
    if (!peelrayInside(edges) || det == 0.0) return certain;
    const float inv = 1.0 / det;
    t = dot(edges, vec3(A.z, B.z, C.z)) * inv * shear.inv;
    uv = edges.yz * inv;
    return certain | PEELRAY_INSIDE;
}

uint peelrayIntersect(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c, out float t, out vec2 uv) {
    return peelrayIntersectSheared(origin, peelrayShear(direction), a, b, c, true, t, uv);
}

#endif
