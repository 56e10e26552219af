// OBJ, PLY, STL and OFF through Assimp.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/scene.h"

struct aiMaterial;

namespace peelray {

/// Reads the file; `extension` in lower case with its dot.
///
/// The triangles come in file order; a polygon gives its triangles in place. An OBJ file's `o` and `g` statements start
/// objects, which come in the order of their first appearance (an `o` name that returns later adds to its first
/// object); inside an object `usemtl` starts a new primitive, in file order.
Scene load_assimp(const std::filesystem::path& path, const std::string& extension);

/// Refuses files whose claimed counts or indices the data cannot hold, before Assimp allocates for them.
/// check_ply returns where the body begins.
size_t check_ply(std::span<const uint8_t> bytes, const std::string& name);
void check_off(std::span<const uint8_t> bytes, const std::string& name);

/// A material of an MTL file (or Assimp's default). Reads the map_Kd texture from `folder`, never from outside of it; a
/// texture that cannot be read becomes a note.
Material convert_material(const aiMaterial& from, const std::filesystem::path& folder, Scene& scene);

}  // namespace peelray
