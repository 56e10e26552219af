// Which parts of a scene that move together share a cube. Private to src/assembly.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// A part that cannot be split: its box, its triangles and their area.
struct Part {
    glm::vec3 lower, upper;
    uint64_t triangles;
    double area;
};

/// Groups of parts, as lists of their indices in ascending order; at most 262. The largest parts of at most
/// PEELRAY_BARE_TRIANGLES triangles are groups of their own, which need no cube where hits are `exact` or `planar` by
/// voxel (a small one elsewhere). What is left is split in two where rays would find their hits in two cubes for less
/// than in one: by an estimate of that cost like the surface area heuristic of bounding volume hierarchies (MacDonald
/// and Booth 1990), for cubes of serving_resolution(). So a large ground does not cost the small things on it the
/// fineness of their voxels, and what lies together stays together.
std::vector<std::vector<uint32_t>> group_parts(const std::vector<Part>& parts);

}  // namespace peelray
