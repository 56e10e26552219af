// Tangents for normal textures and for the direction of anisotropy, where a file has none.
#pragma once

#include "scene/scene.h"

namespace peelray {

/// Tangents by the rule that normal textures are baked with (Mikkelsen: Simulation of Wrinkled Surfaces Revisited,
/// 2008, chapter 5; the public MikkTSpace): each corner takes those of the triangles around it that it is connected
/// with by edges and whose texture runs the same way round, weighted by the corner's angle. `coordinates`: per vertex,
/// as the normal texture is sampled. Vertices are split where tangents differ; triangles keep their order.
void make_tangents(Primitive& primitive, const std::vector<glm::vec2>& coordinates);

/// Does the material need tangents?
bool needs_tangents(const Material& material);

/// The texture whose coordinates a material's tangents follow: that of normals, of the coat's normals, of anisotropy. A
/// primitive has one set of tangents, and a normal texture bends light wrongly by others than its own.
const MaterialTexture& tangent_texture(const Material& material);

/// The texture coordinates that tangents follow, per vertex and as the texture is sampled; empty: there are none.
std::vector<glm::vec2> tangent_coordinates(const Material& material, const Primitive& primitive);

/// Makes the tangents of all primitives that need some and have none.
void complete_tangents(Scene& scene);

}  // namespace peelray
