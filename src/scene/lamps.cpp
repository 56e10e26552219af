#include "scene/lamps.h"

#include <algorithm>

namespace peelray {

Lamps lamps_of(const std::vector<Light>& own, const std::vector<Light>& of_environment) {
    Lamps lamps;
    lamps.lights = own;
    const auto placed = std::stable_partition(lamps.lights.begin(), lamps.lights.end(), [](const Light& light) {
        return light.kind == Light::Kind::directional;
    });
    lamps.first = uint32_t(placed - lamps.lights.begin());
    lamps.count = uint32_t(lamps.lights.end() - placed);
    double sum = 0, so_far = 0;
    // One of negative colour takes light away: it is tried as one that gives as much.
    const auto intensity = [](const Light& light) {
        const glm::dvec3 c = glm::abs(glm::dvec3(light.color));
        return (c.x + c.y + c.z) / 3;
    };
    for (auto light = placed; light != lamps.lights.end(); ++light) sum += intensity(*light);
    for (auto light = placed; light != lamps.lights.end(); ++light) {
        so_far += intensity(*light);
        lamps.cumulative.push_back(sum > 0 ? std::min(1.0f, float(so_far / sum)) : 1.0f);
    }
    if (!lamps.cumulative.empty()) lamps.cumulative.back() = 1;
    lamps.lights.insert(lamps.lights.end(), of_environment.begin(), of_environment.end());
    return lamps;
}

}  // namespace peelray
