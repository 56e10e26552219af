// Where photons for caustics go, and how many passes of them are put together: what all tracers have in common
// (docs/frame.md section 5). How they fly, and how they are gathered, each finds out for itself.
#pragma once

#include <span>
#include <vector>

#include "caustics/photon_params.h"
#include "scene/box.h"
#include "scene/picture.h"

namespace peelray {

/// Lamps send photons towards balls around what mirrors or refracts, evenly over the directions to each. Where balls
/// overlap there are more photons than in one, and each is as much weaker.
struct PhotonPlan {
    uint32_t photons = 0;  ///< per pass; 0: nothing would come of any
    std::vector<PhotonTarget> targets;
    std::vector<PhotonLamp> lamps;
    std::vector<uint32_t> thresholds;  ///< of each lamp's targets
    bool through_glass = false;        ///< photons also go through what transmits: shadow rays do not then
    Box box;                           ///< of the scene
    glm::vec3 centre{0};               ///< of the ball around it
    float reach = 0;                   ///< its radius
    double flux = 0;                   ///< of a photon, the mean
    double radius = 0;                 ///< of the disc on which the first pass's photons are gathered

    bool empty() const { return photons == 0; }
};

/// `lights`: those that the picture's hits sum up or draw from; `geometry`: of the moment. What is generated may be
/// anywhere in its reach.
PhotonPlan plan_photons(const Scene& scene, const Geometry& geometry, std::span<const Light> lights,
                        const PictureSettings& settings);

/// What tells the photons of one sample of the picture from those of others.
struct PhotonPass {
    uint32_t seed;     ///< of their random numbers, as RayState::seed
    uint32_t bits;     ///< that tell the photons apart
    uint32_t picture;  ///< in the place of the picture's seed
    uint32_t offset;   ///< of systematic sampling of the lamps, a share of a photon times 2^32
    float radius;      ///< on which they are gathered
};
PhotonPass photon_pass(const PhotonPlan& plan, const PictureSettings& settings, uint32_t sample);

}  // namespace peelray
