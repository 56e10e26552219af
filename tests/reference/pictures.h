// Pictures by the CPU's path tracer, for the tests here and those of ../closed_forms: in double precision or, where
// PEELRAY_TEST_SINGLE is set, in single.
#pragma once

#include <cstdlib>

#include <scenes.h>

#include "assembly/emitters.h"
#include "motion/animation.h"
#include "reference/path_tracer.h"

namespace peelray {

/// The settings that the GPU's tests know; the reference has no cube to choose a resolution for.
struct RenderSettings : PictureSettings {
    struct {
        uint32_t ldc = 0;
    } cubes;
    Tracer tracer = Tracer::ldc;  ///< none: no effect is traced
};
using RenderResult = Picture;

inline const Precision kPrecision = std::getenv("PEELRAY_TEST_SINGLE") ? Precision::single_ : Precision::double_;
/// Is what makes the pictures held to the reference? Hundreds of them, of many materials, are left to that.
inline const bool kOnDevice = kPrecision == Precision::single_;

inline RenderSettings settings_for(const Camera& camera, uint32_t size = 64) {
    RenderSettings s;
    s.width = s.height = size;
    s.camera = camera;
    return s;
}

class PictureTest : public testing::Test {
  protected:
    Picture render(const Stage& stage, const Environment& environment, RenderSettings settings, unsigned threads = 0) {
        if (settings.tracer == Tracer::none)
            settings.reflection = settings.refraction = settings.shadow = settings.ambient = false;
        const Geometry geometry = flatten(stage.scene);
        const Moment rest = at_rest(stage.scene);
        const Emitters emitters = emitters_of(stage.scene, assemble(stage.scene, rest, motion_of(stage.scene, "")));
        return PathTracer(stage.scene, rest, geometry, environment, emitters, kPrecision).render(settings, {}, threads);
    }
    /// The same while somebody looks on.
    Picture watched(const Stage& stage, const RenderSettings& settings, const PictureWatch& watch) {
        const Geometry geometry = flatten(stage.scene);
        return PathTracer(stage.scene, at_rest(stage.scene), geometry, black, {}, kPrecision).render(settings, watch);
    }
    /// Of a moment of the scene's first animation, if it has any; with Aovs::motion since the moment `before`.
    Picture render_at(const Scene& scene, double time, double before, RenderSettings settings) {
        const std::string which = scene.animations.empty() ? "" : "0";
        const Moment now = moment_of(scene, which, time), then = moment_of(scene, which, before);
        settings.aovs = settings.motion = true;
        settings.moment_before = &then;
        const Geometry geometry = flatten(scene, now);
        return PathTracer(scene, now, geometry, black, {}, kPrecision).render(settings);
    }
    const Environment black = color_environment(glm::vec3(0)), white = color_environment(glm::vec3(1));
};

}  // namespace peelray
