// A frame: camera, lights and all else that does not change from pass to pass (src/render).
#ifndef PEELRAY_FRAME_H
#define PEELRAY_FRAME_H

#include "common/shared.h"
#include "path/backdrop_kinds.h"

#ifdef __cplusplus
namespace peelray {
#endif

struct GpuLight {
    vec3 position;
    uint kind;       ///< 0 directional, 1 point, 2 spot
    vec3 direction;  ///< unit, the direction in which the light travels
    float range;     ///< world units
    vec3 color;
    float cone_scale;  ///< spot: attenuation = clamp(cosine * scale + offset)^2 (KHR_lights_punctual)
    float cone_offset;
    float sine;  ///< directional: of its disc's angular radius; else the radius of its ball, world units
    float cumulative;  ///< probability of it or one before it being tried, where one of many is drawn
};
SHARED_SIZE(GpuLight, 60);

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
    uint lights;       ///< all, or of `drawn_lamps` none
    uint first_drawn;  ///< of the lamps of which one is drawn,
    uint drawn_lamps;  ///< and how many these are; 0: all count
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
    uint sample_bits;  ///< samples of a pixel are less than 2 to its power
    uint seed;         ///< of the random numbers
    uint env_quads;    ///< where in the lookups the environment's distribution begins
    uint env_depth;    ///< of its trees
    uint emitters;       ///< triangles that light is looked for on; 0: emission is met by chance
    uint first_emitter;  ///< in the lookups: instance and triangle (bits of integers), cumulative and own probability
    float env_texels;  ///< of its image per radian; 0: its levels are no means of texels
    uint bounces;       ///< reflections and refractions in a row
    uint bounce_levels;  ///< bounces, and as many blended surfaces as are passed
    uint gi;            ///< diffuse bounces
    uint last_level;    ///< level whose hits spawn no more rays: the sum of both
    float rough_limit;  ///< radiance of the environment that rays after a rough surface see at most: the sun is a light
    float tolerance;    ///< of `tolerance` hits, world units; else 0
    uvec2 block;        ///< pixels of a block of two_level
    uint draws;         ///< GpuDraw entries
    uvec2 camera_media;  ///< MediaStack: what the camera is in
    vec2 cone;           ///< of its rays, for one sample (cone.glsl)
    // What the camera sees where nothing is before it.
    uint backdrop;        ///< BACKDROP_*
    uint backdrop_first;  ///< of the blurred picture, among the environment's texels
    vec3 backdrop_color;
    // What is filtered of the environment (src/scene/filtered_environment.h), in the lookups.
    uvec2 filtered_size;  ///< of the first level
    uint filtered_first, filtered_levels;
    uint filtered_directions;  ///< where they begin: direction and light
    uint all_lights;  ///< with those that stand for a part of an image that is sampled, behind the others
};
SHARED_SIZE(Frame, 404);
#define EFFECT_REFLECTION 1u
#define EFFECT_REFRACTION 2u
#define EFFECT_SHADOW 4u
#define EFFECT_AMBIENT 8u
#define EFFECT_COMPENSATION 16u  // of the energy that rough surfaces would lose
#define EFFECT_SAMPLED 32u       // of rough lobes one direction each, not their means

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
