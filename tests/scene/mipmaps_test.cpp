// Levels of textures, against means that are worked out here.
#include "scene/mipmaps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace peelray {
namespace {

double linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Texel i's channels are (37 i) mod 256 and so on.
Texture texture(uint32_t width, uint32_t height) {
    Texture t;
    t.width = width;
    t.height = height;
    for (uint32_t i = 0; i < width * height; i++)
        t.texels.push_back((37 * i & 255) | (91 * i & 255) << 8 | (i & 255) << 16 | (255 - (i & 255)) << 24);
    return t;
}

double red(const Texture& t, size_t i) {
    return (t.texels[i] & 255) / 255.0;
}

TEST(Mipmaps, SizesHalveDownToOneTexel) {
    const auto sizes = [](uint32_t width, uint32_t height) {
        std::vector<std::pair<uint32_t, uint32_t>> out;
        for (const Texture& level : make_mipmaps(texture(width, height), true))
            out.push_back({level.width, level.height});
        return out;
    };
    using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;
    EXPECT_EQ(sizes(1, 1), Sizes());
    EXPECT_EQ(sizes(8, 2), (Sizes{{4, 1}, {2, 1}, {1, 1}}));
    EXPECT_EQ(sizes(5, 7), (Sizes{{2, 3}, {1, 1}}));
    EXPECT_EQ(sizes(1, 6), (Sizes{{1, 3}, {1, 1}}));
}

TEST(Mipmaps, TexelsAreMeansOfWhatTheyCover) {
    const Texture t = texture(6, 4);
    const Texture stored = make_mipmaps(t, true)[0], light = make_mipmaps(t, false)[0];
    for (uint32_t y = 0; y < 2; y++)
        for (uint32_t x = 0; x < 3; x++) {
            double sum = 0, sum_light = 0;
            for (const uint32_t i : {12 * y + 2 * x, 12 * y + 2 * x + 1, 12 * y + 2 * x + 6, 12 * y + 2 * x + 7}) {
                sum += red(t, i) / 4;
                sum_light += linear(red(t, i)) / 4;
            }
            EXPECT_NEAR(red(stored, 3 * y + x), sum, 0.5 / 255 + 1e-6);
            // Rounded to a code, which is some width of linear light.
            const double code = red(light, 3 * y + x) * 255;
            EXPECT_LE(linear((code - 0.51) / 255), sum_light);
            EXPECT_GE(linear((code + 0.51) / 255), sum_light);
        }
}

TEST(Mipmaps, OddSizesLeaveNothingOut) {
    // Of five texels each of the two above covers two and a half.
    Texture t = texture(5, 1);
    const Texture level = make_mipmaps(t, true)[0];
    EXPECT_NEAR(red(level, 0), (red(t, 0) + red(t, 1) + red(t, 2) / 2) / 2.5, 0.51 / 255);
    EXPECT_NEAR(red(level, 1), (red(t, 2) / 2 + red(t, 3) + red(t, 4)) / 2.5, 0.51 / 255);
    // The last level is the mean of all, whatever the size.
    for (const uint32_t width : {3u, 7u, 12u, 31u})
        for (const uint32_t height : {1u, 5u, 16u}) {
            t = texture(width, height);
            double mean = 0;
            for (size_t i = 0; i < t.texels.size(); i++) mean += red(t, i) / double(t.texels.size());
            EXPECT_NEAR(red(make_mipmaps(t, true).back(), 0), mean, 0.51 / 255) << width << "x" << height;
        }
}

TEST(Mipmaps, DeepTexturesStayDeep) {
    Texture t;
    t.width = 2;
    t.height = 1;
    t.deep_texels = {0xffff000000030001ull, 0xffff000000040004ull};
    const std::vector<Texture> levels = make_mipmaps(t, true);
    ASSERT_EQ(levels.size(), 1u);
    EXPECT_TRUE(levels[0].texels.empty());
    EXPECT_EQ(levels[0].deep_texels, std::vector<uint64_t>{0xffff000000040003ull});  // 2.5 and 3.5, rounded up
    const Texture light = make_mipmaps(t, false)[0];  // so dark that the curve is straight
    EXPECT_NEAR(double(light.deep_texels[0] & 0xffff), 2.5, 1.01);
}

TEST(Mipmaps, OnlyWhatMaterialsUse) {
    Scene scene;
    scene.textures = {texture(4, 4), texture(4, 4), texture(4, 4)};
    scene.textures[1].mipmaps = Texture::Mipmaps::none;
    scene.materials.resize(1);
    scene.materials[0].base_color_texture = 0;
    scene.materials[0].roughness_texture = 0;
    scene.materials[0].emissive_texture = 1;
    const Mipmaps levels(scene);
    EXPECT_EQ(levels.of(0, false).size(), 2u);
    EXPECT_EQ(levels.of(0, true).size(), 2u);
    EXPECT_NE(levels.of(0, false)[0].texels, levels.of(0, true)[0].texels);
    EXPECT_EQ(levels.of(1, false).size(), 0u);
    EXPECT_THROW(levels.of(2, false), std::out_of_range);
}

TEST(Mipmaps, TheFootprintChooses) {
    Texture t = texture(16, 4);
    const auto expect = [&](double lod, uint32_t first, uint32_t second, double part, bool nearest) {
        const LevelChoice c = choose_level(t, lod);
        EXPECT_EQ(c.first, first) << lod;
        EXPECT_EQ(c.second, second) << lod;
        EXPECT_NEAR(c.part, part, 1e-12) << lod;
        EXPECT_EQ(c.nearest, nearest) << lod;
    };
    t.min_nearest = true;
    expect(-std::numeric_limits<double>::infinity(), 0, 0, 0, false);
    expect(0, 0, 0, 0, false);
    expect(0.25, 0, 1, 0.25, true);
    expect(2, 2, 2, 0, true);
    expect(99, 4, 4, 0, true);
    t.mipmaps = Texture::Mipmaps::nearest;
    expect(0.5, 0, 0, 0, true);
    expect(0.51, 1, 1, 0, true);
    t.mipmaps = Texture::Mipmaps::none;
    expect(7, 0, 0, 0, true);
}

}  // namespace
}  // namespace peelray
