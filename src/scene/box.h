// A box along the axes.
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace peelray {

struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    bool operator==(const Box&) const = default;
};

}  // namespace peelray
