// Uncompressed video: the header, and colours against the formulas of BT.709 and against ffmpeg.
#include "image/y4m.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include "temp_folder.h"

namespace peelray {
namespace {

using Y4m = TempFolder;
using Fraction = std::pair<uint64_t, uint64_t>;

/// Edges and single pixels of every colour, and a smooth part.
Image8 test_picture(uint32_t width, uint32_t height) {
    std::mt19937 random(1);
    Image8 image{width, height, {}};
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            image.pixels.push_back(x < width / 2 ? uint32_t(random()) : x * 5 | y * 7 << 8 | 0xff300000);
    return image;
}

std::array<double, 3> channels_at(const Image8& image, uint32_t x, uint32_t y) {
    const uint32_t pixel = image.pixels[y * image.width + x];
    return {double(pixel & 255), double(pixel >> 8 & 255), double(pixel >> 16 & 255)};
}

/// Rec. ITU-R BT.709-6, items 3.2 to 3.4, for 8 bits: luma, and the two colour differences.
std::array<double, 3> bt709(const std::array<double, 3>& rgb) {
    const double luma = (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / 255;
    return {16 + 219 * luma, 128 + 224 * (rgb[2] / 255 - luma) / 1.8556, 128 + 224 * (rgb[0] / 255 - luma) / 1.5748};
}

TEST_F(Y4m, RatesAreFractions) {
    EXPECT_EQ(fraction_of(30), Fraction(30, 1));
    EXPECT_EQ(fraction_of(29.97), Fraction(2997, 100));
    EXPECT_EQ(fraction_of(24000 / 1001.0), Fraction(24000, 1001));
    EXPECT_EQ(fraction_of(12.5), Fraction(25, 2));
    EXPECT_EQ(fraction_of(1 / 3.0), Fraction(1, 3));
    EXPECT_EQ(fraction_of(0.001), Fraction(1, 1000));
    EXPECT_EQ(fraction_of(1000), Fraction(1000, 1));
    const auto [above, below] = fraction_of(3.14159265358979);
    EXPECT_NEAR(double(above) / double(below), 3.14159265358979, 1e-9);
}

TEST_F(Y4m, TheHeaderSaysItAll) {
    EXPECT_EQ(y4m_header(64, 48, 29.97),
              "YUV4MPEG2 W64 H48 F2997:100 Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED\n");
}

TEST_F(Y4m, EveryValueIsTheNearestOne) {
    const Image8 image = test_picture(34, 22);
    const std::string frame = y4m_frame(image);
    ASSERT_EQ(frame.size(), 6u + 34 * 22 * 3 / 2);
    ASSERT_TRUE(frame.starts_with("FRAME\n"));
    const auto value = [&](size_t at) { return double(uint8_t(frame[6 + at])); };
    for (uint32_t y = 0; y < 22; y++)
        for (uint32_t x = 0; x < 34; x++)
            ASSERT_NEAR(value(y * 34 + x), bt709(channels_at(image, x, y))[0], 0.5001) << x << " " << y;
    for (uint32_t y = 0; y < 11; y++)
        for (uint32_t x = 0; x < 17; x++) {
            std::array<double, 3> mean{};
            for (const auto& [i, k] : {std::pair{0u, 0u}, {1u, 0u}, {0u, 1u}, {1u, 1u}})
                for (size_t c = 0; c < 3; c++) mean[c] += channels_at(image, 2 * x + i, 2 * y + k)[c] / 4;
            for (size_t c = 1; c < 3; c++)
                ASSERT_NEAR(value(34 * 22 + (c - 1) * 17 * 11 + y * 17 + x), bt709(mean)[c], 0.5001) << x << " " << y;
        }
}

TEST_F(Y4m, BlackWhiteAndColoursStayInTheirRange) {
    const auto all_of = [](uint32_t pixel) {
        const std::string frame = y4m_frame(Image8{2, 2, std::vector<uint32_t>(4, pixel)});
        return std::array<int, 3>{uint8_t(frame[6]), uint8_t(frame[10]), uint8_t(frame[11])};
    };
    EXPECT_EQ(all_of(0xff000000), (std::array{16, 128, 128}));
    EXPECT_EQ(all_of(0xffffffff), (std::array{235, 128, 128}));
    EXPECT_EQ(all_of(0xff0000ff), (std::array{63, 102, 240}));
    EXPECT_EQ(all_of(0xffff0000), (std::array{32, 240, 118}));
}

TEST_F(Y4m, FfmpegConvertsThemAlike) {
    if (std::system("command -v ffmpeg > /dev/null") != 0) GTEST_SKIP() << "there is no ffmpeg: apt-get install ffmpeg";
    const Image8 image = test_picture(96, 64);
    const std::string pixels(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size() * 4);
    const std::string frame = y4m_frame(image), stream = y4m_header(96, 64, 24) + frame + frame;
    const auto ffmpeg = [&](const std::string& options) {
        const std::string line =
            "ffmpeg -hide_banner -loglevel error " + options + " -f rawvideo - > '" + (folder / "raw").string() + "'";
        EXPECT_EQ(std::system(line.c_str()), 0) << line;
        return get(folder / "raw");
    };
    const std::string own = ffmpeg(
        "-f rawvideo -pix_fmt rgb0 -video_size 96x64 -i '" + put("rgb", pixels).string() +
        "' -vf scale=in_range=full:out_range=limited:out_color_matrix=bt709:flags=area+accurate_rnd -pix_fmt yuv420p");
    ASSERT_EQ(own.size(), 96u * 64 * 3 / 2);
    for (size_t i = 0; i < own.size(); i++) ASSERT_LE(std::abs(uint8_t(own[i]) - uint8_t(frame[6 + i])), 1) << i;
    // And reads what is written as what it is.
    EXPECT_TRUE(ffmpeg("-i '" + put("a.y4m", stream).string() + "' -pix_fmt yuv420p") ==
                frame.substr(6) + frame.substr(6));
}

}  // namespace
}  // namespace peelray
