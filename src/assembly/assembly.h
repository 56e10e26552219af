// The scene as ray tracing sees it: bodies, which have a cube each, and instances, which place them in the world.
#pragma once

#include "motion/motion.h"
#include "scene/moment.h"

namespace peelray {

/// Triangles in bodies, bodies in the world. Bodies and their triangles and vertices are in the same ascending order,
/// without gaps; those whose shape never changes come first.
struct Assembly {
    struct Body {
        uint32_t first_triangle = 0, triangles = 0, first_vertex = 0, vertices = 0;
        glm::vec3 lower{0}, upper{0};  ///< in its own space; of one that deforms: in the moment it was assembled at
        double inverse_edges = 0;      ///< sum of 1 / mean_edge() over its triangles, for serving_resolution
        bool merged = false;           ///< copies of small bodies that move by themselves (MergedInstances)
    };

    /// A body and where it stands: in the space of a node, in which it is moved by `offset`.
    struct Instance {
        uint32_t body = 0;
        int node = -1;  ///< -1: the world
        glm::mat4 offset{1};
        uint32_t first_id = 0;      ///< added to the ids of its triangles: their index in the scene, in file order
        uint32_t first_object = 0;  ///< added to the objects of its triangles: their Geometry::Object
        bool moves = false;         ///< by itself: its node is not there for the sake of precision alone
    };

    /// A primitive of a node in a body that deforms. Its vertices are computed for every moment, in world space.
    struct Piece {
        int node = 0;
        uint32_t primitive = 0;  ///< of the node's mesh
        uint32_t body = 0, first_vertex = 0, first_triangle = 0;
        bool mirrored = false;  ///< its triangles are turned over, as the moment of assembly wants them
    };

    std::vector<glm::vec3> positions, normals;  ///< one per vertex; of bodies that deform: of the moment of assembly
    std::vector<glm::vec2> uvs;
    std::vector<std::vector<glm::vec2>> more_uvs;  ///< sets 1, 2, … of texture coordinates
    std::vector<glm::vec4> tangents;               ///< or empty: no primitive has any; of the moment, as positions
    std::vector<glm::vec4> colors;                 ///< or empty: no primitive has colours
    std::vector<glm::uvec3> triangles;
    std::vector<uint32_t> materials, ids, objects;  ///< one per triangle

    std::vector<Body> bodies;
    uint32_t fixed = 0;               ///< bodies whose shape never changes
    std::vector<Instance> instances;  ///< in the order of their bodies
    std::vector<Piece> pieces;        ///< in the order of their vertices
    bool generates = false;           ///< what is generated moves: Scene::generated
    std::vector<Piece> surfaces;      ///< of Scene::generated.waters, then of its cloths, while they move
    uint64_t shown = 0;               ///< triangles with all instances

    /// Of all bodies, each once.
    uint32_t bodies_triangles() const;
    /// What is left when its triangles are on a device: bodies and instances.
    Assembly without_geometry() const;
};

/// Edge of `triangles` triangles of `area` in all, taken as if they were equal: the root of a triangle's area. Above 0.
double mean_edge(uint64_t triangles, double area);

/// Voxels along the longest side of a cube that serves a body well: 16 to 1024, a multiple of 16. By the number of its
/// triangles, where they are spread over all of it; where they crowd in parts of it, as many as if all of it were
/// divided as finely (sixteen times as many at most). `inverse_edges`: in the units of `longest`, its longest side.
/// Exact hits do not depend on it: it is chosen for speed. A cube that is built for every frame gets coarser voxels.
uint32_t serving_resolution(uint64_t triangles, double longest, double inverse_edges, bool rebuilt = false);

/// Takes the scene at a moment apart so that as little as possible has to be rebuilt for every moment of `motion` (the
/// paper, section 1.2.1): what stands still, and what moves as one without changing its shape, goes into bodies that
/// are built once; equal meshes share one where that pays; a body is split where a part of it would get much finer
/// voxels from a cube of its own, so that a large ground does not cost a small object its resolution. Throws Error as
/// flatten() does.
Assembly assemble(const Scene& scene, const Moment& moment, const Motion& motion);

}  // namespace peelray
