// Structures that C++ and GLSL share (scalar block layout): every pass's parameters and every record in a buffer.
#ifndef PEELRAY_PARAMS_H
#define PEELRAY_PARAMS_H

#include "peelray/cube.h"

#ifdef __cplusplus
namespace peelray {
using glm::ivec3;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
#define SHARED_SIZE(type, size) static_assert(sizeof(type) == size, #type)
#else
#define SHARED_SIZE(type, size)
#endif

// --- Building the cube (src/ldc, shaders/ldc_*.comp) ---

/// Parameters of all ldc_* passes.
struct LdcParams {
    CubeGrid grid;
    uint triangles;
    uint planar;              ///< 1: pixel-centre samples with the overlap band; 0: conservative
    uint fragment_capacity;
    uint big_capacity;        ///< entries of the queue of large triangles
    uint tile_capacity;       ///< entries of the queue of their 16x16-pixel tiles
    uint top_capacity;        ///< occupied 16x16x16 cells that have room
    uint node_capacity;       ///< occupied 4x4x4 nodes that have room
    uint long_capacity;       ///< entries of the queue of long lists
    uint workers;             ///< workgroups of the passes that loop over a count known only on the GPU
    uint axis;                ///< of ldc_sat_scan
};
SHARED_SIZE(LdcParams, 72);

/// Counted on the GPU while building; whatever exceeds a capacity makes the host grow it and build again.
struct LdcCounters {
    uint fragments;   ///< samples
    uint big;
    uint tiles;
    uint tops;
    uint nodes;
    uint voxels;      ///< occupied voxels
    uint long_lists;
    uint longest;     ///< samples of the longest list
    uint degenerate;  ///< triangles without area: dropped
    uint invalid;     ///< triangles with NaN or infinite corners: dropped
};
SHARED_SIZE(LdcCounters, 40);

/// One triangle's crossing of one voxel, before it is sorted into its list.
struct LdcFragment {
    uint top;    ///< index of the 16^3 cell; after ldc_count: index of the voxel's entry
    uint id;     ///< triangle * 4 + axis
    uint local;  ///< voxel inside the 16^3 cell (12 bits: node 6, voxel 6); after ldc_count: slot in its list
};
SHARED_SIZE(LdcFragment, 12);

/// Parameters of the prefix sum passes scan_*.comp.
struct ScanParams {
    uint capacity;  ///< elements, if `counter` is SCAN_NO_COUNTER
    uint counter;   ///< which uint of the counters holds the number of elements (clamped to capacity)
};
SHARED_SIZE(ScanParams, 8);
#define SCAN_NO_COUNTER 0xffffffffu
#define SCAN_BLOCK 1024u

// --- Tracing (shaders/trace.comp) ---

/// A ray in a queue.
struct Ray {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
};
SHARED_SIZE(Ray, 32);

/// A hit in a queue; layout of HITS.npy.
struct Hit {
    float t;
    uint triangle;
    float u;
    float v;
};
SHARED_SIZE(Hit, 16);

struct TraceParams {
    CubeGrid grid;
    uint first;     ///< first ray of this dispatch
    uint count;     ///< rays in the queue; with `counted`: room in the queue
    uint counted;   ///< 1: the count is queue[counter]
    uint counter;
    uint skips;     ///< 1: skip[i] is a triangle that ray i must not hit
};
SHARED_SIZE(TraceParams, 52);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
