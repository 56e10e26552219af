#include "reference/ray_sets.h"

#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "reference/optics.h"
#include "reference/random_numbers.h"
#include "reference/surface.h"

namespace peelray {
namespace {

constexpr uint32_t bounces = 4, ambient_samples = 4;
constexpr double glass_index = 1.5;

/// The parts of the sets, in their order: of refraction one per bounce, of ambient one per sample.
enum Part : size_t {
    primary_part,
    mirror_part,
    shadow_part,
    diffuse_part,
    refraction_part,
    ambient_part = refraction_part + bounces,
    part_count = ambient_part + ambient_samples
};
using Parts = std::array<std::vector<SurfaceRay>, part_count>;

/// Makes all rays that begin at a pixel.
class PixelRays {
  public:
    PixelRays(const Scene& scene, const Geometry& geometry, const Oracle& oracle, const RaySetView& view,
              const std::vector<RayKind>& kinds)
        : geometry_(geometry),
          oracle_(oracle),
          surfaces_(scene, geometry),
          picture_(view),
          view_(make_view(view.camera, float(view.width) / float(view.height), view.box.lower, view.box.upper)) {
        for (const RayKind kind : kinds) wanted_[size_t(kind)] = true;
    }

    void add(uint32_t x, uint32_t y, Parts& out) const {
        const SurfaceRay camera = camera_ray(x, y);
        if (wants(RayKind::primary)) out[primary_part].push_back(camera);
        const OracleHit hit = oracle_.closest(in_double(leaving_ray(camera, 0)));
        if (!hit.hit()) return;
        const glm::dvec3 direction = camera.direction;
        const Surface s = surfaces_.at(hit.triangle, hit.u, hit.v, direction);
        if (wants(RayKind::mirror))
            out[mirror_part].push_back(leave(s, hit.triangle, s.position, reflected(s, direction)));
        if (wants(RayKind::shadow)) add_shadow(s, hit.triangle, out);
        const uint32_t seed = path_seed(x, y);
        for (uint32_t i = 0; wants(RayKind::ambient) && i < ambient_samples; i++)
            out[ambient_part + i].push_back(leave(s, hit.triangle, s.shadow_start, cosine_direction(s, seed, i)));
        if (wants(RayKind::diffuse))
            out[diffuse_part].push_back(leave(s, hit.triangle, s.position, cosine_direction(s, seed, ambient_samples)));
        if (wants(RayKind::refraction)) add_refraction(s, hit.triangle, direction, out);
    }

  private:
    bool wants(RayKind kind) const { return wanted_[size_t(kind)]; }

    static OracleRay in_double(const StartedRay& ray) { return {ray.origin, ray.tmin, ray.direction, ray.tmax}; }

    SurfaceRay camera_ray(uint32_t x, uint32_t y) const {
        const glm::dvec2 p((2 * x + 1.0) / picture_.width - 1, 1 - (2 * y + 1.0) / picture_.height);
        const glm::dvec3 offset = glm::dvec3(view_.right) * p.x + glm::dvec3(view_.up) * p.y;
        const glm::dvec3 eye = glm::dvec3(view_.eye) + (view_.orthographic ? offset : glm::dvec3(0));
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(view_.forward) + (view_.orthographic ? glm::dvec3(0) : offset));
        return {eye, direction, float(infinity), glm::vec3(0), 0, ~0u};
    }

    SurfaceRay leave(const Surface& s, uint32_t triangle, const glm::dvec3& point, const glm::dvec3& direction,
                     double reach = infinity) const {
        float extent = 0;
        for (int i = 0; i < 3; i++) {
            const glm::vec3 corner = glm::abs(geometry_.positions[geometry_.triangles[triangle][i]]);
            extent = std::max({extent, corner.x, corner.y, corner.z});
        }
        return {point, direction, float(reach), s.geometric, float(POSITION_ROUNDING) * extent, triangle};
    }

    static glm::dvec3 reflected(const Surface& s, const glm::dvec3& d) {
        return optics::above_surface(d - 2 * glm::dot(d, s.normal) * s.normal, s.geometric);
    }

    static glm::dvec3 cosine_direction(const Surface& s, uint32_t seed, uint32_t sample) {
        const PixelSample drawn{sample, PixelSample::bits_for(ambient_samples + 1)};
        const glm::dvec2 random = random_pair(seed, 0, RANDOM_SKY, drawn);
        return optics::above_surface(optics::cosine_direction(s.normal, random), s.geometric);
    }

    void add_shadow(const Surface& s, uint32_t triangle, Parts& out) const {
        const bool far = picture_.light.kind == Light::Kind::directional;
        const glm::dvec3 to_light =
            far ? -glm::dvec3(picture_.light.direction) : glm::dvec3(picture_.light.position) - s.position;
        const double distance = glm::length(to_light);
        if (!(distance > 0) || glm::dot(s.geometric, to_light) <= 0) return;
        const glm::dvec3 direction = to_light / distance;
        const double reach = far ? infinity : glm::dot(glm::dvec3(picture_.light.position) - s.shadow_start, direction);
        out[shadow_part].push_back(leave(s, triangle, s.shadow_start, direction, reach));
    }

    void add_refraction(Surface s, uint32_t triangle, glm::dvec3 direction, Parts& out) const {
        for (uint32_t bounce = 0; bounce < bounces; bounce++) {
            const auto refracted = optics::refract_ray(direction, s.normal, s.front ? glass_index : 1 / glass_index);
            const SurfaceRay ray = leave(s, triangle, s.position, refracted ? *refracted : reflected(s, direction));
            out[refraction_part + bounce].push_back(ray);
            if (bounce + 1 == bounces) return;
            const OracleHit hit = oracle_.closest(in_double(leaving_ray(ray, 0)), triangle);
            if (!hit.hit()) return;
            direction = ray.direction;
            triangle = hit.triangle;
            s = surfaces_.at(hit.triangle, hit.u, hit.v, direction);
        }
    }

    const Geometry& geometry_;
    const Oracle& oracle_;
    Surfaces surfaces_;
    RaySetView picture_;
    View view_;
    std::array<bool, kRayKinds> wanted_{};
};

/// The set that a part belongs to.
RayKind kind_of(size_t part) {
    if (part >= ambient_part) return RayKind::ambient;
    if (part >= refraction_part) return RayKind::refraction;
    constexpr RayKind single[] = {RayKind::primary, RayKind::mirror, RayKind::shadow, RayKind::diffuse};
    return single[part];
}

}  // namespace

StartedRay leaving_ray(const SurfaceRay& ray, float offset) {
    if (ray.triangle == ~0u) return {ray.point, 0, ray.direction, ray.reach};
    const float slope = glm::dot(ray.direction, ray.normal);
    const float first =
        std::min(offset / std::max(std::abs(slope), float(LEAST_SLOPE)), float(FLATTEST_START) * offset);
    const float lift = ray.error + (offset - first * std::abs(slope));
    const glm::vec3 moved = ray.normal * (slope >= 0 ? lift : -lift);
    return {ray.point + moved, first, ray.direction, ray.reach - glm::dot(moved, ray.direction)};
}

RaySets make_ray_sets(const Scene& scene, const Geometry& geometry, const Oracle& oracle, const RaySetView& view,
                      const std::vector<RayKind>& kinds) {
    const PixelRays pixels(scene, geometry, oracle, view, kinds);
    constexpr uint32_t tiles_at_once = 64;
    const uint32_t columns = (view.width + 7) / 8;
    const size_t tiles = size_t(columns) * ((view.height + 7) / 8);
    std::vector<Parts> chunks((tiles + tiles_at_once - 1) / tiles_at_once);
    const auto make_chunk = [&](size_t chunk) {
        for (size_t tile = chunk * tiles_at_once; tile < std::min(tiles, (chunk + 1) * tiles_at_once); tile++)
            for (uint32_t lane = 0; lane < 64; lane++) {
                const uint32_t x = uint32_t(tile % columns) * 8 + lane % 8, y = uint32_t(tile / columns) * 8 + lane / 8;
                if (x < view.width && y < view.height) pixels.add(x, y, chunks[chunk]);
            }
    };
    constexpr size_t until_interrupt = 256;
    for (size_t first = 0; first < chunks.size(); first += until_interrupt) {
        check_interrupt();
        parallel_for(std::min(until_interrupt, chunks.size() - first), 1, [&](size_t i) { make_chunk(first + i); });
    }
    RaySets sets;
    for (size_t part = 0; part < part_count; part++) {
        std::vector<SurfaceRay>& set = sets[size_t(kind_of(part))];
        size_t more = 0;
        for (const Parts& chunk : chunks) more += chunk[part].size();
        set.reserve(set.size() + more);
        for (Parts& chunk : chunks) {
            set.insert(set.end(), chunk[part].begin(), chunk[part].end());
            chunk[part] = {};
        }
    }
    return sets;
}

}  // namespace peelray
