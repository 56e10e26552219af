#include "loaders/webp.h"

#include <webp/decode.h>

#include <cstring>
#include <memory>

#include "base/error.h"
#include "loaders/images.h"

namespace peelray {

bool is_webp(std::span<const uint8_t> bytes) {
    return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
           std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

void check_webp(std::span<const uint8_t> bytes, const std::string& where) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
        fail("{}: the WebP image's {} bytes are damaged or cut; repair or re-export it", where, bytes.size());
    if (features.has_animation)
        fail("{}: the WebP image is an animation, of which none is read; replace it by a still one", where);
}

Texture decode_webp(std::span<const uint8_t> bytes, const std::string& where) {
    check_webp(bytes, where);
    int width = 0, height = 0;
    const std::unique_ptr<uint8_t, decltype(&WebPFree)> pixels(
        WebPDecodeRGBA(bytes.data(), bytes.size(), &width, &height), &WebPFree);
    if (!pixels) fail("{}: the WebP image's {} bytes are damaged or cut; repair or re-export it", where, bytes.size());
    return texture_of(pixels.get(), width, height);
}

}  // namespace peelray
