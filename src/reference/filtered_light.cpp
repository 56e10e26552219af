// The environment's light without noise (docs/frame.md section 5: EnvironmentMode::filtered).
#include <algorithm>
#include <cmath>

#include "reference/optics.h"
#include "reference/shader.h"
#include "scene/sampling.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

/// A level of FilteredEnvironment.
struct FilteredLevel {
    uint32_t width, height;
    size_t first;

    FilteredLevel(const FilteredEnvironment& filtered, uint32_t number)
        : width(filtered.width), height(filtered.height), first(0) {
        for (uint32_t i = 0; i < number; i++) {
            first += size_t(width) * height;
            width = FilteredEnvironment::next_size(width, 2 * FILTERED_LEAST_ROWS);
            height = FilteredEnvironment::next_size(height, FILTERED_LEAST_ROWS);
        }
    }
};

}  // namespace

Vec3 Surroundings::filtered_level(const Vec3& d, uint32_t number) const {
    const FilteredEnvironment& filtered = environment_.filtered;
    const FilteredLevel level(filtered, number);
    return bilinear_around(place(d), level.width, level.height,
                           [&](size_t i) { return Vec3(filtered.texels[level.first + i]); });
}

/// A level's lobe is twice as wide as that of the level before; narrower ones than the first's are between it and the
/// image.
Vec3 Surroundings::filtered(const Vec3& d, real alpha, real rough_limit) const {
    const uint32_t last = environment_.filtered.levels - 1;
    const real least = std::exp2(-real(last));
    if (alpha < least) return glm::mix(seen(d, 0, false, rough_limit), filtered_level(d, 0), alpha / least);
    const real at = std::min(real(last), last + std::log2(alpha));
    const uint32_t lower = uint32_t(at);
    return glm::mix(filtered_level(d, lower), filtered_level(d, std::min(last, lower + 1)), at - lower);
}

/// Both blur; in a focus that a lobe blurs light no longer meets. Half of what GGX reflects is within twice atan(alpha)
/// of the mean direction.
Cone Cone::blurred(real alpha) const {
    const real blurred = std::hypot(spread, 4 * alpha);
    return {width, width < 0 ? -blurred : blurred};
}

/// Of a lobe that the surface sends light on in; `part`: of its alpha.
Cone Shader::lobe_cone(const Cone& cone, real roughness, real part) const {
    const bool blurs = context_.filters_environment() && roughness >= MIRROR_ROUGHNESS;
    return blurs ? cone.blurred(part * roughness * roughness) : cone;
}

/// What is seen along a cone that a rough surface has widened.
Vec3 Shader::filtered_lobe(const Vec3& direction, const Cone& cone) const {
    return context_.surroundings.filtered(direction, std::abs(cone.spread) / 4, context_.rough_limit);
}

/// The sky's light behind what is in the way, by the sample's set of directions: each brings a share of it, by what it
/// stands for and the cosine.
Vec3 Shader::filtered_sky(const Lit& at, const BothSides& sky) {
    const std::span<const FixedDirection> set = context_.surroundings.fixed_directions(sample_.number);
    const Vec3& normal = at.surface.normal;
    BothSides all{Vec3(0), Vec3(0)}, arrived = all;
    for (const FixedDirection& fixed : set) {
        const Vec3 direction(fixed.direction);
        const real cosine = glm::dot(direction, normal);
        const bool back = cosine < 0;
        if (largest(back ? sky.back : sky.front) == 0) continue;
        const Vec3 light = Vec3(fixed.light) * std::abs(cosine);
        (back ? all.back : all.front) += light;
        if (light == Vec3(0) || hides_itself(at, direction)) continue;
        const Start start = start_to(at, direction);
        rays_.ambient++;
        (back ? arrived.back : arrived.front) += light * visibility(start.point, direction, endless, at.triangle,
                                                                    start.from_behind ? at.behind : at.path.media);
    }
    Vec3 sum = sky.front + sky.back;
    for (int c = 0; c < 3; c++) {
        if (all.front[c] > 0) sum[c] -= sky.front[c] * (1 - arrived.front[c] / all.front[c]);
        if (all.back[c] > 0) sum[c] -= sky.back[c] * (1 - arrived.back[c] / all.back[c]);
    }
    return sum;
}

}  // namespace peelray::inline PRECISION
