// Pictures by the device's own ray tracing: those of the cubes.
#include "image/metrics.h"
#include "khr_fixture.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "render/renderer.h"
#include "scene/environment.h"

namespace peelray {
namespace {

class KhrPictures : public KhrTest {
  protected:
    const Environment sky_ = sky_environment(default_sun_direction());

    struct Shown {
        Scene scene;
        std::string animation;
        std::unique_ptr<Renderer> renderer;
    };
    Shown show(const std::string& name, double time = -1, bool single_sided = false) {
        Shown shown{load_scene(name), {}, {}};
        for (Material& material : shown.scene.materials) material.double_sided = !single_sided;
        if (time >= 0) shown.animation = "0";
        complete_targets(shown.scene);
        const Moment moment = moment_of(shown.scene, shown.animation, time);
        shown.renderer =
            std::make_unique<Renderer>(device(), shown.scene, moment,
                                       assemble(shown.scene, moment, motion_of(shown.scene, shown.animation)), sky_);
        return shown;
    }
    static RenderSettings settings(const Scene& scene, Tracer tracer) {
        RenderSettings s;
        s.width = 96;
        s.height = 80;
        if (!scene.cameras.empty()) s.camera = scene.cameras[0];
        s.tracer = tracer;
        s.bounces = 3;
        s.hit_auto = false;
        return s;
    }
    static double flip_between(const RenderResult& a, const RenderResult& b) {
        return compare({a.width, a.height, a.encoded}, {b.width, b.height, b.encoded}).flip;
    }
    static double ms_of(const RenderResult& picture, const std::string& pass) {
        for (const auto& time : picture.stats.passes)
            if (time.name == pass) return time.ms;
        return -1;
    }
};

TEST_F(KhrPictures, AreThoseOfTheCubes) {
    for (const char* name : {"builtin:teapots", "builtin:glass", "builtin:leaves", "builtin:particles:50"}) {
        SCOPED_TRACE(name);
        const Shown shown = show(name);
        RenderSettings khr = settings(shown.scene, Tracer::khr), ldc = settings(shown.scene, Tracer::ldc);
        khr.ambient = ldc.ambient = true;
        const RenderResult a = shown.renderer->render(khr), b = shown.renderer->render(ldc);
        fmt::print("  {}: FLIP {:.5f}, {} rays and {}\n", name, flip_between(a, b), a.rays.secondary(),
                   b.rays.secondary());
        EXPECT_LT(flip_between(a, b), 0.002);
        EXPECT_NEAR(double(a.rays.secondary()), double(b.rays.secondary()), 0.002 * double(b.rays.secondary()));
        EXPECT_EQ(a.stats.tracer, Tracer::khr);
        EXPECT_GT(a.stats.structures.bytes, 0u);
        EXPECT_EQ(a.stats.cubes.bodies, 0u);
        EXPECT_GE(ms_of(a, "build/blas"), 0);
        EXPECT_GE(ms_of(a, "trace_khr"), 0);
    }
}

TEST_F(KhrPictures, OfSingleSidedMaterialsAreThoseOfTheCubes) {
    // Shadows through glass are traced in another way than those of scenes without.
    for (const char* name : {"builtin:teapots", "builtin:glass", "builtin:leaves"}) {
        SCOPED_TRACE(name);
        const Shown shown = show(name, -1, true), both = show(name);
        RenderSettings khr = settings(shown.scene, Tracer::khr), ldc = settings(shown.scene, Tracer::ldc);
        khr.ambient = ldc.ambient = true;
        const RenderResult a = shown.renderer->render(khr), b = shown.renderer->render(ldc),
                           c = both.renderer->render(ldc);
        fmt::print("  {}: FLIP {:.5f}, {:.5f} to both sides\n", name, flip_between(a, b), flip_between(b, c));
        EXPECT_LT(flip_between(a, b), 0.002);
    }
}

TEST_F(KhrPictures, DoNotDependOnHowTheStructuresAreKept) {
    const Shown shown = show("builtin:teapots");
    RenderSettings s = settings(shown.scene, Tracer::khr);
    const RenderResult kept = shown.renderer->render(s);
    EXPECT_EQ(kept.stats.structures.kept, kept.stats.structures.bodies);
    s.rebuild = true;
    for (const StructureUpdate update : {StructureUpdate::rebuild, StructureUpdate::refit}) {
        s.structures = update;
        s.repeat = 3;
        const RenderResult again = shown.renderer->render(s);
        EXPECT_EQ(again.stats.structures.kept, 0u);
        EXPECT_GE(ms_of(again, "build/tlas"), 0) << "of every frame";
        EXPECT_LT(flip_between(kept, again), 1e-3) << name_of(update);
    }
}

TEST_F(KhrPictures, FollowAnAnimation) {
    for (const char* name : {"builtin:walker", "builtin:particles:50"}) {
        SCOPED_TRACE(name);
        Shown moving = show(name, 0);
        for (const StructureUpdate update : {StructureUpdate::rebuild, StructureUpdate::refit}) {
            RenderSettings s = settings(moving.scene, Tracer::khr);
            s.structures = update;
            moving.renderer->pose(moment_of(moving.scene, "0", 0));
            const RenderResult first = moving.renderer->render(s);
            moving.renderer->pose(moment_of(moving.scene, "0", 0.4));
            const RenderResult moved = moving.renderer->render(s);
            const Shown fresh = show(name, 0.4);
            const RenderResult cubes = fresh.renderer->render(settings(fresh.scene, Tracer::ldc));
            EXPECT_GT(flip_between(first, moved), 0.004) << "nothing moved";
            EXPECT_LT(flip_between(moved, cubes), 0.002) << name_of(update);
        }
    }
}

}  // namespace
}  // namespace peelray
