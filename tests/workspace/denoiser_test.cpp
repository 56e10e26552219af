// The denoiser's filter, on the GPU and on the CPU: each by what it must do, and both against each other.
#include <cmath>
#include <functional>
#include <numeric>

#include "../gpu/device_fixture.h"
#include "reference/denoiser.h"
#include "render/denoiser.h"

namespace peelray {
namespace {

constexpr float kAlbedo = 0.5f, kDepth = 10;

/// Sums over the samples of a picture and its guides.
struct Canvas {
    uint32_t width, height;
    float samples;
    std::vector<DenoiseGuide> guides;
    std::vector<glm::vec4> picture;

    /// A wall that faces the camera.
    Canvas(uint32_t width, uint32_t height, uint32_t samples = 1)
        : width(width),
          height(height),
          samples(float(samples)),
          guides(size_t(width) * height, DenoiseGuide{{},
                                                      float(samples),
                                                      glm::vec3(kAlbedo * float(samples)),
                                                      kDepth * float(samples),
                                                      {0, 0, float(samples)},
                                                      0,
                                                      0,
                                                      0}),
          picture(guides.size(), glm::vec4(0, 0, 0, float(samples))) {}

    DenoiseGuide& at(uint32_t x, uint32_t y) { return guides[size_t(y) * width + x]; }
    /// Lights a pixel by `light` before its albedo; `deviation`: of the mean of several samples.
    void light(uint32_t x, uint32_t y, const glm::vec3& light, float deviation = 0) {
        DenoiseGuide& guide = at(x, y);
        guide.light = light * guide.albedo;
        guide.mean = glm::dot(light, glm::vec3(0.2126f, 0.7152f, 0.0722f));
        guide.deviations = deviation * deviation * samples * (samples - 1);
        picture[size_t(y) * width + x] = glm::vec4(guide.light, samples);
    }
    void light_all(const std::function<float(uint32_t, uint32_t)>& value, float deviation = 0) {
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) light(x, y, glm::vec3(value(x, y)), deviation);
    }
    /// Of a finished picture the light before the albedo, of some pixels.
    std::vector<double> lights(const std::vector<glm::vec4>& finished,
                               const std::function<bool(uint32_t, uint32_t)>& where) const {
        std::vector<double> values;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                if (const size_t i = size_t(y) * width + x; where(x, y))
                    values.push_back(finished[i].y / guides[i].albedo.y);
        return values;
    }
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}
double variance_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double sum = 0;
    for (const double v : values) sum += (v - mean) * (v - mean);
    return sum / double(values.size());
}
bool everywhere(uint32_t, uint32_t) {
    return true;
}

enum class Where { gpu, cpu };

class DenoiserTest : public DeviceTest, public testing::WithParamInterface<Where> {
  protected:
    std::vector<glm::vec4> on_gpu(const Canvas& canvas) {
        PictureSettings settings;
        settings.width = canvas.width;
        settings.height = canvas.height;
        settings.spp = uint32_t(canvas.samples);
        Denoiser denoiser(device());
        denoiser.prepare(settings);
        const Buffer picture = upload(canvas.picture);
        commands().upload(denoiser.guides(), std::span(canvas.guides));
        denoiser.record_filter(commands(), picture, settings);
        commands().submit();
        return download<glm::vec4>(picture, canvas.picture.size());
    }
    static std::vector<glm::vec4> on_cpu(const Canvas& canvas) {
        std::vector<glm::dvec4> sums(canvas.picture.begin(), canvas.picture.end());
        denoise(canvas.width, canvas.height, canvas.samples == 1, canvas.guides, sums);
        return {sums.begin(), sums.end()};
    }
    std::vector<glm::vec4> denoised(const Canvas& canvas) {
        return GetParam() == Where::gpu ? on_gpu(canvas) : on_cpu(canvas);
    }
    /// The same on every machine, of mean 0 and variance 1.
    double noise() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return (double(state_ >> 33) / 2147483648.0 - 0.5) * std::sqrt(12.0);
    }

  private:
    uint64_t state_ = 1;
};

TEST_P(DenoiserTest, WhatHasNoVarianceStaysBitForBit) {
    Canvas canvas(40, 30, 4);
    for (uint32_t y = 0; y < 30; y++)
        for (uint32_t x = 0; x < 40; x++) {
            canvas.at(x, y).albedo = glm::vec3(4 * (0.1f + 0.8f * float((x * 7 + y * 3) % 11) / 11));
            canvas.light(x, y, glm::vec3(x < 20 ? 1.3f : 0.2f) + 0.01f * float(y));
        }
    EXPECT_EQ(denoised(canvas), canvas.picture);
}

/// An edge of the light of one sample: the neighbours' differences are there only, and tell little of noise.
TEST_P(DenoiserTest, OneSampleOfSmoothLightOnATextureStays) {
    Canvas canvas(40, 30);
    for (uint32_t y = 0; y < 30; y++)
        for (uint32_t x = 0; x < 40; x++) {
            canvas.at(x, y).albedo = glm::vec3(x / 3 % 2 == 0 ? 0.2f : 0.4f);
            canvas.light(x, y, glm::vec3(0.7f));
        }
    const auto finished = denoised(canvas);
    for (size_t i = 0; i < finished.size(); i++) ASSERT_NEAR(finished[i].x, canvas.picture[i].x, 1e-6);
}

TEST_P(DenoiserTest, NoiseFallsAndTheMeanStays) {
    for (const uint32_t samples : {1u, 8u}) {
        SCOPED_TRACE(samples);
        Canvas canvas(96, 96, samples);
        canvas.light_all([&](uint32_t, uint32_t) { return float(2 + 0.4 * noise()); }, 0.4f);
        const auto inner = [](uint32_t x, uint32_t y) { return x >= 16 && x < 80 && y >= 16 && y < 80; };
        const auto before = canvas.lights(canvas.picture, inner), after = canvas.lights(denoised(canvas), inner);
        EXPECT_NEAR(variance_of(before), 0.16, 0.01);
        // Without edges to avoid the five kernels make one of some 1/1500; the range kernel keeps a part.
        EXPECT_LT(variance_of(after), variance_of(before) / 200);
        EXPECT_NEAR(mean_of(after), mean_of(before), 0.01);
    }
}

TEST_P(DenoiserTest, EdgesOfEachGuideStaySharp) {
    const std::vector<std::pair<const char*, std::function<void(DenoiseGuide&)>>> others = {
        {"normal",
         [](DenoiseGuide& g) {
             g.normal = {g.normal.z, 0, 0};
         }},
        {"depth", [](DenoiseGuide& g) { g.depth *= 1.2f; }},
        {"gloss", [](DenoiseGuide& g) { g.gloss = g.surfaces; }}};
    for (const auto& [name, change] : others) {
        SCOPED_TRACE(name);
        Canvas canvas(48, 48, 4);
        for (uint32_t y = 0; y < 48; y++)
            for (uint32_t x = 24; x < 48; x++) change(canvas.at(x, y));
        canvas.light_all([&](uint32_t x, uint32_t) { return float((x < 24 ? 1 : 2) + 0.8 * noise()); }, 0.8f);
        const auto finished = denoised(canvas);
        EXPECT_NEAR(mean_of(canvas.lights(finished, [](uint32_t x, uint32_t) { return x == 23; })), 1, 0.12);
        EXPECT_NEAR(mean_of(canvas.lights(finished, [](uint32_t x, uint32_t) { return x == 24; })), 2, 0.12);
    }
}

/// What the light is multiplied by is not blurred.
TEST_P(DenoiserTest, TexturesStaySharp) {
    Canvas canvas(48, 48, 4);
    for (uint32_t y = 0; y < 48; y++)
        for (uint32_t x = 0; x < 48; x++) canvas.at(x, y).albedo = glm::vec3((x + y) % 2 == 0 ? 0.4f : 3.6f);
    canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.3 * noise()); }, 0.3f);
    const auto finished = denoised(canvas);
    for (const double light : canvas.lights(finished, everywhere)) ASSERT_NEAR(light, 1, 0.15);
    EXPECT_LT(variance_of(canvas.lights(finished, everywhere)), 0.09 / 100);
}

/// Light that is not drawn at random is no part of what is filtered.
TEST_P(DenoiserTest, WhatIsNotRandomStays) {
    Canvas canvas(32, 32, 4);
    canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.3 * noise()); }, 0.3f);
    const auto plain = denoised(canvas);
    for (size_t i = 0; i < canvas.picture.size(); i++) canvas.picture[i] += glm::vec4(glm::vec3(i % 3 == 0 ? 8 : 0), 0);
    const auto with = denoised(canvas);
    for (size_t i = 0; i < with.size(); i++) ASSERT_NEAR(with[i].x, plain[i].x + (i % 3 == 0 ? 8 : 0), 1e-5);
}

TEST_P(DenoiserTest, AnOutlierIsNotSpread) {
    Canvas canvas(48, 48);
    canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.1 * noise()); });
    canvas.light(20, 20, glm::vec3(1000));
    const auto finished = canvas.lights(denoised(canvas), everywhere);
    for (const double light : finished) ASSERT_NEAR(light, 1, 0.3);
    EXPECT_NEAR(mean_of(finished), 1, 0.02);
}

TEST_P(DenoiserTest, ABrightPointThatAllSamplesSeeStays) {
    Canvas canvas(48, 48, 8);
    canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.1 * noise()); }, 0.1f);
    canvas.light(20, 20, glm::vec3(30), 0.1f);
    EXPECT_NEAR(canvas.lights(denoised(canvas), [](uint32_t x, uint32_t y) { return x == 20 && y == 20; })[0], 30, 0.1);
}

TEST_P(DenoiserTest, NothingComesFromWhereNothingIs) {
    Canvas canvas(32, 32, 4);
    canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.3 * noise()); }, 0.3f);
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 16; x++) {
            canvas.at(x, y) = {};
            canvas.picture[y * 32 + x] = glm::vec4(50, 40, 30, 0);
        }
    const auto finished = denoised(canvas);
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++) {
            if (x < 16) {
                ASSERT_EQ(finished[y * 32 + x], canvas.picture[y * 32 + x]);
            } else {
                ASSERT_LT(finished[y * 32 + x].x, 4.0f);
                ASSERT_EQ(finished[y * 32 + x].w, 4.0f) << "coverage";
            }
        }
}

TEST_P(DenoiserTest, PicturesSmallerThanTheFilter) {
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(3, 2), glm::uvec2(1, 40), glm::uvec2(70, 1)})
        for (const uint32_t samples : {1u, 4u}) {
            Canvas canvas(size.x, size.y, samples);
            canvas.light_all([&](uint32_t, uint32_t) { return float(1 + 0.3 * noise()); }, 0.3f);
            for (const double light : canvas.lights(denoised(canvas), everywhere)) ASSERT_NEAR(light, 1, 0.55);
        }
}

INSTANTIATE_TEST_SUITE_P(, DenoiserTest, testing::Values(Where::gpu, Where::cpu),
                         [](const auto& info) { return info.param == Where::gpu ? "Gpu" : "Cpu"; });

/// What both are to agree about.
class DenoisersTest : public DenoiserTest {
  protected:
    Canvas busy(uint32_t samples) {
        Canvas canvas(61, 47, samples);
        const float n = float(samples);
        for (uint32_t y = 0; y < 47; y++)
            for (uint32_t x = 0; x < 61; x++) {
                DenoiseGuide& guide = canvas.at(x, y);
                const double turn = 0.02 * x + (y > 25 ? 0.7 : 0);
                guide.normal = n * glm::vec3(std::sin(turn), 0, std::cos(turn));
                guide.depth = n * float(8 + 0.03 * x + 0.01 * y + (x > 40 ? 2 : 0));
                guide.albedo = n * glm::vec3(0.1f + 0.02f * float((x * 5 + y) % 31), 0.5f, 0.3f);
                guide.gloss = n * (y > 35 ? 0.6f : 0.05f);
                const double bright = (x + y) % 57 == 0 ? 60 : 1;
                canvas.light(x, y, glm::vec3(glm::dvec3(1 + 0.5 * noise(), 1 + 0.5 * noise(), 0.4) * bright), 0.5f);
                if ((x * x + y) % 23 == 0) guide = {};
            }
        return canvas;
    }
};

TEST_F(DenoisersTest, BothDoTheSame) {
    for (const uint32_t samples : {1u, 6u}) {
        SCOPED_TRACE(samples);
        const Canvas canvas = busy(samples);
        const auto gpu = on_gpu(canvas), cpu = on_cpu(canvas);
        ASSERT_NE(cpu, canvas.picture);
        for (size_t i = 0; i < gpu.size(); i++)
            for (int k = 0; k < 4; k++)
                ASSERT_NEAR(gpu[i][k], cpu[i][k], 2e-3 * (float(samples) + std::abs(cpu[i][k]))) << i << ' ' << k;
    }
}

TEST_F(DenoisersTest, TheSameAgainIsTheSame) {
    const Canvas canvas = busy(1);
    EXPECT_EQ(on_gpu(canvas), on_gpu(canvas));
    EXPECT_EQ(on_cpu(canvas), on_cpu(canvas));
}

}  // namespace
}  // namespace peelray
