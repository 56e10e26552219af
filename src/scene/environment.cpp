#include "scene/environment.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"

namespace peelray {
namespace {

/// Appends the coarser levels down to a height of 4 rows: box filters of the level before.
void add_levels(Environment& environment) {
    uint32_t width = environment.width, height = environment.height;
    size_t offset = 0;
    environment.levels = 1;
    while (height > 4) {
        const uint32_t w = std::max(width / 2, 1u), h = std::max(height / 2, 1u);
        const size_t next = offset + size_t(width) * height;
        environment.texels.resize(next + size_t(w) * h);
        for (uint32_t y = 0; y < h; y++)
            for (uint32_t x = 0; x < w; x++) {
                glm::vec4 sum(0);
                for (uint32_t i = 0; i < 4; i++) {
                    const uint32_t sx = std::min(2 * x + (i & 1), width - 1),
                                   sy = std::min(2 * y + (i >> 1), height - 1);
                    sum += environment.texels[offset + size_t(sy) * width + sx];
                }
                environment.texels[next + size_t(y) * w + x] = sum * 0.25f;
            }
        offset = next;
        width = w;
        height = h;
        environment.levels++;
    }
}

/// Directions to the texels' middles, as environment_direction() has them, whose sines and cosines are those of rows
/// and columns: for each texel they took half of what it takes to read a picture.
class TexelDirections {
  public:
    TexelDirections(uint32_t width, uint32_t height) : columns_(width), rows_(height) {
        for (uint32_t x = 0; x < width; x++) {
            const float phi = ((x + 0.5f) / width - 0.5f) * 2 * kPi;
            columns_[x] = {std::sin(phi), std::cos(phi)};
        }
        for (uint32_t y = 0; y < height; y++) {
            const float theta = (y + 0.5f) / height * kPi;
            rows_[y] = {std::sin(theta), std::cos(theta)};
        }
    }
    glm::vec3 operator()(uint32_t x, uint32_t y) const {
        return {rows_[y].x * columns_[x].x, rows_[y].y, -rows_[y].x * columns_[x].y};
    }

  private:
    std::vector<glm::vec2> columns_, rows_;  ///< sines and cosines
};

/// Projects the finest level onto nine harmonics and convolves with the cosine; `radiance(i)` may differ from the
/// texels.
template <typename Radiance>
void project_irradiance(Environment& environment, Radiance radiance) {
    std::array<glm::dvec3, 9> sums{};
    const TexelDirections directions(environment.width, environment.height);
    for (uint32_t y = 0; y < environment.height; y++) {
        const double solid_angle =
            2 * kPi / environment.width *
            (std::cos(kPi * y / environment.height) - std::cos(kPi * (y + 1) / environment.height));
        for (uint32_t x = 0; x < environment.width; x++) {
            const glm::dvec3 d = directions(x, y);
            const glm::dvec3 light = glm::dvec3(radiance(size_t(y) * environment.width + x)) * solid_angle;
            const double basis[9] = {
                1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
            for (int i = 0; i < 9; i++) sums[i] += light * basis[i];
        }
    }
    // Squares of the harmonics' constants times the cosine's band factors (pi, 2 pi/3, pi/4).
    const double c0 = 0.282094792 * 0.282094792 * kPi, c1 = 0.488602512 * 0.488602512 * 2 * kPi / 3;
    const double c2 = 1.092548431 * 1.092548431 * kPi / 4, c20 = 0.315391565 * 0.315391565 * kPi / 4,
                 c22 = 0.546274215 * 0.546274215 * kPi / 4;
    const double factors[9] = {c0, c1, c1, c1, c2, c2, c20, c2, c22};
    for (int i = 0; i < 9; i++) environment.irradiance[i] = glm::vec3(sums[i] * factors[i]);
}

Light sun_light(const glm::vec3& to_sun, const glm::vec3& irradiance) {
    Light light;
    light.name = "sun";
    light.kind = Light::Kind::directional;
    light.direction = -to_sun;
    light.color = irradiance;
    return light;
}

}  // namespace

glm::vec3 environment_direction(float u, float v) {
    const float phi = (u - 0.5f) * 2 * kPi, theta = v * kPi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

glm::vec3 default_sun_direction() {
    return glm::normalize(glm::vec3(0.55f, 0.75f, 0.45f));
}

Environment sky_environment(const glm::vec3& sun_direction) {
    Environment sky;
    sky.is_pyramid = true;
    sky.width = 1024;
    sky.height = 512;
    sky.texels.resize(size_t(sky.width) * sky.height);
    const glm::vec3 zenith(0.14f, 0.30f, 0.68f), horizon(0.80f, 0.86f, 0.94f), haze(0.60f, 0.64f, 0.68f),
        ground(0.24f, 0.25f, 0.26f), glow(1.0f, 0.85f, 0.62f);
    for (uint32_t y = 0; y < sky.height; y++)
        for (uint32_t x = 0; x < sky.width; x++) {
            const glm::vec3 d = environment_direction((x + 0.5f) / sky.width, (y + 0.5f) / sky.height);
            const float height = std::max(d.y, 0.0f);
            glm::vec3 color = glm::mix(horizon, zenith, std::pow(height, 0.45f));
            // Haze: the horizon blends into the ground over about a degree, so that it does not alias.
            const glm::vec3 below = glm::mix(haze, ground, std::pow(std::max(-d.y, 0.0f), 0.5f));
            color = glm::mix(color, below, glm::smoothstep(0.0f, 1.0f, std::clamp(-d.y / 0.02f, 0.0f, 1.0f)));
            const float near_sun = std::max(glm::dot(d, sun_direction), 0.0f);
            if (d.y > -0.02f) color += glow * (0.25f * std::pow(near_sun, 24.0f) + 0.6f * std::pow(near_sun, 400.0f));
            sky.texels[size_t(y) * sky.width + x] = glm::vec4(color, 1);
        }
    project_irradiance(sky, [&](size_t i) { return glm::vec3(sky.texels[i]); });
    add_levels(sky);
    const glm::vec3 irradiance = 3.6f * glm::vec3(1.0f, 0.93f, 0.82f);
    const float radius =
        0.6f * kPi / 180;  // about twice the real sun: its mirror image stays visible at one sample per pixel
    sky.sun_direction = sun_direction;
    sky.sun_cosine = std::cos(radius);
    sky.sun_radiance = irradiance / (kPi * radius * radius);
    sky.lights.push_back(sun_light(sun_direction, irradiance));
    sky.lights.back().radius = radius;
    return sky;
}

Environment color_environment(const glm::vec3& radiance) {
    Environment environment;
    environment.width = 8;
    environment.height = 4;
    environment.texels.assign(32, glm::vec4(radiance, 1));
    environment.irradiance[0] = kPi * radiance;
    add_levels(environment);
    return environment;
}

Environment image_environment(uint32_t width, uint32_t height, std::span<const glm::vec4> pixels) {
    return image_environment(width, height, std::vector<glm::vec4>(pixels.begin(), pixels.end()));
}

Environment image_environment(uint32_t width, uint32_t height, std::vector<glm::vec4>&& pixels_given) {
    Environment environment;
    environment.is_image = environment.is_pyramid = true;
    environment.width = width;
    environment.height = height;
    environment.texels = std::move(pixels_given);
    const std::span<const glm::vec4> pixels = environment.texels;
    const auto brightness = [&](size_t i) {
        return pixels[i].x * 0.2126f + pixels[i].y * 0.7152f + pixels[i].z * 0.0722f;
    };

    double mean = 0, area = 0;
    size_t brightest = 0;
    std::vector<double> solid_angles;  // of rows
    for (double y = 0; y < height; y++)
        solid_angles.push_back(2 * kPi / width * (std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height)));
    const auto solid_angle = [&](size_t i) { return solid_angles[i / width]; };
    for (size_t i = 0; i < pixels.size(); i++) {
        mean += brightness(i) * solid_angle(i);
        area += solid_angle(i);
        if (brightness(i) > brightness(brightest)) brightest = i;
    }
    mean /= area;
    const TexelDirections directions(width, height);
    const auto direction = [&](size_t i) { return directions(uint32_t(i % width), uint32_t(i / width)); };
    // A spot counts as a sun when it is 40 times brighter than the mean: windows and bright clouds are not.
    const float threshold = float(mean) * 40;
    std::vector<bool> taken(pixels.size(), false);
    if (brightness(brightest) > threshold) {
        const glm::vec3 centre = direction(brightest);
        glm::dvec3 irradiance(0), toward(0);
        for (size_t i = 0; i < pixels.size(); i++) {
            if (brightness(i) < threshold * 0.25f || glm::dot(direction(i), centre) < 0.99f) continue;
            taken[i] = true;
            irradiance += glm::dvec3(pixels[i]) * solid_angle(i);
            toward += glm::dvec3(direction(i)) * (double(brightness(i)) * solid_angle(i));
        }
        environment.lights.push_back(sun_light(glm::vec3(glm::normalize(toward)), glm::vec3(irradiance)));
        environment.rough_limit = threshold * 0.25f;
    }
    project_irradiance(environment, [&](size_t i) { return taken[i] ? glm::vec3(float(mean)) : glm::vec3(pixels[i]); });
    add_levels(environment);
    return environment;
}

}  // namespace peelray
