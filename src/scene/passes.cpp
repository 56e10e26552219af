#include "scene/passes.h"

#include <algorithm>
#include <cmath>

#include "settings/limits.h"

namespace peelray {
namespace {

constexpr double kPassSeconds = 0.25;

/// Where noise is looked at: at powers of two and halfway to the next, the numbers of samples that are spread best.
/// Each is at most a half more than the one before.
uint32_t next_look(uint32_t done) {
    uint32_t power = kLeastSamplesForNoise;
    while (2 * power <= done) power *= 2;
    return done < power ? power : done < power + power / 2 ? power + power / 2 : 2 * power;
}

bool is_look(uint32_t samples) {
    return samples >= kLeastSamplesForNoise && next_look(samples - 1) == samples;
}

}  // namespace

Passes::Passes(const PictureSettings& settings, const PictureWatch& watch)
    : settings_(settings),
      watch_(watch),
      several_(settings.time_limit || settings.noise_target || watch.stop || watch.pass_ended) {
    check_limits(kTimeLimits, setting::time_limit, settings.time_limit);
    check_limits(kNoiseLimits, setting::noise_target, settings.noise_target);
    check_limits(kClampLimits, setting::clamp, settings.clamp);
}

uint32_t Passes::next() {
    if (ended_) return 0;
    running_ = settings_.spp - made_.count;
    pass_start_ = Clock::now();
    if (made_.count == 0) start_ = pass_start_;
    if (!several_) return running_;
    if (made_.count == 0) return running_ = 1;
    double time = kPassSeconds;
    if (settings_.time_limit) time = std::min(time, *settings_.time_limit - seconds());
    const double fitting = std::floor(time * made_.count / std::max(busy_, 1e-9));
    if (fitting < running_) running_ = uint32_t(std::max(fitting, 1.0));
    if (settings_.noise_target) running_ = std::min(running_, next_look(made_.count) - made_.count);
    return running_;
}

void Passes::finish(const std::function<float()>& noise, const std::function<Picture()>& look) {
    busy_ += std::chrono::duration<double>(Clock::now() - pass_start_).count();
    made_.count += running_;
    running_ = 0;
    const bool looks = settings_.noise_target && is_look(made_.count);
    if (looks) made_.noise = noise();
    ended_ = ends();
    if (!ended_ && watch_.pass_ended) watch_.pass_ended(look);
    // What is known of the whole picture.
    if (ended_ && !looks && settings_.moments && made_.count > 1) made_.noise = noise();
}

bool Passes::ends() {
    const bool stop = watch_.stop && watch_.stop();  // in any case, for who watches counts on it
    if (made_.count == settings_.spp) return true;
    if (settings_.noise_target && is_look(made_.count) && *made_.noise <= *settings_.noise_target)
        made_.end = PictureEnd::noise_target;
    else if (stop)
        made_.end = PictureEnd::interrupt;
    else if (settings_.time_limit && seconds() >= *settings_.time_limit)
        made_.end = PictureEnd::time_limit;
    return made_.end != PictureEnd::samples;
}

double Passes::share(double of_pass) const {
    const double samples = (made_.count + of_pass * running_) / settings_.spp;
    return settings_.time_limit && end_of_pass() > 0
               ? std::min(1.0, std::max(samples, seconds() / *settings_.time_limit))
               : samples;
}

float noise_of(std::span<const PixelMoments> pixels) {
    double sum = 0;
    for (const PixelMoments& pixel : pixels) sum += pixel.mean;
    if (!(sum > 0)) return 0;
    const double floor = 0.01 * sum / double(pixels.size());
    std::vector<float> errors;
    errors.reserve(pixels.size());
    for (const PixelMoments& pixel : pixels)
        errors.push_back(float(std::sqrt(double(pixel.variance)) / (pixel.mean + floor)));
    const auto at = errors.begin() + ptrdiff_t(0.95 * double(errors.size() - 1));
    std::nth_element(errors.begin(), at, errors.end());
    return *at;
}

}  // namespace peelray
