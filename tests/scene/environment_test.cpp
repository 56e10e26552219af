// Environments as data: turned, dimmed, blurred, and of odd sizes.
#include "scene/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "path/shading_numbers.h"

namespace peelray {
namespace {

std::vector<glm::vec4> speckled(uint32_t width, uint32_t height, bool sun) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < width * height; i++)
        pixels.emplace_back(uniform(random), uniform(random), uniform(random), 1);
    if (sun) pixels[width * (height / 4) + width / 3] = glm::vec4(9000, 8000, 7000, 1);
    return pixels;
}

/// Columns moved to the left by `columns`.
std::vector<glm::vec4> columns_moved(const std::vector<glm::vec4>& pixels, uint32_t width, uint32_t columns) {
    std::vector<glm::vec4> out;
    for (size_t i = 0; i < pixels.size(); i++) out.push_back(pixels[i / width * width + (i % width + columns) % width]);
    return out;
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance) {
    for (int c = 0; c < 3; c++) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(Environment, AWholeTurnIsNone) {
    const Environment image = image_environment(64, 32, speckled(64, 32, true));
    for (const double degrees : {0.0, 360.0, -720.0}) {
        Environment turned = image;
        rotate(turned, degrees);
        EXPECT_EQ(turned.texels, image.texels);
        EXPECT_EQ(turned.irradiance, image.irradiance);
    }
}

TEST(Environment, TurnsByWholeTexelsMoveThem) {
    const std::vector<glm::vec4> pixels = speckled(64, 32, true);
    // A right angle, or the same after many more turns: 16 columns.
    for (const double degrees : {90.0, 90.0 + 360 * 12345, -270.0}) {
        Environment turned = image_environment(64, 32, pixels);
        rotate(turned, degrees);
        const Environment want = image_environment(64, 32, columns_moved(pixels, 64, 16));
        EXPECT_EQ(turned.texels, want.texels) << "with all levels";
        for (int i = 0; i < 9; i++) expect_near(turned.irradiance[size_t(i)], want.irradiance[size_t(i)], 2e-3f);
        ASSERT_EQ(turned.lights.size(), 1u);
        expect_near(turned.lights[0].direction, want.lights[0].direction, 1e-5f);
        EXPECT_EQ(turned.rough_limit, want.rough_limit);
    }
}

TEST(Environment, TurnsBetweenTexelsInterpolate) {
    const std::vector<glm::vec4> pixels = speckled(8, 4, false);
    Environment turned = image_environment(8, 4, pixels);
    rotate(turned, 45.0 * 1.25);
    for (uint32_t y = 0; y < 4; y++)
        for (uint32_t x = 0; x < 8; x++)
            expect_near(turned.texels[y * 8 + x],
                        0.75f * pixels[y * 8 + (x + 1) % 8] + 0.25f * pixels[y * 8 + (x + 2) % 8], 1e-6f);
}

TEST(Environment, IntensityScalesAllOfIt) {
    const Environment image = image_environment(64, 32, speckled(64, 32, true));
    Environment scaled = image;
    scale(scaled, 3);
    for (size_t i = 0; i < image.texels.size(); i++)
        ASSERT_EQ(glm::vec3(scaled.texels[i]), 3.f * glm::vec3(image.texels[i]));
    for (size_t i = 0; i < 9; i++) EXPECT_EQ(scaled.irradiance[i], 3.f * image.irradiance[i]);
    EXPECT_EQ(scaled.lights[0].color, 3.f * image.lights[0].color);
    EXPECT_EQ(scaled.rough_limit, 3 * image.rough_limit);
}

TEST(Environment, BlurredFollowsTheLevels) {
    for (const auto& [width, height] :
         {std::pair(1u, 1u), {8u, 4u}, {300u, 150u}, {512u, 256u}, {64u, 5u}, {3u, 200u}}) {
        SCOPED_TRACE(width);
        std::vector<glm::vec4> pixels(width * height, glm::vec4(2, 3, 4, 1));
        Environment image = image_environment(width, height, pixels);
        EXPECT_EQ(image.level_texels(), image.texels.size());
        const size_t before = image.texels.size();
        add_blurred(image);
        EXPECT_TRUE(image.has_blurred);
        EXPECT_EQ(image.level_texels(), before);
        ASSERT_EQ(image.texels.size(), before + BLURRED_WIDTH * BLURRED_HEIGHT);
        for (size_t i = before; i < image.texels.size(); i++) expect_near(image.texels[i], {2, 3, 4}, 1e-4f);
    }
}

TEST(Environment, OddSizesAreDefined) {
    for (const auto& [width, height] : {std::pair(1u, 1u), {1u, 9u}, {7u, 1u}, {100u, 3u}, {5u, 40u}}) {
        SCOPED_TRACE(width);
        Environment image = image_environment(width, height, speckled(width, height, false));
        rotate(image, 77);
        scale(image, 2);
        for (const glm::vec4& texel : image.texels) ASSERT_TRUE(texel.x >= 0 && texel.x <= 2);
        for (const glm::vec3& harmonic : image.irradiance) ASSERT_TRUE(std::isfinite(harmonic.x));
    }
    const std::vector<glm::vec4> black(32, glm::vec4(0, 0, 0, 1));
    Environment dark = image_environment(8, 4, black);
    rotate(dark, 30);
    EXPECT_TRUE(dark.lights.empty());
    for (const glm::vec3& harmonic : dark.irradiance) EXPECT_EQ(harmonic, glm::vec3(0));
    // The largest that a file may hold, brightened as far as settings let it.
    Environment bright = image_environment(2, 1, std::vector<glm::vec4>(2, glm::vec4(1e12f, 1e12f, 1e12f, 1)));
    scale(bright, 1e6f);
    for (const glm::vec3& harmonic : bright.irradiance) EXPECT_TRUE(std::isfinite(harmonic.x));
}

}  // namespace
}  // namespace peelray
