// The auxiliary picture `motion`: where what the pixels see was in the picture of the moment before.
#pragma once

#include "render/frame_state.h"

namespace peelray {

class MotionPicture {
  public:
    /// Makes room. FrameState::before must know the moment before.
    void prepare(FrameState& f);
    /// Records the motion of a band's hits, which level 0 holds.
    void record(FrameState& f, const LevelParams& band) const;
    /// That of all pixels, after the last band was submitted; where nothing was asked for, 0.
    void store(FrameState& f, Aovs& aovs) const;

  private:
    Buffer motions_;  ///< AovMotion a pixel
};

}  // namespace peelray
