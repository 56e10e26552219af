// What a picture is to look like and how it is traced.
#pragma once

#include "render/tracers/tracer_choice.h"
#include "scene/picture.h"

namespace peelray {

/// What a picture is to look like and how it is traced. Defaults are those of the command line.
struct RenderSettings : PictureSettings, TracerChoice {
    bool hit_auto = true;  ///< choose cubes.hit by the number of triangles
    Visibility visibility = Visibility::automatic;
    uint32_t repeat = 1;      ///< frames to render; times are medians over them
    bool time_passes = true;  ///< else only the frame and its build: passes then do not wait for timestamps
    bool bodies = true;       ///< the statistics say of each body what its cube is, which takes a look at the device
    bool counters = false;    ///< count what rays cost, which slows them: times then tell nothing; of Tracer::ldc

    bool operator==(const RenderSettings&) const = default;
};

/// What `auto` stands for in a scene of so many triangles, if the device has room for it (smaller_than).
CubeChoice choose_automatically(uint32_t triangles, const RenderSettings& settings);

/// False: no effect that is on traces a ray, so that nothing need be built to trace any in.
bool needs_rays(const RenderSettings& settings, bool has_blended);

}  // namespace peelray
