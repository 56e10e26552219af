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
};
SHARED_SIZE(LdcParams, 84);
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
    uvec3 lines;      ///< of ldc_sat_scan along x, y, z
    uint complexity;  ///< of peeling: the depth complexity, largest of all bodies
    uint passes;      ///< of peeling: made for all bodies
};
SHARED_SIZE(LdcCounters, 68);

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

/// Parameters of the prefix sum passes scan_*.comp.
struct ScanParams {
    uint capacity;  ///< elements, if `counter` is SCAN_NO_COUNTER
    uint counter;   ///< which uint of the counters holds the number of elements (clamped to capacity)
};
SHARED_SIZE(ScanParams, 8);
#define SCAN_NO_COUNTER 0xffffffffu
#define SCAN_BLOCK 1024u

// --- Instances (src/ldc/instances; shaders/instances.comp, tree_*.comp) ---

/// Where something stands: p in its own space is linear * p + position in the world.
struct GpuTransform {
    mat3 linear;
    vec3 position;
};
SHARED_SIZE(GpuTransform, 48);

/// What of an instance never changes.
struct InstanceInfo {
    uint body;
    uint first_id;      ///< added to the ids of its triangles
    uint first_object;  ///< added to the objects of its triangles
};
SHARED_SIZE(InstanceInfo, 12);

/// A body placed in the world.
struct GpuInstance {
    GpuTransform to_world;
    InstanceInfo info;
    uint moved;     ///< 0: to_world is the identity
    uint mirrored;  ///< 1: the transform turns triangles inside out
    float voxel;    ///< edge of a voxel in the world (the largest, where the transform is not even)
};
SHARED_SIZE(GpuInstance, 72);

struct InstanceParams {
    uint count;
    uint padded;  ///< rounded up to a multiple of 8
    uint slots;   ///< of up to 8 instances where their boxes go, four bits each: those of bare bodies first
};
SHARED_SIZE(InstanceParams, 12);

/// Parameters of all tree_* passes.
struct TreeParams {
    PeelrayTree tree;
    uint bits;    ///< of each axis of a Morton code
    uint level;   ///< tree_level: which
    uint boxes;   ///< of the level
    uint filled;  ///< the same, filled up to a multiple of 8
};
SHARED_SIZE(TreeParams, 56);
#define TREE_SMALL 1024

/// An instance's place in the order of the hierarchy, before it is sorted.
struct TreeKey {
    uint bucket;
    uint slot;  ///< in its bucket, in the order in which the atomics happened to run
};
SHARED_SIZE(TreeKey, 8);

// --- Deforming (src/render/deformer; shaders/deform*.comp) ---

/// A primitive whose vertices are computed anew for every moment.
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
    uint first_target;  ///< of each target the positions, then the normals of all vertices
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
};
SHARED_SIZE(DeformParams, 16);

// --- What is generated (src/render/generators; shaders/water_*.comp, swarm.comp) ---

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

/// Something that swims, in a moment.
struct GpuFloat {
    uint instance;
    vec2 at;       ///< x, z
    float turned;  ///< about the vertical, radians
    float radius;
};
SHARED_SIZE(GpuFloat, 20);

struct SwarmParams {
    uint bodies;
    float phase;  ///< of the swarm's period, [0, 1)
};
SHARED_SIZE(SwarmParams, 8);

// --- Tracing (shaders/trace.comp) ---

/// A ray in a queue.
struct Ray {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
};
SHARED_SIZE(Ray, 32);

/// A hit in a queue.
struct Hit {
    float t;        ///< +inf: a miss
    uint triangle;  ///< of the triangle buffer; NO_TRIANGLE: a miss
    uint instance;
    float u;
    float v;
};
SHARED_SIZE(Hit, 20);
#define NO_TRIANGLE 0xffffffffu

/// A hit as HITS.npy has it: the triangle counts over the whole scene, in file order.
struct FileHit {
    float t;
    uint triangle;
    float u;
    float v;
};
SHARED_SIZE(FileHit, 16);

/// A surface that a ray starts on and must not hit.
struct SurfaceId {
    uint instance;
    uint triangle;
};
SHARED_SIZE(SurfaceId, 8);

struct TraceParams {
    PeelrayTree tree;
    uint count;    ///< rays in the queue; with `counted`: room in the queue
    uint counted;  ///< 1: the count is queue[counter]
    uint counter;
    uint skips;       ///< 1: ray i must not hit skip[i]
    float tolerance;  ///< of `tolerance` hits, world units
    uvec2 block;      ///< pixels of a block of two_level
};
SHARED_SIZE(TraceParams, 68);

/// What the rays of one kind cost in all (shaders/counting.glsl).
struct CountTotals {
    uint rays;
    PeelrayCounts low;  ///< of sums in 64 bits
    PeelrayCounts high;
    PeelrayCounts largest;  ///< of a single ray
};
SHARED_SIZE(CountTotals, 64);
#define COUNT_TRACED 0u  // what `trace` traces: reflection and refraction, the rays of a file
#define COUNT_SHADOW 1u  // to the lamps and to the sky
#define COUNT_KINDS 2u

// --- The device's own ray tracing (src/khr; shaders/khr_*, trace_khr.rgen, trace_shadow_khr*.rgen) ---

/// A body's acceleration structure.
struct KhrBody {
    uvec2 structure;  ///< its address
    uint first_part;  ///< of its parts in the table of their first triangles
};
SHARED_SIZE(KhrBody, 12);

/// VkAccelerationStructureInstanceKHR.
struct KhrInstance {
    vec4 row_x;  ///< of the way from the body's space into the world
    vec4 row_y;
    vec4 row_z;
    uint part_and_mask;     ///< 24 bits: KhrBody::first_part; 8: the rays that see it
    uint offset_and_flags;  ///< 24 bits: of its hit shaders; 8: VkGeometryInstanceFlagsKHR
    uvec2 structure;        ///< its address; 0: nothing is there
};
SHARED_SIZE(KhrInstance, 64);

struct KhrTraceParams {
    uint count;    ///< rays in the queue; with `counted`: room in the queue
    uint counted;  ///< 1: the count is queue[counter]
    uint counter;
    uint skips;  ///< 1: ray i must not hit skip[i]
};
SHARED_SIZE(KhrTraceParams, 16);

// --- A frame (src/render; shaders/view_triangles.comp to accumulate.comp) ---

struct GpuMaterial {
    vec3 base_color;
    float metallic;
    vec3 emissive;
    float roughness;
    vec3 absorption;  ///< per world unit inside the volume; 0: none
    float transmission;
    float ior;
    int texture;         ///< base colour, -1: none
    uint flags;          ///< MATERIAL_*
    float thickness;     ///< of a volume, world units; rays measure it, cube maps cannot
    float alpha;         ///< of the base colour
    float alpha_cutoff;  ///< 0: opaque
};
SHARED_SIZE(GpuMaterial, 72);
#define MATERIAL_THIN 1u
#define MATERIAL_UNLIT 2u
#define MATERIAL_COLORED 4u  // vertices have colours

struct GpuTexture {
    uint offset;  ///< first texel in the texel buffer
    uint width;
    uint height;
    uint flags;  ///< wrap u (2 bits: repeat, mirror, clamp), wrap v (2 bits), bit 4: nearest
};
SHARED_SIZE(GpuTexture, 16);

struct GpuLight {
    vec3 position;
    uint kind;       ///< 0 directional, 1 point, 2 spot
    vec3 direction;  ///< unit, the way the light travels
    float range;     ///< world units
    vec3 color;
    float cone_scale;  ///< spot: attenuation = clamp(cosine * scale + offset)^2 (KHR_lights_punctual)
    float cone_offset;
};
SHARED_SIZE(GpuLight, 52);

/// Everything of a frame that does not change from pass to pass.
struct Frame {
    PeelrayTree tree;
    // Camera: ray through the pixel position p: forward + right * (2 p.x/width - 1) + up * (1 - 2 p.y/height).
    vec3 eye;
    float near;  ///< depth 1 of the reversed depth buffer
    vec3 right;  ///< times tan(half the horizontal field of view); orthographic: times half the width
    uint orthographic;
    vec3 up;
    float far;     ///< orthographic only
    vec3 forward;  ///< unit
    uint width;
    uint height;
    uint row_pixels;  ///< width rounded up to 8: records of one row of 8x8 tiles / 8
    uint lights;
    // Environment.
    uvec2 env_size;
    uint env_levels;
    float sun_cosine;    ///< of the sun's angular radius; 2: no sun disc
    vec3 sun_direction;  ///< to the sun
    vec3 sun_radiance;
    uint effects;          ///< EFFECT_*
    vec3 irradiance[9];    ///< spherical harmonics of the environment's irradiance, band by band
    float surface_offset;  ///< height above its surface, voxels of its cube, from which a secondary ray counts (not of
                           ///< exact hits)
    uint spp;
    uint last_level;    ///< level whose hits spawn no more rays
    float rough_limit;  ///< radiance of the environment that rays after a rough surface see at most: the sun is a light
    float tolerance;    ///< of `tolerance` hits, world units; else 0
    uvec2 block;        ///< pixels of a block of two_level
    uint draws;         ///< GpuDraw entries
};
SHARED_SIZE(Frame, 300);
#define EFFECT_REFLECTION 1u
#define EFFECT_REFRACTION 2u
#define EFFECT_SHADOW 4u
#define EFFECT_AMBIENT 8u

/// What a ray carries beside its geometry.
struct RayState {
    vec3 weight;  ///< share of the pixel's light that comes along this ray
    uint medium;  ///< material whose volume the ray is in (MEDIUM_NONE: air) | RAY_SEES_SUN
    uint seed;    ///< of the random numbers: from the pixel and the branches taken, never from the place in a queue
};
SHARED_SIZE(RayState, 20);
#define MEDIUM_NONE 0x7fffffffu
#define RAY_SEES_SUN 0x80000000u

/// One hit of the tree of rays below a pixel: its radiance is its own, what arrives along its shadow rays and that of
/// its children, weighted.
struct PathNode {
    vec3 radiance;
    uint first_light;  ///< entry of the queue of shadow rays
    uint flags;        ///< NODE_*, and how many entries are its own
};
SHARED_SIZE(PathNode, 20);
#define NODE_LIGHTS 0x3fffffffu
#define NODE_SURFACE 0x40000000u   // not the sky
#define NODE_BRANCHES 0x80000000u  // it has children

/// The children of a node: places in the next level.
struct PathBranches {
    vec3 weight0;
    uint child0;
    vec3 weight1;
    uint child1;
};
SHARED_SIZE(PathBranches, 32);
#define NO_CHILD 0xffffffffu

/// Counters of a band: queue lengths by level, then rays by kind, then workgroups.
#define QUEUE_LEVELS 17u
#define QUEUE_REFLECTION 17u
#define QUEUE_REFRACTION 18u
#define QUEUE_LIGHT 19u        // shadow rays, those of the sky's light included
#define QUEUE_AMBIENT 20u      // of them: the sky's
#define QUEUE_OVERFLOW 21u     // OVERFLOW_*: what did not fit; the band is done again then
#define QUEUE_VIEW_BLOCKS 22u  // of large triangles
#define QUEUE_FINISHED 23u     // workgroups of the pass that runs
#define QUEUE_COUNTERS 24u
/// After the counters: three workgroup counts for each level, then of the view's blocks and of the shadow rays.
#define QUEUE_GROUPS QUEUE_COUNTERS
#define QUEUE_GROUPS_VIEW 17u
#define QUEUE_GROUPS_LIGHT 18u
/// Then as many rays, for launching them: three each.
#define QUEUE_LAUNCHES (QUEUE_GROUPS + 3u * 19u)
#define QUEUE_WORDS (QUEUE_LAUNCHES + 3u * 19u)
#define OVERFLOW_PATHS 1u  // a level's rays
#define OVERFLOW_VIEW 2u   // blocks
#define OVERFLOW_LIGHT 4u  // shadow rays

/// Triangles of a body in all its instances, one after the other.
struct GpuDraw {
    uint first_number;  ///< of its drawn triangles, counted over all draws
    uint first_triangle;
    uint triangles;  ///< of an instance
    uint first_instance;
};
SHARED_SIZE(GpuDraw, 16);

/// Parameters of the view_* passes.
struct ViewParams {
    vec2 jitter;          ///< sample position in the pixel, [0, 1)
    uint triangles;       ///< drawn, over all instances
    uint block_capacity;  ///< entries of the queue of blocks of large triangles
};
SHARED_SIZE(ViewParams, 16);

struct VisibilityParams {
    vec2 jitter;  ///< sample position in the pixel, [0, 1)
};
SHARED_SIZE(VisibilityParams, 8);

/// Parameters of the passes that work on one level of the tree of rays.
struct LevelParams {
    uint level;
    uint capacity;       ///< room in this level's queue
    uint next_capacity;  ///< room in the next level's queue
    uint sample_index;
    vec2 jitter;
    uint first_row;       ///< of the band, a multiple of 8
    uint light_capacity;  ///< room in the queue of shadow rays
};
SHARED_SIZE(LevelParams, 32);

struct AccumulateParams {
    uint capacity;        ///< level 0's nodes
    uint next_capacity;   ///< room for nodes of level 1
    uint light_capacity;  ///< room in the queue of shadow rays
    uint first_row;       ///< of the band, a multiple of 8
    uint sample_index;
    uint last;    ///< 1: the last sample, the picture is encoded
    float scale;  ///< exposure / samples
    uint curve;   ///< 0 none, 1 ACES, 2 neutral
};
SHARED_SIZE(AccumulateParams, 32);

// --- The baseline: cube maps and shadow maps (src/render/cube_maps, shadow_maps; shaders/cubemap_*, probe_*,
// shadow_depth) ---

/// An object and, if it reflects or refracts, its probe: the cube map of its surroundings.
struct GpuObject {
    vec3 lower;  ///< its box
    uint probe;  ///< first texel of its cube map; NO_PROBE
    vec3 upper;
    uint face;        ///< texels along a side of the sharpest level's faces
    uint levels;      ///< of roughness: 1 or PROBE_LEVELS
    float thickness;  ///< shortest side of its box: no volume is thicker
};
SHARED_SIZE(GpuObject, 40);
#define NO_PROBE 0xffffffffu
/// Level k is blurred to the roughness (k / (PROBE_LEVELS - 1))² and has faces of max(face >> k, PROBE_SMALLEST_FACE)
/// texels.
#define PROBE_LEVELS 6u
#define PROBE_SMALLEST_FACE 8u

/// One shadow map: a view from a light. A light has six in the table; one without texels is not used.
struct GpuShadowMap {
    vec3 eye;
    uint first;  ///< texel
    vec3 right;  ///< as in Frame
    uint size;   ///< texels along a side; 0: not used
    vec3 up;
    uint orthographic;
    vec3 forward;  ///< unit; the depth is measured along it
};
SHARED_SIZE(GpuShadowMap, 60);

/// Parameters of the rasterisation of probes and shadow maps.
struct MapVisibilityParams {
    uint left_out;  ///< object
    uint shadow;    ///< 1: what casts shadows; 0: what a probe sees
    vec2 jitter;    ///< sample position in the pixel, [0, 1)
};
SHARED_SIZE(MapVisibilityParams, 16);

/// Parameters of the passes that fill a map from `first` on.
struct MapParams {
    uint first;
    uint size;          ///< texels along a side
    uint source_first;  ///< probe_mip: the finer level
    uint source_size;
    float roughness;    ///< probe_filter
    uint sample_index;  ///< probe_store: of the samples that a texel is the mean of
};
SHARED_SIZE(MapParams, 24);

/// Parameters of the ray_setup passes: the box of the scene.
struct RaySetupParams {
    vec3 lower;
    vec3 upper;
};
SHARED_SIZE(RaySetupParams, 24);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
