// Where the surfaces of a scene are, at a moment or over an animation: what frames the picture and where the floor
// lies.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "scene/box.h"
#include "scene/moment.h"

namespace peelray {

/// The box of all triangles at a moment.
Box bounds(const Scene& scene, const Moment& moment);

/// Which surfaces count: all, or without those of which alpha masks leave nothing.
enum class Counted : uint8_t { all, visible };

/// Takes points, some at a time.
using PointVisitor = std::function<void(std::span<const glm::vec3>)>;

/// The vertices of triangles at a moment, of the first `nodes` nodes.
void visit_points(const Scene& scene, const Moment& moment, size_t nodes, Counted counted, const PointVisitor& visit);

/// All that surfaces reach at moments of animations (`which`: see moment_of(); empty: at rest); of what is generated,
/// the corners of what it may reach. The moments are spread evenly and over the keys, at most 66; of large meshes that
/// move a share of the vertices is looked at, so that the cost does not grow with them. So at moments in between
/// something may reach a little farther. Throws Error like moment_of().
void visit_reach(const Scene& scene, const std::string& which, Counted counted, const PointVisitor& visit);

}  // namespace peelray
