// Photons by their places: a k-d tree. Private to src/reference.
#pragma once

#include <functional>
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
    void visit(const Vec3& point, const std::function<void(const RestingPhoton&, real)>& visit) const;

  private:
    void sort(size_t first, size_t end);

    /// The middle of each range divides it along `axes_` of the middle.
    std::vector<RestingPhoton> photons_;
    std::vector<uint8_t> axes_;
    real radius_ = 0;
};

}  // namespace peelray::inline PRECISION
