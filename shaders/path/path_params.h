// The tree of rays, its queues, and the passes from scatter to accumulate (src/render).
#ifndef PEELRAY_PATH_PARAMS_H
#define PEELRAY_PATH_PARAMS_H

#include "common/shared.h"
#include "path/camera_before.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// What a ray carries beside its geometry.
struct RayState {
    vec3 weight;  ///< share of the pixel's light that comes along this ray
    uint medium;  ///< material whose volume the ray is in (MEDIUM_NONE: air) | RAY_CHANNEL | RAY_PASSED for each surface | RAY_SEES_SUN
    uint seed;    ///< of the random numbers: from the pixel and the branches taken, never from the place in a queue
    uint cone;    ///< at the ray's start (cone.glsl)
    float density;  ///< of its direction, per steradian, where the environment's light is also found otherwise; 0: it is not; < 0: only
    uint scattered;  ///< diffuse bounces so far
};
SHARED_SIZE(RayState, 32);
#define MEDIUM_NONE 0x00ffffffu
#define RAY_MEDIUM 0x00ffffffu
#define RAY_CHANNEL 0x03000000u  // 0: all colours; 1, 2, 3 times RAY_CHANNEL_UNIT: red, green, blue alone (dispersion)
#define RAY_CHANNEL_UNIT 0x01000000u
#define CHANNEL_MIDDLE 2u  // as a number: the one that light of lamps and of the sky has
#define RAY_PASSED 0x04000000u  // a blended surface; that is no bounce
#define RAY_PASSES 0x7c000000u
#define RAY_SEES_SUN 0x80000000u

/// One hit of the tree of rays below a pixel: its radiance is its own, what arrives along its shadow rays and that of
/// its children, weighted.
struct PathNode {
    vec3 radiance;
    uint first_light;  ///< entry of the queue of shadow rays
    uint flags;        ///< NODE_*, and how many entries are its own
};
SHARED_SIZE(PathNode, 20);
#define NODE_LIGHTS 0x01ffffffu
#define NODE_SHARE 0x02000000u     // of a NODE_CATCHER: its light is the share of the backdrop's that it leaves
#define NODE_CATCHER 0x04000000u   // its light is what it leaves of what is behind it; of its first child only a surface counts, and hides that
#define NODE_BACKDROP 0x08000000u  // first_light is a float: the share of the backdrop's light that gets here; it has no lights
#define NODE_DISPERSED 0x10000000u // its second child is red's, the next two green's and blue's
#define NODE_UNLIT 0x20000000u     // its radiance is a colour that a display is to show as it is
#define NODE_SURFACE 0x40000000u   // not the sky
#define NODE_BRANCHES 0x80000000u  // it has children

/// The children of a node: places in the next level.
struct PathBranches {
    vec3 weight0;
    uint child0;
    vec3 weight1;
    uint child1;
    vec3 weight2;  ///< of scattered light
    uint child2;
};
SHARED_SIZE(PathBranches, 48);
#define NO_CHILD 0xffffffffu
#define BACKDROP_CHILD 0xfffffffeu  // where the picture is transparent: what the camera sees through the node, untraced

/// Counters of a band: queue lengths by level, then rays by kind, then workgroups.
#define QUEUE_LEVELS 17u
#define QUEUE_REFLECTION 17u
#define QUEUE_REFRACTION 18u
#define QUEUE_LIGHT 19u           // shadow rays, those of the sky's light included
#define QUEUE_AMBIENT 20u         // of them: the sky's
#define QUEUE_OVERFLOW 21u        // OVERFLOW_*: what did not fit; the band is then rendered again
#define QUEUE_VIEW_BLOCKS 22u     // of large triangles
#define QUEUE_FINISHED 23u        // workgroups of the pass that runs
#define QUEUE_CUT_REFLECTION 24u  // rays that are not traced because the last level is reached
#define QUEUE_CUT_REFRACTION 25u
#define QUEUE_CROWDED 26u  // rays in more media than a stack holds
#define QUEUE_DIFFUSE 27u
#define QUEUE_PHOTONS 28u  // that have come to rest
#define QUEUE_PHOTON_RAYS 29u  // as many as there are photons
#define QUEUE_COUNTERS 30u
/// After the counters: three workgroup counts for each level, then of the view's blocks and of the shadow rays.
#define QUEUE_GROUPS QUEUE_COUNTERS
#define QUEUE_GROUPS_VIEW 17u
#define QUEUE_GROUPS_LIGHT 18u
/// Then as many rays, for launching them: three each.
#define QUEUE_LAUNCHES (QUEUE_GROUPS + 3u * 19u)
#define QUEUE_WORDS (QUEUE_LAUNCHES + 3u * 19u)

/// Photons that lamps send (src/render/photons.h): none, by mirrors alone, also through glass.
#define PHOTONS_BY_MIRRORS 1u
#define PHOTONS_THROUGH_GLASS 2u
/// In the instance of a surface that a shadow ray starts on: glass is as opaque to it as anything.
#define SHADOW_OPAQUE_GLASS 0x80000000u

#define OVERFLOW_PATHS 1u  // a level's rays
#define OVERFLOW_VIEW 2u   // blocks
#define OVERFLOW_LIGHT 4u  // shadow rays

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
    uint encodes;  ///< 1: the last sample, after which the picture is encoded
    float scale;   ///< exposure / samples
    float share;   ///< 1 / samples
    uint curve;    ///< 0 none, 1 ACES, 2 neutral
    float limit;   ///< to the largest channel of a sample
    uint straight; ///< 1: with an alpha, which colours are divided by
};
SHARED_SIZE(AccumulateParams, 44);

struct EncodeParams {
    uint pixels;
    float scale;  ///< exposure / samples
    float share;  ///< 1 / samples
    uint curve;   ///< 0 none, 1 ACES, 2 neutral
    uint shares;  ///< 1: of unlit colours there are shares, 0: sums
    uint straight;  ///< 1: with an alpha, which colours are divided by
};
SHARED_SIZE(EncodeParams, 24);

/// Parameters of the ray_setup passes: the box of the scene.
struct RaySetupParams {
    vec3 lower;
    vec3 upper;
};
SHARED_SIZE(RaySetupParams, 24);

/// The camera at the moment before, and a band of the picture.
struct MotionParams {
    CameraBefore before;
    uint capacity;   ///< level 0's hits
    uint first_row;  ///< of the band, a multiple of 8
};
SHARED_SIZE(MotionParams, 68);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
