#include "scene/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/encoding.h"

namespace peelray {
namespace {

/// `i`: from one before the first texel to one behind twice as many as there are. No division: it takes as long as all
/// else.
int wrap(int i, int size, Texture::Wrap mode) {
    if (mode == Texture::Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = mode == Texture::Wrap::repeat ? size : 2 * size;
    if (i < 0) i += period;
    while (i >= period) i -= period;
    return i < size ? i : period - 1 - i;
}

/// Of all that 8 bits can hold.
template <typename T>
std::array<T, 256> make_linear_values() {
    std::array<T, 256> values;
    for (int i = 0; i < 256; i++) values[size_t(i)] = T(srgb_to_linear(i / 255.0));
    return values;
}

/// Channel `i` of a texel, [0, 1].
double channel_of(const Texture& texture, size_t texel, uint32_t i) {
    if (!texture.deep_texels.empty()) return double(texture.deep_texels[texel] >> (16 * i) & 0xFFFF) / 65535.0;
    return (texture.texels[texel] >> (8 * i) & 255) / 255.0;
}

template <typename T, typename Decode>
auto sample(const Texture& texture, const glm::vec<2, T>& uv, bool nearest, Decode decode) {
    const auto fetch = [&](int x, int y) {
        const auto column = size_t(wrap(x, int(texture.width), texture.wrap_u));
        const auto row = size_t(wrap(y, int(texture.height), texture.wrap_v));
        return decode(row * texture.width + column);
    };
    // Repeats are dropped, so that any coordinate fits an int.
    const auto place = [](T x, Texture::Wrap mode) {
        return mode == Texture::Wrap::clamp ? std::clamp(x, T(0), T(1)) : x - 2 * std::floor(x / 2);
    };
    const glm::vec<2, T> p(place(uv.x, texture.wrap_u) * T(texture.width),
                           place(uv.y, texture.wrap_v) * T(texture.height));
    if (nearest) return fetch(int(std::floor(p.x)), int(std::floor(p.y)));
    return bilinear(p, fetch);
}

}  // namespace

template <typename T>
glm::vec<3, T> sample_color(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    if (!texture.deep_texels.empty())
        return sample(texture, uv, nearest, [&](size_t texel) {
            const auto channel = [&](uint32_t i) { return T(srgb_to_linear(channel_of(texture, texel, i))); };
            return glm::vec<3, T>(channel(0), channel(1), channel(2));
        });
    static const std::array<T, 256> values = make_linear_values<T>();
    return sample(texture, uv, nearest, [&](size_t texel) {
        const uint32_t all = texture.texels[texel];
        return glm::vec<3, T>(values[all & 255], values[all >> 8 & 255], values[all >> 16 & 255]);
    });
}

template <typename T>
glm::vec<4, T> sample_data(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    if (!texture.deep_texels.empty())
        return sample(texture, uv, nearest, [&](size_t texel) {
            const auto channel = [&](uint32_t i) { return T(channel_of(texture, texel, i)); };
            return glm::vec<4, T>(channel(0), channel(1), channel(2), channel(3));
        });
    // The sum of the weights is 1: the division may come last.
    const glm::vec<4, T> sum = sample(texture, uv, nearest, [&](size_t texel) {
        const uint32_t all = texture.texels[texel];
        return glm::vec<4, T>(T(all & 255), T(all >> 8 & 255), T(all >> 16 & 255), T(all >> 24));
    });
    return sum / T(255);
}

template glm::vec3 sample_color(const Texture&, const glm::vec2&, bool);
template glm::dvec3 sample_color(const Texture&, const glm::dvec2&, bool);
template glm::vec4 sample_data(const Texture&, const glm::vec2&, bool);
template glm::dvec4 sample_data(const Texture&, const glm::dvec2&, bool);

double sample_alpha(const Texture& texture, const glm::dvec2& uv) {
    return sample(texture, uv, texture.nearest, [&](size_t texel) { return channel_of(texture, texel, 3); });
}

double least_value(const Texture& texture, uint32_t channel) {
    double least = 1;
    const size_t count = std::max(texture.texels.size(), texture.deep_texels.size());
    for (size_t i = 0; i < count && least > 0; i++) least = std::min(least, channel_of(texture, i, channel));
    return least;
}

double greatest_value(const Texture& texture, uint32_t channel) {
    double greatest = 0;
    const size_t count = std::max(texture.texels.size(), texture.deep_texels.size());
    for (size_t i = 0; i < count && greatest < 1; i++) greatest = std::max(greatest, channel_of(texture, i, channel));
    return greatest;
}

}  // namespace peelray
