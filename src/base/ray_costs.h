// What tracing rays costs.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace peelray {

/// How often the traversal did each of these for a ray, or for several: PeelrayCounts of include/peelray/cube.h.
struct RayCosts {
    uint32_t steps = 0;      ///< cells of any level that it was in, empty boxes included
    uint32_t cells = 0;      ///< lists of samples that it met
    uint32_t pixels = 0;     ///< by pixel: pixels that it was in, empty ones included
    uint32_t samples = 0;    ///< samples tested
    uint32_t triangles = 0;  ///< triangles tested
};
static_assert(sizeof(RayCosts) == 20);

/// One of them, with the name that it has in files.
struct RayCostField {
    const char* name;
    uint32_t RayCosts::*value;
};
inline constexpr std::array<RayCostField, 5> kRayCostFields = {{{"steps", &RayCosts::steps},
                                                                {"cells", &RayCosts::cells},
                                                                {"pixels", &RayCosts::pixels},
                                                                {"samples", &RayCosts::samples},
                                                                {"triangles", &RayCosts::triangles}}};

/// The largest of one kind; 0 where there are none.
inline uint32_t largest_of(const std::vector<RayCosts>& costs, const RayCostField& field) {
    uint32_t largest = 0;
    for (const RayCosts& cost : costs) largest = std::max(largest, cost.*field.value);
    return largest;
}

}  // namespace peelray
