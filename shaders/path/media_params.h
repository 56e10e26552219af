// Media that overlap or touch (shaders/path/media.glsl): what passes hand on of them. Buffers of scenes without any are
// not there.
#ifndef PEELRAY_MEDIA_PARAMS_H
#define PEELRAY_MEDIA_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// The media that a ray is in, by rank: four of them, 16 bits each, ascending. Rank + 1 in the upper 12 bits, how often
/// the ray has entered it in the lower 4; 0: none.
struct MediaStack {
    uint low;
    uint high;
};
SHARED_SIZE(MediaStack, 8);
#define MEDIA_MOST_RANKS 4095u

/// What a ray meets at its hit, of media.
struct MediaWall {
    MediaStack before;  ///< the media that the ray arrives in
    MediaStack behind;  ///< the media that a ray is in that goes through
    uint from;          ///< material of the medium before the wall (MEDIUM_NONE: air)
    uint to;            ///< and of that behind it
    vec3 passed;        ///< tint of the walls on the way that changed nothing
    float lift;         ///< how far from the wall rays start, world units; 0: as from any surface
    vec3 beside;        ///< tint of the other walls that coincide with the hit
};
SHARED_SIZE(MediaWall, 52);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
