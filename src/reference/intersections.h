// What rays of the CPU tracer meet of the scene's triangles. Private to src/reference.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "reference/oracle.h"
#include "reference/real.h"

namespace peelray::inline PRECISION {

#ifdef PEELRAY_SINGLE
struct Ray {
    Vec3 origin;
    real tmin;
    Vec3 direction;  ///< unit
    real tmax;
};
struct Hit {
    real t = endless;
    uint32_t triangle = ~0u;  ///< ~0u: a miss
    real u = 0, v = 0;        ///< barycentric weights of the second and third vertex
    bool hit() const { return triangle != ~0u; }
};
#else
using Ray = OracleRay;
using Hit = OracleHit;
#endif

/// By distance and number, each triangle once.
inline void put_in_order(std::vector<Hit>& hits) {
    std::ranges::sort(hits, {}, [](const Hit& hit) { return std::pair(hit.t, hit.triangle); });
    const auto repeated = std::ranges::unique(hits, {}, &Hit::triangle);
    hits.erase(repeated.begin(), repeated.end());
}

/// In double precision the oracle's hits, in single Embree's own. Throws Error if Embree runs out of memory.
class Intersections {
  public:
    /// Both must outlive it.
    Intersections(const Scene& scene, const Geometry& geometry);
    ~Intersections();

    /// The nearest with tmin < t < tmax, of equals that of the lowest number. `skip`: a triangle that does not count;
    /// `to_light`: the ray goes from a surface to a light, which meets the other sides of what is in between.
    Hit nearest(const Ray& ray, uint32_t skip, bool to_light = false) const;
    /// All, by t and number, each triangle once.
    std::vector<Hit> along(const Ray& ray, uint32_t skip, bool to_light) const;
    /// What is in the way of a ray that goes from a surface to a light.
    enum class Way {
        free,
        blocked,  ///< by something that lets no light through
        unsure,   ///< something may let light through: nearest() knows what there is
    };
    Way way(const Ray& ray, uint32_t skip) const;

    /// Is there a surface at a point of a triangle?
    bool is_present(uint32_t triangle, real u, real v) const;
    /// Does the triangle show its front only?
    bool is_single(uint32_t triangle) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray::inline PRECISION
