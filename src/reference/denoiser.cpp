#include "reference/denoiser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "reference/denoise_filter.h"
#include "reference/optics.h"

namespace peelray {

using optics::luminance;

DenoiseFilter::DenoiseFilter(uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides)
    : width_(int(width)), height_(int(height)), guides_(guides), features_(guides.size()), signal_(guides.size()) {
    for_all([&](int x, int y) { prepare(x, y); });
    first_ = signal_;
}

void DenoiseFilter::for_all(const std::function<void(int, int)>& body) const {
    parallel_for(size_t(height_), 1, [&](size_t y) {
        for (int x = 0; x < width_; x++) body(x, int(y));
    });
}

void DenoiseFilter::replace(const std::function<Signal(int, int)>& made) {
    std::vector<Signal> next(signal_.size());
    for_all([&](int x, int y) { next[index(x, y)] = made(x, y); });
    signal_ = std::move(next);
}

void DenoiseFilter::limit_outliers() {
    replace([&](int x, int y) { return within_limits(x, y); });
}

void DenoiseFilter::estimate_variance(bool one_sample, bool of_several) {
    replace([&](int x, int y) {
        Signal s = signal(x, y);
        const double pictures = of_several ? -s.variance : 1;
        const bool known = of_several ? s.variance >= 0 : !one_sample;
        s.variance = 0;
        if (features(x, y).filtered)
            s.variance = known        ? variance_of_samples(x, y)
                         : of_several ? variance_of_neighbours(x, y, first_) / pictures
                                      : variance_of_neighbours(x, y, signal_);
        return s;
    });
}

void DenoiseFilter::iterate(int step) {
    replace([&](int x, int y) { return filtered(x, y, step); });
}

void DenoiseFilter::apply(std::span<glm::dvec4> sums) const {
    for (size_t i = 0; i < sums.size(); i++) {
        if (!features_[i].filtered) continue;
        const glm::dvec3 change = (signal_[i].light - first_[i].light) * glm::dvec3(guides_[i].albedo);
        sums[i] = glm::dvec4(glm::max(glm::dvec3(sums[i]) + change, glm::dvec3(0)), sums[i].w);
    }
}

double DenoiseFilter::depth(int x, int y) const {
    if (!inside(x, y)) return 0;
    const DenoiseGuide& guide = guides_[index(x, y)];
    return guide.surfaces > 0 ? double(guide.depth) / guide.surfaces : 0;
}

/// Of both sides the flatter slope: the other may be beyond an edge.
double DenoiseFilter::slope(int x, int y, int dx, int dy) const {
    const double here = depth(x, y), before = depth(x - dx, y - dy), after = depth(x + dx, y + dy);
    if (!(before > 0)) return after > 0 ? after - here : 0;
    if (!(after > 0)) return here - before;
    return std::abs(after - here) < std::abs(here - before) ? after - here : here - before;
}

void DenoiseFilter::prepare(int x, int y) {
    const DenoiseGuide& guide = guides_[index(x, y)];
    const glm::dvec3 albedo(guide.albedo), normal(guide.normal);
    const double n = guide.surfaces;
    if (n == 0 || !(guide.depth > 0) || glm::dot(normal, normal) == 0 || !(luminance(albedo) > 0)) return;
    Features& f = features_[index(x, y)];
    f.filtered = true;
    f.normal = glm::normalize(normal);
    f.depth = depth(x, y);
    f.slope = {slope(x, y, 1, 0), slope(x, y, 0, 1)};
    f.gloss = guide.gloss / n;
    f.albedo = luminance(albedo) / n;
    Signal& s = signal_[index(x, y)];
    for (int i = 0; i < 3; i++) s.light[i] = albedo[i] > 0 ? guide.light[i] / albedo[i] : 0;
    s.variance = n < 2 ? -1 : guide.deviations / (n * (n - 1));
}

/// The weight of a tap by its guides, in [0, 1]; 0: it is none.
double DenoiseFilter::likeness(const Features& pixel, int x, int y, int dx, int dy) const {
    if (!inside(x + dx, y + dy)) return 0;
    const Features& tap = features(x + dx, y + dy);
    if (!tap.filtered) return 0;
    const double rise = pixel.slope.x * dx + pixel.slope.y * dy;
    const double tolerance = DENOISE_SLOPE_TOLERANCE * std::abs(rise) + DENOISE_DEPTH_TOLERANCE * pixel.depth;
    return std::exp(-DENOISE_NORMAL_FALL * (1 - glm::dot(pixel.normal, tap.normal)) -
                    std::abs(tap.depth - pixel.depth - rise) / tolerance -
                    DENOISE_GLOSS_FALL * std::abs(tap.gloss - pixel.gloss) -
                    DENOISE_ALBEDO_FALL * std::abs(tap.albedo - pixel.albedo));
}

DenoiseFilter::Signal DenoiseFilter::within_limits(int x, int y) const {
    Signal s = signal(x, y);
    const double lit = luminance(s.light);
    if (!features(x, y).filtered || lit <= 0) return s;
    std::vector<double> others;
    for_alike(x, y, DENOISE_OUTLIER_REACH, [&](double weight, int i, int j) {
        if ((i != x || j != y) && weight >= DENOISE_SAME) others.push_back(luminance(signal(i, j).light));
    });
    if (others.size() < DENOISE_OUTLIER_WITNESSES) return s;
    double mean = 0, squares = 0;
    for (const double other : others) mean += other / double(others.size());
    for (const double other : others) squares += (other - mean) * (other - mean) / double(others.size());
    if (s.variance >= 0 && std::sqrt(s.variance) < DENOISE_OUTLIER_SHARE * (lit - mean)) return s;
    const double limit = DENOISE_OUTLIER_MEANS * mean + DENOISE_OUTLIER_DEVIATIONS * std::sqrt(squares);
    if (lit <= limit) return s;
    const double left = (mean + DENOISE_OUTLIER_LEFT * std::sqrt(squares)) / lit;
    s.light *= left;
    if (s.variance > 0) s.variance *= left * left;
    return s;
}

double DenoiseFilter::variance_of_samples(int x, int y) const {
    double weights = 0, sum = 0;
    for_alike(x, y, DENOISE_VARIANCE_REACH, [&](double weight, int i, int j) {
        if (signal(i, j).variance < 0) return;
        weights += weight;
        sum += weight * signal(i, j).variance;
    });
    return weights > 0 ? sum / weights : 0;
}

/// By the differences of neighbours, which have twice the variance.
double DenoiseFilter::variance_of_neighbours(int x, int y, const std::vector<Signal>& light) const {
    constexpr int reach = DENOISE_VARIANCE_REACH;
    const Features& pixel = features(x, y);
    double weights = 0, sum = 0;
    const auto pair = [&](int dx, int dy, int ex, int ey) {
        const double weight = likeness(pixel, x, y, dx, dy) * likeness(pixel, x, y, ex, ey);
        if (weight == 0) return;
        const double difference =
            luminance(light[index(x + dx, y + dy)].light) - luminance(light[index(x + ex, y + ey)].light);
        weights += weight;
        sum += weight * difference * difference;
    };
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            if (dx < reach) pair(dx, dy, dx + 1, dy);
            if (dy < reach) pair(dx, dy, dx, dy + 1);
        }
    return weights > 0 ? sum / weights / 2 : 0;
}

double DenoiseFilter::smooth_variance(int x, int y) const {
    double weights = 0, sum = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            if (!inside(x + dx, y + dy) || !features(x + dx, y + dy).filtered) continue;
            const double weight = double((2 - std::abs(dx)) * (2 - std::abs(dy)));
            weights += weight;
            sum += weight * signal(x + dx, y + dy).variance;
        }
    return sum / weights;
}

DenoiseFilter::Signal DenoiseFilter::filtered(int x, int y, int step) const {
    const Signal s = signal(x, y);
    const Features& pixel = features(x, y);
    if (!pixel.filtered) return s;
    const double variance = smooth_variance(x, y);
    if (variance <= 0) return s;
    constexpr double spline[] = {6, 4, 1};
    const double tolerance = DENOISE_DEVIATIONS * std::sqrt(variance);
    double weights = 0, spread = 0;
    glm::dvec3 change(0);
    for (int j = -DENOISE_TAPS; j <= DENOISE_TAPS; j++)
        for (int i = -DENOISE_TAPS; i <= DENOISE_TAPS; i++) {
            const double like = i == 0 && j == 0 ? 1 : likeness(pixel, x, y, i * step, j * step);
            if (like == 0) continue;
            const Signal& other = signal(x + i * step, y + j * step);
            const double distance = std::abs(luminance(other.light) - luminance(s.light));
            const double weight = spline[std::abs(i)] * spline[std::abs(j)] * like * std::exp(-distance / tolerance);
            weights += weight;
            change += weight * (other.light - s.light);
            spread += weight * weight * other.variance;
        }
    return {s.light + change / weights, spread / (weights * weights)};
}

void denoise(uint32_t width, uint32_t height, bool one_sample, std::span<const DenoiseGuide> guides,
             std::span<glm::dvec4> sums) {
    DenoiseFilter filter(width, height, guides);
    filter.limit_outliers();
    filter.estimate_variance(one_sample, false);
    for (int i = 0; i < DENOISE_ITERATIONS; i++) filter.iterate(1 << i);
    filter.apply(sums);
}

void denoise(uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides, int64_t number,
             const PastPictures& past, std::span<glm::dvec4> sums) {
    DenoiseFilter filter(width, height, guides);
    filter.take(past.mean(filter, number));
    filter.limit_outliers();
    filter.estimate_variance(false, true);
    for (int i = 0; i < DENOISE_ITERATIONS; i++) filter.iterate(1 << i);
    filter.apply(sums);
}

}  // namespace peelray
