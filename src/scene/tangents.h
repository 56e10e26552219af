// Tangents for normal textures where a file has none.
#pragma once

#include "scene/scene.h"

namespace peelray {

/// Tangents by the rule that normal textures are baked with (Mikkelsen: Simulation of Wrinkled Surfaces Revisited,
/// 2008, chapter 5; the public MikkTSpace): each corner takes those of the triangles around it that it is connected
/// with by edges and whose texture runs the same way round, weighted by the corner's angle. `coordinates`: per vertex,
/// as the normal texture is sampled. Vertices are split where tangents differ; triangles keep their order.
void make_tangents(Primitive& primitive, const std::vector<glm::vec2>& coordinates);

/// Makes the tangents of all primitives that need some and have none.
void complete_tangents(Scene& scene);

}  // namespace peelray
