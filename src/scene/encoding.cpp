#include "scene/encoding.h"

#include <algorithm>
#include <cmath>

namespace peelray {

double srgb_to_linear(double c) {
    return c > 0.04045 ? std::pow((c + 0.055) / 1.055, 2.4) : c / 12.92;
}

double linear_to_srgb(double c) {
    return c > 0.0031308 ? 1.055 * std::pow(c, 1 / 2.4) - 0.055 : c * 12.92;
}

namespace {

/// Narkowicz, "ACES filmic tone mapping curve", 2015.
glm::dvec3 aces(const glm::dvec3& c) {
    return (c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14);
}

/// Khronos PBR neutral tone mapper, 2024.
glm::dvec3 neutral(glm::dvec3 c) {
    const double darkest = std::min({c.x, c.y, c.z});
    c -= darkest < 0.08 ? darkest - 6.25 * darkest * darkest : 0.04;
    const double peak = std::max({c.x, c.y, c.z}), start = 0.76, room = 1 - start;
    if (peak < start) return c;
    const double compressed = 1 - room * room / (peak + room - start);
    const double white = 1 - 1 / (0.15 * (peak - compressed) + 1);
    return glm::mix(c * (compressed / peak), glm::dvec3(compressed), white);
}

}  // namespace

glm::dvec3 tone_curve(glm::dvec3 color, Tonemap tonemap) {
    if (tonemap == Tonemap::aces) color = aces(color);
    if (tonemap == Tonemap::neutral) color = neutral(color);
    return glm::clamp(color, 0.0, 1.0);
}

uint32_t encode(const glm::dvec3& radiance, double exposure, Tonemap tonemap, const glm::dvec3& unlit) {
    const glm::dvec3 color = glm::clamp(tone_curve(radiance * std::exp2(exposure), tonemap) + unlit, 0.0, 1.0);
    uint32_t encoded = 0xff000000u;
    for (int i = 0; i < 3; i++) encoded |= uint32_t(std::lround(linear_to_srgb(color[i]) * 255)) << (8 * i);
    return encoded;
}

uint32_t encode_straight(const glm::dvec3& radiance, double alpha, double exposure, Tonemap tonemap,
                         const glm::dvec3& unlit) {
    alpha = std::clamp(alpha, 0.0, 1.0);
    if (alpha == 0) return 0;
    return (encode(radiance / alpha, exposure, tonemap, unlit / alpha) & 0xffffffu) | uint32_t(std::lround(alpha * 255))
                                                                                          << 24;
}

}  // namespace peelray
