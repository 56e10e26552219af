// Meshes and rays for the oracle's tests.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "base/infinity.h"
#include "reference/oracle.h"

namespace peelray {

inline void add_triangle(Geometry& geometry, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto first = uint32_t(geometry.positions.size());
    geometry.positions.insert(geometry.positions.end(), {a, b, c});
    geometry.triangles.emplace_back(first, first + 1, first + 2);
}

/// The cube [-1, 1]³: triangles 2·face and 2·face + 1, faces -x, +x, -y, +y, -z, +z.
inline Geometry cube() {
    Geometry geometry;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 corner[4];
            for (int i = 0; i < 4; ++i) {
                corner[i][axis] = side;
                corner[i][(axis + 1) % 3] = i == 1 || i == 2 ? 1.0f : -1.0f;
                corner[i][(axis + 2) % 3] = i >= 2 ? 1.0f : -1.0f;
            }
            add_triangle(geometry, corner[0], corner[1], corner[2]);
            add_triangle(geometry, corner[0], corner[2], corner[3]);
        }
    return geometry;
}

/// A closed unit sphere of 4·rows² triangles (the first and last row of quads lose half of theirs, which have no area).
inline Geometry sphere(uint32_t rows, const glm::vec3& center = glm::vec3(0), float radius = 1) {
    Geometry geometry;
    const uint32_t columns = 2 * rows;
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            const double theta = std::numbers::pi * r / rows, phi = 2 * std::numbers::pi * c / columns;
            const bool pole = r == 0 || r == rows;
            const glm::dvec3 p(pole ? 0 : std::sin(theta) * std::cos(phi), std::cos(theta),
                               pole ? 0 : std::sin(theta) * std::sin(phi));
            geometry.positions.push_back(center + radius * glm::vec3(p));
        }
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            const uint32_t a = r * columns + c, b = r * columns + (c + 1) % columns;
            geometry.triangles.emplace_back(a, b, a + columns);
            geometry.triangles.emplace_back(b, b + columns, a + columns);
        }
    return geometry;
}

class RandomPoints {
  public:
    explicit RandomPoints(uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }
    glm::dvec3 point(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
    uint32_t below(uint32_t n) { return uint32_t(engine_() % n); }

  private:
    std::mt19937_64 engine_;
};

/// Triangles of all sizes: ordinary ones, slivers, needles, axis-parallel ones, degenerate ones, copies of others.
inline Geometry soup(uint32_t count, uint64_t seed, const glm::vec3& center = glm::vec3(0), float scale = 1) {
    Geometry geometry;
    RandomPoints random(seed);
    const auto place = [&](const glm::dvec3& p) { return center + scale * glm::vec3(p); };
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 a = random.point(1), along = random.point(0.3);
        glm::dvec3 b = a + along, c = a + random.point(0.3);
        switch (i % 8) {
            case 1:
                c = a + 0.7 * along + random.point(1e-4);
                break;  // a sliver
            case 2:
                c = a + 0.7 * along + random.point(1e-7);
                break;  // of about one ulp
            case 3:
                b.y = c.y = a.y;
                break;
            case 4:
                b = a + random.point(1e-3), c = a + random.point(1e-3);
                break;
            case 5:
                c = b;
                break;  // no area
            case 6:
                if (i > 8) {
                    const uint32_t old = random.below(i - 1);
                    geometry.triangles.push_back(geometry.triangles[old]);
                    continue;
                }
                break;
            default:
                break;
        }
        add_triangle(geometry, place(a), place(b), place(c));
    }
    return geometry;
}

}  // namespace peelray
