// Auxiliary pictures (AOVs) of what the camera sees.
#pragma once

#include "render/frame_state.h"

namespace peelray {

class AovPictures {
  public:
    /// Renders those of Aovs up to `position`, at the pixels' centres, after the picture itself.
    void render(FrameState& f, Aovs& aovs);
    /// And those that follow, from what render() left on the device; `box`: of the scene.
    void render_ray_setup(FrameState& f, const Box& box, Aovs& aovs);

  private:
    Buffer buffer_;  ///< four vec4 a pixel, as aov.comp writes them
};

}  // namespace peelray
