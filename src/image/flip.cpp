// FLIP: what a viewer sees flipping between two pictures.
// LDR: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020.
// HDR: Andersson, Nilsson, Shirley, Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images",
// Eurographics 2021.
#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <thread>

#include "image/codecs.h"
#include "image/metrics.h"
#include "image/same_size.h"

namespace peelray {
namespace {

constexpr double pi = std::numbers::pi;

// ---- Work in bands of rows ------------------------------------------------------------------------------------------

/// Calls `work(first, last)` for bands of rows, one thread each. A pixel's value does not depend on its band.
template <typename Work>
void for_bands(uint32_t rows, const Work& work) {
    const uint32_t threads = std::clamp(rows / 32, 1u, std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::future<void>> bands;
    for (uint32_t i = 1; i < threads; ++i)
        bands.push_back(std::async(std::launch::async, work, uint32_t(uint64_t(rows) * i / threads),
                                   uint32_t(uint64_t(rows) * (i + 1) / threads)));
    work(0, rows / threads);
    for (std::future<void>& band : bands) band.get();
}

struct Plane {
    uint32_t width, height;
    std::vector<float> values;

    Plane(uint32_t width, uint32_t height) : width(width), height(height), values(size_t(width) * height) {}
    float* row(uint32_t y) { return values.data() + size_t(y) * width; }
    const float* row(uint32_t y) const { return values.data() + size_t(y) * width; }
};

// ---- Colours --------------------------------------------------------------------------------------------------------

/// Linear Rec. 709 to XYZ, the matrix of FLIP's authors, divided by the white point, so that white is (1, 1, 1).
glm::mat3 xyz_of_rgb() {
    const glm::dmat3 rows(10135552. / 24577794, 8788810. / 24577794, 4435075. / 24577794,   //
                          2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897,     //
                          1425312. / 73733382, 8788810. / 73733382, 70074185. / 73733382);  //
    glm::dmat3 relative;
    for (int i = 0; i < 3; ++i) relative[i] = rows[i] / (rows[i].x + rows[i].y + rows[i].z);
    return glm::mat3(glm::transpose(relative));
}

const glm::mat3 to_xyz = xyz_of_rgb();
const glm::mat3 to_rgb = glm::mat3(glm::inverse(glm::dmat3(to_xyz)));

/// CIELAB of XYZ relative to white, a* and b* multiplied by L*/100: colourfulness grows with luminance (Hunt).
glm::vec3 hunt_lab(glm::vec3 xyz) {
    constexpr float delta = 6.0f / 29.0f;
    for (int i = 0; i < 3; ++i)
        xyz[i] = xyz[i] > delta * delta * delta ? std::cbrt(xyz[i]) : xyz[i] / (3 * delta * delta) + 4.0f / 29.0f;
    const float l = 116 * xyz.y - 16;
    return {l, 0.01f * l * 500 * (xyz.x - xyz.y), 0.01f * l * 200 * (xyz.y - xyz.z)};
}

/// HyAB distance, good for large differences, to the power 0.7, which brings the small ones forward.
float color_distance(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = a - b;
    return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), 0.7f);
}

/// Maps distances to [0, 1]: up to 0.4 of the largest one, green to blue, they take [0, 0.95].
float redistribute(float distance) {
    static const float largest = color_distance(hunt_lab(to_xyz[1]), hunt_lab(to_xyz[2]));
    const float knee = 0.4f * largest;
    if (distance < knee) return 0.95f * distance / knee;
    return 0.95f + 0.05f * (distance - knee) / (largest - knee);
}

// ---- Filters --------------------------------------------------------------------------------------------------------

/// A filter along one axis: an odd number of weights, the middle one for the pixel itself. Their sum is 1 or 0.
struct Taps {
    std::vector<float> weights;
    bool zero_sum;

    int radius() const { return int(weights.size() / 2); }
};

/// `function(i)` for i in [-radius, radius]; negative and positive values are scaled to sums of -1 and 1 each.
template <typename Function>
Taps make_taps(int radius, const Function& function) {
    double positive = 0, negative = 0;
    for (int i = -radius; i <= radius; ++i) (function(i) < 0 ? negative : positive) += std::abs(function(i));
    Taps taps{{}, negative > 0};
    for (int i = -radius; i <= radius; ++i)
        taps.weights.push_back(float(function(i) / (function(i) < 0 ? negative : positive)));
    return taps;
}

/// All filters of FLIP are separable or the sum of two separable ones.
struct Filters {
    Taps achromatic, red_green;           ///< contrast sensitivity
    std::array<Taps, 2> blue_yellow;      ///< of the two Gaussians that make up the one for blue-yellow
    std::array<float, 2> blue_yellow_of;  ///< the share of each
    Taps smooth, edge, point;             ///< Gaussian, its first and second derivative
};

Filters make_filters(double pixels_per_degree) {
    // A comparison with NaN is false. Below 1 the weights of the derivatives vanish, above 10^4 the filters are as
    // large as pictures.
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1e4))
        fail("cannot compare at {} pixels per degree; choose 1 to 10000", pixels_per_degree);
    // The contrast sensitivity in space, amplitude a, falloff b: a·sqrt(pi/b)·exp(-pi²x²/b), x in degrees; the sum of
    // two such Gaussians for blue-yellow, one for the others.
    constexpr double widest = 0.04;
    const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    const auto gaussian = [&](double b) {
        return [=](int i) { return std::exp(-pi * pi * i * i / (pixels_per_degree * pixels_per_degree * b)); };
    };
    // What a Gaussian of the sum weighs in two dimensions before the sum is scaled to 1.
    const auto weight = [&](double a, double b) {
        double sum = 0;
        for (int i = -radius; i <= radius; ++i) sum += gaussian(b)(i);
        return a * std::sqrt(pi / b) * sum * sum;
    };
    const double first = weight(34.1, 0.04), second = weight(13.5, 0.025);

    const double sigma = 0.5 * 0.082 * pixels_per_degree;  // 0.082: peak to trough of the edge detector, degrees
    const int reach = int(std::ceil(3 * sigma));
    const auto bell = [=](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
    return {
        .achromatic = make_taps(radius, gaussian(0.0047)),
        .red_green = make_taps(radius, gaussian(0.0053)),
        .blue_yellow = {make_taps(radius, gaussian(0.04)), make_taps(radius, gaussian(0.025))},
        .blue_yellow_of = {float(first / (first + second)), float(second / (first + second))},
        .smooth = make_taps(reach, bell),
        .edge = make_taps(reach, [&](int i) { return -i * bell(i); }),
        .point = make_taps(reach, [&](int i) { return (i * i / (sigma * sigma) - 1) * bell(i); }),
    };
}

/// Adds one tap's part to a row: `from` are the pixels it falls on, `centre` those that the row's own taps fall on. A
/// zero-sum filter sees differences only: rounding must not make a feature, whose root counts, out of a constant.
void add_tap(const float* from, const float* centre, float weight, bool zero_sum, float* to, uint32_t width) {
    if (zero_sum)
        for (uint32_t x = 0; x < width; ++x) to[x] += weight * (from[x] - centre[x]);
    else
        for (uint32_t x = 0; x < width; ++x) to[x] += weight * from[x];
}

/// A row of `from` filtered across; pixels beyond the border are as the border.
void filter_across(const Plane& from, uint32_t y, const Taps& taps, Plane& to) {
    const size_t radius = size_t(taps.radius()), width = from.width;
    std::vector<float> padded(width + 2 * radius);
    const float* row = from.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + ptrdiff_t(radius));
    std::fill_n(padded.end() - ptrdiff_t(radius), radius, row[width - 1]);
    for (size_t k = 0; k < taps.weights.size(); ++k)
        add_tap(padded.data() + k, row, taps.weights[k], taps.zero_sum, to.row(y), from.width);
}

/// Adds row y of `from`, filtered down and times `scale`, to `to`.
void filter_down(const Plane& from, uint32_t y, const Taps& taps, std::vector<float>& to, float scale = 1) {
    for (int k = -taps.radius(); k <= taps.radius(); ++k) {
        const int64_t tap_y = std::clamp(int64_t(y) + k, int64_t(0), int64_t(from.height) - 1);
        add_tap(from.row(uint32_t(tap_y)), from.row(y), scale * taps.weights[size_t(k + taps.radius())], taps.zero_sum,
                to.data(), from.width);
    }
}

// ---- One picture as a viewer sees it --------------------------------------------------------------------------------

/// A picture filtered across; filter_down() does the rest.
struct Across {
    Plane achromatic, red_green, blue_yellow_0, blue_yellow_1;
    Plane smooth, edge, point;

    Across(uint32_t width, uint32_t height)
        : achromatic(width, height),
          red_green(width, height),
          blue_yellow_0(width, height),
          blue_yellow_1(width, height),
          smooth(width, height),
          edge(width, height),
          point(width, height) {}
};

/// `color(i)`: pixel i in linear Rec. 709, [0, 1].
template <typename Color>
Across see_across(uint32_t width, uint32_t height, const Color& color, const Filters& filters) {
    // The opponent space YCxCz of the paper without its factors and offset: the filters are linear and keep constants,
    // and hunt_lab() wants XYZ again. So Y, X - Y, Y - Z.
    Plane y_plane(width, height), cx(width, height), cz(width, height);
    Across out(width, height);
    for_bands(height, [&](uint32_t first, uint32_t last) {
        for (size_t i = size_t(first) * width; i < size_t(last) * width; ++i) {
            const glm::vec3 xyz = to_xyz * color(i);
            y_plane.values[i] = xyz.y;
            cx.values[i] = xyz.x - xyz.y;
            cz.values[i] = xyz.y - xyz.z;
        }
        for (uint32_t y = first; y < last; ++y) {
            filter_across(y_plane, y, filters.achromatic, out.achromatic);
            filter_across(cx, y, filters.red_green, out.red_green);
            filter_across(cz, y, filters.blue_yellow[0], out.blue_yellow_0);
            filter_across(cz, y, filters.blue_yellow[1], out.blue_yellow_1);
            filter_across(y_plane, y, filters.smooth, out.smooth);
            filter_across(y_plane, y, filters.edge, out.edge);
            filter_across(y_plane, y, filters.point, out.point);
        }
    });
    return out;
}

struct Seen {
    glm::vec3 lab;      ///< hunt_lab() of the filtered colour
    float edge, point;  ///< lengths of the filtered derivatives
};

/// One row as it is seen. The colour is clamped to the display's gamut after the filters.
std::vector<Seen> see_row(const Across& across, uint32_t y, const Filters& filters) {
    const uint32_t width = across.smooth.width;
    std::vector<float> achromatic(width), cx(width), cz(width), edge_x(width), edge_y(width), point_x(width),
        point_y(width);
    filter_down(across.achromatic, y, filters.achromatic, achromatic);
    filter_down(across.red_green, y, filters.red_green, cx);
    filter_down(across.blue_yellow_0, y, filters.blue_yellow[0], cz, filters.blue_yellow_of[0]);
    filter_down(across.blue_yellow_1, y, filters.blue_yellow[1], cz, filters.blue_yellow_of[1]);
    filter_down(across.edge, y, filters.smooth, edge_x);
    filter_down(across.smooth, y, filters.edge, edge_y);
    filter_down(across.point, y, filters.smooth, point_x);
    filter_down(across.smooth, y, filters.point, point_y);

    std::vector<Seen> row(width);
    for (uint32_t x = 0; x < width; ++x) {
        const glm::vec3 xyz(achromatic[x] + cx[x], achromatic[x], achromatic[x] - cz[x]);
        row[x].lab = hunt_lab(to_xyz * glm::clamp(to_rgb * xyz, 0.0f, 1.0f));
        row[x].edge = std::sqrt(edge_x[x] * edge_x[x] + edge_y[x] * edge_y[x]);
        row[x].point = std::sqrt(point_x[x] * point_x[x] + point_y[x] * point_y[x]);
    }
    return row;
}

/// Colour and feature differences combined: an edge or point that only one of the pictures has raises the error.
float error_of(const Seen& a, const Seen& b) {
    const float color = redistribute(color_distance(a.lab, b.lab));
    const float feature = std::max(std::abs(a.edge - b.edge), std::abs(a.point - b.point));
    const float error = std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2_v<float>));
    return std::min(error, 1.0f);  // rounding may take green against blue beyond 1
}

template <typename Color>
ErrorMap flip_of(uint32_t width, uint32_t height, const Color& reference, const Color& test, const Filters& filters) {
    const Across a = see_across(width, height, reference, filters), b = see_across(width, height, test, filters);
    ErrorMap map{width, height, std::vector<float>(size_t(width) * height)};
    for_bands(height, [&](uint32_t first, uint32_t last) {
        for (uint32_t y = first; y < last; ++y) {
            const std::vector<Seen> row_a = see_row(a, y, filters), row_b = see_row(b, y, filters);
            for (uint32_t x = 0; x < width; ++x) map.values[size_t(y) * width + x] = error_of(row_a[x], row_b[x]);
        }
    });
    return map;
}

// ---- From encoded and from unbounded pixels to [0, 1] ---------------------------------------------------------------

struct Decoded {
    const Image8& image;
    const std::array<float, 256>& linear;

    glm::vec3 operator()(size_t i) const {
        const uint32_t pixel = image.pixels[i];
        return {linear[pixel & 255], linear[pixel >> 8 & 255], linear[pixel >> 16 & 255]};
    }
};

std::array<float, 256> srgb_table() {
    std::array<float, 256> table;
    for (int i = 0; i < 256; ++i) {
        const double v = i / 255.0;
        table[size_t(i)] = float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return table;
}

/// As read_hdr() leaves pixels: NaN and negative values 0, infinity the largest half.
glm::vec3 sanitised(const glm::vec4& pixel) {
    glm::vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = !(pixel[c] > 0) ? 0 : std::isinf(pixel[c]) ? max_half : pixel[c];
    return out;
}

/// Narkowicz's fit of the ACES film curve with its exposure of 0.6 taken out: (k0·x² + k1·x) / (k2·x² + k3·x + k4).
constexpr std::array<double, 5> aces = {0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14};

struct Exposed {
    const Image& image;
    double factor;

    glm::vec3 operator()(size_t i) const {
        glm::vec3 color = sanitised(image.pixels[i]);
        for (int c = 0; c < 3; ++c) {
            // The curve exceeds 1, where it is clipped, long before 10^6, whose square is still finite.
            const float x = float(std::min(double(color[c]) * factor, 1e6));
            color[c] = std::min(x * (float(aces[0]) * x + float(aces[1])) /
                                    (x * (float(aces[2]) * x + float(aces[3])) + float(aces[4])),
                                1.0f);
        }
        return color;
    }
};

/// How many exposures HDR-FLIP takes between start and stop, both included: about one for each stop, at least 2.
int exposure_count(const ExposureRange& range) {
    const double stops = range.stop - range.start;
    if (!(stops >= 0 && stops <= 300))
        fail(
            "cannot compare at exposures from {} to {} stops; choose a start, a stop not below it and at most 300 "
            "between",
            range.start, range.stop);
    // A range of whole stops must not gain one by rounding.
    return std::max(2, int(std::ceil(stops - 1e-5)));
}

}  // namespace

double default_pixels_per_degree() {
    constexpr double distance = 0.7, monitor_width = 0.7, monitor_pixels = 3840;
    return distance * (monitor_pixels / monitor_width) * (pi / 180);
}

ErrorMap flip(const Image8& reference, const Image8& test, double pixels_per_degree) {
    check_same_size(reference, test);
    static const std::array<float, 256> linear = srgb_table();
    return flip_of(reference.width, reference.height, Decoded{reference, linear}, Decoded{test, linear},
                   make_filters(pixels_per_degree));
}

ExposureRange flip_exposures(const Image& reference) {
    std::vector<float> luminances;
    luminances.reserve(reference.pixels.size());
    for (const glm::vec4& pixel : reference.pixels)
        luminances.push_back(glm::dot(sanitised(pixel), glm::vec3(0.2126f, 0.7152f, 0.0722f)));
    if (luminances.empty()) return {0, 0};
    const float largest = *std::max_element(luminances.begin(), luminances.end());
    if (largest == 0) return {0, 0};  // no light, no exposure is better than another
    const auto middle = luminances.begin() + ptrdiff_t(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    // More than half of the picture black: the authors' code takes the float epsilon for the median.
    const float median = std::max(*middle, std::min(std::numeric_limits<float>::epsilon(), largest));

    // x with aces(x) = 0.85, the larger root of a·x² + b·x + c.
    const double a = aces[0] - 0.85 * aces[2], b = aces[1] - 0.85 * aces[3], c = -0.85 * aces[4];
    const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    return {std::log2(x / double(largest)), std::log2(x / double(median))};
}

ErrorMap hdr_flip(const Image& reference, const Image& test, double pixels_per_degree,
                  std::optional<ExposureRange> range) {
    check_same_size(reference, test);
    const Filters filters = make_filters(pixels_per_degree);
    if (!range) range = flip_exposures(reference);
    const int count = exposure_count(*range);
    ErrorMap worst{reference.width, reference.height, std::vector<float>(reference.pixels.size())};
    for (int i = 0; i < count; ++i) {
        const double factor = std::exp2(range->start + (range->stop - range->start) * i / (count - 1));
        const ErrorMap map =
            flip_of(reference.width, reference.height, Exposed{reference, factor}, Exposed{test, factor}, filters);
        for (size_t p = 0; p < map.values.size(); ++p) worst.values[p] = std::max(worst.values[p], map.values[p]);
        if (range->start == range->stop) break;  // all exposures are this one
    }
    return worst;
}

}  // namespace peelray
