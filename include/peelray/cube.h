// The layered depth cubes' parameters: one text for C++ and GLSL (scalar block layout).
#ifndef PEELRAY_CUBE_H
#define PEELRAY_CUBE_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace peelray {
using glm::mat3;
using glm::uvec3;
using glm::vec3;
using uint = glm::uint;
#endif

/// Where a cube lies in its body's space. Voxels are cubes; their number may differ per axis.
struct CubeGrid {
    vec3 origin;      ///< the lower corner of voxel (0, 0, 0)
    float voxel;      ///< edge of a voxel
    uvec3 dims;       ///< voxels along x, y, z: multiples of 16, at most 2048
    float inv_voxel;  ///< 1 / voxel
};

/// A cube placed in the world: p in the world is M * (p - corner) from the lower corner of the cube's first voxel, in
/// the units of the body's space; x, y and z are the rows of M. In blocks of 16 bytes, which GPUs load at once.
struct PeelrayInstance {
    vec3 x;
    float voxel;  ///< as in CubeGrid
    vec3 y;
    float inv_voxel;
    vec3 z;
    uint tops;  ///< the grid's dims in 16 voxels: 10 bits each; PEELRAY_BARE, PEELRAY_MERGED
    vec3 corner;
    uint
        first_cell;  ///< the cube's first entry in the table of 16x16x16-voxel cells, or its first pixel (by-pixel
                     ///< order); of a bare body its first triangle, and in the upper two bits how many it has, less one
    vec3 origin;     ///< as in CubeGrid
    uint moved;      ///< 0: M is the identity and corner the grid's origin
};

/// Of PeelrayInstance::tops: the body has so few triangles (PEELRAY_BARE_TRIANGLES at most) that a ray tests them all
/// instead of walking through a cube, and there is none.
#define PEELRAY_BARE 0x80000000u
#define PEELRAY_BARE_TRIANGLES 4u

/// Of PeelrayInstance::tops: copies of the instance's triangles are in a cube that it shares with others, and it is not
/// in the hierarchy; first_cell: added to the number of a triangle, that of its copy.
#define PEELRAY_MERGED 0x40000000u

/// A box of the hierarchy over the instances, in the world; lower > upper: nothing.
struct PeelrayBox {
    vec3 lower;
    uint instance;  ///< of the lowest level's boxes
    vec3 upper;
    uint unused;
};

/// Where the boxes of the hierarchy lie: box i of a level holds boxes 8 i to 8 i + 7 of the level below. The highest
/// level has at most 8 boxes; each level is filled up to a multiple of 8.
#define PEELRAY_TREE_LEVELS 8
struct PeelrayTree {
    uint instances;
    uint levels;  ///< at least 1
    uint first[PEELRAY_TREE_LEVELS];
};

/// What a ray has cost: how often the traversal did each of these.
struct PeelrayCounts {
    uint steps;      ///< cells of any level that it was in, empty boxes included
    uint cells;      ///< lists of samples that it met: occupied voxels, or by pixel those that hold a sample
    uint pixels;     ///< by pixel: pixels that it was in, empty ones included
    uint samples;    ///< samples tested
    uint triangles;  ///< triangles tested (`exact`)
};

// Hit tests.
#define PEELRAY_EXACT 0u      // the triangles themselves
#define PEELRAY_PLANAR 1u     // the samples' planes
#define PEELRAY_TOLERANCE 2u  // the samples' depths, within a distance
// Traversals, each with the order of the samples that it reads.
#define PEELRAY_VOXELS 0u     // by voxel
#define PEELRAY_TWO_LEVEL 1u  // by pixel, with one coarse level
#define PEELRAY_MIPMAP 2u     // by pixel, with a min/max pyramid
// What a ray does at a time, by pixel (the paper, section 4).
#define PEELRAY_ONE 0u
#define PEELRAY_FOUR_LAYERS 1u

#ifdef __cplusplus
static_assert(sizeof(CubeGrid) == 32);
static_assert(sizeof(PeelrayInstance) == 80);
static_assert(sizeof(PeelrayBox) == 32);
static_assert(sizeof(PeelrayTree) == 40);
static_assert(sizeof(PeelrayCounts) == 20);
}  // namespace peelray
#endif
#endif
