// Wavefront OBJ files with their material libraries (MTL).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "loaders/polygon_mesh.h"
#include "scene/scene.h"

namespace peelray {

/// What an OBJ file says.
struct ObjFile {
    PolygonMesh mesh;                    ///< materials of its parts: indices into `materials`
    std::vector<std::string> materials;  ///< names after usemtl, as written, in order of first use; the first: none
    std::vector<std::string> libraries;  ///< what stands after each mtllib, each once
    std::vector<std::string> notes;      ///< what has no effect, with counts and lines
};

/// Reads the text of an OBJ file; `name` is the file's, for messages; positions are relative to `origin`. Throws Error,
/// with the line, for a statement that makes no sense: a vertex without three numbers, a corner that names no vertex, a
/// referenced position that is not finite; also for a file without faces.
ObjFile parse_obj(std::string_view text, const std::string& name, const glm::dvec3& origin = glm::dvec3(0));

/// Reads the file, its material libraries and their textures, all in its folder. The triangles come in file order; a
/// polygon gives its triangles in place. `o` and `g` statements start objects, which come in the order of their first
/// appearance (an `o` name that returns later adds to its first object); inside an object `usemtl` starts a new
/// primitive, in file order. What has no effect, and libraries and images that are missing, become notes.
Scene load_obj(const std::filesystem::path& path);

}  // namespace peelray
