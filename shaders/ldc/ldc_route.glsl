// Sending triangles into the LDIs that capture them: what ldc_route.vert and ldc_route.geom share. Include after the buffers.
#ifndef PEELRAY_LDC_ROUTE_GLSL
#define PEELRAY_LDC_ROUTE_GLSL

#include "common/bounds.glsl"
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_common.glsl"
#include "ldc/ldc_routed.glsl"

layout(constant_id = 0) const bool by_geometry = true;  // the geometry shader routes, else the vertex shader
layout(constant_id = 1) const bool dilated = false;     // by half a pixel and more: for conservative sampling
layout(constant_id = 2) const bool layered = false;     // each LDI is a layer of the target

LDC_ROUTED(out)

/// Outside of what is seen: no part of a triangle there is drawn.
const vec4 LDC_NOWHERE = vec4(0, 0, 2, 1);

/// The viewport is a power of two, so that whole parts of pixels stay exact.
vec4 ldcClip(vec2 pixel) { return vec4(pixel * (2.0 / float(params.viewport)) - 1.0, 0.5, 1); }

/// Finite, with an area, and the build has room for its pixels? Then its normal, which need not have unit length.
bool ldcDrawn(vec3 a, vec3 b, vec3 c, CubeGrid grid, out vec3 normal) {
    normal = vec3(0);
    if (!(isBounded(a) && isBounded(b) && isBounded(c))) return false;
    normal = ldcNormal(a, b, c, grid.inv_voxel);
    return normal != vec3(0) && counters[0].cells <= params.cell_capacity;
}

void ldcHandOn(LdcTriangle t, uint id, uint body, vec3 normal) {
    routed_id = uvec2(id, body);
    routed_a = t.a;
    routed_b = t.b;
    routed_c = t.c;
    routed_slope = t.slope;
    const vec3 m = abs(normal);
    routed_normal = normalize(normal / max(m.x, max(m.y, m.z)));
}

// --- Dilation. All that is within half a pixel of a triangle, up and down or to a side, is its sum with a square: a convex
// polygon whose edges are those of both. Its corners are whole sixteenths of a pixel, which no device rounds (Vulkan asks for
// 4 bits below the pixel), so that the triangles it is cut into neither overlap nor gape, however thin the triangle was.
// The fragments decide exactly; the polygon only must not be too small. ---

const float LDC_GROWN_STEPS = 16.0;
const int LDC_GROWN_HALF = 9;  // half a pixel, what rounding takes (1/32) and ldcCovers allows, and a little more

/// The corner of the square that lies farthest along the outward normal of an edge: 0 to 3, counter-clockwise from (+, +).
int ldcSupport(ivec2 edge) {
    const ivec2 n = ivec2(edge.y, -edge.x);
    return n.x > 0 && n.y >= 0 ? 0 : (n.x <= 0 && n.y > 0 ? 1 : (n.x < 0 && n.y <= 0 ? 2 : 3));
}

struct LdcPolygon {
    int count;
    ivec2 corners[7];  ///< counter-clockwise, in sixteenths of a pixel
};

LdcPolygon ldcGrown(LdcTriangle t) {
    const vec2 low = vec2(-64.0), high = vec2(4096.0);
    ivec2 q[3] = ivec2[3](ivec2(round(clamp(t.a.xy, low, high) * LDC_GROWN_STEPS)), ivec2(round(clamp(t.b.xy, low, high) * LDC_GROWN_STEPS)),
                          ivec2(round(clamp(t.c.xy, low, high) * LDC_GROWN_STEPS)));
    const ivec2 e = q[1] - q[0], f = q[2] - q[0];
    const int area = e.x * f.y - e.y * f.x;
    int sides = 3;
    if (area < 0) {
        const ivec2 swapped = q[1];
        q[1] = q[2];
        q[2] = swapped;
    } else if (area == 0) {  // a line between the outermost two, or a point
        ivec2 first = q[0], last = q[0];
        for (int i = 1; i < 3; i++) {
            if (q[i].x < first.x || (q[i].x == first.x && q[i].y < first.y)) first = q[i];
            if (q[i].x > last.x || (q[i].x == last.x && q[i].y > last.y)) last = q[i];
        }
        q[0] = first;
        q[1] = last;
        sides = first == last ? 1 : 2;
    }
    LdcPolygon p;
    p.count = 0;
    for (int i = 0; i < sides; i++) {
        const ivec2 here = q[i], before = q[(i + sides - 1) % sides], after = q[(i + 1) % sides];
        int corner = sides == 1 ? 0 : ldcSupport(here - before);
        const int turns = sides == 1 ? 3 : (ldcSupport(after - here) - corner) & 3;
        for (int k = 0; k <= turns && p.count < 7; k++) {
            p.corners[p.count++] = here + LDC_GROWN_HALF * ivec2(corner == 0 || corner == 3 ? 1 : -1, corner < 2 ? 1 : -1);
            corner = (corner + 1) & 3;
        }
    }
    return p;
}

vec4 ldcGrownClip(LdcPolygon p, int corner) { return ldcClip(vec2(p.corners[min(corner, p.count - 1)]) / LDC_GROWN_STEPS); }

#endif
