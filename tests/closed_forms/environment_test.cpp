// Where light comes from on a miss: orientation, seam, sun.
#include <pictures.h>

namespace peelray {
namespace {

/// Somewhere the camera never looks: a scene needs a triangle.
Stage empty_stage() {
    Stage stage;
    stage.add(faces({{{311, -977, 153}, {311.1f, -977, 153}, {311, -977, 153.1f}}}), unlit({9, 0, 9}));
    return stage;
}

using EnvironmentTest = PictureTest;

const std::pair<glm::vec3, glm::vec3> kViews[] = {{{0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 1, 0}},
                                                  {{0, 0, 1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}},
                                                  {{0, 1, 0}, {0, 0, 1}},  {{0, -1, 0}, {0, 0, -1}}};

TEST_F(EnvironmentTest, ImageIsOriented) {
    const Environment image = direction_image(256);
    for (const auto& [direction, up] : kViews) {
        const Camera camera = perspective({0, 0, 0}, direction, 90, up);
        tally(render(empty_stage(), image, settings_for(camera, 32)), camera, 0.01, [](const ViewRay& ray) {
            return light_of(ray.direction);
        }).expect(0, 1024);
    }
}

TEST_F(EnvironmentTest, MirrorShowsTheImageFromTheOtherSide) {
    const Environment image = direction_image(256);
    for (const auto& [direction, up] : kViews) {
        Stage stage;
        const glm::vec3 side = glm::cross(direction, up);
        stage.add(parallelogram(direction - 3.f * side - 3.f * up, 6.f * side, 6.f * up), plane_mirror());
        const Camera camera = perspective({0, 0, 0}, direction, 90, up);
        const glm::dvec3 normal = direction;
        tally(render(stage, image, settings_for(camera, 32)), camera, 0.01, [&](const ViewRay& ray) {
            return light_of(ray.direction - 2 * glm::dot(ray.direction, normal) * normal);
        }).expect(0, 1024);
    }
}

TEST_F(EnvironmentTest, SeamIsInterpolated) {
    // Eight columns: the seam at +z lies between the last (0) and the first (1); 22.5° to each side a column's middle.
    std::vector<glm::vec4> pixels;
    for (int i = 0; i < 32; i++) pixels.push_back(glm::vec4(glm::vec3(i % 8 == 0 ? 1.f : i % 8 == 7 ? 0.f : 0.5f), 1));
    const Camera camera = perspective({0, 0, 0}, {0, 0, 1}, 40);
    tally(render(empty_stage(), image_environment(8, 4, pixels), settings_for(camera, 64)), camera, 2e-3,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double degrees =
                  std::atan2(-ray.direction.x, ray.direction.z) * 180 / kPi;  // 0 at the seam, rising with the columns
              if (std::abs(degrees) > 22) return {};
              return glm::dvec3(0.5 + degrees / 45);
          })
        .expect(0, 3800);
}

TEST_F(EnvironmentTest, DiffuseLightComesFromTheRightSide) {
    // Light L = 0.5 + 0.4 d has the irradiance pi (0.5 + 0.4 · 2/3 n).
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 24), lambert({1, 1, 1}));
    const Environment image = direction_image(128);
    for (const auto& [direction, up] : kViews) {
        RenderSettings settings = settings_for(perspective(-4.f * direction, {0, 0, 0}, 35, up), 32);
        settings.aovs = true;
        const RenderResult picture = render(stage, image, settings);
        Tally result;
        for (size_t i = 0; i < picture.radiance.size(); i++) {
            if (picture.aovs.triangle[i] < 0) continue;
            const glm::dvec3 want = 0.5 + 0.4 * 2 / 3 * glm::dvec3(picture.aovs.normal[i]),
                             got = glm::dvec3(picture.radiance[i]);
            result.add(near(got, want, 0.01), [&] { return text(got) + ", expected " + text(want); });
        }
        result.expect(0, 500);
    }
}

TEST_F(EnvironmentTest, ColorIsTheSameEverywhere) {
    const Camera camera = perspective({0, 0, 0}, {1, 2, 3}, 120);
    tally(render(empty_stage(), color_environment({0.25f, 3, 0}), settings_for(camera, 32)), camera, 1e-5,
          [](const ViewRay&) { return glm::dvec3(0.25, 3, 0); })
        .expect(0, 1024);
}

const glm::vec3 kSun = glm::normalize(glm::vec3(0.5f, 0.6f, -0.4f));

TEST_F(EnvironmentTest, SunDiscIsSeenDirectlyAndInAMirror) {
    const Environment sky = sky_environment(kSun);
    const double radius = std::acos(double(sky.sun_cosine)), view = 4 * radius;  // the picture is two discs wide
    const auto covered = [&](const RenderResult& picture) {
        double discs = 0;
        for (const glm::vec4& p : picture.radiance) discs += p.x > 0.5f * sky.sun_radiance.x;
        return discs / double(picture.radiance.size());
    };
    RenderSettings settings = settings_for(perspective({0, 0, 0}, kSun, float(view * 180 / kPi)), 64);
    const double share = kPi / 16;
    EXPECT_NEAR(covered(render(empty_stage(), sky, settings)), share, 0.02);

    // A horizontal mirror: look down at the sun's image.
    Stage stage;
    stage.add(ground(5), plane_mirror());
    settings.camera = perspective({-2 * kSun.x, 2 * kSun.y, -2 * kSun.z}, {0, 0, 0}, float(view * 180 / kPi));
    EXPECT_NEAR(covered(render(stage, sky, settings)), share, 0.02);
    EXPECT_GE(radiance_at(render(stage, sky, settings), 32, 32).x, sky.sun_radiance.x);
    // A rough surface gets the sun's light from the lamp that stands for it, never from the disc too.
    stage.scene.materials[0].roughness = 0.3f;
    EXPECT_LT(radiance_at(render(stage, sky, settings), 32, 32).x, 0.02 * sky.sun_radiance.x);
}

TEST_F(EnvironmentTest, SunlightComesFromTheDisc) {
    const Environment sky = sky_environment(kSun);
    ASSERT_EQ(sky.lights.size(), 1u);
    const glm::vec3 centre(0.3f, 1, -0.2f), shadow = centre - kSun * (centre.y / kSun.y);
    Stage stage;
    stage.add(ground(6), lambert({1, 1, 1}));
    stage.add(disc(centre, 0.2f), unlit({0, 0, 1}));
    // From the middle of the shadow the disc hides the sun.
    RenderSettings settings = settings_for(perspective(shadow + kSun * 0.01f, centre, 20), 33);
    EXPECT_TRUE(near(radiance_at(render(stage, sky, settings), 16, 16), {0, 0, 1}, 1e-5));
    // The middle of the shadow lacks exactly the sun's irradiance.
    settings.camera = orthographic(shadow + glm::vec3(0, 0.9f, 0), shadow, 0.1f, {0, 0, -1});
    const glm::dvec3 dark = radiance_at(render(stage, sky, settings), 16, 16);
    settings.shadow = false;
    const glm::dvec3 bright = radiance_at(render(stage, sky, settings), 16, 16);
    EXPECT_TRUE(near(bright - dark, glm::dvec3(sky.lights[0].color) * double(kSun.y) / kPi, 0.01))
        << text(bright - dark);
    // The disc's solid angle and radiance are that irradiance.
    const double solid_angle = 2 * kPi * (1 - double(sky.sun_cosine));
    EXPECT_NEAR(sky.sun_radiance.x * solid_angle, sky.lights[0].color.x, 0.02);
}

TEST_F(EnvironmentTest, BrightSpotBecomesALight) {
    std::vector<glm::vec4> pixels(64 * 32, glm::vec4(0.1f));
    const uint32_t x = 40, y = 6;
    pixels[y * 64 + x] = glm::vec4(5000, 4000, 3000, 1);
    const Environment image = image_environment(64, 32, pixels);
    ASSERT_EQ(image.lights.size(), 1u);
    const double phi = ((x + 0.5) / 64 - 0.5) * 2 * kPi, theta = (y + 0.5) / 32 * kPi;
    const glm::dvec3 to_spot(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
    EXPECT_TRUE(near(glm::dvec3(image.lights[0].direction), -to_spot, 1e-3));
    const double solid_angle = 2 * kPi / 64 * (std::cos(kPi * y / 32) - std::cos(kPi * (y + 1) / 32));
    EXPECT_NEAR(image.lights[0].color.x, 5000 * solid_angle, 0.01 * 5000 * solid_angle);
    // The picture still shows the spot itself.
    const RenderSettings settings = settings_for(perspective({0, 0, 0}, glm::vec3(to_spot), 2), 9);
    EXPECT_GT(radiance_at(render(empty_stage(), image, settings), 4, 4).x, 4900);
}

}  // namespace
}  // namespace peelray
