// PNG out: what others read of it, how large it is, and that it is the same each time.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstdlib>
#include <random>

#include "image/image.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using Png = TempFolder;

uint32_t number_at(const std::string& bytes, size_t at) {
    uint32_t number = 0;
    for (size_t i = 0; i < 4; i++) number = number << 8 | uint8_t(bytes[at + i]);
    return number;
}

/// PNG specification, annex D.
uint32_t checksum(std::string_view bytes) {
    uint32_t crc = 0xffffffff;
    for (const char byte : bytes) {
        crc ^= uint8_t(byte);
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? 0xedb88320 ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

Image8 noise(uint32_t width, uint32_t height) {
    std::mt19937 random(width * 977 + height);
    Image8 image{width, height, std::vector<uint32_t>(size_t(width) * height)};
    for (uint32_t& pixel : image.pixels) pixel = uint32_t(random());
    return image;
}

/// As pictures are: shades that change slowly, edges, and some grain.
Image8 picture(uint32_t width, uint32_t height, int grain) {
    std::mt19937 random(uint32_t(grain) + 1);
    Image8 image{width, height, {}};
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const float u = float(x) / float(width), v = float(y) / float(height);
            const bool ball = (u - 0.5f) * (u - 0.5f) + (v - 0.5f) * (v - 0.5f) < 0.1f;
            const auto shade = [&](float value) {
                return uint32_t(
                    std::clamp(value * 255 + float(grain) * (float(random() % 1024) / 512 - 1), 0.0f, 255.0f));
            };
            const float light = ball ? 1 - 3 * (u - 0.4f) * (u - 0.4f) - 2 * (v - 0.4f) * (v - 0.4f) : 0.3f + 0.4f * v;
            image.pixels.push_back(shade(light) | shade(light * 0.8f + 0.1f * u) << 8 | shade(0.9f - 0.5f * v) << 16 |
                                   0xff000000);
        }
    return image;
}

TEST_F(Png, ConsistsOfWholeChunks) {
    const std::string bytes = encode_png("a.png", picture(33, 20, 3));
    ASSERT_TRUE(bytes.starts_with("\x89PNG\r\n\x1a\n"));
    std::string names;
    size_t at = 8;
    while (at < bytes.size()) {
        const uint32_t size = number_at(bytes, at);
        ASSERT_LE(at + 12 + size, bytes.size());
        names += bytes.substr(at + 4, 4) + " ";
        EXPECT_EQ(checksum(std::string_view(bytes).substr(at + 4, 4 + size)), number_at(bytes, at + 8 + size));
        at += 12 + size;
    }
    EXPECT_EQ(at, bytes.size());
    EXPECT_EQ(names, "IHDR IDAT IEND ");
    EXPECT_EQ(number_at(bytes, 16), 33u);
    EXPECT_EQ(number_at(bytes, 20), 20u);
    EXPECT_EQ(bytes.substr(24, 5), std::string("\x08\x02\0\0\0", 5));
    EXPECT_EQ(encode_png("a.png", picture(33, 20, 3), true).substr(24, 5), std::string("\x08\x06\0\0\0", 5));
}

TEST_F(Png, StbReadsEveryPixelOfEverySize) {
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {1u, 9u}, {9u, 1u}, {2u, 2u}, {15u, 17u}, {64u, 3u}, {333u, 70u}})
        for (const bool alpha : {false, true})
            for (const Image8& image : {noise(width, height), picture(width, height, 2)}) {
                write_png(folder / "a.png", image, alpha);
                const Image8 read = read_ldr(folder / "a.png");
                ASSERT_EQ(read.width, width);
                ASSERT_EQ(read.height, height);
                for (size_t i = 0; i < image.pixels.size(); i++)
                    ASSERT_EQ(read.pixels[i], alpha ? image.pixels[i] : image.pixels[i] | 0xff000000u) << i;
            }
}

/// It checks sums, too, which stb does not.
TEST_F(Png, FfmpegReadsThemToo) {
    if (std::system("command -v ffmpeg > /dev/null") != 0) GTEST_SKIP() << "there is no ffmpeg: apt-get install ffmpeg";
    for (const Image8& image : {noise(61, 40), picture(200, 33, 4)}) {
        write_png(folder / "a.png", image, true);
        const std::string line = "ffmpeg -hide_banner -loglevel error -xerror -err_detect crccheck -i '" +
                                 (folder / "a.png").string() + "' -f rawvideo -pix_fmt rgba - > '" +
                                 (folder / "raw").string() + "' 2> '" + (folder / "said").string() + "'";
        ASSERT_EQ(std::system(line.c_str()), 0) << get(folder / "said");
        EXPECT_EQ(get(folder / "said"), "");
        EXPECT_TRUE(get(folder / "raw") ==
                    std::string(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size() * 4));
    }
}

TEST_F(Png, FilesAreNoLargerThanStbMakesThem) {
    const Image8 lines = [] {
        Image8 image{300, 200, {}};
        for (uint32_t i = 0; i < 300 * 200; i++)
            image.pixels.push_back(i % 300 % 17 < 2 || i / 300 % 23 < 2 ? 0xff204060 : 0xffffffff);
        return image;
    }();
    for (const Image8& image :
         {picture(640, 512, 0), picture(640, 512, 3), picture(640, 512, 24), noise(300, 200), lines}) {
        std::vector<uint8_t> packed;
        for (const uint32_t pixel : image.pixels)
            for (int c = 0; c < 3; c++) packed.push_back(uint8_t(pixel >> (8 * c)));
        std::string stb;
        ASSERT_TRUE(stbi_write_png_to_func(
            [](void* out, void* data, int size) {
                static_cast<std::string*>(out)->append(static_cast<const char*>(data), size_t(size));
            },
            &stb, int(image.width), int(image.height), 3, packed.data(), int(image.width) * 3));
        EXPECT_LE(double(encode_png("a.png", image).size()), 1.1 * double(stb.size()));
    }
}

TEST_F(Png, TheSamePixelsMakeTheSameBytes) {
    const Image8 image = picture(120, 80, 5);
    const std::string first = encode_png("a.png", image);
    for (int i = 0; i < 3; i++) EXPECT_TRUE(encode_png("b.png", image) == first);
    Image8 other = image;
    for (uint32_t& pixel : other.pixels) pixel &= 0xffffff;
    EXPECT_TRUE(encode_png("a.png", other) == first) << "without alpha, alpha has no effect";
}

}  // namespace
}  // namespace peelray
