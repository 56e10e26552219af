// The light that settings ask for.
#pragma once

#include "scene/environment.h"
#include "settings/settings.h"
#include "workspace/notes.h"

namespace peelray {

/// What surrounds the scene, turned, dimmed and, where the camera is to see it so, blurred as the settings say. Throws
/// Error for an image that cannot be read; notes what of it was changed.
Environment choose_environment(const LightArguments& a, const Scene& scene, const Notes& notes);

}  // namespace peelray
