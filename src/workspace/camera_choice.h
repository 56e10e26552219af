// Which camera the settings choose.
#pragma once

#include <string>
#include <vector>

#include "scene/framing.h"
#include "scene/scene.h"
#include "settings/settings.h"

namespace peelray {

/// What chooses a camera by its number: "1", or, where several nodes show the same one, "1.0", "1.1", ... in their
/// order ("1" is then the first).
std::string camera_label(const std::vector<Camera>& cameras, size_t index);

/// What the settings say of the camera that frames a picture.
Framing::Lens framing_lens(const PictureArguments& settings);

/// A camera of the scene, or the framing's, with what the settings say of its place. `cameras`: those of the scene,
/// where they are now. Throws Error for a camera that the scene does not have.
Camera choose_camera(const PictureArguments& settings, const Scene& scene, const std::vector<Camera>& cameras,
                     const Framing& framing);

}  // namespace peelray
