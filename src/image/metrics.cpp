// Pixel-wise measures and SSIM. FLIP has a file of its own.
#include "image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/same_size.h"

namespace peelray {
namespace {

std::array<int, 3> channels(uint32_t pixel) {
    return {int(pixel & 255), int(pixel >> 8 & 255), int(pixel >> 16 & 255)};
}

/// Rec. 709 luma of the encoded channels, in [0, 1].
double luma(uint32_t pixel) {
    const auto [r, g, b] = channels(pixel);
    return (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255;
}

/// Gaussian of sigma 1.5, centred in a window of min(11, size) pixels, sum 1.
std::vector<double> window(uint32_t size) {
    std::vector<double> weights(std::min(11u, size));
    const double centre = 0.5 * double(weights.size() - 1);
    double sum = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        const double x = (double(i) - centre) / 1.5;
        weights[i] = std::exp(-0.5 * x * x);
        sum += weights[i];
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// The first and second moments that SSIM needs, for one row of pixels or of windows.
struct Moments {
    std::vector<double> a, b, aa, bb, ab;

    explicit Moments(size_t size) : a(size), b(size), aa(size), bb(size), ab(size) {}
};

constexpr std::array moments = {&Moments::a, &Moments::b, &Moments::aa, &Moments::bb, &Moments::ab};

void add_scaled(const double* from, double weight, std::vector<double>& to) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += weight * from[i];
}

Moments filter_row(const Image8& reference, const Image8& test, uint32_t y, const std::vector<double>& weights) {
    Moments row(reference.width), filtered(reference.width - weights.size() + 1);
    for (uint32_t x = 0; x < reference.width; ++x) {
        const size_t i = size_t(y) * reference.width + x;
        const double a = row.a[x] = luma(reference.pixels[i]), b = row.b[x] = luma(test.pixels[i]);
        row.aa[x] = a * a;
        row.bb[x] = b * b;
        row.ab[x] = a * b;
    }
    for (const auto moment : moments)
        for (size_t k = 0; k < weights.size(); ++k) add_scaled((row.*moment).data() + k, weights[k], filtered.*moment);
    return filtered;
}

/// Equation 13 of the paper for each window of a row, summed. Equal pictures give exactly 1 each.
double sum_of_ssim(const Moments& m) {
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double sum = 0;
    for (size_t i = 0; i < m.a.size(); ++i) {
        const double aa = m.a[i] * m.a[i], bb = m.b[i] * m.b[i], ab = m.a[i] * m.b[i];
        sum += (2 * ab + c1) * (2 * (m.ab[i] - ab) + c2) / ((aa + bb + c1) * ((m.aa[i] - aa) + (m.bb[i] - bb) + c2));
    }
    return sum;
}

}  // namespace

double psnr(const Image8& reference, const Image8& test) {
    check_same_size(reference, test);
    uint64_t squares = 0;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        const std::array a = channels(reference.pixels[i]), b = channels(test.pixels[i]);
        for (int c = 0; c < 3; ++c) squares += uint64_t((a[c] - b[c]) * (a[c] - b[c]));
    }
    if (squares == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255.0 * 3.0 * double(reference.pixels.size()) / double(squares));
}

double ssim(const Image8& reference, const Image8& test) {
    check_same_size(reference, test);
    const std::vector<double> across = window(reference.width), down = window(reference.height);
    const uint32_t rows = reference.height - uint32_t(down.size()) + 1;
    // The rows that the window covers, filtered across; row y lies at y modulo the window's height.
    std::vector<Moments> band(down.size(), Moments(0));
    double sum = 0;
    for (uint32_t y = 0; y < reference.height; ++y) {
        band[y % band.size()] = filter_row(reference, test, y, across);
        if (y + 1 < down.size()) continue;
        Moments windows(reference.width - across.size() + 1);
        const size_t top = y + 1 - down.size();
        for (const auto moment : moments)
            for (size_t k = 0; k < down.size(); ++k)
                add_scaled((band[(top + k) % band.size()].*moment).data(), down[k], windows.*moment);
        sum += sum_of_ssim(windows);
    }
    return sum / (double(rows) * double(reference.width - across.size() + 1));
}

double share_different(const Image8& reference, const Image8& test) {
    check_same_size(reference, test);
    size_t different = 0;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        const std::array a = channels(reference.pixels[i]), b = channels(test.pixels[i]);
        different += std::abs(a[0] - b[0]) > 1 || std::abs(a[1] - b[1]) > 1 || std::abs(a[2] - b[2]) > 1;
    }
    return double(different) / double(reference.pixels.size());
}

double ErrorMap::mean() const {
    double sum = 0;
    for (const float value : values) sum += double(value);
    return values.empty() ? 0 : sum / double(values.size());
}

Difference compare(const Image8& reference, const Image8& test) {
    Difference difference;
    difference.psnr = psnr(reference, test);
    difference.ssim = ssim(reference, test);
    difference.different = share_different(reference, test);
    difference.map = flip(reference, test);
    difference.flip = difference.map.mean();
    difference.hdr_flip = std::numeric_limits<double>::quiet_NaN();
    return difference;
}

Difference compare(const Image8& reference, const Image8& test, const Image& reference_radiance,
                   const Image& test_radiance) {
    check_same_size(reference, test);
    check_same_size(reference_radiance, test_radiance);
    check_same_size(reference, reference_radiance);
    Difference difference = compare(reference, test);
    difference.hdr_flip = hdr_flip(reference_radiance, test_radiance).mean();
    return difference;
}

}  // namespace peelray
