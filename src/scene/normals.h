// Normals where a file has none, and vertices shared where a file repeats them.
#pragma once

#include "scene/scene.h"

namespace peelray {

/// Vertex i becomes a copy of vertex from[i]. What triangles name is the caller's.
void gather_vertices(Primitive& primitive, const std::vector<uint32_t>& from);

/// Appends a primitive's texture coordinates beyond the first set to as many sets, which then have `vertices` each: (0,
/// 0) where it has none.
void append_uv_sets(std::vector<std::vector<glm::vec2>>& sets, const Primitive& primitive, size_t vertices);

/// One vertex per triangle corner with the triangle's own normal (what glTF asks for where normals are missing).
void make_flat(Primitive& primitive);

/// Normals from the adjacent triangles, weighted by the corner's angle; edges sharper than `crease` (radians) stay
/// hard. Corners at the same position count as one vertex. Vertices are split where normals differ; triangles keep
/// their order.
void make_smooth(Primitive& primitive, float crease);

/// The same for the vertices whose normal is missing (no normals at all, or a zero vector); those that there are, which
/// are unit, stay. Vertices that agree in every attribute are joined, unused ones dropped.
void complete_normals(Primitive& primitive, float crease);

/// Merges vertices that agree in every attribute. Triangles keep their order.
void weld(Primitive& primitive);

/// Makes every normal unit length; where a normal is zero or not finite, takes one from the adjacent triangles.
/// Returns how many of those there were.
size_t repair_normals(Primitive& primitive);

}  // namespace peelray
