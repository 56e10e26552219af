// Radiance and OpenEXR: what we write, what others write, and what is broken.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <fmt/core.h>

#include <cstring>
#include <limits>

#include "image/image.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using Hdr = TempFolder;

constexpr float infinite = std::numeric_limits<float>::infinity();
const float nan = std::numeric_limits<float>::quiet_NaN();

Image hdr_pattern(uint32_t width, uint32_t height) {
    Image image{width, height, {}};
    for (uint32_t i = 0; i < width * height; ++i)
        image.pixels.emplace_back(float(i) * 0.37f, 1e-3f * float(i % 13), 1000.0f / float(i + 1), 1);
    return image;
}

void expect_close(const Image& a, const Image& b, float relative) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        // RGBE shares one exponent, so the error is relative to the largest component.
        const float scale = std::max({a.pixels[i].x, a.pixels[i].y, a.pixels[i].z});
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(a.pixels[i][c], b.pixels[i][c], relative * scale + 1e-7f) << i << " " << c;
    }
}

/// Writes float channels with any windows, scan lines or tiles.
void write_exr(const std::filesystem::path& path, const Imath::Box2i& display, const Imath::Box2i& window,
               const std::vector<std::string>& names, const std::vector<std::vector<float>>& channels, bool tiled,
               Imf::Compression compression) {
    Imf::Header header(display, window);
    header.compression() = compression;
    Imf::FrameBuffer buffer;
    const size_t width = size_t(window.max.x - window.min.x + 1);
    for (size_t i = 0; i < names.size(); ++i) {
        header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
        buffer.insert(names[i], Imf::Slice::Make(Imf::FLOAT, channels[i].data(), window, 4, 4 * width));
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        for (int level = 0; level < file.numLevels(); ++level)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(window.max.y - window.min.y + 1);
    }
}

TEST_F(Hdr, RadianceKeepsEightBits) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 3u}, {8u, 1u}, {300u, 5u}}) {
        const Image image = hdr_pattern(width, height);
        write_hdr(folder / "a.hdr", image);
        expect_close(image, read_hdr(folder / "a.hdr"), 1 / 128.0f);
    }
}

TEST_F(Hdr, ExrFloatIsExactAndHalfNearlySo) {
    Image image = hdr_pattern(31, 9);
    write_hdr(folder / "half.EXR", image);
    expect_close(image, read_hdr(folder / "half.EXR"), 1 / 2048.0f);
    image.at(3, 4) = {1e30f, 1e-30f, 70000, 0.25f};
    write_hdr(folder / "full.exr", image, {.half = false});
    EXPECT_EQ(read_hdr(folder / "full.exr").pixels, image.pixels);
    EXPECT_EQ(files(), 2u);
}

TEST_F(Hdr, HalfClampsInsteadOfOverflowing) {
    Image image{4, 1, {{65504, 65519, 65520, 0}, {1e30f, infinite, -1e30f, 1}, {0, -0.0f, 1e-9f, 1}, {1, 2, 3, 0.5f}}};
    write_hdr(folder / "a.exr", image);
    const Image read = read_hdr(folder / "a.exr");
    EXPECT_EQ(read.pixels[0], glm::vec4(65504, 65504, 65504, 0));
    EXPECT_EQ(read.pixels[1], glm::vec4(65504, 65504, 0, 1));
    EXPECT_EQ(read.pixels[3], glm::vec4(1, 2, 3, 0.5f));
}

TEST_F(Hdr, RadianceTakesNoNonsense) {
    write_hdr(folder / "a.hdr", Image{3, 1, {{nan, -1, 2, 1}, {infinite, 1, 1, 1}, {3e38f, 0, 0, 1}}});
    const Image read = read_hdr(folder / "a.hdr");
    EXPECT_NEAR(read.pixels[0].z, 2, 0.02f);
    EXPECT_EQ(read.pixels[0].x, 0);
    EXPECT_NEAR(read.pixels[1].x, 1e38f, 1e36f);
    EXPECT_NEAR(read.pixels[2].x, 1e38f, 1e36f);
}

TEST_F(Hdr, ReadingSanitises) {
    write_hdr(folder / "a.exr", Image{2, 1, {{nan, infinite, -infinite, nan}, {-1, 5, 1e30f, 1}}}, {.half = false});
    const Image read = read_hdr(folder / "a.exr");
    EXPECT_EQ(read.pixels[0], glm::vec4(0, 65504, 0, 0));
    EXPECT_EQ(read.pixels[1], glm::vec4(0, 5, 1e30f, 1));
}

TEST_F(Hdr, ReadsExrWindowsTilesAndChannelNames) {
    const std::vector<float> a = {1, 2, 3, 4, 5, 6}, b = {7, 8, 9, 10, 11, 12}, c = {13, 14, 15, 16, 17, 18};
    for (const Imath::Box2i& window :
         {Imath::Box2i({0, 0}, {2, 1}), Imath::Box2i({-5, -7}, {-3, -6}), Imath::Box2i({1000, 5000}, {1002, 5001})})
        for (const bool tiled : {false, true})
            for (const Imf::Compression compression :
                 {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION}) {
                write_exr(folder / "rgb.exr", window, window, {"R", "G", "B", "Z"}, {a, b, c, a}, tiled, compression);
                const Image rgb = read_hdr(folder / "rgb.exr");
                ASSERT_EQ(rgb.width, 3u);
                ASSERT_EQ(rgb.height, 2u);
                EXPECT_EQ(rgb.at(1, 1), glm::vec4(5, 11, 17, 1));
                write_exr(folder / "layer.exr", window, window, {"l.R", "l.G", "l.B", "l.A"}, {a, b, c, b}, tiled,
                          compression);
                EXPECT_EQ(read_hdr(folder / "layer.exr").at(2, 0), glm::vec4(3, 9, 15, 9));
                write_exr(folder / "y.exr", window, window, {"Y", "A"}, {b, a}, tiled, compression);
                EXPECT_EQ(read_hdr(folder / "y.exr").at(0, 1), glm::vec4(10, 10, 10, 4));
                write_exr(folder / "z.exr", window, window, {"depth"}, {c}, tiled, compression);
                EXPECT_EQ(read_hdr(folder / "z.exr").at(2, 1), glm::vec4(18, 18, 18, 1));
            }
}

TEST_F(Hdr, ShowsTheDisplayWindowOfAnExr) {
    const std::vector<float> a = {1, 2, 3, 4, 5, 6}, b = {7, 8, 9, 10, 11, 12}, c = {13, 14, 15, 16, 17, 18};
    for (const bool tiled : {false, true}) {
        // Three by two pixels at (1, 2) of a window of five by five that begins at (-1, 0).
        write_exr(folder / "a.exr", {{-1, 0}, {3, 4}}, {{1, 2}, {3, 3}}, {"R", "G", "B"}, {a, b, c}, tiled,
                  Imf::ZIP_COMPRESSION);
        const Image pasted = read_hdr(folder / "a.exr");
        ASSERT_EQ(pasted.width, 5u);
        ASSERT_EQ(pasted.height, 5u);
        for (uint32_t y = 0; y < 5; ++y)
            for (uint32_t x = 0; x < 5; ++x) {
                const bool is_inside = x >= 2 && (y == 2 || y == 3);
                const size_t i = is_inside ? (y - 2) * 3 + x - 2 : 0;
                EXPECT_EQ(pasted.at(x, y), is_inside ? glm::vec4(a[i], b[i], c[i], 1) : glm::vec4(0, 0, 0, 1));
            }
        // Only the last pixel is in a window of one by three.
        write_exr(folder / "b.exr", {{-3, -6}, {-3, -4}}, {{-5, -7}, {-3, -6}}, {"R", "G", "B", "A"}, {a, b, c, a},
                  tiled, Imf::PIZ_COMPRESSION);
        const Image cut = read_hdr(folder / "b.exr");
        ASSERT_EQ(cut.width, 1u);
        ASSERT_EQ(cut.height, 3u);
        EXPECT_EQ(cut.at(0, 0), glm::vec4(6, 12, 18, 6));
        EXPECT_EQ(cut.at(0, 1), glm::vec4(0));
        EXPECT_EQ(cut.at(0, 2), glm::vec4(0));
        write_exr(folder / "c.exr", {{0, 0}, {9, 9}}, {{10, 0}, {12, 1}}, {"Y"}, {a}, tiled, Imf::ZIP_COMPRESSION);
        expect_error([&] { read_hdr(folder / "c.exr"); }, "display window");
        write_exr(folder / "d.exr", {{0, 0}, {99999, 99999}}, {{0, 0}, {2, 1}}, {"Y"}, {a}, tiled,
                  Imf::ZIP_COMPRESSION);
        expect_error([&] { read_hdr(folder / "d.exr"); }, "cannot read");
    }
}

TEST_F(Hdr, ReadsHalvesIntegersAndLaterParts) {
    const Imath::Box2i window({0, 0}, {1, 0});
    const std::vector<Imath::half> red = {Imath::half(0.5f), Imath::half(2)};
    const std::vector<unsigned> green = {3, 70000};
    const std::vector<float> blue = {0.25f, 1e6f};
    Imf::Header header(window, window);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.channels().insert("G", Imf::Channel(Imf::UINT));
    header.channels().insert("B", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::HALF, red.data(), window, 2, 4));
    buffer.insert("G", Imf::Slice::Make(Imf::UINT, green.data(), window, 4, 8));
    buffer.insert("B", Imf::Slice::Make(Imf::FLOAT, blue.data(), window, 4, 8));
    {
        Imf::OutputFile file((folder / "mixed.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(1);
    }
    const std::vector<glm::vec4> expected = {{0.5f, 3, 0.25f, 1}, {2, 70000, 1e6f, 1}};
    EXPECT_EQ(read_hdr(folder / "mixed.exr").pixels, expected);
    {
        Imf::Header first(window, window);
        first.setName("deep");
        first.setType(Imf::DEEPSCANLINE);
        first.compression() = Imf::ZIPS_COMPRESSION;
        first.channels().insert("R", Imf::Channel(Imf::FLOAT));
        header.setName("flat");
        header.setType(Imf::SCANLINEIMAGE);
        const Imf::Header parts[] = {first, header};
        Imf::MultiPartOutputFile file((folder / "parts.exr").c_str(), parts, 2);
        unsigned counts[2] = {0, 0};
        float* samples[2] = {nullptr, nullptr};
        Imf::DeepFrameBuffer deep;
        deep.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), 4, 8));
        deep.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples), sizeof(float*), 16, 4));
        Imf::DeepScanLineOutputPart nothing(file, 0);
        nothing.setFrameBuffer(deep);
        nothing.writePixels(1);
        Imf::OutputPart flat(file, 1);
        flat.setFrameBuffer(buffer);
        flat.writePixels(1);
    }
    EXPECT_EQ(read_hdr(folder / "parts.exr").pixels, expected);
}

TEST_F(Hdr, ReadsLuminanceAndChroma) {
    constexpr int size = 32;
    const std::vector<Imf::Rgba> pixels(size * size, Imf::Rgba(0.25f, 0.5f, 0.75f));
    {
        Imf::RgbaOutputFile file((folder / "yc.exr").c_str(), size, size, Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, size);
        file.writePixels(size);
    }
    const Image read = read_hdr(folder / "yc.exr");
    ASSERT_EQ(read.pixels.size(), pixels.size());
    for (const glm::vec4& pixel : read.pixels) {
        EXPECT_NEAR(pixel.x, 0.25f, 0.01f);
        EXPECT_NEAR(pixel.y, 0.5f, 0.01f);
        EXPECT_NEAR(pixel.z, 0.75f, 0.01f);
        EXPECT_EQ(pixel.w, 1);
    }
}

/// A picture of one pixel, of which the file says which colours its channels are.
std::string with_primaries(const std::filesystem::path& path, const Imf::Chromaticities& primaries,
                           const glm::vec3& color) {
    Imf::Header header(1, 1);
    Imf::addChromaticities(header, primaries);
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; ++c) {
        const char* name[] = {"R", "G", "B"};
        header.channels().insert(name[c], Imf::Channel(Imf::FLOAT));
        buffer.insert(name[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(&color[c])), 4, 4));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(1);
    return path;
}

TEST_F(Hdr, ConvertsOtherPrimariesOfAnExr) {
    using Imath::V2f;
    const V2f red(0.64f, 0.33f), green(0.3f, 0.6f), blue(0.15f, 0.06f), white(0.3127f, 0.329f);
    const auto read = [&](const Imf::Chromaticities& primaries, const glm::vec3& color) {
        return glm::vec3(read_hdr(with_primaries(folder / "p.exr", primaries, color)).pixels[0]);
    };
    const auto expect = [](const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
        EXPECT_LT(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
    };
    // Its own: to the bit.
    EXPECT_EQ(read({red, green, blue, white}, {0.1f, 0.7f, 3}), glm::vec3(0.1f, 0.7f, 3));
    // The same in another order.
    expect(read({green, blue, red, white}, {1, 0, 0}), {0, 1, 0});
    expect(read({green, blue, red, white}, {0.25f, 2, 0.5f}), {0.5f, 0.25f, 2});
    // White is white, whatever the file's is; ACES has (0.32168, 0.33767).
    const Imf::Chromaticities aces({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});
    expect(read(aces, {1, 1, 1}), {1, 1, 1});
    // From there to Rec. 709 with Bradford's adaptation, as ACES publishes it (ACES2065-1 to linear BT.709). By
    // CAT02, another usual adaptation, it would be 5e-4 away.
    expect(read(aces, {0.5f, 0.25f, 0.125f}), {0.92887f, 0.19291f, 0.10011f}, 2e-4f);
    // What makes no colours is left alone, with a note.
    for (const Imf::Chromaticities& bad :
         {Imf::Chromaticities(red, red, red, white), Imf::Chromaticities(red, green, V2f(nan, 0), white),
          Imf::Chromaticities(red, green, blue, V2f(0, 0))}) {
        std::string note;
        const auto file = with_primaries(folder / "bad.exr", bad, {1, 2, 3});
        EXPECT_EQ(glm::vec3(read_hdr(file, &note).pixels[0]), glm::vec3(1, 2, 3));
        EXPECT_NE(note.find("bad.exr: its primaries"), std::string::npos) << note;
    }
}

TEST_F(Hdr, RefusesDeepAndColourlessExrs) {
    const std::vector<float> a = {1, 2};
    const Imath::Box2i window({0, 0}, {1, 0});
    write_exr(folder / "a.exr", window, window, {"N.x", "N.y"}, {a, a}, false, Imf::ZIP_COMPRESSION);
    expect_error([&] { read_hdr(folder / "a.exr"); }, "N.x, N.y");
    write_exr(folder / "xyz.exr", window, window, {"X", "Y", "Z"}, {a, a, a}, false, Imf::ZIP_COMPRESSION);
    expect_error([&] { read_hdr(folder / "xyz.exr"); }, "CIE X, Y, Z");
    Imf::Header header(1, 1);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    {
        float sample = 1;
        float* samples = &sample;
        unsigned count = 1;
        Imf::DeepScanLineOutputFile file((folder / "deep.exr").c_str(), header);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(&count), 4, 4));
        buffer.insert("R",
                      Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(&samples), sizeof samples, sizeof samples, 4));
        file.setFrameBuffer(buffer);
        file.writePixels(1);
    }
    expect_error([&] { read_hdr(folder / "deep.exr"); }, "deep");
}

TEST_F(Hdr, RefusesWhatIsNeitherFormat) {
    expect_error([&] { read_hdr(folder / "none.exr"); }, "No such file");
    expect_error([&] { read_hdr(folder); }, "Is a directory");
    expect_error([&] { read_hdr(put("a.exr", "")); }, "empty");
    expect_error([&] { read_hdr(put("a.exr", "\x89PNG\r\n")); }, "neither");
    expect_error([&] { write_hdr(folder / "a.png", hdr_pattern(1, 1)); }, "'.png'");
    expect_error([&] { write_hdr(folder / "a.exr", Image{}); }, "empty");
    expect_error([&] { write_hdr("/proc/no/a.hdr", hdr_pattern(1, 1)); }, "/proc/no");
}

TEST_F(Hdr, RefusesTruncatedFiles) {
    for (const char* name : {"a.exr", "a.hdr"}) {
        write_hdr(folder / name, hdr_pattern(50, 20));
        const std::string whole = get(folder / name);
        for (size_t length = 1; length < whole.size(); length += length < 600 ? 7 : 101)
            expect_error([&] { read_hdr(put("cut", whole.substr(0, length))); }, "cannot read");
        expect_error([&] { read_hdr(put("cut", whole.substr(0, whole.size() - 1))); }, "cannot read");
    }
}

TEST_F(Hdr, SurvivesFlippedBytes) {
    for (const char* name : {"a.exr", "a.hdr"}) {
        write_hdr(folder / name, hdr_pattern(16, 16));
        const std::string whole = get(folder / name);
        for (size_t i = 0; i < whole.size(); ++i) {
            std::string bytes = whole;
            bytes[i] = char(bytes[i] ^ (1 + i * 37 % 255));
            try {
                read_hdr(put("flipped", bytes));
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
}

TEST_F(Hdr, RefusesHugeSizesBeforeReadingThem) {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 65536 +X 65536\n")); }, "65536 x 65536");
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 1 +X 99999999999\n")); }, "99999999999 x 1");
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 1 +X 99999999999999999999\n")); }, "size line");
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 0 +X 4\n")); }, "empty");
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 16384 +X 16384\n")); }, "row 1 of 16384");
    write_hdr(folder / "a.exr", hdr_pattern(4, 4));
    std::string exr = get(folder / "a.exr");
    const size_t window = exr.find("dataWindow") + 11 + 6 + 4;  // the name, the type "box2i", the size
    const int32_t corners[4] = {0, 0, 0x3fffff, 0x3fffff};
    std::memcpy(&exr[window], corners, sizeof corners);
    expect_error([&] { read_hdr(put("b.exr", exr)); }, "cannot read");
}

TEST_F(Hdr, ReadsRadianceByHand) {
    const std::string head = "#?RGBE\n# a comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n";
    const auto pixel = [](int r, int g, int b, int e) { return std::string{char(r), char(g), char(b), char(e)}; };
    const Image flat = read_hdr(put("a.hdr", head + "-Y 1 +X 3\n" + pixel(128, 64, 0, 129) + pixel(1, 1, 1, 2)));
    EXPECT_EQ(flat.pixels, std::vector<glm::vec4>(3, {0.5f, 0.25f, 0, 1}));  // half of it: EXPOSURE
    std::string runs = pixel(2, 2, 0, 9);
    for (const int value : {128, 64, 32, 130}) runs += pixel(128 + 8, value, 1, value);
    const Image coded = read_hdr(put("a.hdr", head + "-Y 1 +X 9\r\n" + runs));
    EXPECT_EQ(coded.pixels, std::vector<glm::vec4>(9, {1, 0.5f, 0.25f, 1}));
    std::string zero_run = runs;
    zero_run[6] = 0;
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 1 +X 9\n" + zero_run)); }, "illegal length");
    expect_error([&] { read_hdr(put("a.hdr", head + "-Y 1 +X 3\n" + pixel(1, 1, 1, 2))); }, "illegal length");
    for (const char* size : {"+X 3 -X 1\n", "-Y 1\n", "-Y one +X 3\n", "Y 1 X 3\n", "-Z 1 +X 3\n"})
        expect_error([&] { read_hdr(put("a.hdr", head + size)); }, "size line");
    expect_error([&] { read_hdr(put("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_luv\n\n-Y 1 +X 1\n")); }, "luv");
    for (const char* line : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n", "EXPOSURE=\n", "COLORCORR=1 2\n"})
        expect_error([&] { read_hdr(put("a.hdr", std::string("#?RADIANCE\n") + line + "\n-Y 1 +X 1\n\1\1\1\1")); },
                     "factor");
}

TEST_F(Hdr, ReadsAllOrientationsOfRadiancePictures) {
    // A picture of three by two whose red says which pixel it is; 9 by 8 has runs in rows and in columns.
    for (const auto& [width, height] : {std::pair{3u, 2u}, {9u, 8u}})
        for (int kind = 0; kind < 8; ++kind) {
            const bool by_columns = kind & 1, mirrored = kind & 2, upside_down = kind & 4;
            const std::string x = fmt::format("{}X {}", mirrored ? '-' : '+', width),
                              y = fmt::format("{}Y {}", upside_down ? '+' : '-', height);
            std::string bytes =
                "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + (by_columns ? x + " " + y : y + " " + x) + "\n";
            const uint32_t rows = by_columns ? width : height, length = by_columns ? height : width;
            for (uint32_t row = 0; row < rows; ++row) {
                std::string reds;
                for (uint32_t i = 0; i < length; ++i) {
                    const uint32_t fx = by_columns ? row : i, fy = by_columns ? i : row;
                    const uint32_t px = mirrored ? width - 1 - fx : fx, py = upside_down ? height - 1 - fy : fy;
                    reds += char(py * width + px + 1);
                }
                if (length < 8) {
                    for (const char red : reds) bytes += std::string{red, 0, 0, char(136)};
                } else {
                    bytes += std::string{2, 2, 0, char(length), char(length)} + reds;
                    for (const int value : {0, 0, 136}) bytes += std::string{char(128 + length), char(value)};
                }
            }
            const Image image = read_hdr(put("a.hdr", bytes));
            ASSERT_EQ(image.width, width) << kind;
            ASSERT_EQ(image.height, height) << kind;
            for (uint32_t i = 0; i < width * height; ++i) EXPECT_EQ(image.pixels[i].x, float(i + 1)) << kind;
        }
}

TEST_F(Hdr, ReadsXyzAndDividesFactorsOut) {
    // 0.9505, 1, 1.0890 is white; the mantissas are 121.7, 128, 139.4 of 128.
    const std::string pixel{122, char(128), char(139), char(129)};
    const Image white = read_hdr(put("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + pixel));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white.pixels[0][c], 1, 0.02f) << c;
    // A red of Rec. 709: 0.4124, 0.2126, 0.0193.
    const std::string red{106, 54, 5, char(128)};
    const Image pure = read_hdr(put("b.hdr", "#?RADIANCE\nFORMAT= 32-bit_rle_xyze\n\n-Y 1 +X 1\n" + red));
    EXPECT_NEAR(pure.pixels[0].x, 1, 0.02f);
    EXPECT_NEAR(pure.pixels[0].y, 0, 0.02f);
    EXPECT_NEAR(pure.pixels[0].z, 0, 0.02f);
    const std::string grey{char(128), char(128), char(128), char(131)};
    const Image divided = read_hdr(
        put("c.hdr", "#?RADIANCE\nEXPOSURE=2\nEXPOSURE= 0.5\nCOLORCORR= 1 2 4\nEXPOSURE=4\n\n-Y 1 +X 1\n" + grey));
    EXPECT_EQ(divided.pixels[0], glm::vec4(1, 0.5f, 0.25f, 1));
}

TEST_F(Hdr, WritesFloatChannels) {
    const float depths[] = {1, 2, infinite, 4, 5, 1e30f}, pairs[] = {9, 0, 9, 1, 9, 2, 9, 3, 9, 4, 9, 16777215};
    write_exr_channels(folder / "aov.exr", 3, 2, {{"Z", depths}, {"id", pairs + 1, 2}});
    Imf::InputFile file((folder / "aov.exr").c_str());
    ASSERT_NE(file.header().channels().findChannel("Z"), nullptr);
    EXPECT_EQ(file.header().channels().findChannel("id")->type, Imf::FLOAT);
    std::vector<float> z(6), id(6);
    Imf::FrameBuffer buffer;
    buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, z.data(), file.header().dataWindow(), 4, 12));
    buffer.insert("id", Imf::Slice::Make(Imf::FLOAT, id.data(), file.header().dataWindow(), 4, 12));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 1);
    EXPECT_EQ(z, (std::vector<float>{1, 2, infinite, 4, 5, 1e30f}));
    EXPECT_EQ(id[5], 16777215);
    expect_error([&] { write_exr_channels(folder / "b.exr", 0, 2, {{"Z", depths}}); }, "empty");
    expect_error([&] { write_exr_channels("/proc/b.exr", 1, 1, {{"Z", depths}}); }, "/proc/b.exr");
    EXPECT_EQ(files(), 1u);
}

TEST_F(Hdr, ReadsOtherPeoplesFiles) {
    const std::filesystem::path env = std::filesystem::path(PEELRAY_MODELS) / "env";
    if (!std::filesystem::exists(env)) GTEST_SKIP() << env << " is not here";
    const Image radiance = read_hdr(env / "spiaggia_di_mondello_1k.hdr");
    EXPECT_EQ(radiance.width, 2 * radiance.height);
    EXPECT_GT(read_hdr(env / "exr-hdr.exr").pixels.size(), 0u);
}

}  // namespace
}  // namespace peelray
