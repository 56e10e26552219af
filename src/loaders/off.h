// OFF, the object file format of Geomview: polygons, in ASCII and binary.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace peelray {

/// Reads the file: OFF with any of the prefixes ST, C, N, 4 and n (of three dimensions), or without a keyword; comments
/// may stand anywhere. Colours of vertices and faces are whole numbers up to 255, floating-point numbers or indices
/// into Geomview's colour map. Throws Error (one line: what, where, what to do) for files that are no OFF, that end too
/// early or claim more than they hold, and whose faces name no vertex.
Scene load_off(const std::filesystem::path& path);

}  // namespace peelray
