// What the camera sees where nothing is before it, and environments turned and dimmed.
#include <pictures.h>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/encoding.h"

namespace peelray {
namespace {

using BackdropTest = PictureTest;

const Camera kFrontView = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
const glm::dvec3 kBackdropColor(0.1f, 0.2f, 0.3f), kSheetRed(0.9f, 0.1f, 0), kSheetGreen(0, 0.8f, 0.1f);

Material sheet_of(const glm::vec3& color, float alpha) {
    Material m = unlit(color);
    m.alpha = alpha;
    m.blended = true;
    return m;
}

/// Somewhere the camera never looks: a scene needs a triangle.
Stage bare_stage() {
    Stage stage;
    stage.add(faces({{{311, -977, 153}, {311.1f, -977, 153}, {311, -977, 153.1f}}}), unlit({9, 0, 9}));
    return stage;
}

/// Half the picture's width, left of the middle.
Primitive left_half_at(float z) {
    return parallelogram({-3, -3, z}, {3, 0, 0}, {0, 6, 0});
}

RenderSettings backdrop_settings(Backdrop::Kind kind, const Camera& camera = kFrontView, uint32_t size = 16) {
    RenderSettings settings = settings_for(camera, size);
    settings.backdrop = {kind, kind == Backdrop::Kind::color ? glm::vec3(kBackdropColor) : glm::vec3(0)};
    return settings;
}

TEST_F(BackdropTest, CamerasSeeTheColorAndMirrorsTheEnvironment) {
    Stage stage;
    stage.add(left_half_at(0), plane_mirror());
    const Picture picture = render(stage, white, backdrop_settings(Backdrop::Kind::color));
    EXPECT_TRUE(near(radiance_at(picture, 3, 8), glm::dvec3(1), 1e-5));
    EXPECT_TRUE(near(radiance_at(picture, 12, 8), kBackdropColor, 1e-6));
    EXPECT_FALSE(picture.transparent);
    EXPECT_EQ(picture.encoded.front() >> 24, 255u);
    stage.scene.materials[0] = thin_glass();
    EXPECT_TRUE(
        near(radiance_at(render(stage, white, backdrop_settings(Backdrop::Kind::color)), 3, 8), glm::dvec3(1), 1e-5))
        << "glass shows the environment";
}

TEST_F(BackdropTest, BlendedSurfacesLetItThrough) {
    Stage stage;
    stage.add(left_half_at(0), sheet_of(kSheetRed, 0.25f));
    for (const bool traced : {true, false}) {
        RenderSettings settings = backdrop_settings(Backdrop::Kind::color);
        settings.refraction = traced;
        const Picture picture = render(stage, white, settings);
        EXPECT_TRUE(near(radiance_at(picture, 3, 8), 0.25 * kSheetRed + 0.75 * kBackdropColor, 1e-5)) << traced;
    }
}

/// A pixel's bytes, from red to alpha.
glm::ivec4 bytes_at(const Picture& picture, uint32_t x, uint32_t y) {
    const uint32_t pixel = picture.encoded[size_t(y) * picture.width + x];
    return {pixel & 255, pixel >> 8 & 255, pixel >> 16 & 255, pixel >> 24};
}

TEST_F(BackdropTest, AlphaIsWhatCoversTheBackdrop) {
    Stage stage;
    stage.add(left_half_at(0), sheet_of(kSheetRed, 0.25f));
    for (const bool traced : {true, false}) {
        SCOPED_TRACE(traced);
        RenderSettings settings = backdrop_settings(Backdrop::Kind::transparent);
        settings.refraction = settings.reflection = settings.shadow = traced;
        settings.tonemap = Tonemap::none;
        const Picture picture = render(stage, white, settings);
        EXPECT_TRUE(picture.transparent);
        EXPECT_TRUE(near(radiance_at(picture, 3, 8), 0.25 * kSheetRed, 1e-5)) << "premultiplied";
        EXPECT_NEAR(picture.radiance[8 * 16 + 3].w, 0.25, 1e-5);
        // Straight: the sheet's own colour, of which a quarter is there.
        const glm::ivec4 straight = bytes_at(picture, 3, 8);
        for (int i = 0; i < 3; i++) EXPECT_NEAR(straight[i], 255 * linear_to_srgb(kSheetRed[i]), 0.6);
        EXPECT_EQ(straight.w, 64);
        EXPECT_EQ(picture.radiance[8 * 16 + 12], glm::vec4(0));
        EXPECT_EQ(bytes_at(picture, 12, 8), glm::ivec4(0));
    }
}

TEST_F(BackdropTest, SheetsInARowCoverMore) {
    Stage stage;
    for (int i = 0; i < 12; i++) stage.add(left_half_at(float(-i) / 8), sheet_of(kSheetGreen, 0.1f));
    RenderSettings settings = backdrop_settings(Backdrop::Kind::transparent);
    settings.bounces = 1;  // beyond it and eight sheets nothing is followed
    const Picture picture = render(stage, white, settings);
    EXPECT_NEAR(picture.radiance[8 * 16 + 3].w, 1 - std::pow(0.9, 10), 1e-4);
    settings.bounces = 4;
    EXPECT_NEAR(render(stage, white, settings).radiance[8 * 16 + 3].w, 1 - std::pow(0.9, 12), 1e-4);
}

TEST_F(BackdropTest, GlassCoversAndEdgesCoverTheirShare) {
    Stage stage;
    // The edge lies in the picture's ninth column of pixels, 0.3 from its left.
    const float edge = 1.8f * (8.3f / 16 - 0.5f);
    stage.add(parallelogram({-3, -3, 0}, {3 + edge, 0, 0}, {0, 6, 0}), thin_glass());
    RenderSettings settings = backdrop_settings(Backdrop::Kind::transparent);
    settings.spp = 16;
    const Picture picture = render(stage, white, settings);
    EXPECT_EQ(picture.radiance[8 * 16 + 3].w, 1) << "what is seen through glass is the environment";
    EXPECT_TRUE(near(radiance_at(picture, 3, 8), glm::dvec3(1), 1e-5));
    int covered = 0;
    for (uint32_t i = 0; i < 16; i++) covered += sample_position(i).x < 0.3f;
    ASSERT_GT(covered, 2);
    EXPECT_NEAR(picture.radiance[8 * 16 + 8].w, covered / 16.0, 1e-6);
    EXPECT_TRUE(near(radiance_at(picture, 8, 8), glm::dvec3(covered / 16.0), 1e-5));
    // What is covered is as bright at the edge as elsewhere.
    EXPECT_EQ(glm::ivec3(bytes_at(picture, 8, 8)), glm::ivec3(bytes_at(picture, 3, 8)));
    EXPECT_EQ(bytes_at(picture, 8, 8).w, std::lround(covered / 16.0 * 255));
}

TEST_F(BackdropTest, TheTransparentPictureOnAColorIsTheOpaqueOne) {
    Stage stage;
    stage.add(sphere({-0.3f, 0, 0}, 0.5f, 16), plane_mirror());
    stage.add(sphere({0.4f, 0.2f, -1}, 0.4f, 16), lambert({0.5f, 0.6f, 0.7f}));
    stage.add(left_half_at(1), sheet_of(kSheetRed, 0.3f));
    stage.add(parallelogram({-3, -0.2f, 2}, {6, 0, 0}, {0, 0.3f, 0.4f}), sheet_of(kSheetGreen, 0.6f));
    stage.sun({0.2f, -1, -0.5f});
    RenderSettings settings = backdrop_settings(Backdrop::Kind::color, kFrontView, 32);
    settings.spp = 4;
    const Picture opaque = render(stage, white, settings);
    settings.backdrop = {Backdrop::Kind::transparent};
    Picture over = render(stage, white, settings);
    Tally alphas;
    for (glm::vec4& pixel : over.radiance) {
        alphas.add(pixel.w > 0.01f && pixel.w < 0.99f, [] { return std::string("whole"); });
        pixel += glm::vec4(glm::vec3((1 - double(pixel.w)) * kBackdropColor), 0);
    }
    EXPECT_GT(alphas.compared - alphas.wrong, 300u) << "in parts";
    tally(over, opaque, 1e-5).expect(0, 1024);
}

/// Linear light, blurred: its slope is less by the mean cosine of the angles that it is blurred by.
TEST_F(BackdropTest, BlurredIsTheMeanAround) {
    Environment image = direction_image(512);
    add_blurred(image);
    double weights = 0, cosines = 0;
    for (double angle = 5e-4; angle < 4 * BLURRED_RADIANS; angle += 1e-3) {
        const double weight = std::sin(angle) * std::exp(-0.5 * angle * angle / BLURRED_RADIANS / BLURRED_RADIANS);
        weights += weight;
        cosines += weight * std::cos(angle);
    }
    for (const glm::vec3& direction : {glm::vec3(0, 0.2f, -1), {1, -0.5f, 0.2f}, {0, -0.3f, 1}}) {
        const Camera camera = perspective({0, 0, 0}, direction, 60);
        const Picture picture = render(bare_stage(), image, backdrop_settings(Backdrop::Kind::blurred, camera, 24));
        tally(picture, camera, 2e-3, [&](const ViewRay& ray) {
            return 0.5 + cosines / weights * (light_of(ray.direction) - 0.5);
        }).expect(0, 576);
    }
    // What a mirror sees is sharp.
    Stage stage;
    stage.add(parallelogram({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), plane_mirror());
    const Camera camera = perspective({0, 0, 0}, {0, 0, -1}, 60);
    tally(render(stage, image, backdrop_settings(Backdrop::Kind::blurred, camera, 24)), camera, 2e-3,
          [](const ViewRay& ray) {
              return light_of({ray.direction.x, ray.direction.y, -ray.direction.z});
          })
        .expect(0, 576);
}

/// Counter-clockwise as seen from above: from +x to -z.
glm::dvec3 turned_about_y(double degrees, const glm::dvec3& d) {
    const double angle = degrees * kPi / 180, c = std::cos(angle), s = std::sin(angle);
    return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

TEST_F(BackdropTest, TurnedEnvironmentsAreSeenTurned) {
    for (const double degrees : {90.0, 33.3, -200.0}) {
        SCOPED_TRACE(degrees);
        Environment image = direction_image(256);
        rotate(image, degrees);
        const auto light = [&](const glm::dvec3& d) { return light_of(turned_about_y(-degrees, d)); };
        const Camera camera = perspective({0, 0, 0}, {0.3f, 0.2f, -1}, 90);
        tally(render(bare_stage(), image, settings_for(camera, 24)), camera, 0.01, [&](const ViewRay& ray) {
            return light(ray.direction);
        }).expect(0, 576);
        Stage stage;
        stage.add(parallelogram({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), plane_mirror());
        const Camera ahead = perspective({0, 0, 0}, {0, 0, -1}, 90);
        tally(render(stage, image, settings_for(ahead, 24)), ahead, 0.01, [&](const ViewRay& ray) {
            return light({ray.direction.x, ray.direction.y, -ray.direction.z});
        }).expect(0, 576);
    }
}

TEST_F(BackdropTest, ABrightTexelGoesWhereItIsTurnedTo) {
    std::vector<glm::vec4> pixels(64 * 32, glm::vec4(0, 0, 0, 1));
    pixels[12 * 64 + 40] = glm::vec4(5, 4, 3, 1);
    Environment image = image_environment(64, 32, pixels);
    rotate(image, 90);
    const auto direction = [](double x) {
        return glm::dvec3(environment_direction(float((x + 0.5) / 64), 12.5f / 32));
    };
    const glm::dvec3 before = direction(40), after = turned_about_y(90, before);
    EXPECT_TRUE(near(after, direction(40 - 16), 1e-6));
    // Seen in a mirror that stands upright, facing -x.
    Stage stage;
    stage.add(parallelogram({2, -5, -5}, {0, 0, 10}, {0, 10, 0}), plane_mirror());
    for (Material& m : stage.scene.materials) m.double_sided = true;
    for (const auto& [to, light] : {std::pair(after, glm::dvec3(5, 4, 3)), {before, glm::dvec3(0)}}) {
        const Camera direct = perspective({0, 0, 0}, glm::vec3(to), 2);
        EXPECT_TRUE(near(radiance_at(render(bare_stage(), image, settings_for(direct, 9)), 4, 4), light, 1e-2));
        const glm::vec3 towards(std::abs(float(to.x)), float(to.y), float(to.z));
        if (to.x > 0) continue;
        const Camera mirrored = perspective({0, 0, 0}, towards, 2);
        EXPECT_TRUE(near(radiance_at(render(stage, image, settings_for(mirrored, 9)), 4, 4), light, 1e-2));
    }
}

TEST_F(BackdropTest, DiffuseLightAndShadowsTurnAlong) {
    Environment sky = sky_environment(glm::normalize(glm::vec3(1, 1, 0)));
    rotate(sky, 90);
    EXPECT_TRUE(near(glm::dvec3(sky.sun_direction), {0, std::sqrt(0.5), -std::sqrt(0.5)}, 1e-6));
    EXPECT_TRUE(near(glm::dvec3(sky.lights[0].direction), -glm::dvec3(sky.sun_direction), 1e-6));
    Environment image = direction_image(128);
    rotate(image, 37.5);
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 24), lambert({1, 1, 1}));
    RenderSettings settings = settings_for(perspective({3, 1, 2}, {0, 0, 0}, 35), 32);
    settings.aovs = true;
    const Picture picture = render(stage, image, settings);
    Tally result;
    for (size_t i = 0; i < picture.radiance.size(); i++) {
        if (picture.aovs.triangle[i] < 0) continue;
        const glm::dvec3 n = turned_about_y(-37.5, glm::dvec3(picture.aovs.normal[i])), want = 0.5 + 0.4 * 2 / 3 * n,
                         got = glm::dvec3(picture.radiance[i]);
        result.add(near(got, want, 0.01), [&] { return text(got) + ", expected " + text(want); });
    }
    result.expect(0, 400);
}

TEST_F(BackdropTest, IntensityIsAFactorOfAllThatTheEnvironmentSends) {
    Stage stage;
    stage.add(sphere({-0.3f, 0, 0}, 0.5f, 16), plane_mirror());
    stage.add(ground(3, -0.6f), lambert({0.5f, 0.6f, 0.7f}));
    const Camera camera = perspective({0, 1, 4}, {0, 0, 0}, 40);
    Environment sky = sky_environment(default_sun_direction());
    const Picture plain = render(stage, sky, settings_for(camera, 32));
    scale(sky, 2.5f);
    Picture scaled = render(stage, sky, settings_for(camera, 32));
    for (glm::vec4& pixel : scaled.radiance) pixel /= 2.5f;
    Tally result;
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++) {
            const glm::dvec3 a = radiance_at(plain, x, y), b = radiance_at(scaled, x, y);
            result.add(near(a / (a + 1e-9), b / (a + 1e-9), 1e-4), [&] { return text(a) + " " + text(b); });
        }
    result.expect(0, 1024);
    scale(sky, 0);
    const Picture dark = render(stage, sky, settings_for(camera, 32));
    for (const glm::vec4& pixel : dark.radiance) ASSERT_EQ(glm::vec3(pixel), glm::vec3(0));
}

}  // namespace
}  // namespace peelray
