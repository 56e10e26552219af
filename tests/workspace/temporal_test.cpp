// --denoise temporal: pictures depend on the moments before, and on nothing else.
#include <algorithm>
#include <numeric>

#include "made_pictures.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

PictureArguments arguments_for(const char* scene, Tracer tracer, Denoise denoise = Denoise::temporal) {
    PictureArguments a;
    a.scene = scene;
    a.size = {40, 32};
    a.tracing.tracer = tracer;
    a.bounces = 2;
    a.effects.add(Effect::ambient);
    a.denoise = denoise;
    return a;
}

Shot at_frame(int64_t frame) {
    return {.time = double(frame) / 30, .fps = 30, .number = frame};
}

/// Mean squared difference of the luminances, where both see surfaces.
double distance(const MadePicture& a, const MadePicture& b) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < a.picture.radiance.size(); i++) {
        const glm::vec4 &left = a.picture.radiance[i], &right = b.picture.radiance[i];
        if (left.w < 1 || right.w < 1) continue;
        sum += std::pow(double(left.y) - right.y, 2);
        count++;
    }
    return sum / count;
}

/// By the command line in shards and resumed runs: tests/cli/temporal_test.cpp.
TEST(Temporal, AFrameIsTheSameInAnyRun) {
    for (const Tracer tracer : {Tracer::ldc, Tracer::reference}) {
        SCOPED_TRACE(name_of(tracer));
        const PictureArguments a = arguments_for("builtin:particles:50", tracer);
        PictureArguments moving = a;
        moving.animation = "0";
        // Frame 3 after others, of which it needs only itself, and alone at its time.
        Workspace whole(moving);
        MadePicture third;
        for (int64_t frame = 0; frame <= 3; frame++) {
            third = whole.render(at_frame(frame));
            EXPECT_EQ(third.stats.warm_up_pictures, frame == 0 ? uint32_t(DENOISE_WARM_UP) : 0u) << frame;
        }
        PictureArguments alone = a;
        alone.time = 3.0 / 30;
        expect_identical(Workspace(alone).render(Shot{.fps = 30}), third);
        // Back again, where some of the kept pictures are of use.
        const MadePicture first = whole.render(at_frame(1));
        EXPECT_EQ(first.stats.warm_up_pictures, 2u);
        expect_identical(whole.render(at_frame(3)), third);
    }
}

TEST(Temporal, OtherSettingsInBetweenDoNotShapeIt) {
    PictureArguments a = arguments_for("builtin:particles:50", Tracer::reference);
    a.animation = "0";
    a.size = {24, 20};
    Workspace workspace(a);
    const MadePicture before = workspace.render(at_frame(3));
    for (const auto& change : std::vector<std::function<void(RenderSettings&)>>{
             [](RenderSettings& s) { s.denoise = Denoise::spatial; }, [](RenderSettings& s) { s.seed = 5; },
             [](RenderSettings& s) { s.width = 16; }, [](RenderSettings& s) { s.tracer = Tracer::ldc; }}) {
        RenderSettings settings = render_settings(a);
        change(settings);
        workspace.render(settings, at_frame(3));
        expect_identical(workspace.render(at_frame(3)), before);
    }
}

TEST(Temporal, MomentsBetweenFramesAreDefined) {
    PictureArguments a = arguments_for("builtin:particles:50", Tracer::reference);
    a.time = 0;
    Workspace workspace(a);
    expect_identical(workspace.render(at_frame(0)), Workspace(a).render());
    // 0.51 of a frame has the number 0, and everything before it stands at the beginning.
    const Shot between = Shot{.time = 0.51 / 30}.at(0.51 / 30);
    EXPECT_EQ(*between.number, 0);
    EXPECT_EQ(*between.before().number, -1);
    EXPECT_EQ(*between.before().time, 0);
    for (int64_t frame = 0; frame < 1000; frame++) {
        const double time = double(frame) / 29.97;
        EXPECT_EQ(*(Shot{.fps = 29.97}.at(time).number), frame);
    }
}

/// Without mirror images: their noise is no part of what is denoised where the surface scatters light itself. Noise is
/// what differs between pictures of other random numbers.
TEST(Temporal, WhatStandsStillGetsLessNoisyAndHardlyFlickers) {
    const auto made = [](Denoise denoise, uint32_t seed, int64_t number = 0) {
        PictureArguments a = arguments_for("builtin:teapots", Tracer::reference, denoise);
        a.size = {80, 64};
        a.effects = {Effect::shadow, Effect::ambient};
        a.seed = seed;
        return Workspace(a).render({.fps = 0, .number = number});
    };
    const auto noise = [&](Denoise denoise) { return distance(made(denoise, 0), made(denoise, 7)); };
    const double raw = noise(Denoise::none), spatial = noise(Denoise::spatial), temporal = noise(Denoise::temporal);
    EXPECT_LT(temporal, 1.2 * raw / (DENOISE_WARM_UP + 1));
    EXPECT_LT(temporal, 0.5 * spatial);
    // The next frame, of the same six pictures.
    EXPECT_LT(distance(made(Denoise::temporal, 0, 1), made(Denoise::temporal, 0)), 0.3 * temporal);
}

TEST(Temporal, BothTracersMakeTheSamePicture) {
    for (const char* scene : {"builtin:glass", "builtin:particles:200"}) {
        SCOPED_TRACE(scene);
        const auto made = [&](Tracer tracer) {
            PictureArguments a = arguments_for(scene, tracer);
            a.animation = std::string(scene) == "builtin:glass" ? "" : "0";
            // The camera goes round, so that images in mirrors move.
            Workspace workspace(a);
            return workspace.render({.time = 0.3, .fps = 30, .number = 9, .turntable = 90});
        };
        const MadePicture ldc = made(Tracer::ldc), reference = made(Tracer::reference);
        size_t different = 0;
        for (size_t i = 0; i < ldc.picture.radiance.size(); i++)
            different += glm::length(glm::vec3(ldc.picture.radiance[i] - reference.picture.radiance[i])) > 0.02f;
        EXPECT_LT(different, ldc.picture.radiance.size() / 25);  // edges
    }
}

}  // namespace
}  // namespace peelray
