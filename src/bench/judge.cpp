#include "bench/judge.h"

#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "reference/planar_answer.h"

namespace peelray {

double allowed_share(Claim claim, uint32_t resolution) {
    if (claim == Claim::exact) return 0;
    if (claim == Claim::single) return 1e-4;
    return 0.003 * 1024 / resolution;
}

double beside_share(Claim claim, uint32_t resolution) {
    return claim == Claim::voxel ? 0.02 * 1024 / resolution : 1e-3;
}

Judgement judge(const Oracle& oracle, const Geometry& geometry, const RayContender& contender, uint32_t resolution,
                std::span<const Ray> rays, std::span<const FileHit> hits, bool any_hit, size_t most) {
    const Claim claim = contender.claim();
    const double voxel = contender.voxel();
    Judgement out;
    out.allowed = allowed_share(claim, resolution);
    out.beside = beside_share(claim, resolution);
    out.checked = std::min(rays.size(), most);
    std::atomic<uint64_t> wrong{0}, second_look{0}, counted{0};
    parallel_for(out.checked, 64, [&](size_t i) {
        const size_t at = out.checked < rays.size() ? size_t(double(i) * double(rays.size()) / double(most)) : i;
        const Ray& ray = rays[at];
        const OracleRay in_double{glm::dvec3(ray.origin), ray.tmin, glm::dvec3(ray.direction), ray.tmax};
        const bool found = hits[at].triangle != NO_TRIANGLE;
        const double t = found ? double(hits[at].t) : INFINITY;
        if (claim != Claim::voxel) {
            const Verdict verdict =
                any_hit ? oracle.check_any(in_double, found) : oracle.check(in_double, t, hits[at].triangle);
            wrong += verdict == Verdict::wrong;
            second_look += verdict == Verdict::within_offset;
            counted++;
            return;
        }
        const OracleHit right = oracle.closest(in_double);
        counted += any_hit || found || right.hit();
        if (any_hit ? found == right.hit() : distance_off(geometry, in_double, t, right) <= voxel) return;
        const bool beside = any_hit ? occluded_beside(oracle, in_double, found, voxel)
                                    : right_beside(oracle, geometry, in_double, t, voxel);
        beside ? second_look++ : wrong++;
    });
    out.wrong = wrong;
    out.second_look = second_look;
    out.counted = counted;
    return out;
}

}  // namespace peelray
