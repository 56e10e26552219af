// EXT_lights_image_based: a scene's light from all around.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "loaders/gltf_file.h"
#include "scene/cube_light.h"

namespace peelray {

/// What a file's default scene names as its image-based light, checked; `file`: the JSON before check_gltf(), which
/// knows nothing of nested lists. None: it names none. Throws Error.
std::optional<GltfExtensions::ImageLight> image_light_of(const nlohmann::json& root, const std::string& file);

/// The light's largest images. Throws Error for those that are no faces of a cube.
CubeLight read_image_light(GltfFile& file, const GltfExtensions::ImageLight& from);

}  // namespace peelray
