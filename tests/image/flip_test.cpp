// FLIP against closed forms, derived here in double, and against a second implementation.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "image/metrics.h"
#include "pictures.h"
#include "temp_folder.h"

namespace peelray {
namespace {

constexpr double pi = std::numbers::pi;
constexpr uint32_t black = rgb(0, 0, 0), white = rgb(255, 255, 255);

// ---- Closed forms ---------------------------------------------------------------------------------------------------

double decoded(int value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

glm::dvec3 decoded(uint32_t p) {
    return {decoded(channel(p, 0)), decoded(channel(p, 1)), decoded(channel(p, 2))};
}

/// XYZ relative to white, from what defines Rec. 709: the chromaticities of its primaries and of its white, D65.
glm::dvec3 relative_xyz(const glm::dvec3& linear) {
    const auto of = [](double x, double y) { return glm::dvec3(x / y, 1, (1 - x - y) / y); };
    const glm::dvec3 d65 = of(0.31271, 0.32902);
    const glm::dmat3 primaries(of(0.64, 0.33), of(0.30, 0.60), of(0.15, 0.06));
    const glm::dvec3 amounts = glm::inverse(primaries) * d65;
    return primaries * (amounts * linear) / d65;
}

/// L*, a*·L*/100, b*·L*/100.
glm::dvec3 hunt_lab(const glm::dvec3& linear) {
    glm::dvec3 f = relative_xyz(linear);
    for (int i = 0; i < 3; ++i) f[i] = f[i] > 216.0 / 24389 ? std::cbrt(f[i]) : (24389.0 / 27 * f[i] + 16) / 116;
    const double l = 116 * f.y - 16;
    return {l, 5 * l * (f.x - f.y), 2 * l * (f.y - f.z)};
}

/// HyAB.
double distance(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = hunt_lab(a) - hunt_lab(b);
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

double color_error(double distance_of_colors) {
    const double share = std::pow(distance_of_colors / distance({0, 1, 0}, {0, 0, 1}), 0.7);
    return share < 0.4 ? share / 0.4 * 0.95 : 0.95 + (share - 0.4) / 0.6 * 0.05;
}

/// FLIP of two pictures of one linear colour each: no filter changes them, no feature is there.
double color_error(const glm::dvec3& a, const glm::dvec3& b) {
    return color_error(distance(a, b));
}

/// A grey picture that varies along one axis only: the linear value at i, any integer.
using Profile = std::function<double(int)>;

/// `profile` at x filtered with `function`, whose positive and negative weights have sums of 1 and -1.
double filtered(const Profile& profile, int x, int radius, const std::function<double(int)>& function) {
    double positive = 0, negative = 0, weights = 0, opposites = 0;
    for (int i = -radius; i <= radius; ++i) {
        const double weight = function(i);
        (weight > 0 ? positive : negative) += weight * profile(x + i);
        (weight > 0 ? weights : opposites) += std::abs(weight);
    }
    return positive / weights + (opposites > 0 ? negative / opposites : 0);
}

struct Interval {
    double low, high;
};

/// FLIP at x of two profiles: greys have no chrominance, so one filter for the colour, one each for edges and points.
/// As an interval: the powers blow up what floats cannot tell apart, about 1e-4 of HyAB's 100 and 2e-7 of a feature.
Interval profile_error(const Profile& a, const Profile& b, int x, double pixels_per_degree) {
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
    const auto sensitivity = [&](int i) { return std::exp(-std::pow(pi * i / pixels_per_degree, 2) / 0.0047); };
    const double sigma = 0.041 * pixels_per_degree;
    const int reach = int(std::ceil(3 * sigma));
    const auto bell = [&](int i) { return std::exp(-0.5 * std::pow(i / sigma, 2)); };
    const auto edge = [&](int i) { return i * bell(i); };
    const auto point = [&](int i) { return (std::pow(i / sigma, 2) - 1) * bell(i); };
    const auto difference = [&](const std::function<double(int)>& f) {
        return std::abs(std::abs(filtered(a, x, reach, f)) - std::abs(filtered(b, x, reach, f)));
    };
    const double feature = std::max(difference(edge), difference(point));
    const double color =
        distance(glm::dvec3(filtered(a, x, radius, sensitivity)), glm::dvec3(filtered(b, x, radius, sensitivity)));
    const auto error = [&](double rounding) {
        return std::pow(color_error(std::max(0.0, color + 1e-4 * rounding)),
                        1 - std::sqrt(std::max(0.0, feature + 2e-7 * rounding) / std::sqrt(2.0)));
    };
    return {error(-1), error(1)};
}

float largest(const ErrorMap& map) {
    return *std::max_element(map.values.begin(), map.values.end());
}

TEST(Flip, AssumesAScreenOf67PixelsPerDegree) {
    EXPECT_NEAR(default_pixels_per_degree(), 67.0206, 1e-4);
    EXPECT_DOUBLE_EQ(default_pixels_per_degree(), 3840 / 0.7 * 0.7 * pi / 180);
}

TEST(Flip, OfEqualPicturesIsZero) {
    for (const Image8& image : {pattern(), constant(1, 1, white), constant(200, 3, rgb(1, 2, 3))})
        EXPECT_EQ(largest(flip(image, image)), 0);
}

TEST(Flip, OfConstantPicturesIsThatOfTheirColors) {
    const std::vector<uint32_t> colors = {black,
                                          white,
                                          rgb(255, 0, 0),
                                          rgb(0, 255, 0),
                                          rgb(0, 0, 255),
                                          rgb(100, 100, 100),
                                          rgb(110, 110, 110),
                                          rgb(200, 100, 50),
                                          rgb(60, 120, 180),
                                          rgb(1, 0, 2)};
    for (const uint32_t a : colors)
        for (const uint32_t b : colors) {
            if (a == b) continue;
            const double expected = color_error(decoded(a), decoded(b));
            for (const float value : flip(constant(9, 7, a), constant(9, 7, b)).values)
                ASSERT_NEAR(value, expected, 2e-5) << std::hex << a << " " << b;
            EXPECT_NEAR(flip(constant(1, 1, a), constant(1, 1, b)).values[0], expected, 2e-5);
        }
}

TEST(Flip, OfBlackAndWhite) {
    // HyAB 100, against 203.302 of green and blue: (100 / 203.302)^0.7 = 0.60856, that is 0.95 + 0.05 * 0.20856 / 0.6.
    EXPECT_NEAR(flip(constant(40, 30, black), constant(40, 30, white)).mean(), 0.96738, 1e-5);
    EXPECT_NEAR(distance(glm::dvec3(0), glm::dvec3(1)), 100, 1e-9);
    EXPECT_NEAR(distance({0, 1, 0}, {0, 0, 1}), 203.302, 1e-3);
}

TEST(Flip, IsLargestForGreenAndBlue) {
    std::vector<uint32_t> colors;
    for (int i = 0; i < 125; ++i) colors.push_back(rgb(i % 5 * 255 / 4, i / 5 % 5 * 255 / 4, i / 25 * 255 / 4));
    const float most = flip(constant(1, 1, rgb(0, 255, 0)), constant(1, 1, rgb(0, 0, 255))).values[0];
    EXPECT_NEAR(most, 1, 1e-6);
    for (const uint32_t a : colors)
        for (const uint32_t b : colors) EXPECT_LE(flip(constant(1, 1, a), constant(1, 1, b)).values[0], most);
}

TEST(Flip, IsSymmetric) {
    const Image8 a = pattern(), b = changed(a);
    EXPECT_EQ(flip(a, b).values, flip(b, a).values);
}

TEST(Flip, GrowsWithTheDifference) {
    const Image8 a = constant(20, 20, rgb(90, 90, 90));
    double last = 0;
    for (int add = 1; add < 160; add += 3) {
        const double error = flip(a, constant(20, 20, rgb(90 + add, 90 + add, 90 + add))).mean();
        EXPECT_GT(error, last);
        last = error;
    }
}

/// Both orientations of two profiles, on 61 pixels along and `across` pixels across the variation, against the closed
/// form at each pixel.
void expect_profile(const Image8& a_row, const Image8& b_row, double pixels_per_degree) {
    const auto profile = [](const Image8& row) -> Profile {
        return [&row](int i) { return decoded(channel(row.pixels[size_t(std::clamp(i, 0, int(row.width) - 1))], 0)); };
    };
    const uint32_t length = a_row.width, across = 25;
    const auto stacked = [&](const Image8& row, bool down) {
        Image8 image = constant(down ? across : length, down ? length : across, black);
        for (uint32_t i = 0; i < length * across; ++i) image.pixels[i] = row.pixels[down ? i / across : i % length];
        return image;
    };
    const ErrorMap along = flip(stacked(a_row, false), stacked(b_row, false), pixels_per_degree);
    const ErrorMap down = flip(stacked(a_row, true), stacked(b_row, true), pixels_per_degree);
    for (uint32_t x = 0; x < length; ++x) {
        const auto [low, high] = profile_error(profile(a_row), profile(b_row), int(x), pixels_per_degree);
        ASSERT_LT(high - low, 0.03) << x;
        for (const uint32_t y : {0u, 7u, across - 1})
            for (const float value : {along.values[size_t(y) * length + x], down.values[size_t(x) * across + y]}) {
                ASSERT_GE(value, low - 1e-6) << x << " " << y;
                ASSERT_LE(value, high + 1e-6) << x << " " << y;
            }
    }
}

TEST(Flip, OfAnEdge) {
    const Image8 flat = constant(61, 1, black);
    Image8 edge = flat;
    std::fill(edge.pixels.begin() + 30, edge.pixels.end(), white);
    for (const double ppd : {default_pixels_per_degree(), 20.0, 150.0}) expect_profile(flat, edge, ppd);
    // Another edge, one pixel on: no more than its neighbourhood differs.
    Image8 moved = edge;
    moved.pixels[30] = black;
    expect_profile(edge, moved, default_pixels_per_degree());
}

TEST(Flip, OfALine) {
    const Image8 grey = constant(61, 1, rgb(128, 128, 128));
    Image8 line = grey;
    line.pixels[33] = white;
    for (const double ppd : {default_pixels_per_degree(), 20.0, 150.0}) expect_profile(grey, line, ppd);
    // At the border, which goes on beyond the picture.
    Image8 border = grey;
    border.pixels[0] = black;
    expect_profile(grey, border, default_pixels_per_degree());
}

TEST(Flip, OfGreysThatVary) {
    Image8 a = constant(61, 1, black), b = a;
    for (int i = 0; i < 61; ++i) {
        const int x = i * i * 37 % 256, y = i * 97 % 256;
        a.pixels[size_t(i)] = rgb(x, x, x);
        b.pixels[size_t(i)] = rgb(y, y, y);
    }
    expect_profile(a, b, default_pixels_per_degree());
}

TEST(Flip, SeesAPointLessThanALineLessThanAnEdge) {
    const Image8 flat = constant(64, 48, black);
    Image8 point = flat, line = flat, half = flat;
    point.pixels[20 * 64 + 30] = white;
    std::fill_n(line.pixels.begin() + 20 * 64, 64, white);
    std::fill_n(half.pixels.begin() + 20 * 64, 28 * 64, white);
    const ErrorMap of_point = flip(flat, point);
    EXPECT_GT(of_point.mean(), 0);
    EXPECT_LT(of_point.mean(), flip(flat, line).mean());
    EXPECT_LT(flip(flat, line).mean(), flip(flat, half).mean());
    EXPECT_LT(largest(of_point), largest(flip(flat, line)));
    // The point is seen best where it is, and not beyond the filters' reach of 10 pixels.
    EXPECT_EQ(of_point.values[20 * 64 + 30], largest(of_point));
    for (int i = 0; i < 64 * 48; ++i) {
        const bool near = std::abs(i % 64 - 30) <= 10 && std::abs(i / 64 - 20) <= 10;
        EXPECT_TRUE(near || of_point.values[size_t(i)] == 0) << i % 64 << " " << i / 64;
    }
}

TEST(Flip, DoesNotSeeWhatIsTooFine) {
    // A checkerboard of black and white has the light of grey 188: at 67 pixels per degree they look alike, from close
    // by they do not.
    Image8 checkers = constant(40, 40, black);
    for (size_t i = 0; i < 1600; ++i)
        if ((i + i / 40) % 2) checkers.pixels[i] = white;
    const Image8 grey = constant(40, 40, rgb(188, 188, 188));
    const auto centre = [&](double ppd) { return flip(checkers, grey, ppd).values[20 * 40 + 20]; };
    EXPECT_LT(centre(default_pixels_per_degree()), 0.05);
    EXPECT_GT(centre(10), 0.5);
}

TEST(Flip, DoesNotDependOnTheNumberOfBands) {
    // Rows that are all alike: 20 of them are the work of one thread, 400 of as many as there are.
    const Image8 row = pattern(90, 1), other = changed(constant(90, 64, rgb(50, 90, 40)));
    const auto stacked = [&](auto&& pixel, uint32_t height) {
        Image8 image = constant(90, height, black);
        for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = pixel(i % 90);
        return image;
    };
    const auto a = [&](size_t x) { return row.pixels[x]; };
    const auto b = [&](size_t x) { return other.pixels[40 * 90 + x]; };
    const ErrorMap few = flip(stacked(a, 20), stacked(b, 20)), many = flip(stacked(a, 400), stacked(b, 400));
    for (size_t i = 0; i < many.values.size(); ++i) ASSERT_EQ(many.values[i], few.values[i % 90]) << i;
}

TEST(Flip, AgreesWithASecondImplementation) {
    // The values come from a second implementation, written in NumPy after the formulas of the authors' own: in double,
    // with two-dimensional kernels, nothing separable (NumPy 1.24, SciPy 1.10).
    const Image8 a = pattern(), b = changed(a);
    const auto expect = [&](double ppd, double mean, const std::vector<std::array<double, 3>>& pixels) {
        const ErrorMap map = flip(a, b, ppd);
        EXPECT_NEAR(map.mean(), mean, 1e-6) << ppd;
        for (const auto [x, y, value] : pixels)
            EXPECT_NEAR(map.values[size_t(y) * 96 + size_t(x)], value, 5e-5) << ppd << ": " << x << " " << y;
    };
    expect(default_pixels_per_degree(), 0.4162752,
           {{{0, 0, 0}},
            {{95, 63, 0.482801}},
            {{70, 40, 0.604736}},
            {{47, 20, 0.760451}},
            {{16, 50, 0.639790}},
            {{60, 10, 0.410511}},
            {{33, 47, 0.192033}}});
    expect(30, 0.3805536,
           {{{0, 0, 0}},
            {{95, 63, 0.515661}},
            {{70, 40, 0.878473}},
            {{47, 20, 0.984509}},
            {{16, 50, 0.668001}},
            {{60, 10, 0.173359}},
            {{33, 47, 0.094565}}});
}

TEST(Flip, RefusesImpossibleScreens) {
    const Image8 a = constant(2, 2, black);
    for (const double ppd : {0.0, -5.0, 0.5, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        expect_error([&] { flip(a, a, ppd); }, "pixels per degree");
        expect_error([&] { hdr_flip(constant(2, 2, glm::vec3(1)), constant(2, 2, glm::vec3(1)), ppd); },
                     "pixels per degree");
    }
    const Image8 b = constant(2, 2, white);
    for (const double ppd : {1.0, 1e4}) EXPECT_NEAR(flip(a, b, ppd).mean(), 0.96738, 1e-4) << ppd;
}

// ---- HDR ------------------------------------------------------------------------------------------------------------

/// Narkowicz's curve, which expects its input times 0.6.
double aces(double x) {
    x *= 0.6;
    return std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0);
}

glm::dvec3 exposed(const glm::dvec3& color, double stops) {
    return {aces(color.x * std::exp2(stops)), aces(color.y * std::exp2(stops)), aces(color.z * std::exp2(stops))};
}

/// Where aces() is 0.85.
double bright() {
    double low = 0, high = 10;
    for (int i = 0; i < 100; ++i) (aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
    return low;
}

TEST(FlipExposures, BringTheLargestAndTheMedianLuminanceTo085) {
    const auto expect = [](const Image& image, double largest, double median) {
        const ExposureRange range = flip_exposures(image);
        EXPECT_NEAR(range.start, std::log2(bright() / largest), 1e-6);
        EXPECT_NEAR(range.stop, std::log2(bright() / median), 1e-6);
    };
    EXPECT_NEAR(bright(), 2.11888, 1e-5);
    Image image = constant(5, 5, glm::vec3(1));
    expect(image, 1, 1);
    image.pixels[7] = glm::vec4(16, 16, 16, 1);
    expect(image, 16, 1);
    for (size_t i = 12; i < 25; ++i) image.pixels[i] = glm::vec4(0.25f, 0.25f, 0.25f, 1);
    expect(image, 16, 0.25);
    // An even number of pixels: the upper of the two in the middle.
    expect({4, 1, {glm::vec4(1), glm::vec4(2), glm::vec4(4), glm::vec4(8)}}, 8, 4);
    expect(constant(1, 1, glm::vec3(1, 2, 4)), 0.2126 + 2 * 0.7152 + 4 * 0.0722, 0.2126 + 2 * 0.7152 + 4 * 0.0722);
}

TEST(FlipExposures, OfDarkPictures) {
    Image dark = constant(5, 5, glm::vec3(0));
    EXPECT_EQ(flip_exposures(dark).start, 0);
    EXPECT_EQ(flip_exposures(dark).stop, 0);
    // Median 0: the float epsilon stands for it, or the largest luminance if even that is darker.
    dark.pixels[3] = glm::vec4(8);
    EXPECT_NEAR(flip_exposures(dark).start, std::log2(bright() / 8), 1e-6);
    EXPECT_NEAR(flip_exposures(dark).stop, std::log2(bright()) + 23, 1e-6);
    dark.pixels[3] = glm::vec4(1e-20f);
    EXPECT_EQ(flip_exposures(dark).start, flip_exposures(dark).stop);
}

TEST(HdrFlip, OfEqualPicturesIsZero) {
    for (const Image& image : {radiance(), constant(3, 3, glm::vec3(0)), constant(1, 1, glm::vec3(1e9f))})
        EXPECT_EQ(largest(hdr_flip(image, image)), 0);
}

TEST(HdrFlip, OfConstantPicturesIsTheWorstOfTheExposures) {
    const glm::vec3 a(0.3f, 0.5f, 0.1f), b(0.4f, 0.4f, 0.2f);
    for (const double stops : {-6.0, -1.0, 0.0, 1.5, 4.0})
        EXPECT_NEAR(hdr_flip(constant(6, 5, a), constant(6, 5, b), 67, ExposureRange{stops, stops}).mean(),
                    color_error(exposed(a, stops), exposed(b, stops)), 2e-5)
            << stops;
    // 2.5 stops take 3 exposures, both ends included; less than 2 stops still take 2.
    const auto worst = [&](std::initializer_list<double> stops) {
        double error = 0;
        for (const double s : stops) error = std::max(error, color_error(exposed(a, s), exposed(b, s)));
        return error;
    };
    const auto measured = [&](double start, double stop) {
        return hdr_flip(constant(6, 5, a), constant(6, 5, b), 67, ExposureRange{start, stop}).mean();
    };
    EXPECT_NEAR(measured(-4, -1.5), worst({-4, -2.75, -1.5}), 2e-5);
    EXPECT_NEAR(measured(-4, -3.5), worst({-4, -3.5}), 2e-5);
    const double stop = std::log2(bright() / glm::dot(glm::dvec3(a), glm::dvec3(0.2126, 0.7152, 0.0722)));
    EXPECT_NEAR(hdr_flip(constant(6, 5, a), constant(6, 5, b)).mean(), worst({stop}), 2e-5);
}

TEST(HdrFlip, IsTheWorstPerPixel) {
    const Image a = radiance(), b = radiance_changed();
    const auto at = [&](double stops) { return hdr_flip(a, b, 67, ExposureRange{stops, stops}); };
    // 3 whole stops: 3 exposures, 1.5 apart.
    const ErrorMap map = hdr_flip(a, b, 67, ExposureRange{-6, -3}), low = at(-6), middle = at(-4.5), high = at(-3);
    bool from_low = false, from_middle = false, from_high = false;
    for (size_t i = 0; i < map.values.size(); ++i) {
        ASSERT_EQ(map.values[i], std::max({low.values[i], middle.values[i], high.values[i]})) << i;
        from_low = from_low || low.values[i] > std::max(middle.values[i], high.values[i]);
        from_middle = from_middle || middle.values[i] > std::max(low.values[i], high.values[i]);
        from_high = from_high || high.values[i] > std::max(low.values[i], middle.values[i]);
    }
    EXPECT_TRUE(from_low && from_middle && from_high);
}

TEST(HdrFlip, SeesInHighlightsAndShadowsWhatADisplayDoesNot) {
    Image reference = constant(32, 32, glm::vec3(0.5f)), highlight = reference, shadow = reference;
    for (uint32_t y = 10; y < 20; ++y)
        for (uint32_t x = 10; x < 20; ++x) {
            reference.at(x, y) = glm::vec4(1000);
            highlight.at(x, y) = glm::vec4(2000);
        }
    // At the exposure of the middle grey both are white.
    const double middle = flip_exposures(reference).stop;
    EXPECT_EQ(largest(hdr_flip(reference, highlight, 67, ExposureRange{middle, middle})), 0);
    const ErrorMap map = hdr_flip(reference, highlight);
    EXPECT_GT(map.values[15 * 32 + 15], 0.1);
    EXPECT_EQ(map.values[2 * 32 + 2], 0);

    // What is black at the exposure of the highlight is grey at that of the median.
    shadow = reference;
    for (uint32_t x = 0; x < 32; ++x) shadow.at(x, 28) = glm::vec4(0.4f);
    const double start = flip_exposures(reference).start;
    EXPECT_LT(largest(hdr_flip(reference, shadow, 67, ExposureRange{start, start})), 0.01);
    EXPECT_GT(hdr_flip(reference, shadow).values[28 * 32 + 5], 0.05);
}

TEST(HdrFlip, AgreesWithASecondImplementation) {
    // As above; it takes 8 exposures here.
    const ErrorMap map = hdr_flip(radiance(), radiance_changed());
    EXPECT_NEAR(flip_exposures(radiance()).start, -10.862753, 1e-6);
    EXPECT_NEAR(flip_exposures(radiance()).stop, -3.061767, 1e-6);
    EXPECT_NEAR(map.mean(), 0.0720865, 1e-6);
    const std::vector<std::array<double, 3>> pixels = {{{0, 0, 0}},          {{20, 15, 0.269329}},
                                                       {{39, 23, 0.111224}}, {{70, 35, 0.251946}},
                                                       {{50, 50, 0.602553}}, {{80, 52, 0.198629}}};
    for (const auto [x, y, value] : pixels)
        EXPECT_NEAR(map.values[size_t(y) * 96 + size_t(x)], value, 1e-4) << x << " " << y;
}

TEST(HdrFlip, TakesNoLightForWhatIsNoLight) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    Image dirty = radiance(), clean = dirty;
    const auto put = [&](uint32_t x, uint32_t y, float value, float instead) {
        dirty.at(x, y) = glm::vec4(value, 1, value, nan);
        clean.at(x, y) = glm::vec4(instead, 1, instead, 1);
    };
    put(3, 5, nan, 0);
    put(40, 20, -7, 0);
    put(41, 20, -infinity, 0);
    put(60, 50, infinity, 65504);
    const Image other = radiance_changed();
    EXPECT_EQ(flip_exposures(dirty).start, flip_exposures(clean).start);
    EXPECT_EQ(flip_exposures(dirty).stop, flip_exposures(clean).stop);
    EXPECT_EQ(hdr_flip(dirty, other).values, hdr_flip(clean, other).values);
    EXPECT_EQ(hdr_flip(other, dirty).values, hdr_flip(other, clean).values);
    EXPECT_EQ(largest(hdr_flip(dirty, clean)), 0);
}

TEST(HdrFlip, StandsTheLargestAndSmallestFloats) {
    const float huge = std::numeric_limits<float>::max(), tiny = std::numeric_limits<float>::denorm_min();
    const Image dark = constant(4, 4, glm::vec3(0)), a = constant(4, 4, glm::vec3(huge));
    const Image b = constant(4, 4, glm::vec3(tiny));
    for (const Image& x : {dark, a, b})
        for (const Image& y : {dark, a, b})
            for (const float value : hdr_flip(x, y).values) EXPECT_TRUE(value >= 0 && value <= 1) << value;
    EXPECT_NEAR(hdr_flip(dark, a).mean(), 0.96738, 1e-5);
}

TEST(HdrFlip, RefusesImpossibleRanges) {
    const Image a = constant(2, 2, glm::vec3(1));
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const ExposureRange range :
         {ExposureRange{1, 0}, {0, 301}, {0, nan}, {nan, 0}, {0, infinity}, {-infinity, 0}, {infinity, infinity}})
        expect_error([&] { hdr_flip(a, a, 67, range); }, "stops");
}

}  // namespace
}  // namespace peelray
