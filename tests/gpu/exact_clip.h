// Double-precision clipping of triangles: what the tests of the cube's rasterisation trust. Independent of the shaders.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// A convex polygon in (u, v, w).
using Polygon = std::vector<glm::dvec3>;

/// The part of `polygon` where sign · p[axis] >= sign · at (Sutherland and Hodgman's step).
inline Polygon clip_half_space(const Polygon& polygon, int axis, double at, double sign) {
    Polygon out;
    for (size_t i = 0; i < polygon.size(); i++) {
        const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double dp = sign * (p[axis] - at), dq = sign * (q[axis] - at);
        if (dp >= 0) out.push_back(p);
        if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
            glm::dvec3 x = p + (q - p) * (dp / (dp - dq));
            x[axis] = at;
            out.push_back(x);
        }
    }
    return out;
}

/// The part inside [lo, hi] of the first `axes` axes; empty: they do not touch.
inline Polygon clip_box(Polygon polygon, const glm::dvec3& lo, const glm::dvec3& hi, int axes) {
    for (int axis = 0; axis < axes && !polygon.empty(); axis++) {
        polygon = clip_half_space(polygon, axis, lo[axis], 1);
        polygon = clip_half_space(polygon, axis, hi[axis], -1);
    }
    return polygon;
}

/// For each edge of a triangle in (u, v): the largest signed distance (positive inside) that a square of half-width `h`
/// around `centre` reaches; the least of the three. Negative: some edge separates the square from the triangle by that
/// much.
inline double edge_distance(const std::array<glm::dvec3, 3>& t, const glm::dvec2& centre, double h) {
    const glm::dvec2 ab = glm::dvec2(t[1]) - glm::dvec2(t[0]), ac = glm::dvec2(t[2]) - glm::dvec2(t[0]);
    const double side = ab.x * ac.y - ab.y * ac.x < 0 ? -1 : 1;
    double least = 1e300;
    for (int k = 0; k < 3; k++) {
        const glm::dvec2 a(t[size_t(k)]), e = glm::dvec2(t[size_t(k + 1) % 3]) - a;
        const double length = glm::length(e);
        if (length == 0) continue;
        double best = -1e300;
        for (int corner = 0; corner < 4; corner++) {
            const glm::dvec2 p = centre + h * glm::dvec2(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1) - a;
            best = std::max(best, side * (e.x * p.y - e.y * p.x) / length);
        }
        least = std::min(least, best);
    }
    return least;
}

/// The same of a cube of half-width `h` as it is seen along u and along v: the lesser of the two.
inline double side_distance(const std::array<glm::dvec3, 3>& t, const glm::dvec3& centre, double h) {
    std::array<glm::dvec3, 3> along_u, along_v;
    for (size_t k = 0; k < 3; k++) {
        along_u[k] = {t[k].y, t[k].z, t[k].x};
        along_v[k] = {t[k].z, t[k].x, t[k].y};
    }
    return std::min(edge_distance(along_u, {centre.y, centre.z}, h), edge_distance(along_v, {centre.z, centre.x}, h));
}

}  // namespace peelray
