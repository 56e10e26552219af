// Emissive triangles as lights.
#include <pictures.h>

#include "finishes.h"

namespace peelray {
namespace {

using EmitterTest = DrawnLightTest;

const glm::dvec3 kGlow(5, 4, 3);

/// A rectangle parallel to the surface, at this height above the origin.
struct Panel {
    glm::dvec2 lower, upper;
    double z;

    Primitive shape() const {
        return parallelogram({lower.x, lower.y, z}, {upper.x - lower.x, 0, 0}, {0, upper.y - lower.y, 0});
    }
    /// What a surface at the origin sends of its light: a sum over its points.
    glm::dvec3 lights(const Finish& finish, const glm::dvec3& view) const {
        constexpr int side = 300;
        const glm::dvec2 step = (upper - lower) / double(side);
        glm::dvec3 sum(0);
        for (int i = 0; i < side * side; i++) {
            const glm::dvec3 p(lower + step * (glm::dvec2(i % side, i / side) + 0.5), z);
            const double distance = glm::length(p);
            sum += finish.sends(view, p / distance) * std::abs(z) / (distance * distance * distance);
        }
        return sum * step.x * step.y * kGlow;
    }
};

TEST_F(EmitterTest, PanelsLightAsTheIntegralSays) {
    if (kOnDevice) GTEST_SKIP() << "the reference is held to it";
    const Panel before{{-2.2, -0.6}, {-0.4, 0.5}, 1}, behind{{-1, -1}, {1, 0.6}, -1.5};
    const Environment dark = with_distribution(black);
    for (const Finish& finish : finishes(kSlant)) {
        SCOPED_TRACE(finish.name);
        Stage stage = square_of(finish.material);
        for (const Panel& panel : {before, behind}) stage.add(panel.shape(), emitting(glm::vec3(kGlow)));
        const glm::dvec3 want = before.lights(finish, to_slanted(kSlant)) + behind.lights(finish, to_slanted(kSlant));
        Camera camera = slanted(kSlant);
        camera.orthographic_height = 0.01f;
        for (const EnvironmentMode mode : {EnvironmentMode::open, EnvironmentMode::sampled}) {
            RenderSettings settings = sampled_settings(camera, 16, 4);
            settings.env_mode = mode;
            settings.energy_compensation = false;
            for (const uint32_t bounces : {4u, 0u}) {
                settings.bounces = bounces;
                estimate(stage, dark, settings, 8).expect(want, 5e-3);
            }
        }
    }
}

TEST_F(EmitterTest, OneSampleWithoutBouncesSeesThemAsBefore) {
    Stage stage = square_of(lambert({1, 1, 1}));
    stage.add(Panel{{-1, -1}, {0.5, 1}, 1}.shape(), emitting(glm::vec3(kGlow)));
    const Camera camera = orthographic({2, 0, 0.5f}, {0, 0, 0}, 0.01f);
    RenderSettings settings = settings_for(camera, 4);
    EXPECT_TRUE(near(mean_radiance(render(stage, black, settings)), glm::dvec3(0), 1e-6));
    settings.gi = 1;
    EXPECT_GT(mean_radiance(render(stage, black, settings)).x, 0.5);
}

// --- Indirect light ---

TEST_F(EmitterTest, InsideOfAGlowingBallLightGrowsByBounces) {
    // Everything sees everything: each bounce adds its share of what was there.
    Stage stage;
    Material glowing = lambert({0.8f, 0.5f, 0.2f});
    glowing.emissive = {1, 1, 1};
    stage.add(inside_out(sphere({0, 0, 0}, 1, 24)), glowing);
    for (const uint32_t gi : {0u, 1u, 3u})
        for (const uint32_t bounces : {0u, 4u}) {
            SCOPED_TRACE(fmt::format("gi {}, bounces {}", gi, bounces));
            RenderSettings settings = settings_for(perspective({0, 0, 0}, {0.3f, 0.2f, -1}, 60), 16);
            settings.spp = 4;
            settings.gi = gi;
            settings.bounces = bounces;
            glm::dvec3 want(1), bounced(1);
            for (uint32_t i = 0; i <= gi; i++) want += bounced *= glm::dvec3(0.8, 0.5, 0.2);
            estimate(stage, black, settings, 6).expect(want, 0.01);
        }
}

TEST_F(EmitterTest, WhiteWallsInWhiteLightAreWhite) {
    // Two walls at right angles: what the other hides of the sky it gives back, but for what has bounced too often.
    Stage stage;
    stage.add(parallelogram({-40, -40, 0}, {80, 0, 0}, {0, 80, 0}), lambert({1, 1, 1}));
    stage.add(parallelogram({-0.5f, -40, 0}, {0, 80, 0}, {0, 0, 80}), lambert({1, 1, 1}));
    const Environment everywhere = with_distribution(white);
    for (const EnvironmentMode mode : {EnvironmentMode::open, EnvironmentMode::sampled}) {
        RenderSettings settings = sampled_settings(orthographic({0.5f, 0, 2}, {0, 0, 0}, 0.02f), 16, 4);
        settings.env_mode = mode;
        settings.gi = 10;
        // The last bounce sees the open sky, or what there is of it: half of its half, and so on.
        estimate(stage, everywhere, settings, 6).expect(glm::dvec3(1), 0.01);
    }
}

}  // namespace
}  // namespace peelray
