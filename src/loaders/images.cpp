#include "loaders/images.h"

#include <climits>
#include <cstring>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "loaders/webp.h"

// The decoder is compiled into this file alone: no other module sees stb's names.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_PNM
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace peelray {

namespace {

[[noreturn]] void fail_image(const std::string& where, size_t size) {
    const char* reason = stbi_failure_reason();
    fail("{}: {} no PNG, JPEG or WebP image ({}); repair or re-export the image", where,
         counted("{} byte{|s} that {is|are}", size), reason ? reason : "unknown");
}

/// stb_image fills the missing part of a cut-off JPEG with grey; a whole one ends with EOI (FF D9) after its last SOS
/// (FF DA).
bool is_truncated_jpeg(std::span<const uint8_t> bytes) {
    if (bytes.size() < 4 || bytes[0] != 0xFF || bytes[1] != 0xD8) return false;
    for (size_t i = bytes.size() - 1; i > 1; --i)
        if (bytes[i - 1] == 0xFF && (bytes[i] == 0xD9 || bytes[i] == 0xDA)) return bytes[i] == 0xDA;
    return true;
}

}  // namespace

Texture texture_of(const void* pixels, int width, int height, bool deep) {
    Texture texture;
    texture.width = static_cast<uint32_t>(width);
    texture.height = static_cast<uint32_t>(height);
    const auto take = [&](auto& texels) {
        texels.resize(size_t(texture.width) * texture.height);
        std::memcpy(texels.data(), pixels, texels.size() * sizeof texels[0]);
    };
    deep ? take(texture.deep_texels) : take(texture.texels);
    return texture;
}

void check_image(std::span<const uint8_t> bytes, const std::string& where) {
    int width = 0, height = 0, channels = 0;
    if (bytes.empty()) fail("{}: the image is empty", where);
    if (bytes.size() > INT_MAX) fail("{}: the image has {} bytes, more than 2 GiB", where, bytes.size());
    if (is_webp(bytes)) return check_webp(bytes, where);
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels))
        fail_image(where, bytes.size());
    if (width <= 0 || height <= 0 || width > STBI_MAX_DIMENSIONS || height > STBI_MAX_DIMENSIONS)
        fail("{}: the image says it has {}x{} pixels; at most {} on a side are read", where, width, height,
             STBI_MAX_DIMENSIONS);
}

Texture decode_image(std::span<const uint8_t> bytes, const std::string& where, Depth depth) {
    if (is_webp(bytes)) return decode_webp(bytes, where);
    check_image(bytes, where);
    int width = 0, height = 0, channels = 0;
    const int size = static_cast<int>(bytes.size());
    const bool deep = depth == Depth::as_stored && stbi_is_16_bit_from_memory(bytes.data(), size);
    const std::unique_ptr<void, decltype(&stbi_image_free)> pixels(
        deep ? static_cast<void*>(stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, 4))
             : static_cast<void*>(stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4)),
        &stbi_image_free);
    if (!pixels) fail_image(where, bytes.size());
    if (is_truncated_jpeg(bytes))
        fail("{}: the JPEG image is truncated after {}; repair or re-export it", where,
             counted("{} byte{|s}", bytes.size()));
    return texture_of(pixels.get(), width, height, deep);
}

const char* foreign_image_type(std::span<const uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string_view second = text.size() < 12 ? "" : text.substr(4, 4), third = text.substr(0, 12);
    if (text.starts_with("\xABKTX 20")) return "KTX2";
    if (text.starts_with("\xABKTX 11")) return "KTX";
    if (second == "ftyp") return third.substr(8).starts_with("avi") ? "AVIF" : "HEIF";
    if (text.starts_with("DDS ")) return "DDS";
    if (text.starts_with("sB")) return "Basis";
    if (text.starts_with(std::string_view("II*\0", 4)) || text.starts_with(std::string_view("MM\0*", 4))) return "TIFF";
    if (text.starts_with("\x76\x2f\x31\x01")) return "OpenEXR";
    if (text.starts_with("#?")) return "Radiance";
    return text.starts_with("<svg") || text.starts_with("<?xml") ? "SVG" : nullptr;
}

}  // namespace peelray
