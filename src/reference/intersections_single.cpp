// Hits in single precision: Embree's, of triangles that it knows, watertight and without a decision of ours but for
// holes, sides and what a ray starts on.
#include <algorithm>

#include "reference/embree_scene.h"
#include "reference/intersections.h"
#include "scene/picture.h"

#ifndef PEELRAY_SINGLE
#error "of the single-precision tracer alone"
#endif

namespace peelray::inline PRECISION {

/// What decides about a hit, by triangle: most have nothing that does.
enum Trait : uint8_t {
    holes = 1,        ///< it may have some
    one_side = 2,     ///< only its front is there
    see_through = 4,  ///< light may come through
};

struct TriangleTraits {
    AlphaTest alpha;
    std::vector<uint8_t> traits;
};

namespace {

/// A ray on its way through Embree, which hands it back to the filters.
struct Query : RTCIntersectContext {
    const TriangleTraits& triangles;
    uint32_t skip;
    bool to_light;
    float tmin;
    /// The nearest so far: of several at the same distance Embree's order must not decide.
    float nearest = endless;
    uint32_t triangle = ~0u;
    std::vector<Hit>* all = nullptr;
    bool through = false;  ///< something that may let light through is in the way

    Query(const TriangleTraits& triangles, const Ray& ray, uint32_t skip, bool to_light)
        : RTCIntersectContext(), triangles(triangles), skip(skip), to_light(to_light), tmin(ray.tmin) {
        rtcInitIntersectContext(this);
    }

    /// `normal`: of the triangle, as its corners go.
    bool counts(uint32_t id, float u, float v, const Vec3& direction, const Vec3& normal) const {
        if (id == skip) return false;
        const uint8_t traits = triangles.traits[id];
        if (traits & one_side && (glm::dot(normal, direction) < 0) == to_light) return false;
        return !(traits & holes) || triangles.alpha.is_present(id, u, v);
    }
};

struct Candidate {
    Query& query;
    const RTCRay& ray;
    const RTCHit& hit;
    bool counts() const {
        return ray.tfar > query.tmin && query.counts(hit.primID, hit.u, hit.v, {ray.dir_x, ray.dir_y, ray.dir_z},
                                                     {hit.Ng_x, hit.Ng_y, hit.Ng_z});
    }
};

// Single rays only are traced here, hence the casts from Embree's "N rays".
Candidate candidate_of(const RTCFilterFunctionNArguments* args) {
    return {*static_cast<Query*>(args->context), *reinterpret_cast<const RTCRay*>(args->ray),
            *reinterpret_cast<const RTCHit*>(args->hit)};
}

void filter_nearest(const RTCFilterFunctionNArguments* args) {
    const Candidate candidate = candidate_of(args);
    const auto& [query, ray, hit] = candidate;
    const bool farther = ray.tfar > query.nearest || (ray.tfar == query.nearest && hit.primID > query.triangle);
    if (farther || !candidate.counts()) {
        args->valid[0] = 0;
        return;
    }
    if (query.all) {
        query.all->push_back({ray.tfar, hit.primID, hit.u, hit.v});
        args->valid[0] = 0;
        return;
    }
    query.nearest = ray.tfar;
    query.triangle = hit.primID;
}

/// What light may come through does not block for certain.
void filter_blocking(const RTCFilterFunctionNArguments* args) {
    const Candidate candidate = candidate_of(args);
    const bool through = candidate.query.triangles.traits[candidate.hit.primID] & see_through;
    if (through) candidate.query.through |= candidate.hit.primID != candidate.query.skip;
    if (through || !candidate.counts()) args->valid[0] = 0;
}

RTCRay embree_ray(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            std::max(ray.tmin, 0.0f),
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0,
            ray.tmax,
            ~0u,
            0,
            0};
}

}  // namespace

struct Intersections::Impl : TriangleTraits, EmbreeScene {
    Impl(const Scene& described, const Geometry& geometry);
};

Intersections::Impl::Impl(const Scene& described, const Geometry& geometry) {
    alpha = AlphaTest(described, geometry);
    const Sidedness sides(described, geometry);
    const size_t count = geometry.triangles.size();
    traits.resize(count);
    for (uint32_t i = 0; i < count; i++) {
        const bool through = lets_through(described.materials[geometry.materials[i]]);
        traits[i] = uint8_t((alpha.is_masked(i) ? holes : 0) | (sides.is_single(i) ? one_side : 0) |
                            (through ? see_through : 0));
    }
    if (count == 0) return;  // every ray misses
    start();
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Triangles of corners that are not there or not finite are hit by none.
    std::vector<glm::uvec3> corners = geometry.triangles;
    for (glm::uvec3& t : corners)
        if (std::max({t.x, t.y, t.z}) >= geometry.positions.size()) t = glm::uvec3(0);
    // Copied: Embree reads 16 bytes of the last one of shared buffers.
    const auto copy = [&](RTCBufferType type, RTCFormat format, const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        void* to = rtcSetNewGeometryBuffer(mesh, type, 0, format, sizeof(Value), values.size());
        if (to) std::ranges::copy(values, static_cast<Value*>(to));
    };
    copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, geometry.positions);
    copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, corners);
    rtcSetGeometryIntersectFilterFunction(mesh, filter_nearest);
    rtcSetGeometryOccludedFilterFunction(mesh, filter_blocking);
    build(mesh, count);
}

Intersections::Intersections(const Scene& scene, const Geometry& geometry)
    : impl_(std::make_unique<Impl>(scene, geometry)) {}

Intersections::~Intersections() = default;

Hit Intersections::nearest(const Ray& ray, uint32_t skip, bool to_light) const {
    if (!impl_->scene || !(ray.tmin < ray.tmax)) return {};
    Query query(*impl_, ray, skip, to_light);
    RTCRayHit found{embree_ray(ray), {}};
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &query, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {found.ray.tfar, found.hit.primID, found.hit.u, found.hit.v};
}

std::vector<Hit> Intersections::along(const Ray& ray, uint32_t skip, bool to_light) const {
    std::vector<Hit> hits;
    if (!impl_->scene || !(ray.tmin < ray.tmax)) return hits;
    Query query(*impl_, ray, skip, to_light);
    query.all = &hits;
    RTCRayHit found{embree_ray(ray), {}};
    rtcIntersect1(impl_->scene, &query, &found);
    put_in_order(hits);
    return hits;
}

Intersections::Way Intersections::way(const Ray& ray, uint32_t skip) const {
    if (!impl_->scene || !(ray.tmin < ray.tmax)) return Way::free;
    Query query(*impl_, ray, skip, true);
    RTCRay traced = embree_ray(ray);
    rtcOccluded1(impl_->scene, &query, &traced);
    return traced.tfar < 0 ? Way::blocked : query.through ? Way::unsure : Way::free;
}

bool Intersections::is_present(uint32_t triangle, real u, real v) const {
    return !(impl_->traits[triangle] & holes) || impl_->alpha.is_present(triangle, u, v);
}

bool Intersections::is_single(uint32_t triangle) const {
    return impl_->traits[triangle] & one_side;
}

}  // namespace peelray::inline PRECISION
