#include "reference/sheen.h"

#include <algorithm>
#include <cmath>

#include "path/shading_numbers.h"
#include "reference/optics.h"

namespace peelray::inline PRECISION::sheen {
namespace {

/// Their fit of what fibres hide, for the smoothest and the roughest cloth; in between the coefficients are mixed.
real hidden(real alpha, real cosine) {
    cosine = std::min(cosine, 1.0);  // beyond it by rounding
    constexpr real smooth[5] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    constexpr real rough[5] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    const real part = (1 - alpha) * (1 - alpha);
    real c[5];
    for (int i = 0; i < 5; i++) c[i] = part * smooth[i] + (1 - part) * rough[i];
    const auto exponent = [&](real x) { return c[0] / (1 + c[1] * std::pow(x, c[2])) + c[3] * x + c[4]; };
    return std::exp(cosine < 0.5 ? exponent(cosine) : 2 * exponent(0.5) - exponent(1 - cosine));
}

/// Of the fibres' ends, by the sine of their angle to the normal.
real distribution(real alpha, real n_h) {
    const real sine2 = std::max(0.0, 1 - n_h * n_h);
    return (2 + 1 / alpha) * std::pow(sine2, 1 / (2 * alpha)) / (2 * optics::pi);
}

}  // namespace

real alpha_of(real roughness) {
    const real r = std::max(roughness, SHEEN_LEAST_ROUGHNESS);
    return r * r;
}

real lobe(real alpha, real n_h, real n_v, real n_l) {
    return distribution(alpha, n_h) / ((1 + hidden(alpha, n_v) + hidden(alpha, n_l)) * 4 * n_v);
}

real albedo(real alpha, real n_v) {
    // In the root of n·l, for what grazes counts most and changes fastest; half of the circle is as the other.
    constexpr int rings = is_reference ? 128 : 32, sectors = is_reference ? 64 : 16;
    const real sine_v = std::sqrt(1 - n_v * n_v), hidden_v = hidden(alpha, n_v);
    real sum = 0;
    for (int i = 0; i < rings; i++) {
        const real t = (i + 0.5) / rings, n_l = t * t, sine_l = std::sqrt(1 - n_l * n_l);
        real ring = 0;
        for (int k = 0; k < sectors; k++) {
            const real v_l = n_v * n_l + sine_v * sine_l * std::cos(optics::pi * (k + 0.5) / sectors);
            ring += distribution(alpha, std::min(1.0, (n_v + n_l) / std::sqrt(2 + 2 * v_l)));
        }
        sum += ring * 2 * t / ((1 + hidden_v + hidden(alpha, n_l)) * 4 * n_v);
    }
    return std::min(1.0, sum * 2 * optics::pi / (rings * sectors));
}

}  // namespace peelray::inline PRECISION::sheen
