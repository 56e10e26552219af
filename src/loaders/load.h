// Scenes by name: files of any supported format, and the built-in ones.
#pragma once

#include <string>

#include "scene/scene.h"

namespace peelray {

struct LoadOptions {
    std::string variant;        ///< of the materials (KHR_materials_variants), by name; empty: as the file is without
    float point_size = 0;       ///< world units: the diameter of glTF's points and lines; 0: they are left out
    bool double_sided = false;  ///< every material shows both sides
};

/// Reads a scene: "builtin:NAME" or a file (.gltf, .glb, .obj, .ply, .stl, .off).
/// Throws Error (one line: what, where, what to do) for a file that is missing, empty, truncated, without triangles,
/// with indices or accessors out of range, with NaN or infinite vertices, or that requires an unknown extension. A glTF
/// URI never leads outside the file's folder. A variant that the scene does not have is an Error, too.
Scene load_scene(const std::string& name, const LoadOptions& options = {});

}  // namespace peelray
