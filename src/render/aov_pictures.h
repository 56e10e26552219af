// Auxiliary pictures (AOVs) of what the camera sees.
#pragma once

#include "render/motion_picture.h"

namespace peelray {

class AovPictures {
  public:
    /// Renders those of Aovs up to `motion`, at the pixels' centres, after the picture itself. For `motion` itself
    /// FrameState::before must know the moment before.
    void render(FrameState& f, Aovs& aovs);
    /// And those that follow, from what render() left on the device; `box`: of the scene.
    void render_ray_setup(FrameState& f, const Box& box, Aovs& aovs);

  private:
    Buffer buffer_;  ///< AovSurface a pixel
    MotionPicture motion_;
};

}  // namespace peelray
