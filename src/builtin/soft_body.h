// Bodies of round pieces that flow into each other: distance fields with soft unions (Hart, Sphere Tracing, 1996; the
// blend is Quilez' quadratic one). Private to src/builtin.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// The smaller of both, with a bend of radius about `blend` where they meet; exact where they differ by more.
inline float soft_min(float a, float b, float blend) {
    const float h = std::max(blend - std::abs(a - b), 0.f);
    return std::min(a, b) - (blend > 0 ? h * h / (4 * blend) : 0.f);
}

inline float soft_max(float a, float b, float blend) {
    return -soft_min(-a, -b, blend);
}

/// A round cone: the hull of two balls. Or a ring: a torus around `axis`.
struct Piece {
    glm::vec3 a, b;  ///< the balls' centres; a ring's centre and axis (unit)
    float ra, rb;    ///< the balls' radii; a ring's radius and that of its tube
    /// Stretches space around `a` before measuring: (1, 1, 1.25) makes a piece that is a fifth thinner along z. At
    /// least 1 each.
    glm::vec3 thin{1};
    bool is_ring = false;
    float blend = 0.03f;  ///< with the group's pieces before it

    /// Negative inside; never more than the distance outside.
    float at(const glm::vec3& p) const;
};

inline Piece ball(const glm::vec3& center, float radius, const glm::vec3& thin = glm::vec3(1)) {
    return {center, center, radius, radius, thin};
}
inline Piece cone(const glm::vec3& a, float ra, const glm::vec3& b, float rb, const glm::vec3& thin = glm::vec3(1)) {
    return {a, b, ra, rb, thin};
}
inline Piece ring(const glm::vec3& center, const glm::vec3& axis, float radius, float tube,
                  const glm::vec3& thin = glm::vec3(1)) {
    return {center, glm::normalize(axis), radius, tube, thin, true};
}

/// Pieces that flow into each other, cut off by planes.
struct SoftGroup {
    struct Cut {
        glm::vec3 outwards;  ///< unit
        float offset;        ///< what lies beyond dot(outwards, p) = offset is gone
        float blend;         ///< roundness of the edge
    };
    uint32_t part = 0;    ///< what it belongs to
    float seam = 0.006f;  ///< blend with the groups before
    std::vector<Piece> pieces;
    std::vector<Cut> cuts;

    float at(const glm::vec3& p) const;
    /// Precomputes the box outside of which `at` need not be called.
    void measure();
    /// Less than what `at` gives, and cheap; measure() must have been called.
    float at_least(const glm::vec3& p) const;

    glm::vec3 lower{0}, upper{0};  ///< by measure()
    float thinnest = 1;            ///< by measure()
};

/// Groups side by side.
struct SoftBody {
    std::vector<SoftGroup> groups;

    float at(const glm::vec3& p) const;
    /// Of one part alone, as if the others were not there.
    float at(uint32_t part, const glm::vec3& p) const;
    /// The part whose surface is nearest.
    uint32_t part_at(const glm::vec3& p) const;
    /// Negative where `part` is nearer than any other: 0 on the line where they meet.
    float margin(uint32_t part, const glm::vec3& p) const;
};

}  // namespace peelray
