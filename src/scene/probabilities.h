// What is chosen in proportion to a weight.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// By which light of a colour is weighed.
inline double mean_color(const glm::dvec3& color) {
    return (color.x + color.y + color.z) / 3;
}

/// Of each of some weights, from 0 up: the share of it and those before it in their sum; the last one's is 1, and all
/// are where the sum is 0.
std::vector<float> cumulative_shares(const std::vector<double>& weights);

}  // namespace peelray
