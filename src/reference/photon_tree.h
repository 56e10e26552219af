// Photons by their places: a k-d tree. Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/real.h"

namespace peelray::inline PRECISION {

/// Where a photon came to rest.
struct RestingPhoton {
    Vec3 position;
    Vec3 normal;     ///< of the triangle, unit, on the side that the photon came to
    Vec3 direction;  ///< in which it flew, unit
    Vec3 flux;
};

class PhotonTree {
  public:
    PhotonTree() = default;
    PhotonTree(std::vector<RestingPhoton> photons, real radius);

    size_t size() const { return photons_.size(); }
    /// On which they are gathered.
    real radius() const { return radius_; }
    /// Calls `visit(photon, distance²)` for all that are nearer to a point than the radius, in an order that does not
    /// depend on anything else.
    template <typename Visit>
    void visit(const Vec3& point, const Visit& visit) const {
        search(point, visit, 0, photons_.size());
    }

  private:
    template <typename Visit>
    void search(const Vec3& point, const Visit& visit, size_t first, size_t end) const {
        if (first == end) return;
        const size_t middle = first + (end - first) / 2;
        const RestingPhoton& photon = photons_[middle];
        const int axis = axes_[middle];
        const real beyond = point[axis] - photon.position[axis];
        if (beyond < radius_) search(point, visit, first, middle);
        const Vec3 way = photon.position - point;
        const real distance2 = glm::dot(way, way);
        if (distance2 < radius_ * radius_) visit(photon, distance2);
        if (beyond > -radius_) search(point, visit, middle + 1, end);
    }
    void sort(size_t first, size_t end);

    /// The middle of each range divides it along `axes_` of the middle.
    std::vector<RestingPhoton> photons_;
    std::vector<uint8_t> axes_;
    real radius_ = 0;
};

}  // namespace peelray::inline PRECISION
