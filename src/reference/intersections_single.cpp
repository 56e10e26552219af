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
    struct Nearest {
        float t = endless;
        uint32_t triangle = ~0u;
        bool is_before(float other, uint32_t of) const { return other > t || (other == t && of > triangle); }
    };
    Nearest nearest;
    Nearest* rays = &nearest;  ///< of each ray that is traced together with others, by its id
    HitsAlong* all = nullptr;
    bool through = false;  ///< something that may let light through is in the way

    Query(const TriangleTraits& triangles, const Ray& ray, uint32_t skip, bool to_light)
        : RTCIntersectContext(), triangles(triangles), skip(skip), to_light(to_light), tmin(ray.tmin) {
        rtcInitIntersectContext(this);
    }

    /// Is it there? `normal`: of the triangle, as its corners go.
    bool shows(uint32_t id, float u, float v, const Vec3& direction, const Vec3& normal) const {
        const uint8_t traits = triangles.traits[id];
        if (traits & one_side && (glm::dot(normal, direction) < 0) == to_light) return false;
        return !(traits & holes) || triangles.alpha.is_present(id, u, v);
    }
};

struct Candidate {
    Query& query;
    const RTCRay& ray;
    const RTCHit& hit;
    bool shows() const {
        return ray.tfar > query.tmin &&
               query.shows(hit.primID, hit.u, hit.v, {ray.dir_x, ray.dir_y, ray.dir_z}, {hit.Ng_x, hit.Ng_y, hit.Ng_z});
    }
    bool counts() const { return hit.primID != query.skip && shows(); }
    Hit found() const { return {ray.tfar, hit.primID, hit.u, hit.v}; }
};

// Of a single ray, hence the casts from Embree's "N rays".
Candidate candidate_of(const RTCFilterFunctionNArguments* args) {
    return {*static_cast<Query*>(args->context), *reinterpret_cast<const RTCRay*>(args->ray),
            *reinterpret_cast<const RTCHit*>(args->hit)};
}

/// Of rays that are traced together.
void filter_nearest_of_each(const RTCFilterFunctionNArguments* args) {
    Query& query = *static_cast<Query*>(args->context);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; i++) {
        if (args->valid[i] == 0) continue;
        const float t = RTCRayN_tfar(args->ray, n, i);
        const uint32_t id = RTCHitN_primID(args->hit, n, i);
        const Vec3 direction(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                             RTCRayN_dir_z(args->ray, n, i)),
            normal(RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i), RTCHitN_Ng_z(args->hit, n, i));
        Query::Nearest& nearest = query.rays[RTCRayN_id(args->ray, n, i)];
        const bool counts = t > query.tmin && id != query.skip &&
                            query.shows(id, RTCHitN_u(args->hit, n, i), RTCHitN_v(args->hit, n, i), direction, normal);
        if (nearest.is_before(t, id) || !counts)
            args->valid[i] = 0;
        else
            nearest = {t, id};
    }
}

void filter_nearest(const RTCFilterFunctionNArguments* args) {
    if (args->N > 1) {
        filter_nearest_of_each(args);
        return;
    }
    const Candidate candidate = candidate_of(args);
    const auto& [query, ray, hit] = candidate;
    Query::Nearest& nearest = query.rays[ray.id];
    if (nearest.is_before(ray.tfar, hit.primID) || !candidate.counts()) {
        args->valid[0] = 0;
        return;
    }
    if (query.all) {
        query.all->add(candidate.found());
        args->valid[0] = 0;
        return;
    }
    nearest = {ray.tfar, hit.primID};
}

/// What light may come through does not block for certain, nor does what the ray starts on: both are noted.
void filter_blocking(const RTCFilterFunctionNArguments* args) {
    const Candidate candidate = candidate_of(args);
    const auto& [query, ray, hit] = candidate;
    const bool through = query.triangles.traits[hit.primID] & see_through, starts = hit.primID == query.skip;
    const bool shows = candidate.shows();
    if (!through && !starts && shows) return;
    args->valid[0] = 0;
    if (!shows) return;
    query.through |= !starts;
    query.all->add(candidate.found());
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

void Intersections::nearest(std::span<const Ray> rays, std::span<Hit> hits) const {
    std::ranges::fill(hits, Hit());
    if (!impl_->scene || rays.empty()) return;
    if (rays.size() == 1) {
        hits[0] = nearest(rays[0], ~0u);
        return;
    }
    Query query(*impl_, rays[0], ~0u, false);
    query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::array<Query::Nearest, together> each;
    query.rays = each.data();
    alignas(32) std::array<int, together> valid{};
    RTCRayHit8 packet{};
    for (size_t i = 0; i < rays.size(); i++) {
        const RTCRay ray = embree_ray(rays[i]);
        valid[i] = -1;
        packet.ray.org_x[i] = ray.org_x;
        packet.ray.org_y[i] = ray.org_y;
        packet.ray.org_z[i] = ray.org_z;
        packet.ray.tnear[i] = ray.tnear;
        packet.ray.dir_x[i] = ray.dir_x;
        packet.ray.dir_y[i] = ray.dir_y;
        packet.ray.dir_z[i] = ray.dir_z;
        packet.ray.tfar[i] = ray.tfar;
        packet.ray.mask[i] = ray.mask;
        packet.ray.id[i] = unsigned(i);
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid.data(), impl_->scene, &query, &packet);
    for (size_t i = 0; i < rays.size(); i++)
        if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
            hits[i] = {packet.ray.tfar[i], packet.hit.primID[i], packet.hit.u[i], packet.hit.v[i]};
}

HitsAlong Intersections::along(const Ray& ray, uint32_t skip, bool to_light) const {
    HitsAlong hits;
    if (!impl_->scene || !(ray.tmin < ray.tmax)) return hits;
    Query query(*impl_, ray, skip, to_light);
    query.all = &hits;
    RTCRayHit found{embree_ray(ray), {}};
    rtcIntersect1(impl_->scene, &query, &found);
    hits.put_in_order();
    return hits;
}

Intersections::Way Intersections::way(const Ray& ray, uint32_t skip, HitsAlong& crossed) const {
    if (!impl_->scene || !(ray.tmin < ray.tmax)) return Way::free;
    Query query(*impl_, ray, skip, true);
    query.all = &crossed;
    RTCRay traced = embree_ray(ray);
    rtcOccluded1(impl_->scene, &query, &traced);
    if (traced.tfar < 0) return Way::blocked;
    if (!query.through) return Way::free;
    crossed.put_in_order();
    return Way::unsure;
}

bool Intersections::is_present(uint32_t triangle, real u, real v) const {
    return !(impl_->traits[triangle] & holes) || impl_->alpha.is_present(triangle, u, v);
}

bool Intersections::is_single(uint32_t triangle) const {
    return impl_->traits[triangle] & one_side;
}

}  // namespace peelray::inline PRECISION
