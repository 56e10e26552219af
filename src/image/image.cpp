// HDR images: which format, and what a pixel may be.
#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "image/codecs.h"

namespace peelray {
namespace {

/// More than the sun's, in any unit; below it no sum of texels leaves single precision.
constexpr float kMostRadiance = 1e12f;

constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";

/// NaN and negative radiance would spread through every bounce and filter; infinity becomes the largest half.
float sanitised(float value) {
    if (!(value > 0)) return 0;
    return std::isinf(value) ? max_half : value;
}

/// Sets to 0 what cannot be radiance: channels below 0, and texels with one that is infinite, NaN, or so large that
/// sums would be. Returns how many texels had any.
size_t darken_faults(Image& image) {
    size_t count = 0;
    for (glm::vec4& texel : image.pixels) {
        const glm::vec3 color(texel);
        bool finite = true, positive = true;
        for (int c = 0; c < 3; ++c) {
            finite &= std::abs(color[c]) <= kMostRadiance;  // false for NaN
            positive &= color[c] >= 0;
        }
        count += !finite || !positive;
        texel = glm::vec4(finite ? glm::max(color, glm::vec3(0)) : glm::vec3(0), 1);
    }
    return count;
}

/// Means of four texels each, in place; an odd last row or column is left out.
void halve(Image& image) {
    const uint32_t width = std::max(image.width / 2, 1u), height = std::max(image.height / 2, 1u);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t right = std::min(2 * x + 1, image.width - 1), below = std::min(2 * y + 1, image.height - 1);
            const glm::vec4 mean = 0.25f * (image.at(2 * x, 2 * y) + image.at(right, 2 * y) + image.at(2 * x, below) +
                                            image.at(right, below));
            image.pixels[size_t(y) * width + x] = mean;  // which lies before all that is still to be read
        }
    image.width = width;
    image.height = height;
    image.pixels.resize(size_t(width) * height);
    image.pixels.shrink_to_fit();
}

}  // namespace

/// As it is in the file; `note`: what was not understood, if anything.
static Image decode(const std::filesystem::path& path, std::string& note) {
    const std::string bytes = read_file(path);
    if (bytes.starts_with(exr_magic)) return decode_exr(path, bytes, note);
    if (bytes.starts_with("#?")) return decode_radiance(path, bytes);
    fail("cannot read {}: neither Radiance (.hdr) nor OpenEXR (.exr); convert it to one of them", path.string());
}

Image read_hdr(const std::filesystem::path& path, std::string* note) {
    std::string text;
    Image image = decode(path, text);
    if (note) *note = text;
    for (glm::vec4& pixel : image.pixels)
        for (int c = 0; c < 4; ++c) pixel[c] = sanitised(pixel[c]);
    return image;
}

Image read_environment(const std::filesystem::path& path, std::vector<std::string>& notes) {
    std::string text;
    Image image = decode(path, text);
    if (!text.empty()) notes.push_back(text);
    if (const size_t count = darken_faults(image))
        notes.push_back(fmt::format("{}: {} negative, infinite or not a number: what is wrong of {} counts as 0",
                                    path.filename().string(), counted("{} texel{ is|s are}", count),
                                    count == 1 ? "it" : "them"));
    const uint32_t width = image.width, height = image.height;
    while (image.width > kWidestEnvironment || image.height > kWidestEnvironment) halve(image);
    if (image.width != width || image.height != height)
        notes.push_back(fmt::format("{}: its {}x{} texels are reduced to {}x{}", path.filename().string(), width,
                                    height, image.width, image.height));
    return image;
}

size_t write_hdr(const std::filesystem::path& path, const ImageView& image, const ExrFormat& format) {
    const std::string extension = lower_extension(path);
    if (extension == ".exr") return write_exr_layers(path, image, {}, format);
    check_size("write", path, image.width, image.height);
    assert(image.pixels.size() == size_t(image.width) * image.height);
    if (extension != ".hdr")
        fail("cannot write {}: the extension '{}' is neither .exr nor .hdr; choose one of them", path.string(),
             extension);
    store_file(path, encode_radiance(image));
    return 0;
}

}  // namespace peelray
