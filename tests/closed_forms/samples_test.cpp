// What a pixel's samples are like: their number, and the variance of their mean.
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

}  // namespace
}  // namespace peelray
