// Light that is found by drawing directions to it: EnvironmentMode::sampled, and lamps with a size. Its mean is what
// integrals over the whole sphere say.
#include <pictures.h>

#include "finishes.h"

namespace peelray {
namespace {

using SampledLightTest = DrawnLightTest;

// --- An environment with a small bright spot before the surface and one behind it ---

constexpr uint32_t kWidth = 32, kHeight = 16;

Environment spots() {
    std::vector<glm::vec4> pixels;
    for (uint32_t y = 0; y < kHeight; y++)
        for (uint32_t x = 0; x < kWidth; x++)
            pixels.push_back(
                glm::vec4(glm::vec3(light_of(environment_direction((x + 0.5f) / kWidth, (y + 0.5f) / kHeight))), 1));
    pixels[7 * kWidth + 4] = {60, 50, 40, 1};  // about where a mirror would show it
    pixels[5 * kWidth + 16] = {20, 5, 30, 1};  // behind
    return image_environment(kWidth, kHeight, pixels);
}

/// Between the texels' centres.
glm::dvec3 looked_up(const Environment& environment, double x, double y) {
    const int left = int(std::floor(x - 0.5)), top = int(std::floor(y - 0.5));
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const auto texel = [&](int column, int row) {
        return glm::dvec3(environment.texels[size_t(std::clamp(row, 0, int(kHeight) - 1)) * kWidth +
                                             size_t((column + int(kWidth)) % int(kWidth))]);
    };
    return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), fx),
                    glm::mix(texel(left, top + 1), texel(left + 1, top + 1), fx), fy);
}

/// What comes back of the environment's light: a sum over directions all over the sphere.
glm::dvec3 integral(const Environment& environment, const Finish& finish, const glm::dvec3& view) {
    constexpr uint32_t across = 512, down = across / 2;
    glm::dvec3 sum(0);
    for (uint32_t j = 0; j < down; j++)
        for (uint32_t i = 0; i < across; i++) {
            const double u = (i + 0.5) / across, v = (j + 0.5) / down, phi = (u - 0.5) * 2 * kPi, theta = v * kPi;
            const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            sum += finish.sends(view, d) * looked_up(environment, u * kWidth, v * kHeight) * std::sin(theta);
        }
    return sum * 2.0 * kPi * kPi / double(across * down);
}

TEST_F(SampledLightTest, MeanIsTheIntegralOverTheSphere) {
    if (kOnDevice) GTEST_SKIP() << "the reference is held to it";
    const Environment environment = with_distribution(spots());
    ASSERT_EQ(environment.lights.size(), 1u);  // which must not count twice
    for (const Finish& finish : finishes(kSlant)) {
        SCOPED_TRACE(finish.name);
        RenderSettings settings = sampled_settings(slanted(kSlant), 16);
        settings.energy_compensation = false;
        const glm::dvec3 want = integral(environment, finish, to_slanted(kSlant));
        const Estimate got = estimate(square_of(finish.material), environment, settings, 16);
        got.expect(want, 2e-3);
        EXPECT_LT(got.error.y, 0.02 * want.y);
        settings.bounces = 0;  // lobes that no ray follows see the environment
        estimate(square_of(finish.material), environment, settings, 16).expect(want, 2e-3);
    }
}

TEST_F(SampledLightTest, WhiteSurfacesLoseNothing) {
    if (kOnDevice) GTEST_SKIP() << "the reference is held to it";
    Material glossy, paper = lambert({1, 1, 1}), varnished = lambert({1, 1, 1}), velvet = lambert({1, 1, 1});
    glossy.roughness = 0.5f;
    paper.diffuse_transmission = 0.4f;
    varnished.clearcoat = 0.7f;
    varnished.coat_roughness = 0.3f;
    velvet.sheen_color = {1, 1, 1};
    velvet.sheen_roughness = 0.4f;
    Material steel = plane_mirror(), brushed = plane_mirror();
    steel.roughness = 0.5f;
    brushed.roughness = 0.3f;
    brushed.anisotropy = 0.5f;
    const Environment everywhere = with_distribution(white);
    for (const Material& m : {lambert({1, 1, 1}), glossy, paper, varnished, velvet, steel, brushed})
        for (const double cosine : {0.8, 0.3}) {
            SCOPED_TRACE(fmt::format("sheen {}, coat {}, metal {}, stretch {}, cosine {}", m.sheen_color.x, m.clearcoat,
                                     m.metallic, m.anisotropy, cosine));
            double want = 1;
            if (m.anisotropy > 0) {
                // Energy is compensated as of the round lobe that masks the viewer as much.
                const TwoWidths lobe(m.roughness, m.anisotropy, 0);
                const glm::dvec3 view = to_slanted(cosine);
                want = lobe.kept(view) / ggx_mean(cosine, lobe.mean_roughness(view), [](double) { return 1; });
            }
            estimate(square_of(m), everywhere, sampled_settings(slanted(cosine), 32), 6).expect(glm::dvec3(want), 4e-3);
        }
}

TEST_F(SampledLightTest, EnvironmentIsBehindWhatIsInTheWay) {
    // A black disc of radius 1 at height 1 hides half of the cosine's weight from the point below its middle.
    Stage stage;
    Material chalk = lambert({1, 1, 1});
    chalk.occlusion_texture = 0;  // says that nothing arrives, which rays know better
    stage.scene.textures = {two_texels({0, 0, 0}, {0, 0, 0})};
    Primitive floor = ground(8);
    floor.uvs.assign(floor.positions.size(), {0, 0});
    stage.add(floor, chalk);
    stage.add(disc({0, 1, 0}, 1), emitting({0, 0, 0}));
    const Environment everywhere = with_distribution(white);
    const Camera below = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    RenderSettings settings = sampled_settings(below, 16);
    estimate(stage, everywhere, settings, 8).expect(glm::dvec3(0.5), 3e-3);
    settings.shadow = false;
    estimate(stage, everywhere, settings, 8).expect(glm::dvec3(1), 3e-3);
}

TEST_F(SampledLightTest, RoughGlassInTheWayIsCountedOnce) {
    // Light rays go straight through the sheet, the metal's own rays scatter in it: together they bring all light.
    Material metal = plane_mirror(), glass = thin_glass();
    metal.roughness = 0.5f;
    glass.roughness = 0.3f;
    Stage stage;
    stage.add(ground(60), metal);
    stage.add(ground(60, 1), glass);
    RenderSettings settings = sampled_settings(orthographic({0.3f, 0.5f, 0}, {0, 0, 0}, 0.02f), 16);
    settings.bounces = 12;
    estimate(stage, with_distribution(white), settings, 8).expect(glm::dvec3(1), 0.03);
}

TEST_F(SampledLightTest, MirrorsAndTheCameraSeeMeansOfTheImage) {
    // Columns of one texel, black and white by turns, of which a pixel sees ten.
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < 256 * 128; i++) pixels.push_back(glm::vec4(glm::vec3(float(i % 2)), 1));
    const Environment columns = with_distribution(image_environment(256, 128, pixels));
    Stage stage;
    stage.add(parallelogram({-8, -8, -2}, {8, 0, 0}, {0, 16, 0}), plane_mirror());
    const Camera camera = perspective({0, 0, 0}, {0, 0, -1}, 60);
    tally(render(stage, columns, sampled_settings(camera, 8)), camera, 0.03, [](const ViewRay&) {
        return glm::dvec3(0.5);
    }).expect(0, 64);
}

// --- Lamps with a size ---

TEST_F(SampledLightTest, BallShinesAsItsCentreDoes) {
    // Above the horizon as a whole: I cos(theta) / d², whatever its size.
    const Camera above = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    for (const float radius : {0.2f, 1.f, 1.9f})
        for (const float aside : {0.f, 1.5f}) {
            SCOPED_TRACE(fmt::format("radius {}, {} aside", radius, aside));
            Stage stage;
            stage.add(ground(8), lambert({1, 1, 1}));
            stage.lamp({aside, 2, 0.3f}, {9, 6, 3}).radius = radius;
            const glm::dvec3 to_lamp(aside, 2, 0.3f);
            const double distance = glm::length(to_lamp), strength = 2 / distance / (distance * distance) / kPi;
            RenderSettings settings = settings_for(above, 16);
            settings.spp = 4;
            estimate(stage, black, settings, 6).expect(strength * glm::dvec3(9, 6, 3), 1e-3);
        }
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.sun({0.5f, -1, 0.2f}, {3, 2, 1});
    stage.scene.lights[0].radius = 0.6f;
    RenderSettings settings = settings_for(above, 16);
    settings.spp = 4;
    estimate(stage, black, settings, 6).expect(glm::dvec3(3, 2, 1) / std::sqrt(1.29) / kPi, 1e-3);
}

TEST_F(SampledLightTest, ShadowsOfBallsAreSoft) {
    const Camera above = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.lamp({0, 4, 0}, glm::vec3(16 * float(kPi))).radius = 1;
    // A sheet up to the middle hides half of the ball; what is inside the ball hides nothing.
    stage.add(parallelogram({-4, 2, 4}, {4, 0, 0}, {0, 0, -8}), emitting({0, 0, 0}));
    stage.add(disc({0, 3.3f, 0}, 0.4f), emitting({0, 0, 0}));
    RenderSettings settings = settings_for(above, 16);
    settings.spp = 4;
    estimate(stage, black, settings, 6).expect(glm::dvec3(0.5), 0.02);
    // One sample looks for the centre, unless the environment is sampled too.
    settings.spp = 1;
    EXPECT_TRUE(near(mean_radiance(render(stage, black, settings)), glm::dvec3(0), 1e-6));
    settings.env_mode = EnvironmentMode::sampled;
    estimate(stage, with_distribution(black), settings, 6).expect(glm::dvec3(0.5), 0.04);
}

TEST_F(SampledLightTest, OneOfManyLampsStandsForAll) {
    const Camera above = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.sun({0, -1, 0}, {0.5f, 0.5f, 0.5f});
    glm::dvec3 want = glm::dvec3(0.5) / double(kPi);
    for (int i = 0; i < 300; i++) {
        // On a spiral that rises, ever brighter; one in seven behind the floor.
        const glm::dvec3 place(std::sin(i * 2.4) * 3, (i % 7 == 3 ? -1 : 1) * (0.5 + i * 0.01), std::cos(i * 2.4) * 3);
        const glm::dvec3 color = glm::dvec3(i % 3, i % 5, 1) * (i * 1e-3);
        stage.lamp(glm::vec3(place), glm::vec3(color));
        const double distance = glm::length(place);
        want += color * std::max(0.0, place.y) / (distance * distance * distance * double(kPi));
    }
    RenderSettings settings = settings_for(above, 16);
    settings.spp = 16;
    const Estimate got = estimate(stage, black, settings, 8);
    got.expect(want, 2e-3);
    EXPECT_LT(got.error.y, 0.01 * want.y);
    EXPECT_LE(render(stage, black, settings).rays.shadow, 16u * 16 * 16 * 2) << "of the sun, and of one lamp";
    // Without samples all count.
    settings.spp = 1;
    EXPECT_TRUE(near(mean_radiance(render(stage, black, settings)), want, 1e-3));
}

}  // namespace
}  // namespace peelray
