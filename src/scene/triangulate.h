// Polygons into triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace peelray {

/// Cuts a polygon, convex or not, into corners − 2 triangles of its own winding and appends them to `out` as numbers of
/// corners. Convex polygons become a fan around their first corner, quads with an inward corner one around that, others
/// lose their ears one by one (G. H. Meisters, "Polygons have ears", 1975). A polygon that crosses itself or has no
/// area gives as many triangles, some of which overlap. False: the polygon has so many corners and dents that its rest
/// was cut as a fan.
bool triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& out);

}  // namespace peelray
