#include "image/y4m.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace peelray {
namespace {

/// BT.709: what red, green and blue are of luma.
constexpr float kRed = 0.2126f, kGreen = 0.7152f, kBlue = 0.0722f;
constexpr float kLumaScale = 219 / 255.0f, kChromaScale = 224 / 255.0f;

/// An offset and what each channel counts.
struct Weights {
    float offset, red, green, blue;

    float of(float r, float g, float b) const { return offset + red * r + green * g + blue * b; }
};

/// The offsets round: what comes out is cut to a whole number.
constexpr Weights kLuma{16.5f, kLumaScale* kRed, kLumaScale* kGreen, kLumaScale* kBlue};
constexpr Weights chroma(float red, float green, float blue, float own) {
    const float scale = kChromaScale / (2 * (1 - own)) / 4;  // of the sum of four pixels
    return {128.5f, scale * red, scale * green, scale * blue};
}
constexpr Weights kCb = chroma(-kRed, -kGreen, 1 - kBlue, kBlue), kCr = chroma(1 - kRed, -kGreen, -kBlue, kRed);

void put_luma(const uint32_t* __restrict pixels, size_t count, uint8_t* __restrict out) {
    for (size_t i = 0; i < count; i++) {
        const uint32_t pixel = pixels[i];
        out[i] = uint8_t(int32_t(kLuma.of(float(int32_t(pixel & 255)), float(int32_t(pixel >> 8 & 255)),
                                          float(int32_t(pixel >> 16 & 255)))));
    }
}

/// `count`: samples in the row.
void put_chroma(const uint32_t* __restrict upper, const uint32_t* __restrict lower, size_t count,
                uint8_t* __restrict cb, uint8_t* __restrict cr) {
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = upper[2 * i], b = upper[2 * i + 1], c = lower[2 * i], d = lower[2 * i + 1];
        // Sums of red and blue side by side, of at most 1020 each.
        const uint32_t even = (a & 0xff00ff) + (b & 0xff00ff) + (c & 0xff00ff) + (d & 0xff00ff);
        const uint32_t green = (a >> 8 & 255) + (b >> 8 & 255) + (c >> 8 & 255) + (d >> 8 & 255);
        const float red_sum = float(int32_t(even & 0xffff)), green_sum = float(int32_t(green)),
                    blue_sum = float(int32_t(even >> 16));
        cb[i] = uint8_t(int32_t(kCb.of(red_sum, green_sum, blue_sum)));
        cr[i] = uint8_t(int32_t(kCr.of(red_sum, green_sum, blue_sum)));
    }
}

}  // namespace

std::pair<uint64_t, uint64_t> fraction_of(double value) {
    // Continued fractions: each is the nearest one of its size.
    uint64_t above = 1, below = 0, above_before = 0, below_before = 1;
    double rest = value;
    for (int i = 0; i < 20; i++) {
        const double whole = std::floor(rest);
        const uint64_t next_above = uint64_t(whole) * above + above_before,
                       next_below = uint64_t(whole) * below + below_before;
        if (next_below > 100'000) break;
        above_before = std::exchange(above, next_above);
        below_before = std::exchange(below, next_below);
        if (std::abs(double(above) / double(below) - value) < 1e-12 * value) break;
        rest = 1 / (rest - whole);
    }
    return {above, below};
}

std::string y4m_header(uint32_t width, uint32_t height, double fps) {
    const auto [frames, seconds] = fraction_of(fps);
    return fmt::format("YUV4MPEG2 W{} H{} F{}:{} Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n", width, height,
                       frames, seconds);
}

std::string y4m_frame(const Image8View& image) {
    assert(image.width % 2 == 0 && image.height % 2 == 0);
    constexpr std::string_view head = "FRAME\n";
    const size_t pixels = size_t(image.width) * image.height;
    std::string frame(head);
    frame.resize(head.size() + pixels + pixels / 2);
    uint8_t* luma = reinterpret_cast<uint8_t*>(frame.data()) + head.size();
    uint8_t *cb = luma + pixels, *cr = cb + pixels / 4;
    for (uint32_t y = 0; y < image.height; y += 2) {
        const uint32_t* upper = &image.pixels[size_t(y) * image.width];
        put_luma(upper, 2 * size_t(image.width), luma + size_t(y) * image.width);
        const size_t at = size_t(y / 2) * (image.width / 2);
        put_chroma(upper, upper + image.width, image.width / 2, cb + at, cr + at);
    }
    return frame;
}

}  // namespace peelray
