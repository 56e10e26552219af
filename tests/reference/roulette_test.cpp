// Of many samples, the single-precision tracer follows dim paths now and then: in the mean nothing is lost.
#include <pictures.h>

namespace peelray {
namespace {

class RouletteTest : public PictureTest {
  protected:
    /// Of what a ball reflects inside, each path brings little and all together a few hundredths.
    static Stage glass_ball() {
        Stage stage;
        Material m = thin_glass();
        m.thickness = 1;
        stage.add(sphere({0, 0, 0}, 1, 32), m);
        return stage;
    }
    static RenderSettings settings_for_ball() {
        RenderSettings settings = settings_for(orthographic({0, 0, 4}, {0, 0, 0}, 1.9f), 32);
        settings.bounces = 8;
        return settings;
    }
    /// Means over the picture's pixels, with as many samples as roulette begins at, and with fewer.
    void expect_the_same_mean(const Stage& stage, const Environment& environment, RenderSettings settings,
                              double tolerance) {
        settings.spp = 16;
        const glm::dvec3 all = mean_radiance(render(stage, environment, settings));
        settings.spp = 64;
        const glm::dvec3 some = mean_radiance(render(stage, environment, settings));
        for (int c = 0; c < 3; c++) EXPECT_NEAR(some[c], all[c], tolerance * all[c]);
    }
};

TEST_F(RouletteTest, WhatGlassReflectsIsThereInTheMean) {
    expect_the_same_mean(glass_ball(), white, settings_for_ball(), 0.001);
}

TEST_F(RouletteTest, ClampedSamplesLoseNothingToIt) {
    // No sample is brighter than the world, unless it stands for others.
    RenderSettings settings = settings_for_ball();
    settings.clamp = 1.01f;
    expect_the_same_mean(glass_ball(), white, settings, 0.001);
}

TEST_F(RouletteTest, DimEmittersLightInTheMean) {
    // A tenth of the world's light each way.
    Stage stage;
    stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert({0.8f, 0.8f, 0.8f}));
    Material lamp = lambert({0, 0, 0});
    lamp.emissive = glm::vec3(0.3f, 0.2f, 0.1f);
    stage.add(parallelogram({-1, -1, 0.5f}, {0, 2, 0}, {0, 0, 1}), lamp);
    RenderSettings settings = settings_for(orthographic({0, 0, 4}, {0, 0, 0}, 1.6f), 48);
    expect_the_same_mean(stage, color_environment(glm::vec3(0.5f)), settings, 0.005);
}

}  // namespace
}  // namespace peelray
