// Uncompressed video for a pipe: YUV4MPEG2, which ffmpeg, mpv and encoders read.
#pragma once

#include <string>
#include <utility>

#include "image/image.h"

namespace peelray {

/// The nearest fraction of whole numbers with a denominator up to 100,000: 29.97 is 2997/100. 0 < `value` < 10^9.
std::pair<uint64_t, uint64_t> fraction_of(double value);

/// The stream's first line: 4:2:0, 8 bits, limited range; each colour sample lies in the middle of its 2x2 pixels
/// (C420jpeg). Both sides are even, `fps` > 0.
std::string y4m_header(uint32_t width, uint32_t height, double fps);

/// A frame of it, its head included: opaque sRGB by the matrix of BT.709 to luma 16 to 235 and chroma 16 to 240; chroma
/// is that of the mean of 2x2 pixels. Each value is the nearest whole number, of a half either.
std::string y4m_frame(const Image8View& image);

}  // namespace peelray
