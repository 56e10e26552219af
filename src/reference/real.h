// The precision of the CPU tracer. Its sources are compiled twice: the reference in double, `cpu` in single precision
// (PEELRAY_SINGLE, where the compiler takes constants as single, too). Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "path/shading_numbers.h"

#ifdef PEELRAY_SINGLE
#define PRECISION in_single
#else
#define PRECISION in_double
#endif

namespace peelray::inline PRECISION {

#ifdef PEELRAY_SINGLE
using real = float;
inline constexpr bool is_reference = false;
/// Bounds on rounding errors: of a point in a triangle over the largest coordinate of its corners, of the distance to
/// it over itself.
inline constexpr real position_rounding = POSITION_ROUNDING, distance_rounding = DISTANCE_ROUNDING;
#else
using real = double;
inline constexpr bool is_reference = true;
/// Some thousand times the rounding of a sum of three, which counts in the corners.
inline constexpr real position_rounding = 1e-12, distance_rounding = 0;
#endif

using Vec2 = glm::vec<2, real>;
using Vec3 = glm::vec<3, real>;
using Vec4 = glm::vec<4, real>;
using Mat2 = glm::mat<2, 2, real>;
using Mat2x3 = glm::mat<2, 3, real>;

inline constexpr real endless = std::numeric_limits<real>::infinity();
/// The largest number below 1.
inline constexpr real below_one = 1 - std::numeric_limits<real>::epsilon() / 2;

inline real square(real x) {
    return x * x;
}

}  // namespace peelray::inline PRECISION
