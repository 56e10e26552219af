// Scenes by name: files of any supported format, and the built-in ones.
#pragma once

#include <string>

#include "scene/scene.h"

namespace peelray {

/// Reads a scene: "builtin:NAME" or a file (.gltf, .glb, .obj, .ply, .stl, .off).
/// Throws Error (one line: what, where, what to do) for a file that is missing, empty, truncated, without triangles,
/// with indices or accessors out of range, with NaN or infinite vertices, or that requires an unknown extension. A glTF
/// URI never leads outside the file's folder.
Scene load_scene(const std::string& name);

}  // namespace peelray
