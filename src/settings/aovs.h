// Kinds of auxiliary pictures.
#pragma once

#include <algorithm>
#include <vector>

#include "base/ray_costs.h"
#include "settings/choices.h"

namespace peelray {

/// Who writes an auxiliary picture.
enum class AovSource : uint8_t {
    surface,    ///< what the camera sees
    ray_setup,  ///< what the paper sets up before it traces (Figure 7)
    samples,    ///< what a pixel's samples are like
    costs,      ///< what rays cost
};

inline std::vector<Aov> aovs_of(AovSource source) {
#define AOV_VALUE(name, type, channels, nothing) Aov::name,
    switch (source) {
        case AovSource::surface:
            return {SURFACE_AOVS(AOV_VALUE)};
        case AovSource::ray_setup:
            return {RAY_SETUP_AOVS(AOV_VALUE)};
        case AovSource::samples:
            return {SAMPLE_AOVS(AOV_VALUE)};
        case AovSource::costs:
            return {COST_AOVS(AOV_VALUE)};
    }
#undef AOV_VALUE
    return {};
}

/// The field of what a pixel's rays cost that it shows; null: it is none of the costs.
inline const RayCostField* cost_field(Aov aov) {
    const int field = int(aov) - int(Aov::cost_steps);
    return field >= 0 ? &kRayCostFields[size_t(field)] : nullptr;
}

inline bool is_from(AovSource source, Aov aov) {
    const std::vector<Aov> all = aovs_of(source);
    return std::find(all.begin(), all.end(), aov) != all.end();
}

}  // namespace peelray
