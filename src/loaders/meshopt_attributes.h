// Version 1 of meshoptimizer's attribute stream, which libmeshoptimizer 0.18 does not know.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "loaders/files.h"

namespace peelray {

/// count·stride bytes; nothing for a stream that is cut or damaged (KHR_meshopt_compression, appendix A, mode 0).
/// `stride`: a multiple of 4 up to 256.
std::optional<Bytes> decode_meshopt_attributes_1(std::span<const uint8_t> stream, size_t count, size_t stride);

/// Colours in place from YCoCg with a scale (appendix B, filter 4). `stride`: 4 (bytes) or 8 (shorts).
void decode_meshopt_colors(Bytes& data, size_t stride);

}  // namespace peelray
