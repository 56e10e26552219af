// When a picture ends, and why.
#include "scene/passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "base/error.h"

namespace peelray {
namespace {

float no_noise() {
    ADD_FAILURE() << "nobody asked for noise";
    return 0;
}
Picture no_look() {
    ADD_FAILURE() << "nobody looks";
    return {};
}

/// How many samples there are after each pass.
std::vector<uint32_t> passes_of(Passes& passes, const std::function<float()>& noise = no_noise) {
    std::vector<uint32_t> ends;
    while (passes.next() > 0) {
        const uint32_t end = passes.end_of_pass();
        passes.finish(noise, no_look);
        EXPECT_EQ(passes.done(), end);
        ends.push_back(end);
    }
    EXPECT_EQ(passes.next(), 0u) << "and stays so";
    return ends;
}

PictureSettings samples(uint32_t spp) {
    PictureSettings settings;
    settings.spp = spp;
    return settings;
}

TEST(PassesTest, ThereIsOneWhereNobodyLooks) {
    const PictureSettings settings = samples(1000);
    const PictureWatch watch([](double) {});
    Passes passes(settings, watch);
    EXPECT_FALSE(passes.are_several());
    EXPECT_EQ(passes_of(passes), std::vector<uint32_t>{1000});
    EXPECT_EQ(passes.made().count, 1000u);
    EXPECT_EQ(passes.made().end, PictureEnd::samples);
    EXPECT_FALSE(passes.made().noise);
}

TEST(PassesTest, TheFirstIsOfOneSample) {
    const PictureSettings settings = samples(1000);
    PictureWatch watch;
    uint32_t asked = 0;
    watch.stop = [&] {
        asked++;
        return false;
    };
    Passes passes(settings, watch);
    EXPECT_TRUE(passes.are_several());
    const std::vector<uint32_t> ends = passes_of(passes);
    EXPECT_EQ(ends.front(), 1u);
    EXPECT_EQ(ends.back(), 1000u);
    EXPECT_EQ(asked, ends.size()) << "after the last one, too";
    EXPECT_LT(ends.size(), 10u) << "they take no time, so there are few";
}

TEST(PassesTest, SlowOnesAreOfOneSampleEach) {
    const PictureSettings settings = samples(3);
    PictureWatch watch;
    watch.stop = [] { return false; };
    Passes passes(settings, watch);
    std::vector<uint32_t> ends;
    while (passes.next() > 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(260));
        passes.finish(no_noise, no_look);
        ends.push_back(passes.done());
    }
    EXPECT_EQ(ends, (std::vector<uint32_t>{1, 2, 3}));
}

TEST(PassesTest, WhoWatchesEndsIt) {
    const PictureSettings settings = samples(1000);
    PictureWatch watch;
    watch.stop = [] { return true; };
    Passes passes(settings, watch);
    EXPECT_EQ(passes_of(passes), std::vector<uint32_t>{1});
    EXPECT_EQ(passes.made().end, PictureEnd::interrupt);
}

TEST(PassesTest, NoiseIsLookedAtWhereSamplesAreSpreadBest) {
    PictureSettings settings = samples(200);
    settings.moments = true;
    settings.noise_target = 0.1f;
    const PictureWatch watch;
    Passes passes(settings, watch);
    uint32_t looks = 0;
    const std::vector<uint32_t> ends = passes_of(passes, [&] {
        looks++;
        return 1.f;
    });
    const std::vector<uint32_t> looked_at = {8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 200};
    EXPECT_EQ(looks, looked_at.size());
    EXPECT_EQ(std::vector<uint32_t>(ends.end() - ptrdiff_t(looks), ends.end()), looked_at);
    EXPECT_EQ(passes.made().end, PictureEnd::samples);
    EXPECT_EQ(passes.made().noise, 1.f) << "in the end it is known";
}

TEST(PassesTest, NoiseEndsIt) {
    PictureSettings settings = samples(200);
    settings.moments = true;
    settings.noise_target = 0.25f;
    const PictureWatch watch;
    Passes passes(settings, watch);
    EXPECT_EQ(passes_of(passes, [&] { return 1 / std::sqrt(float(passes.done())); }).back(), 16u);
    EXPECT_EQ(passes.made().end, PictureEnd::noise_target);
    EXPECT_EQ(passes.made().noise, 0.25f);
}

TEST(PassesTest, TimeEndsIt) {
    PictureSettings settings = samples(65536);
    settings.time_limit = 0.5;
    const PictureWatch watch;
    Passes passes(settings, watch);
    uint32_t count = 0;
    while (const uint32_t pass = passes.next()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(pass));
        EXPECT_GT(passes.share(1), count++ > 0 ? 0.001 : 0.0) << "of the time, not of the samples";
        passes.finish(no_noise, no_look);
    }
    EXPECT_EQ(passes.made().end, PictureEnd::time_limit);
    EXPECT_GE(passes.done(), 2u);
    EXPECT_LE(passes.done(), 501u) << "no pass is begun that would not fit, but one sample";
}

TEST(PassesTest, SaysHowMuchIsDone) {
    const PictureSettings settings = samples(4);
    PictureWatch watch;
    watch.stop = [] { return false; };
    Passes passes(settings, watch);
    EXPECT_EQ(passes.next(), 1u);
    EXPECT_EQ(passes.share(0), 0);
    EXPECT_EQ(passes.share(0.5), 0.125);
    passes.finish(no_noise, no_look);
    EXPECT_EQ(passes.next(), 3u);
    EXPECT_EQ(passes.share(0), 0.25);
    EXPECT_EQ(passes.share(1), 1);
}

TEST(PassesTest, ImpossibleLimitsNameTheirOption) {
    const auto line_of = [](const std::function<void(PictureSettings&)>& spoil) -> std::string {
        PictureSettings settings;
        spoil(settings);
        const PictureWatch watch;
        try {
            Passes(settings, watch);
        } catch (const Error& error) {
            return error.line("--");
        }
        return "";
    };
    EXPECT_EQ(line_of([](PictureSettings&) {}), "");
    for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)}) {
        SCOPED_TRACE(bad);
        EXPECT_NE(line_of([&](PictureSettings& s) { s.time_limit = bad; }).find("--time-limit"), std::string::npos);
        EXPECT_NE(line_of([&](PictureSettings& s) { s.noise_target = float(bad); }).find("--noise-target"),
                  std::string::npos);
        EXPECT_NE(line_of([&](PictureSettings& s) { s.clamp = float(bad); }).find("--clamp"), std::string::npos);
    }
}

TEST(NoiseTest, IsThe95thPercentileOfRelativeErrors) {
    // Errors of 0, 1, ..., 100 percent; a hundredth of the mean, 4, is added.
    std::vector<PixelMoments> pixels;
    for (int i = 100; i >= 0; i--) pixels.push_back({4, float(i * i * 16 * 1e-4)});
    EXPECT_NEAR(noise_of(pixels), 0.95 / 1.01, 1e-6);
    pixels[0].variance = 1e12f;
    EXPECT_NEAR(noise_of(pixels), 0.95 / 1.01, 1e-6) << "whatever the worst is";
}

TEST(NoiseTest, DarkPixelsCountByThePicture) {
    const std::vector<PixelMoments> pixels(20, {1e-9f, 1e-6f});
    std::vector<PixelMoments> lit = pixels;
    lit.push_back({1, 1e-6f});
    EXPECT_NEAR(noise_of(lit), 1e-3 / (0.01 / 21), 1e-3);
}

TEST(NoiseTest, OfNothingIsNone) {
    EXPECT_EQ(noise_of({}), 0);
    EXPECT_EQ(noise_of(std::vector<PixelMoments>{{0, 0}, {0, 0}}), 0);
}

}  // namespace
}  // namespace peelray
