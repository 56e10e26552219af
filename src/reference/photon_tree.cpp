#include "reference/photon_tree.h"

#include <algorithm>

namespace peelray::inline PRECISION {

PhotonTree::PhotonTree(std::vector<RestingPhoton> photons, real radius)
    : photons_(std::move(photons)), axes_(photons_.size()), radius_(radius) {
    sort(0, photons_.size());
}

/// Along the axis on which they are farthest apart.
void PhotonTree::sort(size_t first, size_t end) {
    if (end - first < 2) return;
    Vec3 lower = photons_[first].position, upper = lower;
    for (size_t i = first; i < end; i++) {
        lower = glm::min(lower, photons_[i].position);
        upper = glm::max(upper, photons_[i].position);
    }
    const Vec3 size = upper - lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t middle = first + (end - first) / 2;
    const auto begin = photons_.begin();
    std::nth_element(
        begin + ptrdiff_t(first), begin + ptrdiff_t(middle), begin + ptrdiff_t(end),
        [&](const RestingPhoton& a, const RestingPhoton& b) { return a.position[axis] < b.position[axis]; });
    axes_[middle] = uint8_t(axis);
    sort(first, middle);
    sort(middle + 1, end);
}

}  // namespace peelray::inline PRECISION
