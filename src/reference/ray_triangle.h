// One ray against one triangle in double precision. Private to src/reference.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "reference/oracle.h"

namespace peelray {

/// The triangles that can be hit, as the oracle sees them. Degenerate (exactly zero area), out-of-range and non-finite
/// ones are left out, all others keep their index in `ids`.
struct TriangleSet {
    explicit TriangleSet(const Geometry& geometry);

    std::vector<std::array<glm::vec3, 3>> corners;
    std::vector<uint32_t> ids;  ///< ascending
    glm::dvec3 lower{0}, upper{0};
    double diagonal = 0;
};

/// A legal ray made ready for the intersection. The direction is scaled by a power of two, which is exact, so that
/// neither 10⁻³⁰⁰ nor 10³⁰⁰ overflows; a distant origin is moved along the ray to the scene, so that the subtraction
/// "vertex - origin" keeps its digits.
class PreparedRay {
  public:
    /// Nothing if the ray misses by definition: NaN, infinite origin or direction, zero direction, tmin ≥ tmax.
    static std::optional<PreparedRay> make(const OracleRay& ray, const TriangleSet& scene);

    /// Watertight (Woop, Benthin, Wald: "Watertight Ray/Triangle Intersection", JCGT 2013): vertices are sheared into
    /// the ray's own frame, one and the same way for every triangle that has them, so two triangles never part at an
    /// edge that they share. Edges and vertices belong to the triangle. Both sides count. `triangle` stays ~0u on a
    /// miss.
    bool intersect(const std::array<glm::vec3, 3>& corners, OracleHit& hit) const;

    /// A vertex in the ray's frame: the ray is the axis x = y = 0, z the distance in `scaled` direction lengths.
    glm::dvec3 sheared(const glm::vec3& vertex) const;

    glm::dvec3 origin;     ///< moved near the scene
    glm::dvec3 direction;  ///< scaled: its largest component is in [0.5, 1)
    double start = 0;      ///< the scaled t of `origin` on the ray as it was given
    int exponent = 0;      ///< t = scaled t · 2^-exponent
    double tmin = 0, tmax = std::numeric_limits<double>::infinity();  ///< as given

  private:
    int kx_ = 0, ky_ = 1, kz_ = 2;
    double sx_ = 0, sy_ = 0, sz_ = 1;
};

/// Where the ray is inside a box: scaled t, from `PreparedRay::origin`. Empty if first > second.
std::pair<double, double> clip(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& lower,
                               const glm::dvec3& upper);

}  // namespace peelray
