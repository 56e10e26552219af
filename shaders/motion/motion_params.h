// What moves vertices and instances: deform*.comp, water_*.comp, cloth_surface.comp, swarm.comp (src/render/deformer, generators).
#ifndef PEELRAY_MOTION_PARAMS_H
#define PEELRAY_MOTION_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// A primitive whose vertices are computed for every moment.
struct DeformPiece {
    uint first_group;  ///< of 64 vertices
    uint vertices;
    uint first_rest;      ///< of the vertices at rest
    uint first_vertex;    ///< of the vertex buffers
    uint first_triangle;  ///< of the triangle buffer
    uint body;
    uint first_joint;  ///< its node, then the joints of its skin
    uint influences;   ///< joints that pull at a vertex; 0: all follow the node
    uint first_influence;
    uint targets;
    uint first_target;  ///< of each target the positions, then the normals, then the tangents if there are any
    uint first_weight;
    uint flat_shaded;
};
SHARED_SIZE(DeformPiece, 52);

struct JointInfluence {
    uint joint;  ///< of the skin
    float weight;
};
SHARED_SIZE(JointInfluence, 8);

struct DeformParams {
    uint pieces;
    uint groups;
    uint first_triangle;  ///< of all pieces
    uint triangles;
    uint first_tangent;  ///< in the buffer of texture coordinates
};
SHARED_SIZE(DeformParams, 20);

/// Parameters of all water_* passes: see Water of src/scene/generated.h.
struct WaterParams {
    uint cells;
    float size;
    float step;       ///< seconds
    float stiffness;  ///< (speed / spacing)², per second squared
    float damping;    ///< per second
    float rest;       ///< seconds from the last step to the moment
    uint first_vertex;
    uint body;
    vec2 drop_at;
    float drop_strength;
    float drop_width;
    uint floats;
};
SHARED_SIZE(WaterParams, 52);

/// Something that floats, at a moment.
struct GpuFloat {
    uint instance;
    vec2 at;       ///< x, z
    float turned;  ///< about the vertical, radians
    float radius;
};
SHARED_SIZE(GpuFloat, 20);

/// See Cloth of src/scene/generated.h.
struct ClothParams {
    uint across, along;  ///< cells of the mesh
    uint points;         ///< of the net, each way
    uint first_vertex;
    uint body;
};
SHARED_SIZE(ClothParams, 20);

struct SwarmParams {
    uint bodies;
    float phase;  ///< of the swarm's period, [0, 1)
};
SHARED_SIZE(SwarmParams, 8);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
