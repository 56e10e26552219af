// Pictures by a workspace, as a program that is no command line makes them.
#include "workspace/workspace.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "made_pictures.h"
#include "workspace/render_settings.h"

namespace peelray {
namespace {

PictureArguments small(const char* scene, Tracer tracer = Tracer::ldc) {
    PictureArguments settings;
    settings.scene = scene;
    settings.size = {32, 24};
    settings.tracing.tracer = tracer;
    settings.bounces = 2;
    return settings;
}

TEST(Workspace, AFewLinesMakeAPicture) {
    Workspace workspace(small("builtin:glass"));
    const MadePicture made = workspace.render();
    EXPECT_EQ(made.picture.encoded.size(), 32u * 24);
    EXPECT_EQ(made.stats.width, 32u);
    EXPECT_EQ(made.stats.triangles, workspace.scene().triangles());
    EXPECT_GT(made.stats.rays.secondary(), 0u);
    EXPECT_TRUE(made.stats.has_cubes());
    EXPECT_FALSE(made.stats.by_cpu());
    EXPECT_FALSE(made.stats.machine.api_version.empty());
}

TEST(Workspace, AMomentIsTheSameAloneAndAfterOthers) {
    struct Case {
        const char* scene;
        Tracer tracer;
    };
    for (const Case& c : {Case{"builtin:waves:200", Tracer::cubemap}, Case{"builtin:particles:50", Tracer::ldc},
                          Case{"builtin:walker", Tracer::reference}}) {
        SCOPED_TRACE(fmt::format("{} {}", c.scene, int(c.tracer)));
        PictureArguments settings = small(c.scene, c.tracer);
        settings.time = 0.2;
        Workspace workspace(settings);
        const MadePicture first = workspace.render();
        const MadePicture later = workspace.render({.time = 0.9});
        settings.time = 0.9;
        expect_identical(Workspace(settings).render(), later);
        expect_identical(workspace.render({.time = 0.2}), first);
        EXPECT_NE(first.picture.encoded, later.picture.encoded) << "something moves";
    }
}

TEST(Workspace, TracersOneAfterTheOther) {
    Workspace workspace(small("builtin:teapots"));
    const MadePicture ldc = workspace.render();
    const MadePicture reference = Workspace(small("builtin:teapots", Tracer::reference)).render();
    EXPECT_TRUE(reference.stats.by_cpu());
    EXPECT_EQ(reference.stats.machine.kind, "cpu");
    ASSERT_EQ(reference.stats.render.passes.size(), 2u);
    EXPECT_EQ(reference.stats.rays.primary, ldc.stats.rays.primary);
    size_t different = 0;
    for (size_t i = 0; i < ldc.picture.encoded.size(); i++)
        different += ldc.picture.encoded[i] != reference.picture.encoded[i];
    EXPECT_LT(different, ldc.picture.encoded.size() / 4);
}

TEST(Workspace, TheCameraGoesRound) {
    Workspace workspace(small("builtin:teapots"));
    const MadePicture front = workspace.render(), side = workspace.render({.number = 1, .turntable = 4});
    EXPECT_NE(front.picture.encoded, side.picture.encoded);
    expect_identical(workspace.render(), front);
}

TEST(Workspace, MotionIsWhatTheFrameBeforeShowsByEveryTracer) {
    for (const char* scene : {"builtin:waves:200", "builtin:particles:1000"}) {
        SCOPED_TRACE(scene);
        std::vector<std::vector<glm::vec2>> motions;
        std::vector<std::vector<float>> triangles;
        for (const Tracer tracer : {Tracer::ldc, Tracer::none, Tracer::reference}) {
            PictureArguments arguments = small(scene, tracer);
            arguments.animation = "0";
            Workspace workspace(arguments);
            RenderSettings settings = render_settings(arguments);
            settings.aovs = settings.motion = true;
            workspace.render(settings, {.time = 0.8});
            const Aovs aovs = workspace.render(settings, {.time = 0.6, .fps = 10}).picture.aovs;
            motions.push_back(aovs.motion);
            triangles.push_back(aovs.triangle);
            for (const glm::vec2& v : workspace.render(settings, {.fps = 0}).picture.aovs.motion)
                ASSERT_EQ(v, glm::vec2(0)) << "all stands still";
            const auto round =
                workspace.render(settings, {.fps = 0, .number = 0, .turntable = 100}).picture.aovs.motion;
            EXPECT_GT(std::ranges::count_if(round, [](const auto& v) { return glm::length(v) > 0.05f; }), 50);
        }
        size_t moved = 0;
        for (size_t i = 0; i < motions[0].size(); i++) {
            EXPECT_EQ(motions[0][i], motions[1][i]);
            if (triangles[0][i] != triangles[2][i]) continue;  // at an edge
            EXPECT_LT(glm::length(motions[0][i] - motions[2][i]), 5e-3f) << i;
            moved += glm::length(motions[0][i]) > 0.05f;
        }
        EXPECT_GT(moved, 10u);
    }
}

TEST(Workspace, ToldOfProgressAndEndedByIt) {
    PictureArguments settings = small("builtin:teapots");
    settings.spp = 2;  // so small a picture is told of once a sample
    Workspace workspace(settings);
    double last = -1;
    workspace.render({}, [&](double share) {
        EXPECT_GE(share, last);
        last = share;
    });
    EXPECT_GT(last, 0);
    EXPECT_THROW(workspace.render({}, [](double) { fail("enough"); }), Error);
    EXPECT_NO_THROW(workspace.render()) << "and goes on";
}

TEST(Workspace, ANoteIsGivenOnceAndNothingIsPrinted) {
    PictureArguments settings = small("builtin:teapots");
    settings.tracing.hit = HitTest::tolerance;
    settings.tracing.tolerance = 1e-7;
    std::vector<std::string> notes;
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    Workspace workspace(settings, [&](const std::string& text) { notes.push_back(text); });
    workspace.render();
    workspace.render();
    EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
    size_t count = 0;
    for (const std::string& text : notes) count += text.find("rays slip through") != std::string::npos;
    EXPECT_EQ(count, 1u);
}

}  // namespace
}  // namespace peelray
