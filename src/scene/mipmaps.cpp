#include "scene/mipmaps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "scene/encoding.h"

namespace peelray {
namespace {

/// Encoded values of 16-bit linear ones and back: pow() for every texel would take longer than to read the file.
struct Curves {
    std::vector<float> linear;      ///< of encoded values of 8 or 16 bits
    std::vector<uint16_t> encoded;  ///< 16 bits, of linear ones of 18 bits

    static constexpr uint32_t steps = (1 << 18) - 1;
    explicit Curves(uint32_t most) : linear(most + 1), encoded(steps + 1) {
        for (uint32_t i = 0; i <= most; i++) linear[i] = float(srgb_to_linear(double(i) / most));
        for (uint32_t i = 0; i <= steps; i++) encoded[i] = uint16_t(linear_to_srgb(double(i) / steps) * 65535 + 0.5);
    }
};

const Curves& curves(bool deep) {
    static const Curves eight(255);
    if (!deep) return eight;
    static const Curves sixteen(65535);
    return sixteen;
}

/// What a texel of the next level covers along one side: of each up to three texels the share.
struct Cover {
    uint32_t first = 0, count = 0;
    std::array<float, 3> shares{};
};
std::vector<Cover> covers(uint32_t from, uint32_t to) {
    std::vector<Cover> out(to);
    for (uint32_t i = 0; i < to; i++) {
        const double begin = double(i) * from / to, end = double(i + 1) * from / to;
        Cover& c = out[i];
        c.first = uint32_t(begin);
        for (uint32_t k = c.first; k < from && k < end && c.count < 3; k++)
            c.shares[c.count++] = float((std::min(end, k + 1.0) - std::max(begin, double(k))) / (end - begin));
    }
    return out;
}

/// A level while the next one is made of it: linear or as stored, [0, 1].
struct Values {
    uint32_t width, height;
    std::vector<glm::vec4> texels;
};

glm::vec4 decode(const Texture& texture, size_t i, bool is_data) {
    const bool deep = !texture.deep_texels.empty();
    glm::uvec4 stored;
    for (uint32_t k = 0; k < 4; k++)
        stored[int(k)] =
            deep ? uint32_t(texture.deep_texels[i] >> (16 * k) & 0xffff) : texture.texels[i] >> (8 * k) & 255;
    const float scale = deep ? 1 / 65535.0f : 1 / 255.0f;
    if (is_data) return glm::vec4(stored) * scale;
    const std::vector<float>& linear = curves(deep).linear;
    return {linear[stored.x], linear[stored.y], linear[stored.z], float(stored.w) * scale};
}

void encode_into(Texture& texture, size_t i, const glm::vec4& value, bool is_data, bool deep) {
    glm::uvec4 stored;
    for (int k = 0; k < 4; k++) {
        const float v = std::clamp(value[k], 0.0f, 1.0f);
        uint32_t bits = uint32_t(v * 65535 + 0.5f);
        if (!is_data && k < 3) bits = curves(deep).encoded[size_t(v * float(Curves::steps) + 0.5f)];
        stored[k] = deep ? bits : (bits + 128) / 257;
    }
    if (deep)
        texture.deep_texels[i] =
            uint64_t(stored.x) | uint64_t(stored.y) << 16 | uint64_t(stored.z) << 32 | uint64_t(stored.w) << 48;
    else
        texture.texels[i] = stored.x | stored.y << 8 | stored.z << 16 | stored.w << 24;
}

/// The next level; `fetch(i)`: texel i of this one.
template <typename Fetch>
Values halved(uint32_t width, uint32_t height, Fetch fetch) {
    Values out{std::max(width / 2, 1u), std::max(height / 2, 1u), {}};
    out.texels.resize(size_t(out.width) * out.height);
    const std::vector<Cover> columns = covers(width, out.width), rows = covers(height, out.height);
    for (uint32_t y = 0; y < out.height; y++)
        for (uint32_t x = 0; x < out.width; x++) {
            glm::vec4 sum(0);
            for (uint32_t j = 0; j < rows[y].count; j++)
                for (uint32_t i = 0; i < columns[x].count; i++)
                    sum += rows[y].shares[j] * columns[x].shares[i] *
                           fetch(size_t(rows[y].first + j) * width + columns[x].first + i);
            out.texels[size_t(y) * out.width + x] = sum;
        }
    return out;
}

}  // namespace

std::vector<Texture> make_mipmaps(const Texture& texture, bool is_data) {
    std::vector<Texture> levels;
    if (texture.width * uint64_t(texture.height) <= 1) return levels;
    const bool deep = !texture.deep_texels.empty();
    Values values = halved(texture.width, texture.height, [&](size_t i) { return decode(texture, i, is_data); });
    while (true) {
        Texture level;
        level.width = values.width;
        level.height = values.height;
        level.wrap_u = texture.wrap_u;
        level.wrap_v = texture.wrap_v;
        if (deep)
            level.deep_texels.resize(values.texels.size());
        else
            level.texels.resize(values.texels.size());
        for (size_t i = 0; i < values.texels.size(); i++) encode_into(level, i, values.texels[i], is_data, deep);
        levels.push_back(std::move(level));
        if (values.texels.size() == 1) return levels;
        values = halved(values.width, values.height, [&](size_t i) { return values.texels[i]; });
    }
}

Mipmaps::Mipmaps(const Scene& scene) : scene_(scene), made_(2 * scene.textures.size()) {
    for (const Material& material : scene.materials)
        for (const auto use : material_textures)
            if (material.*use) {
                std::unique_ptr<Made>& made = made_.at(2 * size_t((material.*use).texture) + !is_color(use));
                if (!made) made = std::make_unique<Made>();
            }
}

const std::vector<Texture>& Mipmaps::of(int texture, bool is_data) const {
    Made* const found = made_.at(2 * size_t(texture) + is_data).get();
    if (!found) throw std::out_of_range("no material uses the texture");
    Made& made = *found;
    made.once([&] {
        const Texture& source = scene_.textures[size_t(texture)];
        if (source.mipmaps != Texture::Mipmaps::none) made.levels = make_mipmaps(source, is_data);
    });
    return made.levels;
}

LevelChoice choose_level(const Texture& texture, double lod) {
    LevelChoice choice;
    choice.nearest = lod > 0 ? texture.min_nearest : texture.nearest;
    if (!(lod > 0) || texture.mipmaps == Texture::Mipmaps::none) return choice;
    lod = std::min(lod, double(std::bit_width(std::max(texture.width, texture.height)) - 1));
    if (texture.mipmaps == Texture::Mipmaps::nearest) lod = std::ceil(lod - 0.5);
    choice.first = uint32_t(lod);
    choice.part = lod - choice.first;
    choice.second = choice.part > 0 ? choice.first + 1 : choice.first;
    return choice;
}

}  // namespace peelray
