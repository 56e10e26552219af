#include "reference/past_pictures.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/optics.h"

namespace peelray {

using optics::luminance;

/// A surface on its way into the past.
struct PastPictures::Trail {
    glm::dvec2 place;  ///< in the next picture to look at, pixels
    double depth;      ///< expected there
    glm::dvec3 normal;
};

/// What a picture shows between its pixels.
struct PastPictures::Seen {
    DenoiseFilter::Signal signal;
    glm::dvec2 motion;
    double depth;  ///< in the picture before
    glm::dvec3 normal;
    double around, deviation;
};

void PastPictures::keep(int64_t number, uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides,
                        std::span<const DenoiseMotion> motions) {
    std::erase_if(kept_, [&](const auto& each) { return (each.first - number) % (DENOISE_WARM_UP + 1) == 0; });
    const DenoiseFilter filter(width, height, guides);
    Kept& kept = kept_[number];
    kept.resize(guides.size());
    filter.for_all([&](int x, int y) {
        Pixel& pixel = kept[filter.index(x, y)];
        pixel.features = filter.features(x, y);
        pixel.signal = filter.signal(x, y);
        pixel.motion = motions[filter.index(x, y)];
        if (!pixel.features.filtered) return;
        double weights = 0, squares = 0, light = 0, deviations = 0;
        filter.for_alike(x, y, DENOISE_VARIANCE_REACH, [&](double weight, int i, int j) {
            weights += weight;
            squares += weight * weight;
            light += weight * luminance(filter.signal(i, j).light);
        });
        pixel.around = light / weights;
        filter.for_alike(x, y, DENOISE_VARIANCE_REACH, [&](double weight, int i, int j) {
            const double from_mean = luminance(filter.signal(i, j).light) - pixel.around;
            deviations += weight * from_mean * from_mean;
        });
        // Too few pixels tell nothing: then it has no limit.
        pixel.deviation = weights * weights < DENOISE_OUTLIER_WITNESSES * squares
                              ? 1e4 * pixel.around
                              : std::sqrt(deviations * squares / (weights - squares / weights)) / weights;
    });
}

/// Does a pixel of the past show the surface that is followed?
bool PastPictures::is_same(const Pixel& present, const Trail& trail, const Pixel& pixel) {
    if (!pixel.features.filtered || pixel.motion.object != present.motion.object) return false;
    const glm::dvec2 slope = present.features.slope / present.features.depth;
    const double rise = DENOISE_SAME_RISE * (std::abs(slope.x) + std::abs(slope.y));
    if (std::abs(pixel.features.depth - trail.depth) > (DENOISE_SAME_DEPTH + rise) * trail.depth) return false;
    return glm::dot(pixel.features.normal, trail.normal) >= DENOISE_SAME_NORMAL;
}

std::optional<PastPictures::Seen> PastPictures::look(const DenoiseFilter& filter, const Kept& then,
                                                     const Pixel& present, const Trail& trail) {
    glm::dvec2 place = trail.place;
    for (int k = 0; k < 2; k++)
        if (std::abs(place[k] - std::round(place[k])) < DENOISE_WHOLE_PIXEL) place[k] = std::round(place[k]);
    double weights = 0;
    Seen seen{{glm::dvec3(0), 0}, glm::dvec2(0), 0, glm::dvec3(0), 0, 0};
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const glm::dvec2 pixel = glm::floor(place) + glm::dvec2(dx, dy);
            if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < filter.width() && pixel.y < filter.height())) continue;
            const double weight = (1 - std::abs(place.x - pixel.x)) * (1 - std::abs(place.y - pixel.y));
            const Pixel& there = then[filter.index(int(pixel.x), int(pixel.y))];
            if (weight <= 0 || !is_same(present, trail, there)) continue;
            weights += weight;
            seen.signal.light += weight * there.signal.light;
            seen.signal.variance += weight * weight * there.signal.variance;
            seen.motion += weight * glm::dvec2(there.motion.motion);
            seen.depth += weight * there.motion.depth;
            seen.normal += weight * there.features.normal;
            seen.around += weight * there.around;
            seen.deviation += weight * there.deviation;
        }
    if (weights < DENOISE_LEAST_PART) return {};
    return Seen{{seen.signal.light / weights, seen.signal.variance / (weights * weights)},
                seen.motion / weights,
                seen.depth / weights,
                glm::normalize(seen.normal),
                seen.around / weights,
                seen.deviation / weights};
}

DenoiseFilter::Signal PastPictures::mean_at(const DenoiseFilter& filter, int64_t number, int x, int y) const {
    struct Weighted {
        DenoiseFilter::Signal signal;
        double weight;
    };
    const Pixel& present = kept_.at(number)[filter.index(x, y)];
    std::vector<Weighted> all = {{present.signal, 1}};
    Trail trail{glm::dvec2(x, y) + glm::dvec2(present.motion.motion), present.motion.depth, present.features.normal};
    double trust = present.motion.object == DENOISE_NO_OBJECT ? 0 : 1;
    for (int64_t back = 1; back <= DENOISE_WARM_UP && trust > 0; back++) {
        const auto then = kept_.find(number - back);
        if (then == kept_.end()) break;
        const std::optional<Seen> seen = look(filter, then->second, present, trail);
        if (!seen) break;
        const double least = DENOISE_LEAST_CHANGE * std::max(present.around, seen->around);
        const double deviation = std::hypot(present.deviation, seen->deviation, least);
        const double change = deviation > 0 ? std::abs(seen->around - present.around) / deviation : 0;
        trust = std::clamp((DENOISE_CHANGE_LAST - change) / (DENOISE_CHANGE_LAST - DENOISE_CHANGE_FIRST), 0.0, trust);
        all.push_back({seen->signal, trust});
        trail = {trail.place + seen->motion, seen->depth, seen->normal};
    }
    double weights = 0, squares = 0, deviations = 0, variance = 0;
    glm::dvec3 light(0);
    for (const Weighted& each : all) {
        weights += each.weight;
        squares += each.weight * each.weight;
        light += each.weight * each.signal.light;
        variance += each.weight * each.weight * each.signal.variance;
    }
    light /= weights;
    const double pictures = weights * weights / squares;
    if (present.signal.variance >= 0) return {light, variance / (weights * weights)};
    if (pictures < DENOISE_LEAST_HISTORY - 0.5) return {light, -pictures};
    for (const Weighted& each : all) {
        const double from_mean = luminance(each.signal.light) - luminance(light);
        deviations += each.weight * from_mean * from_mean;
    }
    return {light, deviations / (weights - squares / weights) / pictures};
}

std::vector<DenoiseFilter::Signal> PastPictures::mean(const DenoiseFilter& filter, int64_t number) const {
    std::vector<DenoiseFilter::Signal> means(size_t(filter.width()) * size_t(filter.height()));
    filter.for_all([&](int x, int y) {
        means[filter.index(x, y)] =
            filter.features(x, y).filtered ? mean_at(filter, number, x, y) : filter.signal(x, y);
    });
    return means;
}

}  // namespace peelray
