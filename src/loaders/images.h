// Decodes PNG, JPEG, WebP, BMP, TGA, GIF images to 8-bit RGBA.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "scene/scene.h"

namespace peelray {

/// Fills size and texels; 16-bit images are reduced to 8 bits. Throws Error, prefixed with `where`, for bytes that are
/// not such an image, for a truncated one, and for a side of more than 16384 pixels.
Texture decode_image(std::span<const uint8_t> bytes, const std::string& where);

/// Checks that the bytes begin like an image that decode_image reads, without decoding the pixels.
void check_image(std::span<const uint8_t> bytes, const std::string& where);

/// The type of an image that decode_image does not read, such as "KTX2" or "AVIF", by its first bytes; nullptr: none
/// that is known.
const char* foreign_image_type(std::span<const uint8_t> bytes);

/// The mean of all texels, channels in [0, 1] as stored (`linear`) or with red, green, blue decoded from sRGB.
glm::vec4 mean_texel(const Texture& texture, bool srgb);

}  // namespace peelray
