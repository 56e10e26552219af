// The auxiliary picture `motion`: where what the pixels see was in the picture of the moment before.
#pragma once

#include "render/frame_state.h"

namespace peelray {

class MotionPicture {
  public:
    /// Before the frame: poses the scene at the moment before, keeps where its vertices and instances are then, and
    /// poses it at `now` again, without its vertices, which the frame computes anyway. In this order water, which goes
    /// from moment to moment, need not start again. `view`: of the camera at the moment before. Submits.
    void look_back(FrameState& f, const Scene& source, const Moment& before, const Moment& now,
                   const Assembly& assembly, const View& view);
    /// Records the motion of a band's hits, which level 0 holds.
    void record(FrameState& f, const LevelParams& band) const;
    /// That of all pixels, after the last band was submitted; where nothing was asked for, 0.
    void store(FrameState& f, Aovs& aovs) const;

  private:
    MotionParams params_{};
    Buffer positions_;   ///< vec3 of each vertex that changes from moment to moment
    Buffer transforms_;  ///< GpuTransform of each instance
    Buffer motions_;     ///< AovMotion a pixel
};

}  // namespace peelray
