// The seam between a frame and who traces its rays, and that between a picture and what is done to it afterwards.
#include <pictures.h>

#include "common/ray.h"
#include "render/ray_scene.h"

namespace peelray {
namespace {

class Tracers : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), plane_mirror());
        stage.add(sphere({0, 0, 3}, 0.5f, 16), lambert({0.8f, 0.5f, 0.2f}));
        stage.lamp({1, 2, 2}, {10, 10, 10});
    }
    std::vector<Tracer> possible() {
        std::vector<Tracer> all = {Tracer::ldc, Tracer::cubemap, Tracer::none};
        if (device().features.ray_tracing) all.push_back(Tracer::khr);
        return all;
    }
    RenderSettings settings(Tracer tracer) {
        RenderSettings s = settings_for(perspective({0.5f, 0.5f, 5}, {0, 0, 0}, 50), 32);
        s.tracer = tracer;
        return s;
    }
    static uint64_t cube_bytes(const RenderStats& stats) {
        uint64_t bytes = 0;
        for (const Allocation& allocation : stats.memory) bytes += allocation.part == "cubes" ? allocation.bytes : 0;
        return bytes;
    }
    Stage stage;
};

TEST_F(Tracers, AnswerTheSameQuestions) {
    const Moment rest = at_rest(stage.scene);
    const Assembly assembly = assemble(stage.scene, rest, motion_of(stage.scene, ""));
    // At the mirror, at the ball, past both.
    const std::vector<Ray> rays = {
        {{0.5f, 0.5f, 1}, 0, {0, 0, -1}, 10}, {{0.1f, 0.1f, 6}, 0, {0, 0, -1}, 10}, {{3, 3, 3}, 0, {0, 0, -1}, 10}};
    for (const Tracer tracer : possible()) {
        SCOPED_TRACE(int(tracer));
        TracerChoice choice;
        choice.tracer = tracer;
        RayScene scene(device(), stage.scene, rest, assembly, choice);
        const bool traces = scene.tracer().traces();
        EXPECT_EQ(traces, tracer == Tracer::ldc || tracer == Tracer::khr);
        EXPECT_EQ(scene.tracer().counts(), tracer == Tracer::ldc);
        EXPECT_EQ(scene.tracer().bodies().bodies().size(), assembly.bodies.size());
        const Buffer ray_buffer = upload<Ray>(rays), hits(device(), "hits", rays.size() * sizeof(FileHit));
        scene.record(commands(), ray_buffer, uint32_t(rays.size()), hits, false);
        commands().submit();
        const auto found = download<FileHit>(hits, rays.size());
        EXPECT_EQ(found[0].triangle != ~0u, traces);
        EXPECT_EQ(found[1].triangle != ~0u, traces);
        EXPECT_EQ(found[2].triangle, ~0u);
        EXPECT_TRUE(!traces || std::abs(found[0].t - 1) < 1e-5) << found[0].t;
        scene.record_build(commands());
        commands().submit();
        EXPECT_TRUE(scene.finish_build(commands()));
        const TracerStats stats = scene.stats(commands());
        EXPECT_EQ(stats.cubes.bodies > 0, tracer == Tracer::ldc);
        EXPECT_EQ(stats.structures.bodies > 0, tracer == Tracer::khr);
    }
}

TEST_F(Tracers, NoCubesWhereNobodyTracesThem) {
    for (const Tracer tracer : possible()) {
        SCOPED_TRACE(int(tracer));
        const RenderResult picture = renderer_for(stage, white)->render(settings(tracer));
        EXPECT_EQ(cube_bytes(picture.stats) > 0, tracer == Tracer::ldc);
        EXPECT_EQ(picture.stats.cubes.bodies > 0, tracer == Tracer::ldc);
        EXPECT_EQ(picture.stats.tracer, tracer);
    }
}

TEST_F(Tracers, TakeTurnsInOneRenderer) {
    const auto renderer = renderer_for(stage, white);
    std::vector<RenderResult> first;
    for (const Tracer tracer : possible()) first.push_back(renderer->render(settings(tracer)));
    for (size_t i = 0; i < first.size(); i++) {
        const Tracer tracer = possible()[i];
        SCOPED_TRACE(int(tracer));
        const RenderResult again = renderer->render(settings(tracer));
        EXPECT_EQ(again.radiance, first[i].radiance);
        EXPECT_EQ(cube_bytes(again.stats) > 0, tracer == Tracer::ldc) << "one tracer at a time";
    }
}

TEST_F(Tracers, PostPassesWorkBetweenAccumulationAndToneMapping) {
    RenderSettings s = settings(Tracer::ldc);
    s.spp = 3;
    s.exposure = -0.5f;
    const RenderResult plain = renderer_for(stage, white)->render(s);
    uint32_t calls = 0;
    const auto renderer = renderer_for(stage, white);
    renderer->add_post_pass([&](Commands&, const Buffer& picture, const PictureSettings& of) {
        calls++;
        EXPECT_GE(picture.bytes(), 32u * 32 * 16);
        EXPECT_EQ(of.spp, 3u);
    });
    const RenderResult same = renderer->render(s);
    EXPECT_EQ(calls, 1u);
    EXPECT_EQ(same.radiance, plain.radiance);
    EXPECT_EQ(same.encoded, plain.encoded) << "encoded in a pass of its own, bit for bit";

    renderer->add_post_pass(
        [](Commands& commands, const Buffer& picture, const PictureSettings&) { commands.fill(picture, 0); });
    const RenderResult black_picture = renderer->render(s);
    for (const uint32_t pixel : black_picture.encoded) ASSERT_EQ(pixel, 0xff000000u);
    EXPECT_EQ(black_picture.radiance[500], glm::vec4(0));
}

}  // namespace
}  // namespace peelray
