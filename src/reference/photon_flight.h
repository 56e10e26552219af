// Photons on their way from the lamps to what scatters light (docs/frame.md section 5). Private to src/reference.
#pragma once

#include "reference/photon_tree.h"
#include "reference/shader.h"
#include "scene/photons.h"

namespace peelray::inline PRECISION {

/// A photon that leaves a lamp.
struct SentPhoton {
    Vec3 origin, direction;
    Vec3 flux;
    const Light* light;
};

/// Photon `number` of a pass; the context's lights are those of the plan.
SentPhoton send_photon(const RenderContext& context, const PhotonPlan& plan, const PhotonPass& pass, uint32_t number);

/// All photons of a pass that come to rest, in their order.
std::vector<RestingPhoton> fly_photons(const RenderContext& context, const PhotonPlan& plan, const PhotonPass& pass);

}  // namespace peelray::inline PRECISION
