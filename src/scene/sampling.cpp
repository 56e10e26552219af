#include "scene/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/encoding.h"

namespace peelray {
namespace {

/// Channel `i` of a texel, [0, 1].
double channel_of(const Texture& texture, size_t texel, uint32_t i) {
    if (!texture.deep_texels.empty()) return double(texture.deep_texels[texel] >> (16 * i) & 0xFFFF) / 65535.0;
    return (texture.texels[texel] >> (8 * i) & 255) / 255.0;
}

}  // namespace

template <typename T>
const std::array<T, 256>& linear_values() {
    static const std::array<T, 256> values = [] {
        std::array<T, 256> values;
        for (int i = 0; i < 256; i++) values[size_t(i)] = T(srgb_to_linear(i / 255.0));
        return values;
    }();
    return values;
}

template <typename T>
glm::vec<3, T> sample_deep_color(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    return sample(texture, uv, nearest, [&](size_t texel) {
        const auto channel = [&](uint32_t i) { return T(srgb_to_linear(channel_of(texture, texel, i))); };
        return glm::vec<3, T>(channel(0), channel(1), channel(2));
    });
}

template <typename T>
glm::vec<4, T> sample_deep_data(const Texture& texture, const glm::vec<2, T>& uv, bool nearest) {
    return sample(texture, uv, nearest, [&](size_t texel) {
        const auto channel = [&](uint32_t i) { return T(channel_of(texture, texel, i)); };
        return glm::vec<4, T>(channel(0), channel(1), channel(2), channel(3));
    });
}

template const std::array<float, 256>& linear_values();
template const std::array<double, 256>& linear_values();
template glm::vec3 sample_deep_color(const Texture&, const glm::vec2&, bool);
template glm::dvec3 sample_deep_color(const Texture&, const glm::dvec2&, bool);
template glm::vec4 sample_deep_data(const Texture&, const glm::vec2&, bool);
template glm::dvec4 sample_deep_data(const Texture&, const glm::dvec2&, bool);

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
