#include "scene/lamps.h"

#include <algorithm>

#include "scene/probabilities.h"

namespace peelray {

Lamps lamps_of(const std::vector<Light>& own, const std::vector<Light>& of_environment) {
    Lamps lamps;
    lamps.lights = own;
    const auto placed = std::stable_partition(lamps.lights.begin(), lamps.lights.end(), [](const Light& light) {
        return light.kind == Light::Kind::directional;
    });
    lamps.first = uint32_t(placed - lamps.lights.begin());
    lamps.count = uint32_t(lamps.lights.end() - placed);
    std::vector<double> intensities;
    // One of negative colour takes light away: it is tried as one that gives as much.
    for (auto light = placed; light != lamps.lights.end(); ++light)
        intensities.push_back(mean_color(glm::abs(glm::dvec3(light->color))));
    lamps.cumulative = cumulative_shares(intensities);
    lamps.lights.insert(lamps.lights.end(), of_environment.begin(), of_environment.end());
    return lamps;
}

}  // namespace peelray
