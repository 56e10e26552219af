// Texture lookups in double or single precision (T), by the rules of shaders/common/textures.glsl.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/scene.h"

namespace peelray {

/// Bilinear between the four values around `p` (values lie at half-integers); `fetch`: the value at column x, row y.
template <typename T, typename Fetch>
auto bilinear(const glm::vec<2, T>& p, Fetch fetch) {
    const glm::vec<2, T> q = p - T(0.5), f = q - glm::floor(q);
    const int x = int(std::floor(q.x)), y = int(std::floor(q.y));
    return glm::mix(glm::mix(fetch(x, y), fetch(x + 1, y), f.x), glm::mix(fetch(x, y + 1), fetch(x + 1, y + 1), f.x),
                    f.y);
}

/// The same at a place in [0, 1]² of an equirectangular picture, whose columns go round; `texel(i)`: counted row by
/// row.
template <typename T, typename Texel>
auto bilinear_around(const glm::vec<2, T>& place, uint32_t width, uint32_t height, Texel texel) {
    return bilinear(place * glm::vec<2, T>(width, height), [&](int x, int y) {
        const int column = x < 0 ? x + int(width) : x >= int(width) ? x - int(width) : x;
        return texel(size_t(std::clamp(y, 0, int(height) - 1)) * width + size_t(column));
    });
}

/// Linear colour of one level; `nearest`: of the nearest texel, else bilinear.
template <typename T>
glm::vec<3, T> sample_color(const Texture& texture, const glm::vec<2, T>& uv, bool nearest);
/// The same of all channels as they are stored, [0, 1].
template <typename T>
glm::vec<4, T> sample_data(const Texture& texture, const glm::vec<2, T>& uv, bool nearest);
/// Alpha, magnified as the texture says.
double sample_alpha(const Texture& texture, const glm::dvec2& uv);

/// The least value of a channel; 1 for a texture without texels.
double least_value(const Texture& texture, uint32_t channel);
/// The greatest; 0 for a texture without texels.
double greatest_value(const Texture& texture, uint32_t channel);

}  // namespace peelray
