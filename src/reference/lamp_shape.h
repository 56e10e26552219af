// What KHR_lights_punctual makes of a lamp's strength. Private to src/reference.
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/real.h"
#include "scene/scene.h"

namespace peelray::inline PRECISION {

/// A smooth end at the range, [0, 1].
inline real within_range(const Light& light, real distance) {
    if (light.kind == Light::Kind::directional || !std::isfinite(light.range)) return 1;
    return std::clamp(1 - square(square(distance / light.range)), 0.0, 1.0);
}

/// A squared ramp between the cones of a spot light; `direction`: unit, from the lamp.
inline real within_cone(const Light& light, const Vec3& direction) {
    if (light.kind != Light::Kind::spot) return 1;
    const real inner = std::cos(real(light.inner_cone)), outer = std::cos(real(light.outer_cone));
    const real cosine = glm::dot(Vec3(light.direction), direction);
    return square(std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0));
}

}  // namespace peelray::inline PRECISION
