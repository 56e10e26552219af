// What the denoiser's passes (src/render/denoiser.cpp) and the reference's denoiser share: its input and its numbers.
#ifndef PEELRAY_DENOISE_PARAMS_H
#define PEELRAY_DENOISE_PARAMS_H

#include "common/shared.h"
#include "path/camera_before.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// Of a pixel, the sums over those of its samples that see light drawn at random: that of the first surface along the
/// camera's ray, mirrors and clear glass being followed, where any is.
struct DenoiseGuide {
    vec3 light;      ///< that light, as it arrives at the camera
    float surfaces;  ///< how many samples there are
    vec3 albedo;     ///< what the light is divided by: the share of light that the surface sends on, weighted likewise
    float depth;     ///< length of the path
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
    uint first_row;  ///< of the band, a multiple of 8
    uint sample_index;
    uint samples_lobes;  ///< 1: of a rough lobe one direction is drawn
    uint
        finds_light;  ///< 1: shadow rays or diffuse bounces bring light to what scatters it, where the draw is not zero
    float limit;      ///< of a sample's light (PictureSettings::clamp)
};
SHARED_SIZE(DenoiseGuideParams, 44);

struct DenoiseParams {
    uint width;
    uint height;
    uint step;  ///< pixels between a filter's taps
};
SHARED_SIZE(DenoiseParams, 12);

/// Of a pixel, where the surface that its guide comes from was in the picture of the moment before; of sample 0, whose
/// ray goes through the pixel's centre.
struct DenoiseMotion {
    vec2 motion;  ///< pixels, to the right and down
    float depth;  ///< length of the path then
    uint object;  ///< the surface's, or DENOISE_NO_OBJECT: it was nowhere, or there is none
};
SHARED_SIZE(DenoiseMotion, 16);
#define DENOISE_NO_OBJECT 0xffffffffu

/// What the surfaces on a camera ray's way, mirrors and glass, make of a point of the moment before, relative to the
/// eye then: where the camera saw its image. The way is straightened at each of them, as it stood then.
struct DenoiseImage {
    vec3 x, y, z;  ///< columns of the linear part
    vec3 origin;
    uint place;  ///< where the way was one level before, in that level's queue
};
SHARED_SIZE(DenoiseImage, 52);

/// The camera at the moment before, and a level of the tree of rays.
struct DenoiseMotionParams {
    CameraBefore before;
    uint capacity;  ///< level 0's rays
    vec2 jitter;
    uint first_row;       ///< of the band, a multiple of 8
    uint level_capacity;  ///< room in this level's queue
};
SHARED_SIZE(DenoiseMotionParams, 80);

/// Of a pixel, how far back its surface has been followed, and what its light was.
struct DenoiseTrail {
    vec2 place;   ///< in the next picture to look at, pixels; that of a pixel's centre is its number
    float depth;  ///< expected there
    uint normal;  ///< packed, of the picture before
    vec3 change;  ///< sum of the light less the present one's, weighted
    float trust;  ///< weight of the last picture that was looked at; 0: the way has ended
    float weights;
    float squares;     ///< of the weights, their sum
    float mean;        ///< of the luminances, weighted,
    float deviations;  ///< and the sum of their squared deviations from that
    float variance;    ///< of the sum, where samples tell it; else < 0
};
SHARED_SIZE(DenoiseTrail, 52);

// Denoise::temporal: how many moments before the picture's own are rendered and looked at. Each costs 44 bytes a pixel
// and a picture where a run begins; with six pictures in all a sixth of the variance is left.
#define DENOISE_WARM_UP 5
// A picture has the random numbers of its number modulo this: any DENOISE_WARM_UP + 1 in a row differ, and where
// nothing moves all pictures are the same. Between the seeds of one and the next:
#define DENOISE_SEEDS (DENOISE_WARM_UP + 1)
#define DENOISE_SEED_STEP 0x9e3779b9u
// What was seen then is the same surface if the cosine between the normals is at least this, and the depths differ by
// at most this share and as the surface rises over as many pixels.
#define DENOISE_SAME_NORMAL 0.9
#define DENOISE_SAME_DEPTH 0.02
#define DENOISE_SAME_RISE 1.5
// Of the four pixels around a place those that are must have at least this part of the weight.
#define DENOISE_LEAST_PART 0.1
// Motions this near to whole pixels are whole: rounding must not blur.
#define DENOISE_WHOLE_PIXEL (1.0 / 128.0)
// The light has changed if its mean around differs by more than so many standard deviations; from the second on it is
// another's. Noise alone gets above the first at one place in twenty.
#define DENOISE_CHANGE_FIRST 2.0
#define DENOISE_CHANGE_LAST 4.0
// Changes below this share of the mean are none.
#define DENOISE_LEAST_CHANGE 0.01
// From so many pictures on their own differences tell the variance.
#define DENOISE_LEAST_HISTORY 4

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
// by the difference to the depth of the plane through the pixel, over these shares of that plane's rise and of the
// depth;
#define DENOISE_SLOPE_TOLERANCE 0.3
#define DENOISE_DEPTH_TOLERANCE 0.002
// by the difference of luminances, over this many standard deviations.
#define DENOISE_DEVIATIONS 4.0
// Two pixels whose guides' weight is above this show the same.
#define DENOISE_SAME 0.2
// A luminance is an outlier above this many times the mean and this many standard deviations of the pixels around that
// show the same, of which there are at least so many; of several samples only if its own standard deviation is a
// share of what it is above the mean. It is then brought down to fewer deviations above that mean. ToyCar under an HDR
// has much of its light in few pixels at one sample: with half of these deviations it lost 5 to 13 % of it. (Without
// any limit it lost up to 11 %, for the difference of luminances keeps such pixels from their neighbours, too.)
#define DENOISE_OUTLIER_MEANS 2.0
#define DENOISE_OUTLIER_DEVIATIONS 8.0
#define DENOISE_OUTLIER_LEFT 4.0
#define DENOISE_OUTLIER_WITNESSES 4
#define DENOISE_OUTLIER_SHARE 0.25

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
