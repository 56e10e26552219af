// Arcs of directions on an environment map. Private to src/reference.
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/real.h"

namespace peelray::inline PRECISION {

#ifdef PEELRAY_SINGLE
// Polynomials of the least greatest error, 2.4e-7 with their rounding: a map of 4096 columns has steps of 1.5e-3. The C
// library's functions took a twelfth of a picture's time.

inline real arc_cosine(real x) {
    const real a = std::abs(x);
    const real root =
        std::sqrt(std::max(0.0, 1 - a)) *
        (1.57079625 +
         a * (-0.2145988 +
              a * (0.08897905 +
                   a * (-0.05017471 + a * (0.030893033 + a * (-0.01708978 + a * (0.0066712713 - a * 0.0012628246)))))));
    return x < 0 ? 3.14159265358979323846 - root : root;
}

/// As std::atan2; of nothing 0.
inline real arc_tangent(real y, real x) {
    const real ax = std::abs(x), ay = std::abs(y), least = std::min(ax, ay), most = std::max(ax, ay);
    const real t = most > 0 ? least / most : 0, s = t * t;
    real arc =
        t *
        (0.9999995 +
         s * (-0.33330348 +
              s * (0.19951117 +
                   s * (-0.1392834 + s * (0.096872173 + s * (-0.05647225 + s * (0.022221543 - s * 0.0041471426)))))));
    if (ay > ax) arc = 1.57079632679489661923 - arc;
    if (x < 0) arc = 3.14159265358979323846 - arc;
    return y < 0 ? -arc : arc;
}
#else
inline real arc_cosine(real x) {
    return std::acos(x);
}
inline real arc_tangent(real y, real x) {
    return std::atan2(y, x);
}
#endif

}  // namespace peelray::inline PRECISION
