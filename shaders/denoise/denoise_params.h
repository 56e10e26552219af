// What the denoiser's passes (src/render/denoiser.cpp) and the reference's denoiser share: its input and its numbers.
#ifndef PEELRAY_DENOISE_PARAMS_H
#define PEELRAY_DENOISE_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// Of a pixel, the sums over those of its samples that see light drawn at random: that of the first surface along the
/// camera's ray, mirrors and clear glass being followed, where any is.
struct DenoiseGuide {
    vec3 light;     ///< that light, as it arrives at the camera
    float surfaces;  ///< how many samples there are
    vec3 albedo;    ///< what the light is divided by: the share of light that the surface sends on, weighted likewise
    float depth;    ///< length of the path
    vec3 normal;
    float gloss;       ///< share of the light that is mirrored, times how sharply
    float mean;        ///< of the samples: luminance of the light over that of the albedo,
    float deviations;  ///< and the sum of its squared deviations from that
};
SHARED_SIZE(DenoiseGuide, 56);

/// Where a camera ray has come to that is followed through mirrors.
struct DenoiseLink {
    vec3 weight;  ///< share of the light that goes the whole way
    float depth;  ///< length of the path
    uint place;   ///< in its level's queue, or NO_CHILD
};
SHARED_SIZE(DenoiseLink, 20);

struct DenoiseGuideParams {
    uint capacity;        ///< level 0's rays
    uint level_capacity;  ///< room in this level's queue
    uint next_capacity;   ///< room in the next level's
    uint light_capacity;  ///< room in the queue of shadow rays
    vec2 jitter;
    uint first_row;     ///< of the band, a multiple of 8
    uint sample_index;
    uint samples_lobes;  ///< 1: of a rough lobe one direction is drawn
    float limit;         ///< of a sample's light (PictureSettings::clamp)
};
SHARED_SIZE(DenoiseGuideParams, 40);

struct DenoiseParams {
    uint width;
    uint height;
    uint step;  ///< pixels between a filter's taps
};
SHARED_SIZE(DenoiseParams, 12);

// The filter's iterations: each has taps twice as far apart as the one before.
#define DENOISE_ITERATIONS 5
// Taps on either side in a filter, and of the windows that outliers and variance are looked for in.
#define DENOISE_TAPS 2
#define DENOISE_OUTLIER_REACH 2
#define DENOISE_VARIANCE_REACH 3
// Albedos below this count as this: little light says little about what it was before.
#define DENOISE_LEAST_ALBEDO 0.02
// How much a tap's weight falls (exponents of e): per 1 - cosine between the normals, per difference of gloss, of the
// luminance of the albedo;
#define DENOISE_NORMAL_FALL 256.0
#define DENOISE_GLOSS_FALL 8.0
#define DENOISE_ALBEDO_FALL 2.0
// by the difference to the depth of the plane through the pixel, over these shares of that plane's rise and of the depth;
#define DENOISE_SLOPE_TOLERANCE 0.3
#define DENOISE_DEPTH_TOLERANCE 0.002
// by the difference of luminances, over this many standard deviations.
#define DENOISE_DEVIATIONS 4.0
// Two pixels whose guides' weight is above this show the same.
#define DENOISE_SAME 0.2
// A luminance is an outlier above this many times the mean and this many standard deviations of the pixels around that
// show the same, of which there are at least so many; of several samples only if its own standard deviation is a
// share of what it is above the mean. It is then brought down to fewer deviations above that mean. ToyCar under an HDR
// has much of its light in few pixels at one sample: with half of these deviations it lost 5 to 13 % of it. (Without any
// limit it lost up to 11 %, for the difference of luminances keeps such pixels from their neighbours, too.)
#define DENOISE_OUTLIER_MEANS 2.0
#define DENOISE_OUTLIER_DEVIATIONS 8.0
#define DENOISE_OUTLIER_LEFT 4.0
#define DENOISE_OUTLIER_WITNESSES 4
#define DENOISE_OUTLIER_SHARE 0.25

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
