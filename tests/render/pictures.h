// Pictures by the GPU, for the tests here and those of ../closed_forms.
#pragma once

#include <scenes.h>

#include "../gpu/device_fixture.h"
#include "effort.h"
#include "motion/animation.h"
#include "render/renderer.h"

namespace peelray {

/// Does a device make the pictures? Hundreds of them, of many materials, are left to the reference, which it is held
/// to.
inline constexpr bool kOnDevice = true;

inline RenderSettings settings_for(const Camera& camera, uint32_t size = 64) {
    RenderSettings s;
    s.width = s.height = size;
    s.camera = camera;
    s.cubes.ldc = 64;
    s.hit_auto = false;
    return s;
}

class PictureTest : public DeviceTest {
  protected:
    /// One instance is counted, more are found in the hierarchy: variants of shaders are what takes time here. Those
    /// for each number are traced by InstancesTest, by the program, and in `make test-long` here, too.
    void SetUp() override {
        DeviceTest::SetUp();
        device().counted_instances = test::effort(1, 8);
    }
    void TearDown() override {
        device().counted_instances = 8;
        DeviceTest::TearDown();
    }

    RenderResult render(const Stage& stage, const Environment& environment, const RenderSettings& settings) {
        return renderer_for(stage, environment)->render(settings);
    }
    /// The same while somebody looks on.
    RenderResult watched(const Stage& stage, const RenderSettings& settings, const PictureWatch& watch) {
        return renderer_for(stage, black)->render(settings, watch);
    }
    /// For several pictures of a scene that stands still; the stage must outlive it.
    std::unique_ptr<Renderer> renderer_for(const Stage& stage, const Environment& environment) {
        const Moment rest = at_rest(stage.scene);
        return std::make_unique<Renderer>(device(), stage.scene, rest,
                                          assemble(stage.scene, rest, motion_of(stage.scene, "")), environment);
    }
    /// Of a moment of the scene's first animation, if it has any; with Aovs::motion since the moment `before`.
    RenderResult render_at(const Scene& scene, double time, double before, RenderSettings settings) {
        const std::string which = scene.animations.empty() ? "" : "0";
        const Moment now = moment_of(scene, which, time), then = moment_of(scene, which, before);
        settings.aovs = settings.motion = true;
        settings.moment_before = &then;
        const Assembly assembly = assemble(scene, moment_of(scene, which, 0), motion_of(scene, which));
        return Renderer(device(), scene, now, assembly, black).render(settings);
    }
    const Environment black = color_environment(glm::vec3(0)), white = color_environment(glm::vec3(1));
};

}  // namespace peelray
