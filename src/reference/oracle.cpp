#include "reference/oracle.h"

#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "reference/bvh.h"

namespace peelray {
namespace {

enum class Mode { nearest, occluded, collect };

/// One ray on its way through Embree, which hands the context back to each callback: threads share nothing that
/// changes.
struct Query : RTCIntersectContext {
    const TriangleSet& triangles;
    const AlphaTest& alpha;
    const Sidedness& sides;
    PreparedRay ray;
    Mode mode;
    uint32_t skip = ~0u;
    bool to_light = false;
    double reach = 0;    ///< of the scene's diagonal
    double begin = 0;    ///< scaled t of the origin that Embree got
    double to_unit = 1;  ///< from scaled t to Embree's
    OracleHit hit{infinity, ~0u, 0, 0};
    uint32_t index = ~0u;
    std::vector<uint32_t> collected;

    /// Tests one candidate; returns how far Embree has to go on.
    float visit(uint32_t candidate, float tfar) {
        if (mode == Mode::collect) {
            collected.push_back(candidate);
            return tfar;
        }
        const uint32_t id = triangles.ids[candidate];
        OracleHit found;
        if (id == skip || !ray.intersect(triangles.corners[candidate], found)) return tfar;
        if (found.t > hit.t || (found.t == hit.t && id > hit.triangle)) return tfar;
        if (!alpha.is_present(id, found.u, found.v)) return tfar;
        if (sides.is_single(id) && comes_from_front(triangles.corners[candidate], ray.direction) == to_light)
            return tfar;
        hit = found;
        hit.triangle = id;
        index = candidate;
        if (mode == Mode::occluded) return -float(infinity);
        // Embree's own t is off by less than `reach`: every box that could hold a nearer hit stays in.
        const double t = (std::ldexp(hit.t, ray.exponent) - ray.start - begin) * to_unit + 2 * reach;
        return std::min(tfar, std::nextafter(float(t), float(infinity)));
    }

    /// The float ray for Embree: from where the ray enters the scene's box to where it leaves it, a little longer at
    /// both ends. False if it passes by.
    bool aim(RTCRay& out) {
        const double margin = 2 * reach * triangles.diagonal;
        auto [first, last] =
            clip(ray.origin, ray.direction, triangles.lower - glm::dvec3(margin), triangles.upper + glm::dvec3(margin));
        const double length = glm::length(ray.direction), slack = margin / length;
        first = std::max(first, std::ldexp(ray.tmin, ray.exponent) - ray.start - slack);
        last = std::min(last, std::ldexp(ray.tmax, ray.exponent) - ray.start + slack);
        if (!(first <= last)) return false;
        begin = first - slack;
        to_unit = length / triangles.diagonal;
        const glm::dvec3 center = (triangles.lower + triangles.upper) * 0.5;
        const glm::vec3 origin((ray.origin + begin * ray.direction - center) / triangles.diagonal);
        const glm::vec3 direction(ray.direction / length);
        out = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0};
        out.tfar = std::nextafter(float((last + slack - begin) * to_unit), float(infinity));
        out.mask = ~0u;
        out.id = out.flags = 0;
        return true;
    }
};

void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
    const auto& corners = set.corners[args->primID];
    const glm::dvec3 center = (set.lower + set.upper) * 0.5, reach(Bvh::reach);
    const glm::dvec3 low(glm::min(glm::min(corners[0], corners[1]), corners[2]));
    const glm::dvec3 high(glm::max(glm::max(corners[0], corners[1]), corners[2]));
    const glm::vec3 l((low - center) / set.diagonal - reach), h((high - center) / set.diagonal + reach);
    *args->bounds_o = {l.x, l.y, l.z, 0, h.x, h.y, h.z, 0};
}

void visit(RTCIntersectContext* context, uint32_t candidate, float& tfar) {
    tfar = static_cast<Query*>(context)->visit(candidate, tfar);
}

// Single rays only are traced here, hence the casts from Embree's "N rays".
void intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0]) visit(args->context, args->primID, reinterpret_cast<RTCRayHit*>(args->rayhit)->ray.tfar);
}

void occlude(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0]) visit(args->context, args->primID, reinterpret_cast<RTCRay*>(args->ray)->tfar);
}

Query trace(const Bvh& bvh, const OracleRay& ray, Mode mode, uint32_t skip, bool to_light = false) {
    Query query{{}, bvh.triangles, bvh.alpha, bvh.sides, {}, mode, skip, to_light, Bvh::reach};
    rtcInitIntersectContext(&query);
    const std::optional<PreparedRay> prepared = PreparedRay::make(ray, bvh.triangles);
    if (!bvh.scene || !prepared) return query;
    query.ray = *prepared;
    RTCRayHit ray_hit{};
    if (!query.aim(ray_hit.ray)) return query;
    if (mode == Mode::occluded)
        rtcOccluded1(bvh.scene, &query, &ray_hit.ray);
    else
        rtcIntersect1(bvh.scene, &query, &ray_hit);
    return query;
}

}  // namespace

Bvh::Bvh(const Geometry& geometry, const AlphaTest& alpha, const Sidedness& sides)
    : triangles(geometry), alpha(alpha), sides(sides) {
    if (triangles.ids.empty()) return;  // every ray misses
    start();
    RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(user, unsigned(triangles.ids.size()));
    rtcSetGeometryUserData(user, &triangles);
    rtcSetGeometryBoundsFunction(user, bounds, nullptr);
    rtcSetGeometryIntersectFunction(user, intersect);
    rtcSetGeometryOccludedFunction(user, occlude);
    build(user, triangles.ids.size());
}

Bvh::Found Bvh::nearest(const OracleRay& ray, uint32_t skip, bool to_light) const {
    const Query query = trace(*this, ray, Mode::nearest, skip, to_light);
    return {query.hit, query.index};
}

bool Bvh::occluded(const OracleRay& ray) const {
    return trace(*this, ray, Mode::occluded, ~0u).hit.hit();
}

std::vector<uint32_t> Bvh::along(const OracleRay& ray) const {
    return trace(*this, ray, Mode::collect, ~0u).collected;
}

Oracle::Oracle(const Geometry& geometry, const AlphaTest& alpha, const Sidedness& sides)
    : impl_(std::make_unique<Impl>(geometry, alpha, sides)) {}
Oracle::~Oracle() = default;

OracleHit Oracle::closest(const OracleRay& ray, uint32_t skip) const {
    return impl_->nearest(ray, skip).hit;
}

double Oracle::diagonal() const {
    return impl_->triangles.diagonal;
}

OracleHit closest_brute_force(const Geometry& geometry, const OracleRay& ray, uint32_t skip, const AlphaTest& alpha,
                              const Sidedness& sides) {
    const TriangleSet triangles(geometry);
    OracleHit nearest{infinity, ~0u, 0, 0};
    const std::optional<PreparedRay> prepared = PreparedRay::make(ray, triangles);
    for (size_t i = 0; prepared && i < triangles.ids.size(); ++i) {
        OracleHit hit;
        // Ascending indices: of equal t the lowest index stays, as in the oracle.
        if (triangles.ids[i] == skip || !prepared->intersect(triangles.corners[i], hit) || hit.t >= nearest.t) continue;
        if (!alpha.is_present(triangles.ids[i], hit.u, hit.v)) continue;
        if (!sides.shows(triangles.ids[i], comes_from_front(triangles.corners[i], prepared->direction))) continue;
        nearest = hit;
        nearest.triangle = triangles.ids[i];
    }
    return nearest;
}

}  // namespace peelray
