// The samples of pixels: the variance of their mean, their limit, and pictures that end before all are made.
#include <pictures.h>

namespace peelray {
namespace {

/// Seen from above, two lights side by side: each sample sees one of two luminances, which makes the variance
/// Bernoulli's.
class SamplesTest : public PictureTest {
  protected:
    static constexpr double kSlope = 0.15;  // of the border between them: x of z

    static Stage lights(const glm::vec3& left, const glm::vec3& right) {
        const float x = 2 * kSlope;
        Stage stage;
        stage.add(faces({{{-2, 0, 2}, {x, 0, 2}, {-x, 0, -2}, {-2, 0, -2}}}), emitting(left));
        stage.add(faces({{{x, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-x, 0, -2}}}), emitting(right));
        return stage;
    }
    static double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

    /// How many of a pixel's samples see the left one; none: rounding may decide.
    std::optional<uint32_t> on_the_left(uint32_t x, uint32_t y) const {
        uint32_t count = 0;
        for (uint32_t i = 0; i < settings_.spp; i++) {
            const glm::dvec2 p = glm::dvec2(x, y) + glm::dvec2(sample_position(i));
            const glm::dvec3 seen =
                view_ray(settings_.camera, settings_.width, settings_.height, p.x, p.y).at_plane(1, 0);
            const double side = seen.x - kSlope * seen.z;
            if (std::abs(side) < 1e-4) return {};
            count += side < 0;
        }
        return count;
    }
    /// Compares all pixels with p(1 - p)d²/(n - 1), within a share of the largest, and with the mean.
    Tally compare(const glm::vec3& left, const glm::vec3& right, double tolerance) {
        const RenderResult picture = render(lights(left, right), black, settings_);
        const double n = settings_.spp, d = luminance(left) - luminance(right), largest = d * d / 4 / (n - 1);
        Tally result;
        for (uint32_t y = 0; y < settings_.height; y++)
            for (uint32_t x = 0; x < settings_.width; x++) {
                const std::optional<uint32_t> count = on_the_left(x, y);
                if (!count) continue;
                const double p = *count / n, want = p * (1 - p) * d * d / (n - 1);
                const double got = picture.aovs.variance[y * settings_.width + x];
                mixed_ += p > 0 && p < 1;
                result.add(std::abs(got - want) <= tolerance * largest, [&] {
                    return fmt::format("pixel {},{}: {:.3g} for {} samples of {}, not {:.3g}", x, y, got, *count, n,
                                       want);
                });
            }
        return result;
    }

    RenderSettings settings_ = [] {
        RenderSettings s = settings_for(from_above(2), 24);
        s.spp = 16;
        s.moments = true;
        return s;
    }();
    size_t mixed_ = 0;  ///< pixels that saw both
};

TEST_F(SamplesTest, TheVarianceOfTheMeanIsThatOfTwoColours) {
    for (const uint32_t spp : {2u, 7u, 16u}) {
        SCOPED_TRACE(spp);
        settings_.spp = spp;
        compare({3, 0.5f, 0.25f}, {0.25f, 0.5f, 1}, 1e-5).expect(0, 400);
    }
    EXPECT_GT(mixed_, 40u);
}

/// Of values that are large beside their differences single precision would leave nothing in sums of squares.
TEST_F(SamplesTest, ALargeMeanTakesNothingFromTheVariance) {
    compare(glm::vec3(4000.5f), glm::vec3(4000), 0.01).expect(0, 400);
}

TEST_F(SamplesTest, OfOneSampleNothingIsKnown) {
    settings_.spp = 1;
    const RenderResult picture = render(lights({3, 0, 0}, {0, 1, 0}), black, settings_);
    ASSERT_EQ(picture.aovs.variance.size(), picture.radiance.size());
    for (const float variance : picture.aovs.variance) ASSERT_EQ(variance, 0);
    for (const float count : picture.aovs.sample_count) ASSERT_EQ(count, 1);
}

TEST_F(SamplesTest, NothingIsCountedUnasked) {
    RenderSettings settings = settings_;
    settings.moments = false;
    const Stage stage = lights({3, 0, 0}, {0, 1, 0});
    const RenderResult without = render(stage, black, settings), with = render(stage, black, settings_);
    EXPECT_TRUE(without.aovs.variance.empty());
    EXPECT_TRUE(without.aovs.sample_count.empty());
    for (const float count : with.aovs.sample_count) ASSERT_EQ(count, 16);
    EXPECT_EQ(with.radiance, without.radiance) << "the picture itself does not change";
    EXPECT_EQ(with.encoded, without.encoded);
}

/// Scaled down to the limit, so that it keeps its colour; what is not brighter stays as it is.
TEST_F(SamplesTest, NoneIsBrighterThanTheLimit) {
    settings_.clamp = 2.f;
    const RenderResult picture = render(lights({8, 4, 0}, {0, 1.5f, 0.5f}), black, settings_);
    Tally result;
    for (uint32_t y = 0; y < settings_.height; y++)
        for (uint32_t x = 0; x < settings_.width; x++) {
            const std::optional<uint32_t> count = on_the_left(x, y);
            if (!count) continue;
            const double p = double(*count) / settings_.spp;
            const glm::dvec3 want = p * glm::dvec3(2, 1, 0) + (1 - p) * glm::dvec3(0, 1.5, 0.5);
            result.add(near(radiance_at(picture, x, y), want, 1e-5),
                       [&] { return fmt::format("{},{}: {}", x, y, text(radiance_at(picture, x, y))); });
            const double d = luminance({2, 1, 0}) - luminance({0, 1.5, 0.5});
            EXPECT_NEAR(picture.aovs.variance[y * settings_.width + x], p * (1 - p) * d * d / 15, 1e-6);
        }
    result.expect(0, 400);
}

TEST_F(SamplesTest, UnlitColoursAreLimitedToo) {
    settings_.clamp = 0.25f;
    settings_.tonemap = Tonemap::none;
    Stage stage;
    stage.add(ground(4), unlit({0.5f, 0.25f, 0}));
    const RenderResult picture = render(stage, black, settings_);
    EXPECT_TRUE(near(radiance_at(picture, 5, 5), {0.25, 0.125, 0}, 1e-6)) << text(radiance_at(picture, 5, 5));
    // 0.25 and 0.125 in sRGB are 0.537 and 0.388.
    EXPECT_NEAR(picture.encoded[0] & 255, 137, 1);
    EXPECT_NEAR(picture.encoded[0] >> 8 & 255, 99, 1);
}

/// A picture that ends early is the one of fewer samples, bit for bit; so is what is seen of it on the way.
TEST_F(SamplesTest, PassesMakeTheSamePicture) {
    Stage stage = lights({3, 0.5f, 0.25f}, {0.25f, 0.5f, 1});
    stage.add(turned(ground(0.3f, 0.5f), 20, {0, 0, 1}), unlit({0.2f, 0.5f, 0.7f}));
    std::vector<uint32_t> passes;
    std::vector<Picture> seen;
    PictureWatch watch;
    uint32_t most = 1000;
    watch.pass_ended = [&](const std::function<Picture()>& look) { seen.push_back(look()); };
    watch.stop = [&] { return seen.size() + 1 >= most; };
    for (const bool early : {false, true}) {
        SCOPED_TRACE(early);
        most = early ? 2 : 1000;
        seen.clear();
        RenderSettings all = settings_;
        if (early) all.spp = 65536;  // no machine makes all of these in its second pass
        const RenderResult got = watched(stage, all, watch);
        EXPECT_EQ(got.samples.end, early ? PictureEnd::interrupt : PictureEnd::samples);
        ASSERT_GE(got.samples.count, 2u);
        ASSERT_GE(seen.size(), 1u);
        RenderSettings fewer = all;
        fewer.spp = got.samples.count;
        const RenderResult want = render(stage, black, fewer);
        EXPECT_EQ(got.radiance, want.radiance);
        EXPECT_EQ(got.encoded, want.encoded);
        EXPECT_EQ(got.aovs.variance, want.aovs.variance);
        EXPECT_EQ(got.aovs.sample_count, want.aovs.sample_count);
        EXPECT_EQ(got.rays.primary, want.rays.primary);
        fewer.spp = 1;
        const RenderResult one = render(stage, black, fewer);
        EXPECT_EQ(seen.front().radiance, one.radiance);
        EXPECT_EQ(seen.front().encoded, one.encoded);
    }
}

/// Known from Bernoulli: the noise of the picture that is there is below the target, and with half the samples it was
/// not.
TEST_F(SamplesTest, EndsWhenItIsNotNoisyAnyMore) {
    settings_.width = settings_.height = 8;  // every third pixel is on the border
    settings_.spp = 4096;
    const Stage stage = lights({3, 0.5f, 0.25f}, {0.25f, 0.5f, 1});
    const auto noise_at = [&](uint32_t samples) {
        RenderSettings settings = settings_;
        settings.spp = samples;
        settings.noise_target.reset();
        return *render(stage, black, settings).samples.noise;
    };
    settings_.noise_target = noise_at(96) * 1.001f;
    const RenderResult picture = render(stage, black, settings_);
    EXPECT_EQ(picture.samples.end, PictureEnd::noise_target);
    ASSERT_TRUE(picture.samples.noise);
    EXPECT_LE(*picture.samples.noise, *settings_.noise_target);
    EXPECT_LE(picture.samples.count, 96u);
    EXPECT_GE(picture.samples.count, 48u);
    EXPECT_NEAR(*picture.samples.noise, noise_at(picture.samples.count), 1e-6);
}

TEST_F(SamplesTest, ATimeLimitLeavesOneSampleAtLeast) {
    settings_.spp = 65536;
    settings_.time_limit = 1e-9;
    const Stage stage = lights({3, 0, 0}, {0, 1, 0});
    const RenderResult picture = render(stage, black, settings_);
    EXPECT_EQ(picture.samples.end, PictureEnd::time_limit);
    EXPECT_EQ(picture.samples.count, 1u);
    settings_.spp = 1;
    settings_.time_limit.reset();
    EXPECT_EQ(picture.radiance, render(stage, black, settings_).radiance);
}

}  // namespace
}  // namespace peelray
