// The queue of shadow rays: several lights, room for them, the same picture every time.
#include <pictures.h>

namespace peelray {
namespace {

class LightQueueTest : public PictureTest {
  protected:
    static constexpr int kLights = 7;

    /// A mirror, a glass pane and solid bodies under some of seven lights.
    static Stage stage_with(std::initializer_list<int> lights) {
        Stage stage;
        stage.add(ground(3), lambert({0.8f, 0.7f, 0.6f}));
        stage.add(turned(box({-0.5f, 0, -0.4f}, {0.5f, 0.7f, 0.4f}), 31, {0, 1, 0}), lambert({1, 0.5f, 0.2f}));
        stage.add(parallelogram({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}), plane_mirror());
        for (int i : lights)
            stage.lamp({std::cos(i * 0.9f) * 2, 1.5f + 0.2f * float(i), std::sin(i * 0.9f) * 1.5f + 0.5f},
                       {1 + float(i % 3), 2, 3 - float(i % 3)});
        return stage;
    }
    static RenderSettings with_effects() {
        RenderSettings settings = settings_for(perspective({0.5f, 2.5f, 4}, {0, 0.4f, 0}, 50), 80);
        settings.bounces = 2;
        return settings;
    }
};

TEST_F(LightQueueTest, LightsAddUpWhateverRoomTheyNeed) {
    const RenderSettings settings = with_effects();
    const RenderResult all = render(stage_with({0, 1, 2, 3, 4, 5, 6}), black, settings);
    EXPECT_GT(all.stats.redone, 0u) << "seven rays a pixel, room for one";
    EXPECT_GT(all.rays.shadow, 20000u);
    std::vector<glm::vec4> sum(all.radiance.size(), glm::vec4(0));
    uint64_t rays = 0;
    for (int i = 0; i < kLights; i++) {
        const RenderResult one = render(stage_with({i}), black, settings);
        rays += one.rays.shadow;
        for (size_t k = 0; k < sum.size(); k++) sum[k] += one.radiance[k];
    }
    EXPECT_EQ(rays, all.rays.shadow);
    Tally result;
    for (size_t k = 0; k < sum.size(); k++)
        result.add(near(glm::dvec3(sum[k]), glm::dvec3(all.radiance[k]), 1e-4), [&] {
            return fmt::format("pixel {}: {}, in turn {}", k, text(glm::dvec3(all.radiance[k])),
                               text(glm::dvec3(sum[k])));
        });
    result.expect(0, 80 * 80);
}

TEST_F(LightQueueTest, ThePictureIsTheSameBitByBit) {
    const Stage stage = stage_with({0, 1, 2, 3, 4, 5, 6});
    RenderSettings settings = with_effects();
    settings.ambient = true;
    settings.spp = 2;
    const auto renderer = renderer_for(stage, white);
    const RenderResult first = renderer->render(settings), second = renderer->render(settings),
                       other = render(stage, white, settings);
    EXPECT_GT(first.rays.ambient, 1000u);
    EXPECT_EQ(first.radiance, second.radiance);
    EXPECT_EQ(first.radiance, other.radiance);
    EXPECT_EQ(first.encoded, other.encoded);
    EXPECT_EQ(first.rays.shadow, other.rays.shadow);
    // One submission once the cubes are known to find room, and without stamps between the passes.
    settings.time_passes = false;
    settings.repeat = 3;
    settings.rebuild = true;
    const RenderResult untimed = renderer->render(settings);
    EXPECT_EQ(first.radiance, untimed.radiance);
    EXPECT_GT(untimed.stats.frame_ms, untimed.stats.build_ms);
    EXPECT_GT(untimed.stats.build_ms, 0);
    for (const auto& pass : untimed.stats.passes) EXPECT_TRUE(pass.name.ends_with("all") || pass.name == "all passes");
}

}  // namespace
}  // namespace peelray
