// The oracle's BVH. Private to src/reference.
#pragma once

#include "reference/embree_scene.h"
#include "reference/ray_triangle.h"

namespace peelray {

/// Embree sees user geometry only, so that no decision of its single-precision triangle test counts. It works in a
/// space of its own (the scene's centre at 0, its diagonal 1), so that neither large coordinates nor extreme scales
/// cost digits.
struct Bvh : EmbreeScene {
    /// In Embree's space. Rounding the ray to float moves it by less than 5·10⁻⁷ there, an allowed offset by 2·10⁻⁶:
    /// boxes enlarged by this much meet the ray whenever the triangle could.
    static constexpr double reach = 5e-6;

    struct Found {
        OracleHit hit{std::numeric_limits<double>::infinity(), ~0u, 0, 0};
        uint32_t index = ~0u;  ///< into triangles.corners
    };

    explicit Bvh(const Geometry& geometry, const AlphaTest& alpha = {}, const Sidedness& sides = {});

    /// `to_light`: the ray goes from a surface to a light, which meets the other sides of what is in between.
    Found nearest(const OracleRay& ray, uint32_t skip, bool to_light = false) const;
    bool occluded(const OracleRay& ray) const;
    /// All triangles whose enlarged boxes the ray meets, `reach` before tmin and behind tmax included.
    std::vector<uint32_t> along(const OracleRay& ray) const;

    TriangleSet triangles;
    AlphaTest alpha;  ///< a hit where it finds a hole does not count
    Sidedness sides;  ///< nor does one on a side that is not shown
};

struct Oracle::Impl : Bvh {
    using Bvh::Bvh;
};

}  // namespace peelray
