// Building cubes: bodies, their tables and the parameters of the ldc_* passes (src/ldc).
#ifndef PEELRAY_LDC_PARAMS_H
#define PEELRAY_LDC_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// One body: triangles that share a cube, in a space of their own.
struct LdcBody {
    CubeGrid grid;        ///< written by ldc_grids
    uint first_triangle;  ///< of the triangle buffer
    uint triangles;
    uint resolution;   ///< voxels along the longest side, a multiple of 16; LDC_BARE
    uint first_cell;   ///< in the table of 16x16x16 cells, or its first pixel; written by ldc_grids
    uvec3 first_line;  ///< of ldc_sat_scan along x, y, z, counted over the bodies of a build; written by ldc_grids
    float tolerance;   ///< of `tolerance` hits, in the units of the body's space
};
SHARED_SIZE(LdcBody, 64);
/// Of LdcBody::resolution: the body has no cube, its triangles are tested one by one (PEELRAY_BARE).
#define LDC_BARE 0x80000000u

/// The corners of a triangle of a body from the grid's origin, in the units of the body's space: what `exact` hits by
/// voxel are tested against, in three blocks that GPUs load at once.
struct LdcCorners {
    vec4 a_bx, byz_cxy, cz_normal;  ///< and the normal, not normalised (ldcNormal)
};
SHARED_SIZE(LdcCorners, 48);

/// Parameters of all ldc_* passes. A build makes the cubes of a range of bodies; its tables begin behind those of the
/// bodies that were built before.
struct LdcParams {
    uint first_body;
    uint bodies;
    uint first_triangle;  ///< of the first body
    uint triangles;       ///< of all bodies of the build
    uint first_cell;      ///< entry of the table of 16x16x16 cells, or pixel
    uint first_occupied;  ///< number of an occupied 16x16x16 cell
    uint first_node;      ///< number of an occupied 4x4x4 node
    uint first_sample;
    uint sampling;           ///< LDC_CONSERVATIVE, LDC_BAND or LDC_CENTRE
    uint by_pixel;           ///< 1: fragments for the by-pixel order; 2: with depths of 16 bits
    uint cell_capacity;      ///< 16x16x16 cells, or pixels, that have room
    uint occupied_capacity;  ///< of them occupied
    uint node_capacity;      ///< occupied 4x4x4 nodes that have room
    uint fragment_capacity;
    uint block_capacity;  ///< entries of the queue of blocks of large triangles
    uint long_capacity;   ///< entries of the queue of long lists; by pixel
    uint axis;            ///< of ldc_sat_scan
    uint block;           ///< of ldc_ranges: pixels of a block along u, and along v << 16
    uint level;           ///< of ldc_ranges_up; of ldc_peel: passes before this one
    uint viewport;        ///< of the graphics pipeline: pixels along a side of what clip space covers, a power of two
    uint side;            ///< of peeling: pixels along a side of the targets
    uint refine_above;     ///< lists longer than this are refined; ~0: none
    uint refine_from;      ///< but only if the longest list of all is longer than this
    uint refine_most;      ///< and no more than so many are to be
    uint refine_capacity;  ///< lists to be refined that have room
    uint fine_capacity;    ///< samples of finer voxels that have room
};
SHARED_SIZE(LdcParams, 104);
#define LDC_CONSERVATIVE 0u  // every pixel that a triangle touches: `exact`
#define LDC_BAND 1u          // pixel centres, with the overlap band: `planar`
#define LDC_CENTRE 2u        // pixel centres, each triangle in one LDI, as in the paper: `tolerance`

/// Counted on the GPU while building; whatever exceeds a capacity makes the host grow it and build again.
struct LdcCounters {
    uint fragments;  ///< samples
    uint blocks;     ///< of 32x32 pixels, of large triangles
    uint listed;     ///< samples that are in lists; by voxel
    uint cells;      ///< 16x16x16 cells, or pixels
    uint occupied;   ///< of them occupied
    uint nodes;      ///< occupied 4x4x4 nodes
    uint voxels;     ///< occupied voxels
    uint long_lists;
    uint longest;     ///< samples of the longest list; by pixel: the depth complexity
    uint degenerate;  ///< triangles without area: dropped
    uint invalid;     ///< triangles with NaN or infinite corners: dropped
    uint wrapped;     ///< bit 0: more fragments than 32 bits count; 1: cells or pixels; 2: a tolerance beyond what
                      ///< by-voxel samples hold
    uint complexity;  ///< of peeling: the depth complexity, largest of all bodies
    uint passes;      ///< of peeling: made for all bodies
    uint refine;      ///< lists that are to be refined, if any are
    uint longest_left;  ///< samples of the longest of the other lists
};
SHARED_SIZE(LdcCounters, 64);

/// How large the grids of a build are: of its counters what is known before its first triangle, apart from them so that passes which need no
/// more can go on beside those that count.
struct LdcExtent {
    uvec3 lines;  ///< of ldc_sat_scan along x, y, z
    uint cells;   ///< 16x16x16 cells
};
SHARED_SIZE(LdcExtent, 16);

/// Longer lists are not refined: one workgroup would take too long for them.
#define LDC_LONGEST_REFINED 2048u

/// What refining has counted. Apart from the counters, so that it can go on beside passes that read those.
struct LdcRefined {
    uint voxels;   ///< that became 4x4x4 finer ones: of the lists that are to be refined those that were worth it
    uint samples;  ///< of finer voxels
    uint longest;  ///< list among those that were to be refined, afterwards
};
SHARED_SIZE(LdcRefined, 12);

/// Bits of LdcCounters::wrapped.
#define LDC_WRAPPED_FRAGMENTS 1u
#define LDC_WRAPPED_CELLS 2u
#define LDC_FAR_TOLERANCE 4u
/// By voxel a sample's depth is stored within so many voxels of the voxel that it is filed under.
#define LDC_FARTHEST_BY_VOXEL 2.0f

/// Workgroups of the passes whose work is counted on the GPU, in this order in the buffer of groups.
#define LDC_GROUPS_BLOCKS 0u
#define LDC_GROUPS_FRAGMENTS 1u  // by pixel, as those that follow
#define LDC_GROUPS_LONG 2u
#define LDC_GROUPS_CELLS 3u  // 256 to a group
#define LDC_GROUPS 4u

/// Parameters of ldc_max, one step of a reduction.
struct MaxParams {
    uint from;  ///< of the values
    uint count;
    uint to;  ///< where the maxima of LDC_MAX_BLOCK values each go
};
SHARED_SIZE(MaxParams, 12);
#define LDC_MAX_BLOCK 1024u

/// Parameters of ldc_peel_plan.
struct PeelPlanParams {
    uint value;  ///< place of the depth complexity
    uint body;
    uint passes;    ///< recorded
    uint vertices;  ///< of a draw
    uint draws;     ///< of a pass: 1, or one for each LDI
    uint texels;    ///< of the three LDIs' targets
};
SHARED_SIZE(PeelPlanParams, 24);

/// VkDrawIndirectCommand.
struct DrawArguments {
    uint vertices;
    uint instances;
    uint first_vertex;
    uint first_instance;
};
SHARED_SIZE(DrawArguments, 16);

/// One triangle's crossing of one voxel or pixel, before it is sorted into its list.
struct LdcFragment {
    uint cell;   ///< of the build's 16^3 cells; after ldc_count: index of the voxel's entry, counted from the build's
                 ///< first. Or pixel
    uint id;     ///< triangle * 4 + axis
    uint local;  ///< voxel inside the 16^3 cell (12 bits: node 6, voxel 6); after ldc_count: slot in its list. Or
                 ///< depth: bits of a float
};
SHARED_SIZE(LdcFragment, 12);

/// What a sample of a drawn stream carries beside its depth.
struct LdcCaptured {
    uint slope;   ///< as in a sample of the by-pixel order
    uint normal;  ///< packSnorm4x8
    uint color;   ///< packUnorm4x8, linear
};
SHARED_SIZE(LdcCaptured, 12);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
