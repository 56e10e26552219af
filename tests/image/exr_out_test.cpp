// EXR out, read by OpenEXR: half floats, compression, and values that half floats do not reach.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "image/half.h"
#include "image/image.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using ExrOut = TempFolder;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinite = std::numeric_limits<float>::infinity();

Image random_image(uint32_t width, uint32_t height, bool opaque) {
    std::mt19937 random(width * 31 + height);
    std::uniform_real_distribution<float> exponent(-30, 15);
    Image image{width, height, {}};
    for (uint32_t i = 0; i < width * height; i++) {
        glm::vec4 pixel;
        for (int c = 0; c < 4; c++) pixel[c] = std::exp2(exponent(random));
        if (opaque) pixel.w = 1;
        image.pixels.push_back(pixel);
    }
    return image;
}

/// Every half float, what lies in the middle of two, and next to that.
TEST_F(ExrOut, HalvesAreTheNearest) {
    uint32_t beyond = 0;
    size_t checked = 0;
    for (uint32_t bits = 0; bits < 0x7c00; bits++)
        for (const int64_t step : {int64_t(0), int64_t(0xfff), int64_t(0x1000), int64_t(0x1001)}) {
            Imath::half base;
            base.setBits(uint16_t(bits));
            const float value = std::bit_cast<float>(uint32_t(std::bit_cast<uint32_t>(float(base)) + step));
            if (value > 65504) continue;
            for (const float signed_value : {value, -value})
                ASSERT_EQ(to_half(signed_value, beyond), Imath::half(signed_value).bits()) << signed_value;
            checked++;
        }
    std::mt19937 random(3);
    std::uniform_real_distribution<float> exponent(-40, 15.9f);
    for (int i = 0; i < 100'000; i++) {
        const float value = std::exp2(exponent(random));
        ASSERT_EQ(to_half(value, beyond), Imath::half(value).bits()) << value;
    }
    EXPECT_GT(checked, 120'000u);
    EXPECT_EQ(beyond, 0u);
}

TEST_F(ExrOut, WhatHalvesDoNotReachIsCountedAndDefined) {
    uint32_t beyond = 0;
    EXPECT_EQ(to_half(65504, beyond), 0x7bff);
    EXPECT_EQ(beyond, 0u);
    for (const float value : {65505.0f, 1e30f, kInfinite}) {
        EXPECT_EQ(to_half(value, beyond), 0x7bff) << value;
        EXPECT_EQ(to_half(-value, beyond), 0xfbff) << value;
    }
    EXPECT_EQ(beyond, 6u);
    EXPECT_EQ(to_half(kNan, beyond) & 0x7c00, 0x7c00);
    EXPECT_NE(to_half(kNan, beyond) & 0x3ff, 0);
    EXPECT_EQ(beyond, 6u) << "not a number is no large number";

    const Image image{3, 1, {{1e6f, 70000, 65504, 1}, {kNan, kInfinite, 0, 1}, {0, -1e9f, 1, 1}}};
    EXPECT_EQ(write_hdr(folder / "half.exr", image), 4u);
    EXPECT_EQ(write_hdr(folder / "float.exr", image, {.half = false}), 0u);
    EXPECT_EQ(read_hdr(folder / "half.exr").pixels[0], glm::vec4(65504, 65504, 65504, 1));
    EXPECT_EQ(read_hdr(folder / "float.exr").pixels[0], glm::vec4(1e6f, 70000, 65504, 1));
}

TEST_F(ExrOut, OpenExrReadsEverySizeAndCompression) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {5u, 1u}, {1u, 40u}, {17u, 16u}, {31u, 33u}, {200u, 50u}})
        for (const bool opaque : {true, false})
            for (const bool half : {true, false})
                for (const bool zip : {true, false}) {
                    const Image image = random_image(width, height, opaque);
                    EXPECT_EQ(write_hdr(folder / "a.exr", image, ExrFormat{half, zip}), 0u);
                    Imf::InputFile file((folder / "a.exr").c_str());
                    EXPECT_TRUE(file.isComplete());
                    EXPECT_EQ(file.header().compression(), zip ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION);
                    const Imf::ChannelList& channels = file.header().channels();
                    EXPECT_EQ(channels.findChannel("G")->type, half ? Imf::HALF : Imf::FLOAT);
                    EXPECT_EQ(channels.findChannel("A") == nullptr, opaque);
                    const Image read = read_hdr(folder / "a.exr");
                    ASSERT_EQ(read.width, width);
                    ASSERT_EQ(read.height, height);
                    for (size_t i = 0; i < image.pixels.size(); i++)
                        for (int c = 0; c < 4; c++) {
                            const float value = image.pixels[i][c];
                            ASSERT_EQ(read.pixels[i][c], half ? float(Imath::half(value)) : value) << i << " " << c;
                        }
                }
}

/// Shades deflate; noise does not, and its blocks stay as they are.
TEST_F(ExrOut, ZipMakesFilesSmaller) {
    Image shades{256, 64, {}};
    for (uint32_t i = 0; i < 256 * 64; i++) shades.pixels.push_back(glm::vec4(float(i % 256) / 256, 0.5f, 0.25f, 1));
    write_hdr(folder / "zip.exr", shades);
    write_hdr(folder / "none.exr", shades, {.zip = false});
    EXPECT_LT(std::filesystem::file_size(folder / "zip.exr"), std::filesystem::file_size(folder / "none.exr") / 4);
    const size_t plain = 256 * 64 * 6 + 64 * 8 + 64 * 8;  // halves, heads of rows, the table
    EXPECT_NEAR(double(std::filesystem::file_size(folder / "none.exr")), double(plain), 400);
}

TEST_F(ExrOut, LayersStayFloats) {
    const Image image = random_image(20, 18, true);
    std::vector<float> depths(20 * 18, 1e30f);
    write_exr_layers(folder / "a.exr", image, {{"depth.Z", depths.data()}, {"B2", &image.pixels[0].x, 4}});
    Imf::InputFile file((folder / "a.exr").c_str());
    std::string names;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names += channel.name() + std::string(" ");
    EXPECT_EQ(names, "B B2 G R depth.Z ");
    EXPECT_EQ(channels.findChannel("depth.Z")->type, Imf::FLOAT);
    EXPECT_EQ(channels.findChannel("R")->type, Imf::HALF);
    std::vector<float> read(20 * 18), other(20 * 18);
    Imf::FrameBuffer buffer;
    buffer.insert("depth.Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(read.data()), 4, 4 * 20));
    buffer.insert("B2", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(other.data()), 4, 4 * 20));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 17);
    EXPECT_EQ(read, depths);
    for (size_t i = 0; i < other.size(); i++) ASSERT_EQ(other[i], image.pixels[i].x);
}

}  // namespace
}  // namespace peelray
