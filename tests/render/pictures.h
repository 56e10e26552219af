// Pictures by the GPU, for the tests here and those of ../closed_forms.
#pragma once

#include <scenes.h>

#include "../gpu/device_fixture.h"
#include "render/renderer.h"

namespace peelray {

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
    RenderResult render(const Stage& stage, const Environment& environment, const RenderSettings& settings) {
        return renderer_for(stage, environment)->render(settings);
    }
    /// For several pictures of a scene that stands still; the stage must outlive it.
    std::unique_ptr<Renderer> renderer_for(const Stage& stage, const Environment& environment) {
        const Moment rest = at_rest(stage.scene);
        return std::make_unique<Renderer>(device(), stage.scene, rest,
                                          assemble(stage.scene, rest, motion_of(stage.scene, "")), environment);
    }
    const Environment black = color_environment(glm::vec3(0)), white = color_environment(glm::vec3(1));
};

}  // namespace peelray
