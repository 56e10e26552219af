// What the denoiser makes of the pictures of the moments before, on the GPU and on the CPU: each by what it must do,
// and both against each other.
#include <cmath>
#include <functional>
#include <numeric>

#include "../gpu/device_fixture.h"
#include "reference/past_pictures.h"
#include "render/denoiser.h"

namespace peelray {
namespace {

constexpr float kWallDepth = 10;
constexpr int64_t kPictures = DENOISE_WARM_UP + 1;

/// Pictures in a row: their guides, and where their surfaces were before.
struct Film {
    uint32_t width, height;
    float samples;
    std::vector<std::vector<DenoiseGuide>> guides;
    std::vector<std::vector<DenoiseMotion>> motions;

    /// A wall that faces the camera and stands still.
    Film(uint32_t width, uint32_t height, uint32_t samples = 1)
        : width(width), height(height), samples(float(samples)) {
        const float n = float(samples);
        const DenoiseGuide wall{glm::vec3(n), n, glm::vec3(n), kWallDepth * n, {0, 0, n}, 0, 1, 0};
        guides.assign(kPictures, std::vector<DenoiseGuide>(size_t(width) * height, wall));
        motions.assign(kPictures, std::vector<DenoiseMotion>(size_t(width) * height, {glm::vec2(0), kWallDepth, 7}));
    }
    size_t index(uint32_t x, uint32_t y) const { return size_t(y) * width + x; }
    /// body(picture, x, y, guide, motion) for all pixels.
    template <typename Body>
    void for_all(Body body) {
        for (size_t k = 0; k < guides.size(); k++)
            for (uint32_t y = 0; y < height; y++)
                for (uint32_t x = 0; x < width; x++)
                    body(int64_t(k), x, y, guides[k][index(x, y)], motions[k][index(x, y)]);
    }
    /// `deviation`: of the samples' mean.
    void light(DenoiseGuide& guide, const glm::vec3& light, float deviation = 0) const {
        guide.light = light * guide.albedo;
        guide.mean = glm::dot(light, glm::vec3(0.2126f, 0.7152f, 0.0722f));
        guide.deviations = deviation * deviation * samples * (samples - 1);
    }
};

/// Light and variance of each pixel.
using Means = std::vector<glm::vec4>;

enum class Side { gpu, cpu };

class PastTest : public DeviceTest, public testing::WithParamInterface<Side> {
  protected:
    /// The mean of the film's last picture, which has the number `last`, with those before it.
    Means on_gpu(const Film& film, int64_t last) {
        PictureSettings settings;
        settings.width = film.width;
        settings.height = film.height;
        settings.spp = uint32_t(film.samples);
        PastFrames past(device());
        past.prepare(settings);
        const uint64_t pixels = film.guides[0].size();
        const Buffer features(device(), "features", pixels * sizeof(glm::uvec4)),
            signal(device(), "signal", pixels * sizeof(glm::vec4)), mean(device(), "mean", pixels * sizeof(glm::vec4));
        for (int64_t k = 0; k < kPictures; k++) {
            settings.number = last + 1 - kPictures + k;
            const Buffer guides = upload(film.guides[size_t(k)]);
            commands().upload(past.motions(), std::span(film.motions[size_t(k)]));
            commands().run(device().pass("denoise_prepare"),
                           {{"denoise_guides", guides}, {"features", features}, {"signal", signal}},
                           DenoiseParams{film.width, film.height, 1}, groups_for(pixels, 64));
            past.record_memory(commands(), settings, features, signal);
            commands().submit();
        }
        past.record_mean(commands(), settings, features, signal, mean);
        commands().submit();
        return download<glm::vec4>(mean, pixels);
    }
    static Means on_cpu(const Film& film, int64_t last) {
        PastPictures past;
        for (int64_t k = 0; k < kPictures; k++)
            past.keep(last + 1 - kPictures + k, film.width, film.height, film.guides[size_t(k)],
                      film.motions[size_t(k)]);
        Means means;
        for (const auto& s : past.mean(DenoiseFilter(film.width, film.height, film.guides.back()), last))
            means.emplace_back(s.light, s.variance);
        return means;
    }
    Means mean(const Film& film, int64_t last = 3) {
        return GetParam() == Side::gpu ? on_gpu(film, last) : on_cpu(film, last);
    }
    /// The same on every machine, of mean 0 and variance 1.
    float noise() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return float((double(state_ >> 33) / 2147483648.0 - 0.5) * std::sqrt(12.0));
    }

  private:
    uint64_t state_ = 1;
};

/// Of what holds for the pixels that `where` chooses.
double mean_over(const Film& film, const Means& means, const std::function<double(const glm::vec4&)>& value,
                 const std::function<bool(uint32_t, uint32_t)>& where) {
    double sum = 0, count = 0;
    for (uint32_t y = 0; y < film.height; y++)
        for (uint32_t x = 0; x < film.width; x++)
            if (where(x, y)) sum += value(means[film.index(x, y)]), count++;
    return sum / count;
}
bool anywhere(uint32_t, uint32_t) {
    return true;
}

TEST_P(PastTest, NoiseOfWhatStandsStillFallsAsTheNumberOfPictures) {
    for (const uint32_t samples : {1u, 8u}) {
        SCOPED_TRACE(samples);
        Film film(64, 64, samples);
        film.for_all([&](int64_t, uint32_t, uint32_t, DenoiseGuide& guide, DenoiseMotion&) {
            film.light(guide, glm::vec3(2 + 0.4f * noise()), 0.4f);
        });
        const Means means = mean(film);
        const auto error = [](const glm::vec4& m) { return (m.y - 2.0) * (m.y - 2.0); };
        EXPECT_NEAR(mean_over(film, means, error, anywhere), 0.16 / kPictures, 0.1 * 0.16 / kPictures);
        // And the variance that goes on to the filter says so.
        const auto variance = [](const glm::vec4& m) { return m.w < 0 ? 0.16 / kPictures : m.w; };
        EXPECT_NEAR(mean_over(film, means, variance, anywhere), 0.16 / kPictures, 0.1 * 0.16 / kPictures);
        // What noise takes for a change of the light is rare.
        const auto unknown = [](const glm::vec4& m) { return m.w < 0 ? 1.0 : 0.0; };
        EXPECT_LT(mean_over(film, means, unknown, anywhere), 0.01);
    }
}

TEST_P(PastTest, WhatIsTheSameStaysBitForBit) {
    Film film(20, 16);
    film.for_all([&](int64_t, uint32_t x, uint32_t y, DenoiseGuide& guide, DenoiseMotion&) {
        guide.albedo = glm::vec3(1);
        film.light(guide, glm::vec3(0.1f * float(x), 0.3f, 1.7f * float(y)));
    });
    const Means means = mean(film);
    for (size_t i = 0; i < means.size(); i++) {
        ASSERT_EQ(glm::vec3(means[i]), film.guides.back()[i].light) << i;
        ASSERT_EQ(means[i].w, 0) << i;
    }
}

/// A pattern on a wall that moves by so much from picture to picture, with noise.
TEST_P(PastTest, WhatMovesIsFollowed) {
    const glm::vec2 step(1.625f, -0.75f);
    const auto pattern = [&](int64_t k, uint32_t x, uint32_t y) {
        const glm::vec2 on_wall = glm::vec2(x, y) - step * float(k);
        return 2 + 0.5f * std::sin(0.35f * on_wall.x) + 0.3f * std::cos(0.4f * on_wall.y);
    };
    Film film(64, 48);
    film.for_all([&](int64_t k, uint32_t x, uint32_t y, DenoiseGuide& guide, DenoiseMotion& motion) {
        film.light(guide, glm::vec3(pattern(k, x, y) + 0.2f * noise()));
        motion.motion = -step;
    });
    const Means means = mean(film);
    const auto inner = [](uint32_t x, uint32_t y) { return x >= 10 && x < 54 && y >= 6 && y < 42; };
    double error = 0, count = 0;
    for (uint32_t y = 0; y < 48; y++)
        for (uint32_t x = 0; x < 64; x++)
            if (inner(x, y)) error += std::pow(means[film.index(x, y)].y - pattern(kPictures - 1, x, y), 2), count++;
    EXPECT_LT(error / count, 0.04 / kPictures);  // pixels in between take more
    // At the edge where it comes in there is no past.
    EXPECT_EQ(means[film.index(0, 20)].w, -1);
}

/// One after the other, each alone, tells what is not the same surface.
TEST_P(PastTest, WhatWasHiddenHasNoPast) {
    struct Case {
        const char* name;
        std::function<void(DenoiseGuide&, DenoiseMotion&)> hide;
    };
    for (const Case& c : std::vector<Case>{{"object", [](auto&, auto&motion) { motion.object = 8; }},
                                           {"depth", [](auto&guide, auto&) { guide.depth *= 0.9f; }},
                                           {"normal",
                                            [](auto&guide, auto&) {
                                                guide.normal = {0.6f, 0, 0.8f};
                                            }},
                                           {"nothing", [](auto&guide, auto&) { guide = {}; }}}) {
        SCOPED_TRACE(c.name);
        Film film(24, 16);
        film.for_all([&](int64_t k, uint32_t x, uint32_t, DenoiseGuide& guide, DenoiseMotion& motion) {
            film.light(guide, glm::vec3(1 + 0.1f * noise()));
            const bool hidden = x < 12 && k < kPictures - 2;  // seen in the last two pictures
            if (!hidden) return;
            film.light(guide, glm::vec3(50));
            c.hide(guide, motion);
        });
        const Means means = mean(film);
        const auto left = [](uint32_t x, uint32_t) { return x < 12; };
        const auto right = [](uint32_t x, uint32_t) { return x >= 16; };  // around it nothing changes
        for (uint32_t y = 0; y < 16; y++)
            for (uint32_t x = 0; x < 12; x++) {
                const float now = film.guides[kPictures - 1][film.index(x, y)].light.y,
                            then = film.guides[kPictures - 2][film.index(x, y)].light.y;
                ASSERT_NEAR(means[film.index(x, y)].y, (now + then) / 2, 0.05) << x << ' ' << y;
            }
        EXPECT_NEAR(mean_over(
                        film, means, [](const glm::vec4& m) { return m.w; }, left),
                    -2, 0.1);
        EXPECT_GT(mean_over(
                      film, means, [](const glm::vec4& m) { return m.w; }, right),
                  0);
    }
}

TEST_P(PastTest, WhatHasNoMotionHasNoPast) {
    Film film(16, 16);
    film.for_all([&](int64_t k, uint32_t, uint32_t, DenoiseGuide& guide, DenoiseMotion& motion) {
        film.light(guide, glm::vec3(float(k + 1)));
        if (k == kPictures - 1) motion.object = DENOISE_NO_OBJECT;
    });
    for (const glm::vec4& m : mean(film)) ASSERT_EQ(m, glm::vec4(glm::vec3(float(kPictures)), -1));
}

TEST_P(PastTest, WhereTheLightChangesThePastIsDropped) {
    Film film(48, 32);
    film.for_all([&](int64_t k, uint32_t x, uint32_t, DenoiseGuide& guide, DenoiseMotion&) {
        film.light(guide, glm::vec3((x < 24 || k < kPictures - 1 ? 1.0f : 0.4f) + 0.1f * noise()));
    });
    const Means means = mean(film);
    const auto light = [](const glm::vec4& m) { return m.y; };
    EXPECT_NEAR(mean_over(film, means, light, [](uint32_t x, uint32_t) { return x >= 28; }), 0.4, 0.02);
    EXPECT_NEAR(mean_over(film, means, light, [](uint32_t x, uint32_t) { return x < 20; }), 1, 0.02);
    const auto error = [](const glm::vec4& m) { return (m.y - 1.0) * (m.y - 1.0); };
    EXPECT_LT(mean_over(film, means, error, [](uint32_t x, uint32_t) { return x < 20; }), 1.5 * 0.01 / kPictures);
}

/// Numbers before the animation's beginning are negative.
TEST_P(PastTest, NumbersShapeNothing) {
    Film film(20, 16);
    film.for_all([&](int64_t, uint32_t, uint32_t, DenoiseGuide& guide, DenoiseMotion&) {
        film.light(guide, glm::vec3(1 + 0.3f * noise()));
    });
    const Means means = mean(film, 0);
    for (const int64_t last : {-9, 5, 1'000'000'007}) EXPECT_EQ(mean(film, last), means) << last;
}

TEST_P(PastTest, PicturesSmallerThanTheFilter) {
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(3, 2), glm::uvec2(1, 40), glm::uvec2(70, 1)}) {
        Film film(size.x, size.y);
        film.for_all([&](int64_t, uint32_t, uint32_t, DenoiseGuide& guide, DenoiseMotion& motion) {
            film.light(guide, glm::vec3(1 + 0.3f * noise()));
            motion.motion = {0.3f, 1e30f * noise()};
        });
        for (const glm::vec4& m : mean(film)) ASSERT_NEAR(m.y, 1, 0.55);
    }
}

INSTANTIATE_TEST_SUITE_P(, PastTest, testing::Values(Side::gpu, Side::cpu),
                         [](const auto& info) { return info.param == Side::gpu ? "Gpu" : "Cpu"; });

class BothPastsTest : public PastTest {};

TEST_F(BothPastsTest, DoTheSame) {
    for (const uint32_t samples : {1u, 6u}) {
        SCOPED_TRACE(samples);
        Film film(61, 47, samples);
        const float n = float(samples);
        film.for_all([&](int64_t k, uint32_t x, uint32_t y, DenoiseGuide& guide, DenoiseMotion& motion) {
            const float turn = 0.01f * float(x) + (y > 25 ? 1.2f : 0.05f * float(k));
            guide.normal = n * glm::vec3(std::sin(turn), 0, std::cos(turn));
            motion.depth = 8 + 0.03f * float(x) + 0.01f * float(y) + (x > 40 + uint32_t(k) ? 2.0f : 0.0f);
            guide.depth = n * motion.depth;
            guide.albedo = n * glm::vec3(0.1f + 0.02f * float((x * 5 + y) % 31), 0.5f, 0.3f);
            const float bright =
                (x < 20 ? 1 : 1 + 0.2f * float(k)) * ((x + 3 * y + uint32_t(k)) % 57 == 0 ? 60.0f : 1.0f);
            film.light(guide, bright * glm::vec3(1 + 0.5f * noise(), 1 + 0.5f * noise(), 0.4f), 0.5f);
            motion.motion = {0.4f * noise(), 1.3f};
            motion.object = y / 16 + (x + uint32_t(k)) / 30;
            if ((x * x + y) % 23 == 0) guide = {};
        });
        const Means gpu = on_gpu(film, 4), cpu = on_cpu(film, 4);
        size_t different = 0, followed = 0;
        for (size_t i = 0; i < gpu.size(); i++) {
            followed += cpu[i].w != -1;
            bool near = true;
            for (int c = 0; c < 4; c++)
                near &= std::abs(gpu[i][c] - cpu[i][c]) <= 0.03f * (0.05f + std::abs(cpu[i][c]));
            different += !near;
        }
        EXPECT_GT(followed, gpu.size() / 2);
        EXPECT_LT(different, gpu.size() / 50);  // a threshold on whose other side rounding is
    }
}

}  // namespace
}  // namespace peelray
