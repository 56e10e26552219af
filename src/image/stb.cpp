// PNG, JPEG and the like in, Radiance out, through stb. Static: libtinygltf carries a copy of its own.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS (1 << 16)
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "base/error.h"
#include "image/codecs.h"

namespace peelray {
namespace {

/// A JPEG's entropy-coded data must reach its end marker: stb takes what is missing for grey.
bool jpeg_is_whole(std::string_view bytes) {
    size_t at = 2;
    while (at + 4 <= bytes.size()) {
        if (uint8_t(bytes[at]) != 0xff) return true;  // not as expected: left to stb
        const uint8_t marker = uint8_t(bytes[at + 1]);
        if (marker == 0xff) {  // a fill byte
            ++at;
            continue;
        }
        if (marker == 0xda) return bytes.find("\xff\xd9", at) != std::string_view::npos;
        at += 2 + (size_t(uint8_t(bytes[at + 2])) << 8 | uint8_t(bytes[at + 3]));
    }
    return false;
}

/// stb calls a PNG whose header claims too much "unknown"; the user should see the size.
void check_png_size(const std::filesystem::path& path, std::string_view bytes) {
    if (!bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.size() < 24) return;
    int64_t sides[2] = {0, 0};
    for (size_t i = 0; i < 8; ++i) sides[i / 4] = sides[i / 4] << 8 | uint8_t(bytes[16 + i]);
    check_size("read", path, sides[0], sides[1]);
}

void append(void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), size_t(size));
}

}  // namespace

Image8 read_ldr(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    if (bytes.size() > size_t(std::numeric_limits<int>::max()))
        fail("cannot read {}: {} bytes are too many for an image; at most 2 GiB are supported", path.string(),
             bytes.size());
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = int(bytes.size());
    int width = 0, height = 0, components = 0;
    check_png_size(path, bytes);
    if (!stbi_info_from_memory(data, size, &width, &height, &components))
        fail("cannot read {}: not a PNG, JPEG or other 8-bit image, or broken ({}); save it as PNG", path.string(),
             stbi_failure_reason());
    check_size("read", path, width, height);
    if (bytes.starts_with("\xff\xd8") && !jpeg_is_whole(bytes))
        fail("cannot read {}: the JPEG is truncated; save it again", path.string());
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &components, 4), stbi_image_free);
    if (!pixels) fail("cannot read {}: broken image ({}); save it again", path.string(), stbi_failure_reason());
    Image8 image{uint32_t(width), uint32_t(height), {}};
    image.pixels.resize(size_t(width) * size_t(height));
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * 4);
    return image;
}

std::string encode_radiance(const ImageView& image) {
    std::vector<float> packed;
    packed.reserve(image.pixels.size() * 3);
    // RGBE knows no sign and no infinity; 1e38 is safely below its largest exponent. NaN fails the comparison.
    for (const glm::vec4& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) packed.push_back(pixel[c] > 0 ? std::min(pixel[c], 1e38f) : 0.0f);
    std::string bytes;
    const int written = stbi_write_hdr_to_func(append, &bytes, int(image.width), int(image.height), 3, packed.data());
    return written ? bytes : std::string();
}

}  // namespace peelray
