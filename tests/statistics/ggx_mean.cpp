#include "statistics/ggx_mean.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace peelray {

double ggx_mean(double cosine, double roughness, const std::function<double(double)>& value) {
    const double alpha = roughness * roughness, sine = std::sqrt(1 - cosine * cosine);
    const auto lambda = [&](double c) { return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2; };
    constexpr int rings = 240, sectors = 120;
    double turns[sectors], sum = 0;
    for (int k = 0; k < sectors; k++) turns[k] = std::cos((k + 0.5) / sectors * std::numbers::pi);
    for (int i = 0; i < rings; i++) {
        const double t = (i + 0.5) / rings, u = 1 - t * t, c = 1 / std::sqrt(1 + alpha * alpha * u / (1 - u));
        for (int k = 0; k < sectors; k++) {
            const double v_h = sine * std::sqrt(1 - c * c) * turns[k] + cosine * c;
            const double n_l = 2 * v_h * c - cosine;
            if (v_h > 0 && n_l > 0)
                sum +=
                    2 * t * value(std::min(v_h, 1.0)) * v_h / (c * cosine * (1 + lambda(cosine)) * (1 + lambda(n_l)));
        }
    }
    return sum / (rings * sectors);
}

}  // namespace peelray
