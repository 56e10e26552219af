// Photons for caustics: what the passes of src/render/photons.cpp share, and the numbers that the reference has in common with
// them (docs/frame.md section 5).
#ifndef PEELRAY_PHOTON_PARAMS_H
#define PEELRAY_PHOTON_PARAMS_H

#include "path/path_params.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// A ball around something that mirrors or refracts: photons are aimed at these.
struct PhotonTarget {
    vec3 centre;
    float radius;
    float share;  ///< weight of directions to it, (0, 1]: how much of the light it sends on
};
SHARED_SIZE(PhotonTarget, 20);

/// A lamp that sends photons.
struct PhotonLamp {
    uint light;      ///< index into the lights
    uint threshold;  ///< probability of it or one before it being chosen, times 2^32; the last one's is all the same
    float weight;    ///< of a photon's flux: what its targets fill over its share of the photons, sr or squares of world units
    uint first;      ///< of the thresholds of its targets, which are the same times 2^32 - 1
};
SHARED_SIZE(PhotonLamp, 16);

/// A photon on its way.
struct PhotonState {
    vec3 flux;      ///< 0: it has come to its end
    uint medium;    ///< as RayState::medium
    float way;      ///< its length so far
    uint specular;  ///< reflections and refractions so far
    uint light;     ///< that sent it
};
SHARED_SIZE(PhotonState, 28);

/// Where a photon came to an end on a surface that scatters light.
struct Photon {
    vec3 position;
    vec3 normal;     ///< of the triangle, unit, on the side that the photon came to
    vec3 direction;  ///< in which it flew, unit; 0: there is no photon
    vec3 flux;
};
SHARED_SIZE(Photon, 48);

struct PhotonEmitParams {
    vec3 centre;  ///< of the scene
    float reach;  ///< around it, of the ball in which all of it is
    uint count;   ///< photons
    uint bits;    ///< that tell them apart
    uint seed;    ///< of the pass, see PhotonPass
    uint picture;
    uint offset;
    uint lamps;
    uint targets;
    uint soft;  ///< 1: lamps have their size
};
SHARED_SIZE(PhotonEmitParams, 48);

struct PhotonScatterParams {
    uint count;
    uint bits;
    uint seed;
    uint picture;
    uint level;
    uint last;    ///< 1: whatever goes on is lost
    float usual;  ///< flux of a photon, the mean
};
SHARED_SIZE(PhotonScatterParams, 28);

struct PhotonGridParams {
    vec3 lower;  ///< of the scene
    float inverse_cell;
    uint count;  ///< photons
    uint mask;   ///< number of buckets, a power of two, less one
};
SHARED_SIZE(PhotonGridParams, 24);

struct PhotonGatherParams {
    LevelParams level;
    vec3 lower;
    float inverse_cell;
    float radius;
    float inverse_unit;  ///< what radiance is counted in is 1 over this
    uint mask;
};
SHARED_SIZE(PhotonGatherParams, 60);

// What random numbers of photons are for, beside RANDOM_MICROFACET and RANDOM_COAT.
#define RANDOM_PHOTON_TARGET 1024  // x: which target and where; y: where
#define RANDOM_PHOTON_LAMP 1025    // where on the lamp's ball or the sun's disc
#define RANDOM_PHOTON_WAY 1026     // which way at a surface; y: which colour
// Targets at most: of more, those that are close to each other share a ball.
#define PHOTON_MOST_TARGETS 64
// Weight of directions to what reflects little, as plastic does.
#define PHOTON_LEAST_SHARE 0.1
// At a surface that scatters light and mirrors it, a photon ends at least this often.
#define PHOTON_LEAST_END 0.0625
// Photons are gathered where the cosine between the two surfaces' normals is above this,
#define PHOTON_SAME_SIDE 0.7
// and from no farther above or below the surface than this share of the radius.
#define PHOTON_FLATNESS 0.5
// The first pass's radius is such that this many photons would be in the disc if they fell evenly on a plane as large as the targets.
#define PHOTON_GATHERED 64
// But no more than this share of the scene's radius.
#define PHOTON_MOST_RADIUS 0.1
// Squares of radii of successive passes are as (i + this) to (i + 1) (Knaus and Zwicker 2011): variance and bias both vanish.
#define PHOTON_SHRINKING (2.0 / 3.0)

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
