#include "reference/sample_sums.h"

#include <algorithm>

#include "base/parallel.h"
#include "reference/denoiser.h"
#include "scene/encoding.h"
#include "scene/passes.h"

namespace peelray {

SampleSums::SampleSums(const PictureSettings& settings, bool has_unlit, PastPictures* past)
    : settings_(settings), sums_(size_t(settings.width) * settings.height, glm::dvec4(0)), past_(past) {
    if (has_unlit) unlit_.assign(sums_.size(), glm::dvec3(0));
    if (settings.moments) moments_.resize(sums_.size());
    if (is_denoised(settings)) guides_.resize(sums_.size());
    if (is_temporal(settings)) motions_.resize(sums_.size(), {glm::vec2(0), 0, DENOISE_NO_OBJECT});
}

void SampleSums::add(size_t pixel, uint32_t index, const glm::dvec4& covered, const glm::dvec3& unlit) {
    const glm::dvec3 radiance(covered);
    // One bad number must not poison a pixel.
    bool usable = true;
    for (int i = 0; i < 3; i++) usable &= radiance[i] >= 0 && radiance[i] < 1e30;
    const double largest = std::max({radiance.x, radiance.y, radiance.z});
    const double kept = settings_.clamp && largest > *settings_.clamp ? *settings_.clamp / largest : 1;
    const glm::dvec3 added = usable ? radiance * kept : glm::dvec3(0);
    sums_[pixel] += glm::dvec4(added, covered.w);
    if (usable && !unlit_.empty()) unlit_[pixel] += unlit * kept;
    if (moments_.empty()) return;
    Moments& moments = moments_[pixel];
    const double luminance = glm::dot(added, glm::dvec3(LUMINANCE_RED, LUMINANCE_GREEN, LUMINANCE_BLUE));
    const double before = luminance - moments.mean;
    moments.mean += before / (index + 1);
    moments.deviations += before * (luminance - moments.mean);
}

void SampleSums::add_guide(size_t pixel, uint32_t index, DenoiseGuide guide, const DenoiseMotion& motion) {
    if (index == 0 && !motions_.empty()) motions_[pixel] = motion;
    if (guides_.empty() || guide.surfaces == 0) return;
    const float largest = std::max({guide.light.x, guide.light.y, guide.light.z});
    if (settings_.clamp && largest > *settings_.clamp) {
        guide.light *= *settings_.clamp / largest;
        guide.mean *= *settings_.clamp / largest;
    }
    DenoiseGuide& sums = guides_[pixel];
    sums.light += guide.light;
    sums.albedo += guide.albedo;
    sums.normal += guide.normal;
    sums.depth += guide.depth;
    sums.gloss += guide.gloss;
    sums.surfaces += 1;
    const float before = guide.mean - sums.mean;
    sums.mean += before / sums.surfaces;
    sums.deviations += before * (guide.mean - sums.mean);
}

void SampleSums::denoise_pixels(uint32_t samples, std::vector<glm::dvec4>& pixels) const {
    if (motions_.empty()) return denoise(settings_.width, settings_.height, samples == 1, guides_, pixels);
    PastPictures none;
    PastPictures& past = past_ ? *past_ : none;
    past.keep(settings_.number, settings_.width, settings_.height, guides_, motions_);
    denoise(settings_.width, settings_.height, guides_, settings_.number, past, pixels);
}

void SampleSums::store(Picture& picture, uint32_t samples, bool finished) const {
    picture.width = settings_.width;
    picture.height = settings_.height;
    picture.transparent = settings_.backdrop.is_transparent();
    picture.radiance.resize(sums_.size());
    picture.encoded.resize(sums_.size());
    std::vector<glm::dvec4> pixels = sums_;
    if (finished && !guides_.empty()) denoise_pixels(samples, pixels);
    constexpr size_t kGrain = 1024;  // encoding a pixel takes some 100 ns
    parallel_for(pixels.size(), kGrain, [&](size_t i) {
        const glm::dvec4 mean = pixels[i] / double(samples);
        const glm::dvec3 unlit = (unlit_.empty() ? glm::dvec3(0) : unlit_[i]) / double(samples);
        picture.radiance[i] = glm::vec4(mean);
        picture.encoded[i] =
            settings_.backdrop.is_transparent()
                ? encode_straight(glm::dvec3(mean) - unlit, mean.w, settings_.exposure, settings_.tonemap, unlit)
                : encode(glm::dvec3(mean) - unlit, settings_.exposure, settings_.tonemap, unlit);
    });
    if (moments_.empty()) return;
    picture.aovs.variance.clear();
    for (const Moments& moments : moments_)
        picture.aovs.variance.push_back(variance_of_mean(moments.deviations, samples));
    picture.aovs.sample_count.assign(moments_.size(), float(samples));
}

float SampleSums::noise(uint32_t samples) const {
    std::vector<PixelMoments> pixels;
    for (size_t i = 0; i < moments_.size(); i++)
        if (sums_[i].w > 0)
            pixels.push_back({float(moments_[i].mean), variance_of_mean(moments_[i].deviations, samples)});
    return noise_of(pixels);
}

}  // namespace peelray
