// Texture lookups in double or single precision (T), by the rules of shaders/common/textures.glsl.
#pragma once

#include <algorithm>
#include <array>
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
    const glm::vec<2, T> q = place * glm::vec<2, T>(width, height) - T(0.5), low = glm::floor(q), f = q - low;
    const auto column = [&](int x) { return size_t(x < 0 ? x + int(width) : x >= int(width) ? x - int(width) : x); };
    const auto row = [&](int y) { return size_t(std::clamp(y, 0, int(height) - 1)) * width; };
    const size_t left = column(int(low.x)), right = column(int(low.x) + 1), upper = row(int(low.y)),
                 lower = row(int(low.y) + 1);
    return glm::mix(glm::mix(texel(upper + left), texel(upper + right), f.x),
                    glm::mix(texel(lower + left), texel(lower + right), f.x), f.y);
}

/// Of all that 8 bits can hold.
template <typename T>
const std::array<T, 256>& linear_values();

/// The texel that a column or row stands for. `i`: from one before the first texel to one behind twice as many as there
/// are. No division: it takes as long as all else.
inline int wrapped(int i, int size, Texture::Wrap mode) {
    if (mode == Texture::Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = mode == Texture::Wrap::repeat ? size : 2 * size;
    if (i < 0) i += period;
    while (i >= period) i -= period;
    return i < size ? i : period - 1 - i;
}

/// Between the four texels around a place, or of the nearest; `texel(i)`: counted row by row.
template <typename T, typename Texel>
auto sample(const Texture& texture, const glm::vec<2, T>& uv, bool nearest, Texel texel) {
    const int width = int(texture.width), height = int(texture.height);
    // Repeats are dropped, so that any coordinate fits an int.
    const auto place = [](T x, Texture::Wrap mode) {
        return mode == Texture::Wrap::clamp ? std::clamp(x, T(0), T(1)) : x - 2 * std::floor(x / 2);
    };
    const auto column = [&](int x) { return size_t(wrapped(x, width, texture.wrap_u)); };
    const auto row = [&](int y) { return size_t(wrapped(y, height, texture.wrap_v)) * texture.width; };
    const glm::vec<2, T> p(place(uv.x, texture.wrap_u) * T(width), place(uv.y, texture.wrap_v) * T(height));
    if (nearest) return texel(row(int(std::floor(p.y))) + column(int(std::floor(p.x))));
    const glm::vec<2, T> q = p - T(0.5), low = glm::floor(q), f = q - low;
    const size_t left = column(int(low.x)), right = column(int(low.x) + 1), upper = row(int(low.y)),
                 lower = row(int(low.y) + 1);
    return glm::mix(glm::mix(texel(upper + left), texel(upper + right), f.x),
                    glm::mix(texel(lower + left), texel(lower + right), f.x), f.y);
}

/// Linear colour of one level of a texture of 16 bits a channel.
template <typename T>
glm::vec<3, T> sample_deep_color(const Texture& texture, const glm::vec<2, T>& uv, bool nearest);
template <typename T>
glm::vec<4, T> sample_deep_data(const Texture& texture, const glm::vec<2, T>& uv, bool nearest);

/// Linear colour of one level; `nearest`: of the nearest texel, else bilinear.
template <typename T>
glm::vec<3, T> sample_color(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    if (!texture.deep_texels.empty()) return sample_deep_color(texture, uv, nearest);
    const std::array<T, 256>& values = linear_values<T>();
    return sample(texture, uv, nearest, [&](size_t texel) {
        const uint32_t all = texture.texels[texel];
        return glm::vec<3, T>(values[all & 255], values[all >> 8 & 255], values[all >> 16 & 255]);
    });
}

/// The same of all channels as they are stored, [0, 1].
template <typename T>
glm::vec<4, T> sample_data(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    if (!texture.deep_texels.empty()) return sample_deep_data(texture, uv, nearest);
    // The sum of the weights is 1: the division may come last.
    const glm::vec<4, T> sum = sample(texture, uv, nearest, [&](size_t texel) {
        const uint32_t all = texture.texels[texel];
        return glm::vec<4, T>(T(int(all & 255)), T(int(all >> 8 & 255)), T(int(all >> 16 & 255)), T(int(all >> 24)));
    });
    return sum / T(255);
}

/// Alpha, magnified as the texture says.
double sample_alpha(const Texture& texture, const glm::dvec2& uv);

/// The least value of a channel; 1 for a texture without texels.
double least_value(const Texture& texture, uint32_t channel);
/// The greatest; 0 for a texture without texels.
double greatest_value(const Texture& texture, uint32_t channel);

}  // namespace peelray
