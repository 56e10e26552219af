// Where everything was at the moment before a picture's.
#pragma once

#include "assembly/assembly.h"
#include "gpu/commands.h"
#include "path/camera_before.h"
#include "scene/moment.h"
#include "scene/picture.h"

namespace peelray {

struct FrameState;

class MomentBefore {
  public:
    /// Before the frame: poses the scene at the moment before, keeps where its vertices and instances are then, and
    /// poses it at `now` again, without its vertices, which the frame computes anyway. In this order water, which goes
    /// from moment to moment, need not start again. `view`: of the camera at the moment before. Submits.
    void look_back(FrameState& f, const Scene& source, const Moment& before, const Moment& now,
                   const Assembly& assembly, const View& view);

    /// And which vertices are in positions().
    const CameraBefore& camera() const { return camera_; }
    const Buffer& positions() const { return positions_; }
    const Buffer& transforms() const { return transforms_; }

  private:
    CameraBefore camera_{};
    Buffer positions_;   ///< vec3 of each vertex that changes from moment to moment
    Buffer transforms_;  ///< GpuTransform of each instance
};

}  // namespace peelray
