// Makes even triangle meshes of implicit surfaces.
#pragma once

#include <functional>

#include "builtin/closed_mesh.h"

namespace peelray {

/// A scalar field over space: negative inside of a body, zero on its surface; never grows faster than the distance
/// (so that its value tells how far away the surface is at least).
using Field = std::function<float(const glm::vec3&)>;
/// A length for each point.
using Size = std::function<float(const glm::vec3&)>;

/// How the field grows.
glm::vec3 gradient(const Field& field, const glm::vec3& p);

/// A point near the surface moved onto it, in two of Newton's steps.
glm::vec3 onto_surface(const Field& field, glm::vec3 p);

/// The surface inside the box as a closed mesh, by marching tetrahedra: cubes of edge `cell`, six tetrahedra each
/// (Kuhn's partition; every mesh that comes of it is a manifold). The body must keep a cell's distance from the box.
/// Parts thinner than a cell may be lost.
ClosedMesh polygonise(const Field& field, const glm::vec3& lower, const glm::vec3& upper, float cell);

/// Makes the edges as long as `size` says, the triangles nearly equilateral, and puts all vertices onto the surface.
void remesh(ClosedMesh& mesh, const Field& field, const Size& size, int rounds);

}  // namespace peelray
