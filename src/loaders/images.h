// Decodes PNG, JPEG, WebP, BMP, TGA, GIF images to RGBA.
#pragma once

#include <span>
#include <string>

#include "scene/scene.h"

namespace peelray {

enum class Depth : uint8_t {
    eight,      ///< images of 16 bits a channel are reduced
    as_stored,  ///< those give Texture::deep_texels
};

/// A texture of decoded pixels: RGBA of eight bits a channel or, `deep`, of sixteen.
Texture texture_of(const void* pixels, int width, int height, bool deep = false);

/// Fills size and texels. Throws Error, prefixed with `where`, for bytes that are not such an image, for a truncated
/// one, and for a side of more than 16384 pixels.
Texture decode_image(std::span<const uint8_t> bytes, const std::string& where, Depth depth = Depth::eight);

/// Checks that the bytes begin like an image that decode_image reads, without decoding the pixels.
void check_image(std::span<const uint8_t> bytes, const std::string& where);

/// The type of an image that decode_image does not read, such as "KTX2" or "AVIF", by its first bytes; nullptr: none
/// that is known.
const char* foreign_image_type(std::span<const uint8_t> bytes);

}  // namespace peelray
