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

constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";

/// NaN and negative radiance would spread through every bounce and filter; infinity becomes the largest half.
float sanitised(float value) {
    if (!(value > 0)) return 0;
    return std::isinf(value) ? max_half : value;
}

}  // namespace

Image read_hdr(const std::filesystem::path& path, std::string* note) {
    const std::string bytes = read_file(path);
    std::string text;
    Image image;
    if (bytes.starts_with(exr_magic))
        image = decode_exr(path, bytes, text);
    else if (bytes.starts_with("#?"))
        image = decode_radiance(path, bytes);
    else
        fail("cannot read {}: neither Radiance (.hdr) nor OpenEXR (.exr); convert it to one of them", path.string());
    if (note) *note = text;
    for (glm::vec4& pixel : image.pixels)
        for (int c = 0; c < 4; ++c) pixel[c] = sanitised(pixel[c]);
    return image;
}

void write_hdr(const std::filesystem::path& path, const Image& image, bool full) {
    check_size("write", path, image.width, image.height);
    assert(image.pixels.size() == size_t(image.width) * image.height);
    const std::string extension = lower_extension(path);
    if (extension == ".exr") return store_file(path, encode_exr(path, image, full));
    if (extension == ".hdr") return store_file(path, encode_radiance(image));
    fail("cannot write {}: the extension '{}' is neither .exr nor .hdr; choose one of them", path.string(), extension);
}

}  // namespace peelray
