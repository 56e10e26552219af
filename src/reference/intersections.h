// What rays of the CPU tracer meet of the scene's triangles. Private to src/reference.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
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

/// A few hits, by distance and number, each triangle once: in place as long as they are few.
class HitsAlong {
  public:
    void add(const Hit& hit) {
        if (count_ < few_.size()) {
            few_[count_++] = hit;
            return;
        }
        if (more_.empty()) more_.assign(few_.begin(), few_.end());
        more_.push_back(hit);
    }
    void put_in_order() {
        const auto key = [](const Hit& hit) { return std::pair(hit.t, hit.triangle); };
        const std::span<Hit> all = hits();
        if (all.size() < 2) return;
        std::ranges::sort(all, {}, key);
        const size_t left = size_t(std::ranges::unique(all, {}, &Hit::triangle).begin() - all.begin());
        if (more_.empty())
            count_ = left;
        else
            more_.resize(left);
    }
    std::span<Hit> hits() { return more_.empty() ? std::span(few_).first(count_) : std::span(more_); }
    std::span<const Hit> hits() const { return more_.empty() ? std::span(few_).first(count_) : std::span(more_); }

  private:
    std::array<Hit, 12> few_;
    size_t count_ = 0;  ///< in `few_`, all that there are if `more_` is empty
    std::vector<Hit> more_;
};

/// In double precision the oracle's hits, in single Embree's own. Throws Error if Embree runs out of memory.
class Intersections {
  public:
    /// Both must outlive it.
    Intersections(const Scene& scene, const Geometry& geometry);
    ~Intersections();

    /// The nearest with tmin < t < tmax, of equals that of the lowest number. `skip`: a triangle that does not count;
    /// `to_light`: the ray goes from a surface to a light, which meets the other sides of what is in between.
    Hit nearest(const Ray& ray, uint32_t skip, bool to_light = false) const;
    /// The nearest of each of up to `together` rays that go much the same way, from a camera.
    void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;
    static constexpr size_t together = 8;
    HitsAlong along(const Ray& ray, uint32_t skip, bool to_light) const;
    /// What is in the way of a ray that goes from a surface to a light.
    enum class Way {
        free,
        blocked,  ///< by something that lets no light through
        unsure,   ///< something may let light through: `crossed` or, where it is empty, nearest() knows what there is
    };
    /// `crossed`: what a ray to a light meets, whatever it skips.
    Way way(const Ray& ray, uint32_t skip, HitsAlong& crossed) const;

    /// Is there a surface at a point of a triangle?
    bool is_present(uint32_t triangle, real u, real v) const;
    /// Does the triangle show its front only?
    bool is_single(uint32_t triangle) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray::inline PRECISION
