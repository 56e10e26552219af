// Decodes WebP images, by libwebp.
#pragma once

#include <span>
#include <string>

#include "scene/scene.h"

namespace peelray {

bool is_webp(std::span<const uint8_t> bytes);

/// Checks the image's headers without decoding the pixels. Throws Error, prefixed with `where`, for what is damaged or
/// an animation.
void check_webp(std::span<const uint8_t> bytes, const std::string& where);

/// Fills size and texels. Throws Error as check_webp() does, also for an image that is cut.
Texture decode_webp(std::span<const uint8_t> bytes, const std::string& where);

}  // namespace peelray
