// The environment's light without noise: EnvironmentMode::filtered. It is exact where nothing is in the way, and near
// the integrals elsewhere.
#include <pictures.h>

#include "effort.h"
#include "finishes.h"
#include "path/filtered_numbers.h"

namespace peelray {
namespace {

class FilteredLightTest : public PictureTest {
  protected:
    static Environment filtered(Environment environment) {
        environment.filtered = FilteredEnvironment(environment);
        return environment;
    }
    static RenderSettings filtered_settings(const Camera& camera, uint32_t size = 8, uint32_t spp = 1) {
        RenderSettings settings = settings_for(camera, size);
        settings.env_mode = EnvironmentMode::filtered;
        settings.spp = spp;
        return settings;
    }
    /// Of a small piece of the floor around a point.
    static Camera above(float x, float z = 0) { return orthographic({x, 0.5f, z}, {x, 0, z}, 1e-3f, {0, 0, -1}); }
    double light_at(const Stage& stage, const Environment& environment, float x, uint32_t spp) {
        return mean_radiance(render(stage, environment, filtered_settings(above(x), 4, spp))).y;
    }
};

/// A white floor that goes on, with a black wall of height 1 at x = 0 that goes on to both sides.
Stage floor_and_wall() {
    Stage stage;
    stage.add(ground(600), lambert({1, 1, 1}));
    stage.add(parallelogram({0, 0, 600}, {0, 0, -1200}, {0, 1, 0}), emitting({0, 0, 0}));
    return stage;
}

TEST_F(FilteredLightTest, OpenPlanesAreExact) {
    const Environment everywhere = filtered(white), image = filtered(direction_image(128));
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    for (const uint32_t spp : {1u, 4u}) {
        const RenderSettings settings = filtered_settings(above(0), 8, spp);
        EXPECT_TRUE(near(mean_radiance(render(stage, everywhere, settings)), glm::dvec3(1), 1e-5)) << spp;
        // Light L = 0.5 + 0.4 d has the irradiance pi (0.5 + 0.4 · 2/3 n).
        EXPECT_TRUE(near(mean_radiance(render(stage, image, settings)), 0.5 + glm::dvec3(0, 0.8 / 3, 0), 2e-3)) << spp;
    }
    if (kOnDevice) return;  // it would compile another shader
    RenderSettings settings = filtered_settings(above(0));
    settings.gi = 1;
    EXPECT_TRUE(near(mean_radiance(render(stage, everywhere, settings)), glm::dvec3(1), 1e-5))
        << "diffuse rays bring no light of the environment's";
}

TEST_F(FilteredLightTest, WallsHideAboutWhatTheyHide) {
    const Environment everywhere = filtered(white);
    const Stage stage = floor_and_wall();
    double worst = 0, worst_of_many = 0;
    for (const float x : {0.01f, 0.2f, 0.5f, 1.f, 2.f, -0.01f, -0.7f}) {
        if (kOnDevice && x != 0.01f && x != 1.f) continue;
        // Of a sheet that goes on to both sides a point sees a share of 1 - the cosine to its edge, halved.
        const double want = 1 - (1 - std::abs(x) / std::hypot(x, 1)) / 2;
        const double one = light_at(stage, everywhere, x, 1), many = light_at(stage, everywhere, x, FILTERED_SETS);
        EXPECT_NEAR(one, want, 0.1) << x;
        EXPECT_NEAR(many, want, 0.02) << x;
        worst = std::max(worst, std::abs(one - want));
        worst_of_many = std::max(worst_of_many, std::abs(many - want));
    }
    RecordProperty("worst", fmt::format("{:.4f}, of all sets {:.4f}", worst, worst_of_many));
    RenderSettings settings = filtered_settings(above(0.2f));
    settings.shadow = false;
    EXPECT_TRUE(near(mean_radiance(render(stage, everywhere, settings)), glm::dvec3(1), 1e-5)) << "nothing occludes";
    settings.ambient = true;
    EXPECT_LT(mean_radiance(render(stage, everywhere, settings)).y, 0.75) << "occlusion alone";
}

TEST_F(FilteredLightTest, BrightSidesThatAreHiddenDarkenMore) {
    // All light comes from the right half of the sky.
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < 64 * 32; i++) pixels.push_back(glm::vec4(glm::vec3(float(i % 64 / 32)), 1));
    const Environment half = filtered(image_environment(64, 32, pixels));
    const Stage stage = floor_and_wall();
    const double open = light_at(stage, half, 400, 1);
    EXPECT_NEAR(open, 0.5, 0.02);
    EXPECT_NEAR(light_at(stage, half, 0.05f, 1), open, 0.1 * open) << "the wall hides what is dark";
    EXPECT_LT(light_at(stage, half, -0.05f, 1), 0.15 * open);
}

TEST_F(FilteredLightTest, IsFreeOfNoise) {
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < 32 * 16; i++) pixels.push_back(glm::vec4(0.2f + 0.1f * float(i * 7 % 11), 1, 0.5f, 1));
    const Environment image = filtered(image_environment(32, 16, pixels));
    Material gloss = lambert({0.7f, 0.5f, 0.3f});
    gloss.ior = 1.5f;
    gloss.roughness = 0.4f;
    Stage stage;
    stage.add(ground(30), gloss);
    stage.add(parallelogram({0, 0, 30}, {0, 0, -60}, {0, 1, 0}), gloss);
    for (const uint32_t spp : {1u, 3u}) {
        RenderSettings settings = filtered_settings(perspective({4, 3, 2}, {0, 0, 0}, 50), 16, spp);
        const Picture one = render(stage, image, settings);
        settings.seed = 7;
        const Picture other = render(stage, image, settings);
        EXPECT_EQ(one.radiance, other.radiance) << spp;
    }
    // Where no shadow's edge is, neighbours hardly differ.
    Stage open;
    open.add(ground(30), gloss);
    const Picture plane = render(open, image, filtered_settings(perspective({4, 3, 2}, {0, 0, 0}, 10), 16));
    for (uint32_t i = 1; i < 16 * 16; i++) {
        if (i % 16 == 0) continue;
        EXPECT_NEAR(plane.radiance[i].y, plane.radiance[i - 1].y, 0.01f * plane.radiance[i].y) << i;
    }
}

TEST_F(FilteredLightTest, RoughMirrorsSeeTheirLobe) {
    // Seen along the normal, the lobe of GGX is round; what it makes of light that grows linearly along d follows from
    // its mean cosine.
    const Environment image = filtered(direction_image(256));
    for (const double roughness : {0.15, 0.4, 0.7, 1.0}) {
        if (kOnDevice && roughness != 0.4) continue;
        Material metal = plane_mirror();
        metal.roughness = float(roughness);
        double cosines = 0, weights = 0;
        const double alpha = roughness * roughness;
        for (int i = 0; i < 20000; i++) {
            const double cosine = (i + 0.5) / 20000, half2 = 0.5 * (1 + cosine),
                         width = half2 * (alpha * alpha - 1) + 1, weight = cosine / (width * width);
            cosines += weight * cosine;
            weights += weight;
        }
        Stage stage;
        stage.add(ground(8), metal);
        const glm::dvec3 got = mean_radiance(render(stage, image, filtered_settings(above(0))));
        EXPECT_NEAR(got.y, 0.5 + 0.4 * cosines / weights, 0.02) << roughness;
        EXPECT_NEAR(got.x, 0.5, 0.01) << roughness;
    }
}

TEST_F(FilteredLightTest, WhiteSurfacesLoseNothing) {
    if (kOnDevice) GTEST_SKIP() << "the reference is held to it";
    Material steel = plane_mirror(), varnished = lambert({1, 1, 1}), velvet = lambert({1, 1, 1}), paper = velvet;
    steel.roughness = 0.5f;
    varnished.clearcoat = 0.7f;
    varnished.coat_roughness = 0.3f;
    velvet.sheen_color = {1, 1, 1};
    velvet.sheen_roughness = 0.4f;
    paper.diffuse_transmission = 0.4f;
    for (const Material& m : {steel, varnished, velvet, paper}) {
        Stage stage;
        stage.add(brushed_square(), m);
        const Picture picture = render(stage, filtered(white), filtered_settings(slanted(kSlant)));
        EXPECT_TRUE(near(mean_radiance(picture), glm::dvec3(1), 0.012)) << text(mean_radiance(picture));
    }
}

TEST_F(FilteredLightTest, LampsThatStandForSpotsCountOnce) {
    if (kOnDevice) GTEST_SKIP() << "the reference is held to it";
    // A spot of 2000 texels' light overhead in a grey sky: the lamp's light, and the rest's.
    std::vector<glm::vec4> pixels(128 * 64, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    for (uint32_t x = 32; x < 34; x++) pixels[16 * 128 + x] = glm::vec4(900, 900, 900, 1);
    const Environment image = filtered(image_environment(128, 64, pixels));
    ASSERT_EQ(image.lights.size(), 1u);
    for (const glm::vec4& texel : image.filtered.texels) ASSERT_LT(texel.x, 1);
    double light = 0;
    for (size_t k = 0; k < FILTERED_DIRECTIONS; k++) light += image.filtered.directions[k].light.x;
    EXPECT_NEAR(light, 2 * kPi, 0.05);
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    const glm::dvec3 got = mean_radiance(render(stage, image, filtered_settings(above(0))));
    const double lamp = image.lights[0].color.x * -image.lights[0].direction.y / kPi;
    EXPECT_NEAR(got.x, 0.5 + lamp, 0.02 * (0.5 + lamp));
}

TEST_F(FilteredLightTest, CatchersShowTheShade) {
    if (kOnDevice && !test::effort(false, true)) GTEST_SKIP() << "a shader more to compile";
    // A disc of radius 1 at height 1 hides half of the cosine's weight from the point below its middle.
    Material catcher = lambert({0.5f, 0.5f, 0.5f});
    catcher.catcher = true;
    catcher.double_sided = false;
    Stage stage;
    stage.add(ground(8), catcher);
    stage.add(disc({0, 1, 0}, 1), emitting({0, 0, 0}));
    RenderSettings settings = filtered_settings(above(0), 4, FILTERED_SETS);
    settings.backdrop = {Backdrop::Kind::transparent, glm::vec3(0)};
    EXPECT_NEAR(render(stage, filtered(white), settings).radiance[5].w, 0.5, 0.05);
    settings.shadow = false;
    EXPECT_NEAR(render(stage, filtered(white), settings).radiance[5].w, 0, 1e-5);
}

}  // namespace
}  // namespace peelray
