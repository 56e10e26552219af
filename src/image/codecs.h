// What the image files share: limits, whole files in memory, one function per format. Private to src/image.
#pragma once

#include <string>
#include <string_view>

#include "image/image.h"

namespace peelray {

/// Larger images are refused before anything is allocated: a broken header must not take the machine's memory.
inline constexpr uint32_t max_side = 1u << 16;
inline constexpr uint64_t max_pixels = uint64_t(1) << 28;

/// Largest finite half; what an infinite pixel becomes.
inline constexpr float max_half = 65504.0f;

/// Throws Error if no image of this size can exist (zero, negative or beyond the limits); `doing` is "read" or "write".
void check_size(std::string_view doing, const std::filesystem::path& path, int64_t width, int64_t height);

/// All bytes of a file or pipe. Throws Error (with the system's reason) if it cannot be read or is empty.
std::string read_file(const std::filesystem::path& path);

/// The next bytes of a file, which last until the next call; none: it has ended.
using NextPart = std::function<std::string_view()>;
/// store_file() of what need not be in memory as a whole; `size`: bytes in all.
void store_parts(const std::filesystem::path& path, uint64_t size, const NextPart& next);

/// `note`: what was not understood, if anything.
Image decode_exr(const std::filesystem::path& path, std::string_view bytes, std::string& note);
Image decode_radiance(const std::filesystem::path& path, std::string_view bytes);
std::string encode_radiance(const ImageView& image);

}  // namespace peelray
