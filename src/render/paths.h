// The tree of rays below a band of pixels: rays are traced and shaded level by level, then the shadow rays of all
// levels, and the light is gathered back to the camera's level.
#pragma once

#include "render/frame_state.h"

namespace peelray {

/// Records the levels of a band. Where a queue does not find room all that follows is left out, for the band is done
/// again.
void record_paths(FrameState& f, uint32_t sample, uint32_t first_row);

/// What shading reads beside triangles and instances, all of it only if used: for tracers that look at surfaces.
std::vector<Binding> surfaces_of(const FrameState& f);

}  // namespace peelray
