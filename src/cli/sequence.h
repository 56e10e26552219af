// Several pictures in a row: which frames there are and what each shows.
#pragma once

#include "cli/arguments.h"
#include "workspace/workspace.h"

namespace peelray {

/// Frames per second where none are chosen.
inline constexpr double kUsualFps = 30;

struct Sequence {
    FrameRange frames;
    Shard shard;
    double fps = kUsualFps;
    bool runs = false;       ///< the animation does: frame k shows the moment k/fps
    uint32_t turntable = 0;  ///< frames of the camera's full circle; 0: it stays

    /// Those of the shard, in order.
    std::vector<uint32_t> numbers() const;
    Shot shot(uint32_t frame) const;
};

/// What the options ask for. Throws Error where they contradict each other or are out of range.
Sequence plan_sequence(const RenderArguments& arguments);

/// Throws Error where an option of sequences has no effect on a single picture.
void check_single(const RenderArguments& arguments);

}  // namespace peelray
