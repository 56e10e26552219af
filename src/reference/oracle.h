// The oracle: what a ray hits, in double precision, on the CPU.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray {

struct OracleRay {
    glm::dvec3 origin;
    double tmin;
    glm::dvec3 direction;  ///< any length; t counts in its lengths
    double tmax;
};

struct OracleHit {
    double t;           ///< +inf: a miss
    uint32_t triangle;  ///< ~0u: a miss
    double u, v;        ///< barycentric weights of the second and third vertex
    bool hit() const { return triangle != ~0u; }
};

/// What a checked answer turned out to be.
enum class Verdict {
    same,           ///< the double-precision answer for the ray itself
    within_offset,  ///< the answer of a ray within the allowed parallel offset
    wrong,
};

/// Double-precision ray casting: Embree 3 (robust mode) finds candidate triangles, each is intersected again in double.
class Oracle {
  public:
    /// `alpha`: where the geometry has holes; `sides`: from which sides it is there.
    explicit Oracle(const Geometry& geometry, const AlphaTest& alpha = {}, const Sidedness& sides = {});
    ~Oracle();
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;

    /// The nearest hit with tmin < t < tmax. A ray with NaN, a zero direction or tmin ≥ tmax misses.
    /// `skip`: a triangle that does not count (~0u: none).
    OracleHit closest(const OracleRay& ray, uint32_t skip = ~0u) const;

    /// Is `t` (+inf: a miss), `triangle` a right answer for `ray`? Right when the ray
    /// itself, or one within 2·10⁻⁶ of the scene's diagonal (parallel offset), has a nearest hit whose distance across
    /// the surface
    /// (|Δt|·|d|·cosine to the normal) is ≤ 10⁻⁵ of the diagonal; misses must agree likewise.
    Verdict check(const OracleRay& ray, double t, uint32_t triangle) const;

    /// The same for an any-hit answer (`occluded`): right when the ray or an offset ray is occluded likewise.
    Verdict check_any(const OracleRay& ray, bool occluded) const;

    double diagonal() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The same answer as Oracle::closest() from a loop over all triangles, without Embree: what tests compare the oracle
/// with.
OracleHit closest_brute_force(const Geometry& geometry, const OracleRay& ray, uint32_t skip = ~0u,
                              const AlphaTest& alpha = {}, const Sidedness& sides = {});

}  // namespace peelray
