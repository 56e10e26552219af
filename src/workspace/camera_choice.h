// Which camera the settings choose.
#pragma once

#include "scene/box.h"
#include "scene/scene.h"
#include "settings/settings.h"

namespace peelray {

/// A camera of the scene, or one that sees all of `box`, with what the settings say of its place. `cameras`: those of
/// the scene, where they are now. Throws Error for a camera that the scene does not have.
Camera choose_camera(const PictureArguments& settings, const Scene& scene, const std::vector<Camera>& cameras,
                     const Box& box);

}  // namespace peelray
