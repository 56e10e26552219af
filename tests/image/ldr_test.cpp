// PNG and what else stb reads.
#include "image/image.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using Ldr = TempFolder;

Image8 ldr_pattern(uint32_t width, uint32_t height) {
    Image8 image{width, height, {}};
    for (uint32_t i = 0; i < width * height; ++i) image.pixels.push_back(i * 2654435761u);
    return image;
}

TEST_F(Ldr, PngKeepsEveryByte) {
    const Image8 image = ldr_pattern(17, 5);
    write_png(folder / "a.png", image, true);
    const Image8 with = read_ldr(folder / "a.png");
    ASSERT_EQ(with.width, 17u);
    ASSERT_EQ(with.height, 5u);
    EXPECT_EQ(with.pixels, image.pixels);
    write_png(folder / "b.png", image);
    const Image8 without = read_ldr(folder / "b.png");
    ASSERT_EQ(without.pixels.size(), image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); ++i) EXPECT_EQ(without.pixels[i], image.pixels[i] | 0xff000000u);
    EXPECT_EQ(files(), 2u);
}

TEST_F(Ldr, RefusesWhatIsNoImage) {
    expect_error([&] { read_ldr(folder / "none.png"); }, "No such file");
    expect_error([&] { read_ldr(folder); }, "Is a directory");
    expect_error([&] { read_ldr(put("a.png", "")); }, "empty");
    expect_error([&] { read_ldr(put("a.png", "this is a text, not an image at all")); }, "not a PNG");
    expect_error([&] { read_ldr(put("a.png", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd")); }, "not a PNG");
}

TEST_F(Ldr, RefusesTruncatedPngs) {
    write_png(folder / "a.png", ldr_pattern(40, 40));
    const std::string whole = get(folder / "a.png");
    for (size_t length = 1; length < whole.size() - 12; length += 37)
        EXPECT_THROW(read_ldr(put("b.png", whole.substr(0, length))), Error) << length;
}

TEST_F(Ldr, RefusesHugeSizesBeforeReadingThem) {
    write_png(folder / "a.png", ldr_pattern(4, 4));
    std::string bytes = get(folder / "a.png");
    const std::string huge("\x00\x00\xff\xff\x00\x00\xff\xff", 8);  // 65535 x 65535
    bytes.replace(16, 8, huge);
    expect_error([&] { read_ldr(put("b.png", bytes)); }, "65535 x 65535");
}

/// The smallest baseline JPEG that matters here: one grey 8 x 8 block of value 0 (mid-grey), with and without its end.
TEST_F(Ldr, RefusesATruncatedJpeg) {
    std::string jpeg("\xff\xd8\xff\xdb\x00\x43\x00", 7);
    jpeg.append(64, '\x01');
    jpeg += std::string("\xff\xc0\x00\x0b\x08\x00\x08\x00\x08\x01\x01\x11\x00", 13);
    for (const char* table : {"\x00", "\x10"}) {  // one code of one bit, for the value 0
        jpeg += std::string("\xff\xc4\x00\x14", 4) + std::string(table, 1) + '\x01' + std::string(15, '\0') + '\0';
    }
    jpeg += std::string("\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00", 10) + "\x3f";
    const Image8 image = read_ldr(put("a.jpg", jpeg + "\xff\xd9"));
    ASSERT_EQ(image.width, 8u);
    EXPECT_EQ(image.pixels[0], 0xff808080u);
    expect_error([&] { read_ldr(put("b.jpg", jpeg)); }, "truncated");
}

TEST_F(Ldr, WritersSayWhyTheyCannot) {
    expect_error([&] { write_png("/proc/no/a.png", ldr_pattern(2, 2)); }, "/proc/no");
    expect_error([&] { write_png("/proc/a.png", ldr_pattern(2, 2)); }, "/proc/a.png");
    expect_error([&] { write_png(folder / "a.png", Image8{}); }, "empty");
    EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace peelray
