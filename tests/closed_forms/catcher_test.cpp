// Floors that show nothing but shadows and mirror images.
#include <pictures.h>

namespace peelray {
namespace {

using CatcherTest = PictureTest;

const glm::dvec3 kBehindColor(0.1f, 0.2f, 0.3f), kWallRed(0.9f, 0.1f, 0);

Material catcher_of(float ior) {
    Material m = lambert({0.5f, 0.4f, 0.3f});
    m.roughness = 0;
    m.ior = ior;
    m.catcher = true;
    m.double_sided = false;
    return m;
}

/// A floor, above it on the left a sheet, and a sun straight overhead.
Stage shaded_floor(float ior = 1, const glm::vec3& sun = glm::vec3(2, 3, 4)) {
    Stage stage;
    stage.add(ground(5), catcher_of(ior));
    stage.add(parallelogram({-4, 1, 4}, {4, 0, 0}, {0, 0, -8}), unlit({9, 9, 9}));
    stage.sun({0, -1, 0}, sun);
    return stage;
}

/// From the right, below the sheet's edge: what lies in its shadow is in the picture's upper half.
const Camera kShadeView = orthographic({3, 3, 0}, {0, 0, 0}, 0.8f, {-1, 1, 0});

RenderSettings catcher_settings(Backdrop::Kind kind, const Camera& camera) {
    RenderSettings settings = settings_for(camera, 16);
    settings.backdrop = {kind, kind == Backdrop::Kind::color ? glm::vec3(kBehindColor) : glm::vec3(0)};
    return settings;
}

double luminance_of(const glm::dvec3& c) {
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

TEST_F(CatcherTest, ShadowsAreTheShareOfLightThatIsMissing) {
    const glm::dvec3 sun(2, 3, 4), sky(kPi);
    for (const bool lit_by_sky : {false, true}) {
        SCOPED_TRACE(lit_by_sky);
        const glm::dvec3 left = lit_by_sky ? sky / (sky + sun) : glm::dvec3(0);
        const Environment& around = lit_by_sky ? white : black;
        const Picture color = render(shaded_floor(), around, catcher_settings(Backdrop::Kind::color, kShadeView));
        EXPECT_TRUE(near(radiance_at(color, 8, 13), kBehindColor, 1e-5)) << text(radiance_at(color, 8, 13));
        EXPECT_TRUE(near(radiance_at(color, 8, 2), left * kBehindColor, 1e-5)) << text(radiance_at(color, 8, 2));
        EXPECT_EQ(color.radiance[2 * 16 + 8].w, 0) << "no surface of its own";
        const Picture clear = render(shaded_floor(), around, catcher_settings(Backdrop::Kind::transparent, kShadeView));
        EXPECT_EQ(clear.radiance[13 * 16 + 8], glm::vec4(0));
        EXPECT_EQ(glm::vec3(clear.radiance[2 * 16 + 8]), glm::vec3(0)) << "shadows are black";
        EXPECT_NEAR(clear.radiance[2 * 16 + 8].w, 1 - luminance_of(left), 1e-5);
        EXPECT_EQ(clear.encoded[2 * 16 + 8], uint32_t(std::lround(255 * (1 - luminance_of(left)))) << 24);
    }
}

TEST_F(CatcherTest, WithoutLightNothingIsMissing) {
    const Picture picture =
        render(shaded_floor(1, glm::vec3(0)), black, catcher_settings(Backdrop::Kind::color, kShadeView));
    EXPECT_TRUE(near(radiance_at(picture, 8, 2), kBehindColor, 1e-5));
    RenderSettings settings = catcher_settings(Backdrop::Kind::color, kShadeView);
    settings.shadow = settings.reflection = settings.refraction = false;
    EXPECT_TRUE(near(radiance_at(render(shaded_floor(), white, settings), 8, 2), kBehindColor, 1e-5))
        << "nothing is traced";
}

TEST_F(CatcherTest, MirrorImagesCoverByTheirReflectance) {
    // A wall to the left, which the camera sees in the floor below it but not itself.
    Stage stage;
    stage.add(ground(5), catcher_of(1.8f));
    stage.add(parallelogram({-1, 0, 3}, {0, 0, -6}, {0, 0.8f, 0}), unlit(kWallRed));
    const double f = fresnel(std::sqrt(0.5), 1, 1.8);
    const Camera camera = orthographic({3.5f, 4, 0}, {-0.5f, 0, 0}, 0.6f, {-1, 1, 0});
    for (const auto kind : {Backdrop::Kind::color, Backdrop::Kind::transparent}) {
        const bool clear = kind == Backdrop::Kind::transparent;
        const Picture picture = render(stage, white, catcher_settings(kind, camera));
        // At x the mirrored ray is as high above -1 as x is to the right of it: below 0.8 it meets the wall.
        EXPECT_TRUE(near(radiance_at(picture, 8, 8), f * kWallRed + (clear ? 0 : 1 - f) * kBehindColor, 1e-5))
            << text(radiance_at(picture, 8, 8));
        EXPECT_NEAR(picture.radiance[8 * 16 + 8].w, clear ? f : 0, 1e-5);
        // And above it nothing, of which nothing is mirrored: not the environment either.
        EXPECT_TRUE(near(radiance_at(picture, 8, 15), clear ? glm::dvec3(0) : kBehindColor, 1e-5))
            << text(radiance_at(picture, 8, 15));
    }
}

TEST_F(CatcherTest, OthersSeeTheEnvironmentInItsPlace) {
    // An upright mirror, in which the camera sees the floor before it, half of it in the shade.
    Stage stage = shaded_floor();
    stage.add(parallelogram({-3, -1, -1}, {6, 0, 0}, {0, 3, 0}), plane_mirror());
    stage.scene.meshes[1].primitives[0].positions = parallelogram({-4, 4, 9}, {4, 0, 0}, {0, 0, -18}).positions;
    const Camera camera = orthographic({0, 2, 2}, {0, 0.5f, -1}, 0.3f);
    const Picture picture = render(stage, white, catcher_settings(Backdrop::Kind::color, camera));
    const glm::dvec3 shade = glm::dvec3(kPi) / (glm::dvec3(kPi) + glm::dvec3(2, 3, 4));
    EXPECT_TRUE(near(radiance_at(picture, 3, 8), shade, 1e-4)) << text(radiance_at(picture, 3, 8));
    EXPECT_TRUE(near(radiance_at(picture, 12, 8), glm::dvec3(1), 1e-4)) << text(radiance_at(picture, 12, 8));
}

TEST_F(CatcherTest, ShadowsAreSeenThroughBlendedSurfaces) {
    Stage stage = shaded_floor();
    Material m = unlit(kWallRed);
    m.alpha = 0.25f;
    m.blended = true;
    // Across the camera's way, and in nobody else's.
    stage.add(parallelogram({1.9f, 1.1f, 4}, {-1, 1, 0}, {0, 0, -8}), m);
    const glm::dvec3 left = glm::dvec3(kPi) / (kPi + glm::dvec3(2, 3, 4));
    const Camera camera = orthographic({2.7f, 3, 0}, {-0.3f, 0, 0}, 0.2f, {-1, 1, 0});
    RenderSettings settings = catcher_settings(Backdrop::Kind::transparent, camera);
    const Picture picture = render(stage, white, settings);
    const glm::vec4 pixel = picture.radiance[2 * 16 + 8];
    SCOPED_TRACE(fmt::format("{} {} {} {}", pixel.x, pixel.y, pixel.z, pixel.w));
    EXPECT_TRUE(near(glm::dvec3(pixel), 0.25 * kWallRed, 1e-5));
    EXPECT_NEAR(pixel.w, 1 - 0.75 * luminance_of(left), 1e-4);
}

TEST_F(CatcherTest, TheTransparentPictureOnAColorIsTheOpaqueOne) {
    // Grey light: colours of shadows do not survive in one alpha.
    Stage stage;
    stage.add(ground(5, -0.5f), catcher_of(1.8f));
    stage.add(sphere({-0.3f, 0, 0}, 0.5f, 16), plane_mirror());
    stage.add(sphere({0.6f, 0, -0.6f}, 0.4f, 16), lambert({0.5f, 0.6f, 0.7f}));
    stage.sun({0.4f, -1, -0.5f}, glm::vec3(3));
    RenderSettings settings = catcher_settings(Backdrop::Kind::color, perspective({0.3f, 1.2f, 3}, {0, -0.2f, 0}, 40));
    settings.width = settings.height = 32;
    settings.spp = 4;
    settings.ambient = true;
    const Picture opaque = render(stage, white, settings);
    settings.backdrop = {Backdrop::Kind::transparent};
    Picture over = render(stage, white, settings);
    int parts = 0;
    for (glm::vec4& pixel : over.radiance) {
        parts += pixel.w > 0.01f && pixel.w < 0.99f;
        pixel += glm::vec4(glm::vec3((1 - double(pixel.w)) * kBehindColor), 0);
    }
    EXPECT_GT(parts, 200);
    tally(over, opaque, 1e-4).expect(0, 1024);
}

TEST_F(CatcherTest, NothingIsHiddenFromBelow) {
    Stage stage;
    stage.add(ground(5), catcher_of(1.8f));
    stage.add(disc({0, 1, 0}, 3), unlit(kWallRed));
    const Camera camera = orthographic({0, -3, 0}, {0, 0, 0}, 0.5f, {0, 0, 1});
    EXPECT_TRUE(
        near(radiance_at(render(stage, white, catcher_settings(Backdrop::Kind::color, camera)), 8, 8), kWallRed, 1e-5));
}

}  // namespace
}  // namespace peelray
