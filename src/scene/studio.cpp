// The studio that lights files without lights: soft boxes around a backdrop, all of it grey, so that colours are the
// materials' own.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/environment.h"
#include "scene/pi.h"

namespace peelray {
namespace {

float smooth(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

/// A rectangle of light that faces the scene, upright, with soft edges.
struct SoftBox {
    glm::vec3 towards;
    glm::vec2 half;  ///< width and height at distance 1
    float radiance;

    float light(const glm::vec3& d) const {
        const glm::vec3 forward = glm::normalize(towards);
        const float ahead = glm::dot(d, forward);
        if (ahead <= 0) return 0;
        const glm::vec3 side =
            std::abs(forward.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::normalize(glm::cross(glm::vec3(0, 1, 0), forward));
        const float x = std::abs(glm::dot(d, side)) / ahead;
        const float y = std::abs(glm::dot(d, glm::cross(forward, side))) / ahead;
        // Edges of several texels, and a little less light towards them, as of a lamp behind cloth.
        constexpr float edge = 0.1f;
        const float fall = 1 - 0.25f * (x * x / (half.x * half.x) + y * y / (half.y * half.y)) / 2;
        return radiance * fall * (1 - smooth(half.x - edge, half.x + edge, x)) *
               (1 - smooth(half.y - edge, half.y + edge, y));
    }
};

/// A floor that rises into a wall: brightest where they meet, at the horizon, and darker up and down from there.
float backdrop(const glm::vec3& d) {
    const float elevation = std::asin(std::clamp(d.y, -1.f, 1.f));
    const float wall = glm::mix(0.44f, 0.20f, smooth(0, 0.45f * kPi, elevation));
    const float floor = glm::mix(0.40f, 0.16f, smooth(0, 0.5f * kPi, -elevation));
    return glm::mix(floor, wall, smooth(-0.06f, 0.10f, elevation));
}

/// One level of an equirectangular image between its texels.
struct Level {
    const glm::vec4* texels;
    uint32_t width, height;

    float at(const glm::vec3& d) const {
        const float x = (0.5f + std::atan2(d.x, -d.z) / (2 * kPi)) * float(width) - 0.5f;
        const float y = std::acos(std::clamp(d.y, -1.f, 1.f)) / kPi * float(height) - 0.5f;
        const auto column = [&](float i) { return uint32_t(int(i) + int(width)) % width; };
        const auto row = [&](float i) { return uint32_t(std::clamp(int(i), 0, int(height) - 1)); };
        const float left = std::floor(x), top = std::floor(y);
        const auto texel = [&](float i, float j) { return texels[row(j) * width + column(i)].x; };
        return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), x - left),
                        glm::mix(texel(left, top + 1), texel(left + 1, top + 1), x - left), y - top);
    }
};

std::vector<Level> levels_of(const Environment& environment) {
    std::vector<Level> levels;
    const glm::vec4* texels = environment.texels.data();
    uint32_t width = environment.width, height = environment.height;
    for (uint32_t i = 0; i < environment.levels; i++) {
        levels.push_back({texels, width, height});
        texels += size_t(width) * height;
        width /= 2;
        height /= 2;
    }
    return levels;
}

/// A direction that a rough mirror sees, beside the one that a smooth one would; z is that one.
struct Tap {
    glm::vec3 direction;
    float weight;
    size_t level;  ///< whose texels are as large as the part of the lobe that the tap stands for
};

/// Karis 2013: the lobe of GGX where the viewer looks along the normal.
std::vector<Tap> taps_of(float roughness, const std::vector<Level>& levels) {
    constexpr uint32_t rings = 8, spokes = 8;
    const float alpha2 = std::pow(roughness, 4.f);
    std::vector<Tap> taps;
    for (uint32_t i = 0; i < rings * spokes; i++) {
        const float u = (float(i / spokes) + 0.5f) / rings,
                    phi = 2 * kPi * (float(i % spokes) + 0.5f * float(i / spokes % 2)) / spokes;
        const float h = std::sqrt((1 - u) / (1 + (alpha2 - 1) * u)), z = 2 * h * h - 1;
        if (z <= 0) continue;
        const float density = alpha2 / (kPi * std::pow((alpha2 - 1) * h * h + 1, 2.f)) / 4;
        const float texels = float(levels[0].width * levels[0].height) / (4 * kPi * density * rings * spokes);
        const float level = std::clamp(0.5f * std::log2(texels) + 1, 0.f, float(levels.size() - 1));
        const float radius = std::sqrt(1 - z * z);
        taps.push_back({{radius * std::cos(phi), radius * std::sin(phi), z}, z, size_t(level)});
    }
    return taps;
}

/// A level as what a rough mirror sees: reflections then have no texels and no poles.
void blur(const Level& to, glm::vec4* texels, const std::vector<Tap>& taps, const std::vector<Level>& from) {
    parallel_for(size_t(to.width) * to.height, 256, [&](size_t i) {
        const glm::vec3 d = environment_direction((float(i % to.width) + 0.5f) / float(to.width),
                                                  (float(i / to.width) + 0.5f) / float(to.height));
        const glm::vec3 side =
            glm::normalize(glm::cross(std::abs(d.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), d));
        const glm::vec3 other = glm::cross(d, side);
        float sum = 0, weights = 0;
        for (const Tap& tap : taps) {
            const glm::vec3 t = tap.direction;
            sum += tap.weight * from[tap.level].at(t.x * side + t.y * other + t.z * d);
            weights += tap.weight;
        }
        texels[i] = glm::vec4(glm::vec3(sum / weights), 1);
    });
}

}  // namespace

Environment studio_environment() {
    static constexpr uint32_t width = 256, height = 128, blurred = 3;
    // All of them above the horizon: the framed view looks down and sees the backdrop alone.
    const SoftBox boxes[] = {
        {{-0.80f, 0.62f, 0.80f}, {0.50f, 0.46f}, 2.9f},   // key, from the left
        {{1.00f, 0.62f, 0.70f}, {0.32f, 0.46f}, 2.2f},    // fill, from the right
        {{0.00f, 1.00f, 0.10f}, {0.70f, 0.40f}, 0.7f},    // overhead
        {{-0.85f, 0.75f, -0.80f}, {0.14f, 0.50f}, 2.2f},  // rims, from behind
        {{0.90f, 0.80f, -0.75f}, {0.14f, 0.50f}, 2.2f},
    };
    std::vector<glm::vec4> pixels;
    pixels.reserve(size_t(width) * height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const glm::vec3 d = environment_direction((float(x) + 0.5f) / width, (float(y) + 0.5f) / height);
            float light = backdrop(d);
            for (const SoftBox& box : boxes) light += box.light(d);
            pixels.emplace_back(glm::vec3(light), 1);
        }
    const Environment sharp = image_environment(width, height, pixels);
    Environment studio = sharp;
    studio.is_pyramid = false;
    const std::vector<Level> from = levels_of(sharp);
    size_t offset = 0;
    for (uint32_t i = 1; i <= blurred; i++) {
        offset += size_t(from[i - 1].width) * from[i - 1].height;
        blur(from[i], &studio.texels[offset], taps_of(float(i) / blurred, from), from);
    }
    studio.levels = blurred + 1;
    studio.texels.resize(offset + size_t(from[blurred].width) * from[blurred].height);
    return studio;
}

}  // namespace peelray
