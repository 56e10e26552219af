// PSNR, SSIM, the share of different pixels, error maps in colours, and what all comparisons refuse.
#include "image/metrics.h"
#include "base/infinity.h"

#include <cmath>
#include <limits>

#include "pictures.h"
#include "temp_folder.h"

namespace peelray {
namespace {

/// The picture with `add` on one channel of one pixel.
Image8 with(Image8 image, size_t pixel, int c, int add) {
    image.pixels[pixel] += uint32_t(add) << (8 * c);
    return image;
}

TEST(Psnr, OfAKnownError) {
    const Image8 grey = constant(7, 5, rgb(100, 100, 100));
    EXPECT_EQ(psnr(grey, grey), infinity);
    EXPECT_DOUBLE_EQ(psnr(grey, constant(7, 5, rgb(110, 90, 110))), 10 * std::log10(255.0 * 255.0 / 100));
    EXPECT_NEAR(psnr(constant(7, 5, rgb(0, 0, 0)), constant(7, 5, rgb(255, 255, 255))), 0, 1e-12);
    // One channel of one pixel: the mean is over all pixels and the three channels.
    for (int c = 0; c < 3; ++c)
        EXPECT_DOUBLE_EQ(psnr(grey, with(grey, 17, c, 30)), 10 * std::log10(255.0 * 255.0 * 7 * 5 * 3 / 900)) << c;
}

TEST(ShareDifferent, CountsPixelsBeyondOneStep) {
    const Image8 grey = constant(10, 10, rgb(100, 100, 100));
    EXPECT_EQ(share_different(grey, grey), 0);
    EXPECT_EQ(share_different(grey, constant(10, 10, rgb(101, 99, 101))), 0);
    EXPECT_EQ(share_different(grey, constant(10, 10, rgb(100, 100, 102))), 1);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(share_different(grey, with(grey, 3, c, 2)), 0.01) << c;
        EXPECT_EQ(share_different(with(grey, 3, c, 2), grey), 0.01) << c;
    }
    // Three channels of one pixel are one pixel.
    EXPECT_EQ(share_different(grey, with(with(grey, 3, 0, 9), 3, 2, 9)), 0.01);
}

TEST(Metrics, IgnoreAlpha) {
    const Image8 opaque = pattern();
    Image8 clear = opaque;
    for (uint32_t& pixel : clear.pixels) pixel &= 0xffffff;
    EXPECT_EQ(psnr(opaque, clear), infinity);
    EXPECT_EQ(ssim(opaque, clear), 1);
    EXPECT_EQ(share_different(opaque, clear), 0);
    EXPECT_EQ(flip(opaque, clear).mean(), 0);
}

// ---- SSIM -----------------------------------------------------------------------------------------------------------

double luma(uint32_t p) {
    return (0.2126 * channel(p, 0) + 0.7152 * channel(p, 1) + 0.0722 * channel(p, 2)) / 255;
}

/// SSIM of the window at (left, top), in two dimensions and from centred moments.
double window_ssim(const Image8& a, const Image8& b, uint32_t left, uint32_t top, uint32_t across, uint32_t down) {
    const auto weight = [&](uint32_t x, uint32_t y) {
        const double dx = x - 0.5 * (across - 1), dy = y - 0.5 * (down - 1);
        return std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
    };
    const auto mean = [&](auto&& value) {
        double sum = 0, weights = 0;
        for (uint32_t y = 0; y < down; ++y)
            for (uint32_t x = 0; x < across; ++x) {
                sum += weight(x, y) * value(size_t(top + y) * a.width + left + x);
                weights += weight(x, y);
            }
        return sum / weights;
    };
    const double mean_a = mean([&](size_t i) { return luma(a.pixels[i]); });
    const double mean_b = mean([&](size_t i) { return luma(b.pixels[i]); });
    const double variance_a = mean([&](size_t i) { return std::pow(luma(a.pixels[i]) - mean_a, 2); });
    const double variance_b = mean([&](size_t i) { return std::pow(luma(b.pixels[i]) - mean_b, 2); });
    const double covariance =
        mean([&](size_t i) { return (luma(a.pixels[i]) - mean_a) * (luma(b.pixels[i]) - mean_b); });
    return (2 * mean_a * mean_b + 1e-4) / (mean_a * mean_a + mean_b * mean_b + 1e-4) * (2 * covariance + 9e-4) /
           (variance_a + variance_b + 9e-4);
}

double slow_ssim(const Image8& a, const Image8& b) {
    const uint32_t across = std::min(11u, a.width), down = std::min(11u, a.height);
    double sum = 0;
    int windows = 0;
    for (uint32_t top = 0; top + down <= a.height; ++top)
        for (uint32_t left = 0; left + across <= a.width; ++left, ++windows)
            sum += window_ssim(a, b, left, top, across, down);
    return sum / windows;
}

TEST(Ssim, OfEqualPicturesIsOne) {
    EXPECT_EQ(ssim(pattern(), pattern()), 1);
    EXPECT_EQ(ssim(constant(1, 1, 0u), constant(1, 1, 0u)), 1);
}

TEST(Ssim, OfConstantPictures) {
    // No variance: only the luminances are compared.
    for (const int a : {0, 1, 100, 255})
        for (const int b : {0, 2, 130, 255}) {
            const double x = a / 255.0, y = b / 255.0;
            for (const uint32_t size : {1u, 10u, 11u, 30u})
                EXPECT_NEAR(ssim(constant(size, 20, rgb(a, a, a)), constant(size, 20, rgb(b, b, b))),
                            (2 * x * y + 1e-4) / (x * x + y * y + 1e-4), 1e-9)
                    << a << " " << b << " " << size;
        }
}

TEST(Ssim, IsThatOfTheDefinition) {
    const auto sizes = {std::pair(71u, 50u), std::pair(11u, 11u), std::pair(12u, 40u), std::pair(40u, 12u),
                        std::pair(10u, 30u), std::pair(30u, 7u),  std::pair(4u, 4u),   std::pair(2u, 1u)};
    for (const auto& [width, height] : sizes) {
        const Image8 a = pattern(width, height);
        Image8 b = a;
        for (size_t i = 0; i < b.pixels.size(); ++i) b.pixels[i] ^= uint32_t(i * 2654435761u) & 0x3f3f3f;
        EXPECT_NEAR(ssim(a, b), slow_ssim(a, b), 1e-10) << width << "x" << height;
        EXPECT_EQ(ssim(a, b), ssim(b, a));
        EXPECT_LT(ssim(a, b), 1);
    }
}

TEST(Ssim, IsThatOfScikitImage) {
    // structural_similarity(…, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1) of
    // scikit-image 0.19.3, on the luma of the same two pictures.
    EXPECT_NEAR(ssim(pattern(), changed(pattern())), 0.858883087, 1e-9);
}

TEST(Ssim, OfANegativeIsNegative) {
    Image8 negative = pattern();
    for (uint32_t& pixel : negative.pixels) pixel ^= 0xffffff;
    EXPECT_LT(ssim(pattern(), negative), 0);
    EXPECT_GE(ssim(pattern(), negative), -1);
}

// ---- Error maps and all of it ---------------------------------------------------------------------------------------

TEST(ErrorMap, HasAMean) {
    EXPECT_EQ(ErrorMap{}.mean(), 0);
    EXPECT_DOUBLE_EQ((ErrorMap{2, 2, {0, 0.5f, 1, 0.25f}}.mean()), 0.4375);
}

TEST(Colorize, GoesFromBlackToLightYellow) {
    ErrorMap map{256, 1, {}};
    for (int i = 0; i < 256; ++i) map.values.push_back(float(i) / 255);
    const Image8 image = colorize(map);
    ASSERT_EQ(image.width, 256u);
    ASSERT_EQ(image.height, 1u);
    EXPECT_EQ(image.pixels.front(), rgb(0x00, 0x00, 0x04));
    EXPECT_EQ(image.pixels[128], rgb(0xb7, 0x37, 0x79));
    EXPECT_EQ(image.pixels.back(), rgb(0xfc, 0xfd, 0xbf));
    for (size_t i = 1; i < 256; ++i) EXPECT_GT(luma(image.pixels[i]), luma(image.pixels[i - 1]) - 0.002) << i;
}

TEST(Colorize, ClampsWhatIsNoError) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Image8 image = colorize({5, 1, {-1, 2, nan, float(infinity), 0.499f / 255}});
    const uint32_t none = rgb(0, 0, 4), most = rgb(0xfc, 0xfd, 0xbf);
    EXPECT_EQ(image.pixels, (std::vector{none, most, most, most, none}));
}

TEST(Compare, CollectsTheMeasures) {
    const Image8 a = pattern(), b = changed(a);
    const Difference difference = compare(a, b, radiance(), radiance_changed());
    EXPECT_EQ(difference.psnr, psnr(a, b));
    EXPECT_EQ(difference.ssim, ssim(a, b));
    EXPECT_EQ(difference.different, share_different(a, b));
    EXPECT_EQ(difference.map.values, flip(a, b).values);
    EXPECT_EQ(difference.flip, flip(a, b).mean());
    EXPECT_EQ(difference.hdr_flip, hdr_flip(radiance(), radiance_changed()).mean());

    const Difference none = compare(a, a, radiance(), radiance());
    EXPECT_EQ(none.psnr, infinity);
    EXPECT_EQ(none.ssim, 1);
    EXPECT_EQ(none.different, 0);
    EXPECT_EQ(none.flip, 0);
    EXPECT_EQ(none.hdr_flip, 0);
}

TEST(Metrics, RefuseDifferentSizes) {
    const Image8 a = constant(3, 4, 0u), b = constant(4, 3, 0u);
    const Image c = constant(3, 4, glm::vec3(1)), d = constant(3, 5, glm::vec3(1));
    const std::string ab = "the reference has 3x4 pixels, the other 4x3";
    expect_error([&] { psnr(a, b); }, ab);
    expect_error([&] { ssim(a, b); }, ab);
    expect_error([&] { share_different(a, b); }, ab);
    expect_error([&] { flip(a, b); }, ab);
    expect_error([&] { hdr_flip(c, d); }, "the reference has 3x4 pixels, the other 3x5");
    expect_error([&] { compare(a, b, c, c); }, ab);
    expect_error([&] { compare(a, a, c, d); }, "the reference has 3x4 pixels, the other 3x5");
    expect_error([&] { compare(b, b, c, c); }, "the reference has 4x3 pixels, the other 3x4");
}

TEST(Metrics, RefusePicturesWithoutPixels) {
    const Image8 none{0, 5, {}};
    expect_error([&] { psnr(none, none); }, "0x5");
    expect_error([&] { ssim(none, none); }, "0x5");
    expect_error([&] { share_different(none, none); }, "0x5");
    expect_error([&] { flip(none, none); }, "0x5");
    expect_error([&] { hdr_flip({}, {}); }, "0x0");
    expect_error([&] { compare(none, none, {}, {}); }, "0x5");
}

}  // namespace
}  // namespace peelray
