// The studio that lights files without lights: how bright and how smooth what it lights is.
#include <pictures.h>

#include "scene/framing.h"

namespace peelray {
namespace {

const Environment& studio() {
    static const Environment environment = studio_environment();
    return environment;
}

/// Seen as a file without a camera is.
Camera framed(const Stage& stage) {
    Framing framing({glm::radians(40.f), 1, {0, 1, 0}});
    for (const Mesh& mesh : stage.scene.meshes) framing.add(mesh.primitives.front().positions);
    return framing.camera();
}

Stage ball_of(const Material& material) {
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 24), material);
    return stage;
}

uint32_t channel(uint32_t pixel, int c) {
    return pixel >> (8 * c) & 255;
}

using StudioTest = PictureTest;

TEST_F(StudioTest, IsGreyAndSmoothAndHasNoSun) {
    const Environment& s = studio();
    EXPECT_TRUE(s.lights.empty());
    EXPECT_EQ(s.sun_radiance, glm::vec3(0));
    double brightest = 0, darkest = 1e9, step = 0;
    for (uint32_t y = 0; y < s.height; y++)
        for (uint32_t x = 0; x < s.width; x++) {
            const glm::vec4 here = s.texels[size_t(y) * s.width + x];
            ASSERT_EQ(here.x, here.y);
            ASSERT_EQ(here.x, here.z);
            brightest = std::max(brightest, double(here.x));
            darkest = std::min(darkest, double(here.x));
            const glm::vec4 right = s.texels[size_t(y) * s.width + (x + 1) % s.width];
            const glm::vec4 below = s.texels[size_t(std::min(y + 1, s.height - 1)) * s.width + x];
            step = std::max({step, std::abs(double(right.x - here.x)), std::abs(double(below.x - here.x))});
        }
    EXPECT_GT(darkest, 0.1);
    EXPECT_LT(brightest, 4) << "nothing for rough surfaces to sparkle with";
    EXPECT_GT(brightest, 2) << "mirrors show soft boxes";
    EXPECT_LT(step, 0.65) << "edges are several texels wide";
}

TEST_F(StudioTest, AWhiteLambertBallIsBrightAndNotClipped) {
    const Stage stage = ball_of(lambert({1, 1, 1}));
    const Camera front = framed(stage);
    for (const double turn : {0.0, 0.25, 0.5, 0.75}) {
        SCOPED_TRACE(turn);
        const RenderResult picture = render(stage, studio(), settings_for(turned(front, turn), 96));
        uint32_t least = 255, most = 0;
        double sum = 0, pixels = 0;
        for (size_t i = 0; i < picture.encoded.size(); i++) {
            if (picture.radiance[i].w < 1) continue;
            sum += picture.radiance[i].x;
            pixels++;
            for (int c = 0; c < 3; c++) {
                least = std::min(least, channel(picture.encoded[i], c));
                most = std::max(most, channel(picture.encoded[i], c));
                ASSERT_NEAR(channel(picture.encoded[i], c), channel(picture.encoded[i], 0), 1) << "a colour of its own";
            }
        }
        EXPECT_GT(pixels, 96 * 96 * 0.55) << "the ball fills the picture";
        EXPECT_LE(most, 250u);
        EXPECT_GE(least, 100u);
        EXPECT_GE(most - least, 60u) << "it looks round";
        EXPECT_GT(sum / pixels, turn == 0 ? 0.8 : 0.6);
        EXPECT_LT(sum / pixels, 1);
    }
}

TEST_F(StudioTest, AGreyCardIsAMiddleGrey) {
    Stage stage;
    const glm::vec3 back = glm::normalize(glm::vec3(0.55f, 0.45f, 1)),
                    right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back)), up = glm::cross(back, right);
    stage.add(parallelogram(-right - up, 2.f * right, 2.f * up), lambert(glm::vec3(0.18f)));
    const RenderResult picture = render(stage, studio(), settings_for(framed(stage), 32));
    const size_t middle = 16 * 32 + 16;
    ASSERT_EQ(picture.radiance[middle].w, 1);
    EXPECT_NEAR(picture.radiance[middle].x, 0.18, 0.02);
    // The default curve takes 0.04 away, what a dielectric would mirror: 0.14 is 105.
    EXPECT_NEAR(channel(picture.encoded[middle], 0), 105, 8);
}

TEST_F(StudioTest, RoughMetalDoesNotSparkleAtOneSample) {
    for (const float roughness : {0.4f, 0.5f, 0.7f, 1.f}) {
        SCOPED_TRACE(roughness);
        Material rough = metal("rough", glm::vec3(0.9f));
        rough.roughness = roughness;
        const Stage stage = ball_of(rough);
        const RenderResult picture = render(stage, studio(), settings_for(framed(stage), 192));
        const auto value = [&](uint32_t x, uint32_t y) { return int(channel(picture.encoded[y * 192 + x], 0)); };
        int step = 0;
        for (uint32_t y = 40; y < 152; y++)
            for (uint32_t x = 40; x < 152; x++) {
                ASSERT_EQ(picture.radiance[y * 192 + x].w, 1);
                step =
                    std::max({step, std::abs(value(x, y) - value(x + 1, y)), std::abs(value(x, y) - value(x, y + 1))});
            }
        EXPECT_LE(step, roughness < 0.5f ? 24 : 6);
    }
}

}  // namespace
}  // namespace peelray
