// STL: triangles of solids, in ASCII and binary.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace peelray {

/// Reads the file. In ASCII, keywords may stand in any case and on any line, and each solid becomes an object; in
/// binary, facets have the colours of Magics ("COLOR=" in the header) or of VisCAM and SolidView. The normals of facets
/// are ignored. Throws Error (one line: what, where, what to do) for files that are no STL, that end too early or claim
/// more triangles than they hold.
Scene load_stl(const std::filesystem::path& path);

}  // namespace peelray
