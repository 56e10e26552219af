// Kinds of auxiliary pictures.
#pragma once

#include "base/ray_costs.h"
#include "settings/choices.h"

namespace peelray {

/// The field of what a pixel's rays cost that it shows; null: it is none of the costs.
inline const RayCostField* cost_field(Aov aov) {
    const int field = int(aov) - int(Aov::cost_steps);
    return field >= 0 ? &kRayCostFields[size_t(field)] : nullptr;
}

/// Is it one of what the paper sets up before it traces (Figure 7)?
inline bool is_ray_setup(Aov aov) {
    return aov == Aov::reflection || aov == Aov::box || aov == Aov::directions;
}

}  // namespace peelray
