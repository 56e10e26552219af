// Martin Newell's teapot (1975): the control points of its 32 bicubic Bézier patches, with the lid, body, rim and
// bottom written as the four profiles of revolution that they are and handle and spout as one half of a mirrored pair.

#include <array>
#include <glm/glm.hpp>

#include "builtin/shapes.h"

namespace peelray {

namespace {

using Patch = std::array<std::array<glm::dvec3, 4>, 4>;
using Profile = std::array<glm::dvec2, 4>;  ///< radius, height

// From the top of the lid down, so that (along the profile) × (around) points outwards everywhere.
constexpr std::array<Profile, 6> profiles = {{
    {{{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}}},             // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},              // lid
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}},            // upper body
    {{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},            // lower body
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0.0}, {0.0, 0.0}}},           // bottom
}};

// Newell's own approximation of a quarter circle; exact would be 0.5523.
constexpr double quarter = 0.56;

// Cross-sections of one half (y ≤ 0; z is up here), from which the other half is mirrored: x and z of the inner edge, x
// and z of the outer edge, and the half width.
struct Section {
    double inner_x, inner_z, outer_x, outer_z, width;
};
using Tube = std::array<Section, 7>;  ///< two patches that share the fourth section

constexpr Tube handle = {{{-1.6, 2.025, -1.5, 2.25, 0.3},
                          {-2.3, 2.025, -2.5, 2.25, 0.3},
                          {-2.7, 2.025, -3.0, 2.25, 0.3},
                          {-2.7, 1.8, -3.0, 1.8, 0.3},
                          {-2.7, 1.575, -3.0, 1.35, 0.3},
                          {-2.5, 1.125, -2.65, 0.9375, 0.3},
                          {-2.0, 0.9, -1.9, 0.6, 0.3}}};
constexpr Tube spout = {{{1.7, 1.425, 1.7, 0.6, 0.66},
                         {2.6, 1.425, 3.1, 0.825, 0.66},
                         {2.3, 2.1, 2.4, 2.025, 0.25},
                         {2.7, 2.4, 3.3, 2.4, 0.25},
                         {2.8, 2.475, 3.525, 2.49375, 0.25},
                         {2.9, 2.475, 3.45, 2.5125, 0.15},
                         {2.8, 2.4, 3.2, 2.4, 0.15}}};

Patch revolve(const Profile& profile, int quadrant) {
    constexpr std::array<glm::dvec2, 4> arc = {{{1, 0}, {1, quarter}, {quarter, 1}, {0, 1}}};
    Patch out;
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j) {
            glm::dvec2 around = arc[j];
            for (int turn = 0; turn < quadrant; ++turn) around = {-around.y, around.x};
            out[i][j] = {profile[i].x * around.x, profile[i].x * around.y, profile[i].y};
        }
    return out;
}

Patch half_tube(const Tube& tube, size_t first, bool mirrored) {
    Patch out;
    for (size_t i = 0; i < 4; ++i) {
        const Section& s = tube[first + i];
        const double y = mirrored ? s.width : -s.width;
        out[i] = {{{s.inner_x, 0, s.inner_z},
                   {s.inner_x, y, s.inner_z},
                   {s.outer_x, y, s.outer_z},
                   {s.outer_x, 0, s.outer_z}}};
        if (!mirrored) std::swap(out[i][0], out[i][3]), std::swap(out[i][1], out[i][2]);
    }
    return out;
}

std::array<double, 4> bernstein(double t) {
    const double s = 1 - t;
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

std::array<double, 4> bernstein_derivative(double t) {
    const double s = 1 - t;
    return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

glm::dvec3 blend(const Patch& patch, const std::array<double, 4>& u, const std::array<double, 4>& v) {
    glm::dvec3 sum{0};
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j) sum += patch[i][j] * (u[i] * v[j]);
    return sum;
}

glm::dvec3 patch_normal(const Patch& patch, double u, double v) {
    const auto cross = [&](double at) {
        return glm::cross(blend(patch, bernstein_derivative(at), bernstein(v)),
                          blend(patch, bernstein(at), bernstein_derivative(v)));
    };
    glm::dvec3 normal = cross(u);
    // At the poles of lid and bottom a whole edge is one point; the normal there is the limit from inside the patch.
    if (glm::length(normal) < 1e-9) normal = cross(u < 0.5 ? 1e-4 : 1 - 1e-4);
    return glm::normalize(normal);
}

glm::vec3 y_up(const glm::dvec3& p) {
    return {p.x, p.z, -p.y};
}

void tessellate(const Patch& patch, uint32_t n, Primitive& out) {
    const auto first = static_cast<uint32_t>(out.positions.size());
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j <= n; ++j) {
            const double u = double(i) / n, v = double(j) / n;
            out.positions.push_back(y_up(blend(patch, bernstein(u), bernstein(v))));
            out.normals.push_back(glm::normalize(y_up(patch_normal(patch, u, v))));
        }
    const auto emit = [&](uint32_t a, uint32_t b, uint32_t c) {
        const auto& p = out.positions;
        if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a]) out.triangles.push_back({a, b, c});
    };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t a = first + i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
            emit(a, c, d);
            emit(a, d, b);
        }
}

}  // namespace

Primitive teapot(uint32_t n) {
    Primitive out;
    for (const Profile& profile : profiles)
        for (int quadrant = 0; quadrant < 4; ++quadrant) tessellate(revolve(profile, quadrant), n, out);
    for (const Tube* tube : {&handle, &spout})
        for (const size_t first : {size_t(0), size_t(3)})
            for (const bool mirrored : {false, true}) tessellate(half_tube(*tube, first, mirrored), n, out);
    return out;
}

}  // namespace peelray
