// Writes the tables of shaders/path/tables.h as a C++ header: tabulate OUTPUT. Run by the build.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "path/shading_numbers.h"
#include "path/tables.h"

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

void write(std::FILE* file, const Powers& p) {
    std::fprintf(file, "    {%.7ff, %.7ff, %.7ff, %.7ff},\n", p[0], p[1], p[2], p[3]);
}

void write_split_sum(std::FILE* file) {
    for (int r = 0; r < SPLIT_SUM_SIDE; r++)
        for (int c = 0; c < SPLIT_SUM_SIDE; c++) {
            const double roughness = squared(r / (SPLIT_SUM_SIDE - 1.0));
            const double cosine = std::max(GRAZING_COSINE, squared(c / (SPLIT_SUM_SIDE - 1.0)));
            // Without roughness every microfacet is the surface.
            write(file, r == 0 ? powers(cosine) : mean(squared(roughness), cosine));
        }
}

/// Λ of the sheen's masking, by its authors' fit.
double sheen_lambda(double cosine, double alpha) {
    cosine = std::min(cosine, 1.0);
    const double part = squared(1 - alpha);
    const auto mixed = [&](double soft, double hard) { return part * soft + (1 - part) * hard; };
    const double a = mixed(25.3245, 21.5473), b = mixed(3.32435, 3.82987), c = mixed(0.16801, 0.19823),
                 d = mixed(-1.27393, -1.97760), e = mixed(-4.85967, -4.32054);
    const auto l = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    return cosine < 0.5 ? std::exp(l(cosine)) : std::exp(2 * l(0.5) - l(1 - cosine));
}

/// Share of white light that a white sheen reflects: the midpoint rule over half vectors. Their density times the solid
/// angle is even in t = sine^(2 + 1/alpha) but for one over the cosine, which rings that crowd at t = 1 make up for.
double sheen(double alpha, double cosine) {
    constexpr int rings = 192, sectors = 24;
    const double sine = std::sqrt(1 - cosine * cosine), power = 2 + 1 / alpha;
    double sum = 0;
    for (int i = 0; i < rings; i++) {
        const double u = (i + 0.5) / rings, s = std::pow(1 - u * u, 1 / power), up = std::sqrt(1 - s * s);
        for (int k = 0; k < sectors; k++) {
            const double v_h = sine * s * std::cos(std::numbers::pi * (k + 0.5) / sectors) + cosine * up;
            const double n_l = 2 * v_h * up - cosine;
            if (v_h <= 0 || n_l <= 0) continue;
            const double visible =
                1 / ((1 + sheen_lambda(cosine, alpha) + sheen_lambda(n_l, alpha)) * 4 * cosine * n_l);
            sum += visible * n_l * 4 * v_h * 2 * u / (up * rings * sectors);
        }
    }
    return std::min(sum, 1.0);
}

void write_sheen(std::FILE* file) {
    for (int r = 0; r < SHEEN_SIDE; r++)
        for (int c = 0; c < SHEEN_SIDE; c++) {
            const double roughness = std::max(SHEEN_LEAST_ROUGHNESS, squared(r / (SHEEN_SIDE - 1.0)));
            const double cosine = std::max(GRAZING_COSINE, squared(c / (SHEEN_SIDE - 1.0)));
            write(file, {sheen(squared(roughness), cosine)});
        }
}

/// A lobe of the fit to the eye's colour matching functions (Wyman, Sloan, Shirley: Simple Analytic Approximations to
/// the CIE XYZ Color Matching Functions, JCGT 2013).
double lobe(double wavelength, double height, double middle, double below, double above) {
    return height * std::exp(-0.5 * squared((wavelength - middle) / (wavelength < middle ? below : above)));
}

/// What red, green and blue of Rec. 709 see of a wavelength (nm).
std::array<double, 3> response(double w) {
    const double x =
        lobe(w, 1.056, 599.8, 37.9, 31.0) + lobe(w, 0.362, 442.0, 16.0, 26.7) + lobe(w, -0.065, 501.1, 20.4, 26.2);
    const double y = lobe(w, 0.821, 568.8, 46.9, 40.5) + lobe(w, 0.286, 530.9, 16.3, 31.1);
    const double z = lobe(w, 1.217, 437.0, 11.8, 36.0) + lobe(w, 0.681, 459.0, 26.0, 13.8);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

void write_film(std::FILE* file) {
    for (int i = 0; i < FILM_ENTRIES; i++) {
        Powers sum{};
        std::array<double, 3> whole{};
        for (double w = 380.5; w < 780; w++) {
            const std::array<double, 3> seen = response(w);
            for (size_t c = 0; c < 3; c++) {
                sum[c] += seen[c] * std::cos(2 * std::numbers::pi * i * FILM_STEP / w);
                whole[c] += seen[c];
            }
        }
        for (size_t c = 0; c < 3; c++) sum[c] /= whole[c];
        write(file, sum);
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    std::FILE* file = std::fopen(arguments[1], "w");
    if (!file) return 1;
    std::fprintf(file,
                 "// Made by tabulate: see path/tables.h.\n#pragma once\n\nnamespace peelray {\n\n"
                 "inline constexpr float kTables[][4] = {\n");
    write_split_sum(file);
    write_sheen(file);
    write_film(file);
    std::fprintf(file, "};\n\n}  // namespace peelray\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
