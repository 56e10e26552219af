// A scene at one moment: all that an animation changes. The scene itself never changes.
#pragma once

#include "scene/scene.h"

namespace peelray {

struct Moment {
    std::vector<glm::dmat4> locals;           ///< of all nodes: node to parent
    std::vector<glm::mat4> worlds;            ///< of all nodes, relative to Scene::origin
    std::vector<std::vector<float>> weights;  ///< of all nodes: of its mesh's morph targets; empty: the mesh's own
    std::vector<Camera> cameras;              ///< Scene::cameras where they are now
    std::vector<Light> lights;                ///< Scene::lights likewise
    double generated_time = 0;                ///< of what is generated, seconds

    /// Vertices of a node's only primitive that are not where the scene has them: of water and
    /// of cloth.
    struct Surface {
        int node = -1;
        std::vector<glm::vec3> positions, normals;
    };
    std::vector<Surface> surfaces;  ///< see Simulation

    /// Null: the node's vertices are the scene's own.
    const Surface* surface_of(int node) const;
};

/// The scene as it was read.
Moment at_rest(const Scene& scene);

/// Weights of the morph targets of a node's mesh.
const std::vector<float>& weights_of(const Scene& scene, const Moment& moment, size_t node);

/// World matrices of all nodes, relative to Scene::origin; `locals`: of all nodes, each in its parent.
std::vector<glm::mat4> world_matrices(const Scene& scene, const std::vector<glm::dmat4>& locals);
/// The same before they are rounded, of a scene that is `precise`.
std::vector<glm::dmat4> exact_world_matrices(const Scene& scene, const std::vector<glm::dmat4>& locals);

/// Puts the scene's cameras and lights where their nodes are. `distance`: from a camera, as it was, to the point that
/// it is to look at from `eye`.
void carry_along(
    const Scene& scene, const Moment& moment, std::vector<Camera>& cameras, std::vector<Light>& lights,
    const std::function<double(const Camera& before, const glm::dvec3& eye, const glm::dvec3& ahead)>& distance);

/// World-space triangles of the whole scene (see Geometry). Throws Error when there is no triangle, naming the scene.
Geometry flatten(const Scene& scene, const Moment& moment);

}  // namespace peelray
