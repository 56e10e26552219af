// Watertight ray-triangle intersection, without bindings.
#ifndef PEELRAY_INTERSECT_GLSL
#define PEELRAY_INTERSECT_GLSL

/// Ray against triangle, watertight: an edge is seen the same way from both of its triangles (Woop, Benthin, Wald: Watertight
/// Ray/Triangle Intersection, JCGT 2013). `origin` and corners relative to one point near all of them.
bool peelrayIntersect(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c, out float t, out vec2 uv) {
    const vec3 size = abs(direction);
    const bool x_largest = size.x >= size.y && size.x >= size.z;
    const bool y_largest = !x_largest && size.y >= size.z;
    // Cyclic permutation that brings the largest component to z.
#define PEELRAY_PERMUTE(v) (x_largest ? (v).yzx : (y_largest ? (v).zxy : (v)))
    const vec3 d = PEELRAY_PERMUTE(direction);
    precise vec3 A = PEELRAY_PERMUTE(a - origin);
    precise vec3 B = PEELRAY_PERMUTE(b - origin);
    precise vec3 C = PEELRAY_PERMUTE(c - origin);
#undef PEELRAY_PERMUTE
    const float sz = 1.0 / d.z;
    const vec2 shear = d.xy * sz;
    precise vec2 p = A.xy - shear * A.z;
    precise vec2 q = B.xy - shear * B.z;
    precise vec2 r = C.xy - shear * C.z;
    precise float u = r.x * q.y - r.y * q.x;
    precise float v = p.x * r.y - p.y * r.x;
    precise float w = q.x * p.y - q.y * p.x;
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
    const float det = u + v + w;
    if (det == 0.0) return false;
    const float inv = 1.0 / det;
    t = (u * A.z + v * B.z + w * C.z) * inv * sz;
    uv = vec2(v, w) * inv;
    return !isinf(inv);
}

#endif
