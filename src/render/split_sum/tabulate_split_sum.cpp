// Writes the table of shaders/path/split_sum.h as a C++ header: tabulate_split_sum OUTPUT. Run by the build.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "path/shading_numbers.h"
#include "path/split_sum.h"

namespace {

using Powers = std::array<double, 4>;

/// (1 - cosine)^k for the exponents of the table.
Powers powers(double cosine) {
    const double m = 1 - cosine;
    return {1, std::pow(m, SPLIT_SUM_FLAT_EXPONENT), std::pow(m, SPLIT_SUM_SCHLICK_EXPONENT),
            std::pow(m, SPLIT_SUM_STEEP_EXPONENT)};
}

/// Smith's masking of one direction.
double masking(double cosine, double alpha) {
    return 2 * cosine / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
}

/// The mean over visible normals (Heitz, JCGT 2018), by the midpoint rule on the disc that the samples come from, with
/// rings that crowd at its rim: there a smooth surface seen obliquely has its edge.
Powers mean(double alpha, double cosine) {
    constexpr int rings = 96, sectors = 96;
    const double sine = std::sqrt(1 - cosine * cosine), stretched = std::hypot(alpha * sine, cosine);
    const double x = alpha * sine / stretched, z = cosine / stretched, warp = (1 + z) / 2;
    Powers sum{};
    for (int i = 0; i < rings; i++)
        for (int k = 0; k < sectors; k++) {
            // One half of the disc: the other mirrors it.
            const double t = (i + 0.5) / rings, radius = std::sqrt(1 - t * t),
                         angle = std::numbers::pi * (k + 0.5) / sectors;
            const double across = radius * std::sin(angle), whole = std::sqrt(1 - across * across);
            const double along = (1 - warp) * whole + warp * radius * std::cos(angle);
            const double up = std::sqrt(std::max(0.0, whole * whole - along * along));
            // Of the microfacet's normal; `along` counts against the view's slope.
            const double hx = alpha * (up * x - along * z), hy = alpha * across,
                         hz = std::max(1e-6, along * x + up * z);
            const double length = std::hypot(hx, hy, hz);
            const double v_h = std::clamp((sine * hx + cosine * hz) / length, 0.0, 1.0);
            const double n_l = 2 * v_h * hz / length - cosine;
            if (n_l <= 0) continue;
            const Powers p = powers(v_h);
            for (size_t j = 0; j < 4; j++) sum[j] += p[j] * masking(n_l, alpha) * 2 * t / (rings * sectors);
        }
    return sum;
}

double squared(double x) {
    return x * x;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    std::FILE* file = std::fopen(arguments[1], "w");
    if (!file) return 1;
    std::fprintf(file,
                 "// Made by tabulate_split_sum: see path/split_sum.h.\n#pragma once\n\nnamespace peelray {\n\n"
                 "inline constexpr float kSplitSum[][4] = {\n");
    for (int r = 0; r < SPLIT_SUM_SIDE; r++)
        for (int c = 0; c < SPLIT_SUM_SIDE; c++) {
            const double roughness = squared(r / (SPLIT_SUM_SIDE - 1.0));
            const double cosine = std::max(GRAZING_COSINE, squared(c / (SPLIT_SUM_SIDE - 1.0)));
            // Without roughness every microfacet is the surface.
            const Powers p = r == 0 ? powers(cosine) : mean(squared(roughness), cosine);
            std::fprintf(file, "    {%.7ff, %.7ff, %.7ff, %.7ff},\n", p[0], p[1], p[2], p[3]);
        }
    std::fprintf(file, "};\n\n}  // namespace peelray\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
