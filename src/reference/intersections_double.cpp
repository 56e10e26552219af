// The reference's hits: the oracle's.
#include "reference/bvh.h"
#include "reference/intersections.h"

#ifdef PEELRAY_SINGLE
#error "of the double-precision tracer alone"
#endif

namespace peelray::inline PRECISION {

struct Intersections::Impl : Bvh {
    Impl(const Scene& scene, const Geometry& geometry)
        : Bvh(geometry, AlphaTest(scene, geometry), Sidedness(scene, geometry)) {}
};

Intersections::Intersections(const Scene& scene, const Geometry& geometry)
    : impl_(std::make_unique<Impl>(scene, geometry)) {}

Intersections::~Intersections() = default;

Hit Intersections::nearest(const Ray& ray, uint32_t skip, bool to_light) const {
    return impl_->nearest(ray, skip, to_light).hit;
}

void Intersections::nearest(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (size_t i = 0; i < rays.size(); i++) hits[i] = nearest(rays[i], ~0u);
}

HitsAlong Intersections::along(const Ray& ray, uint32_t skip, bool to_light) const {
    HitsAlong hits;
    const TriangleSet& set = impl_->triangles;
    const auto prepared = PreparedRay::make(ray, set);
    if (!prepared) return hits;
    for (const uint32_t index : impl_->along(ray)) {
        Hit hit;
        hit.triangle = set.ids[index];
        if (hit.triangle == skip || !prepared->intersect(set.corners[index], hit)) continue;
        const bool shown = !is_single(hit.triangle) || comes_from_front(set.corners[index], ray.direction) != to_light;
        if (shown && is_present(hit.triangle, hit.u, hit.v)) hits.add(hit);
    }
    hits.put_in_order();
    return hits;
}

/// The reference looks at each surface.
Intersections::Way Intersections::way(const Ray&, uint32_t, HitsAlong&) const {
    return Way::unsure;
}

bool Intersections::is_present(uint32_t triangle, real u, real v) const {
    return impl_->alpha.is_present(triangle, u, v);
}

bool Intersections::is_single(uint32_t triangle) const {
    return impl_->sides.is_single(triangle);
}

}  // namespace peelray::inline PRECISION
