// Floats to half floats, many at a time. Private to src/image.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace peelray {

/// The nearest half float, of two the even one; what is beyond becomes ±65504, NaN stays. `beyond` goes up by one where
/// it was. Without branches, so that a loop of it can be vectorised.
inline uint16_t to_half(float value, uint32_t& beyond) {
    constexpr int32_t largest = 0x477fe000, smallest_normal = 0x38800000, infinity = 0x7f800000;  // 65504, 2^-14
    const uint32_t bits = std::bit_cast<uint32_t>(value);
    const int32_t size = int32_t(bits & 0x7fffffff);
    const bool nan = size > infinity;
    beyond += uint32_t(size > largest) - uint32_t(nan);
    const int32_t kept = size > largest ? largest : size;
    const int32_t normal = (kept - 0x38000000 + 0xfff + ((kept >> 13) & 1)) >> 13;
    // The sum with 0.5 is rounded to what a subnormal half can be, 2^-24 apart.
    const int32_t subnormal = std::bit_cast<int32_t>(std::bit_cast<float>(kept) + 0.5f) - 0x3f000000;
    const int32_t finite = kept < smallest_normal ? subnormal : normal;
    return uint16_t((bits >> 16 & 0x8000) | uint32_t(nan ? 0x7e00 : finite));
}

/// `count` half floats, of a float every `Stride`. Returns how many were beyond. `count` is below 2^32.
template <size_t Stride>
size_t put_halves(const float* __restrict from, size_t count, char* __restrict out) {
    uint32_t beyond = 0;
    uint16_t block[256];
    for (size_t first = 0; first < count; first += std::size(block)) {
        const size_t here = std::min(std::size(block), count - first);
        for (size_t i = 0; i < here; i++) block[i] = to_half(from[(first + i) * Stride], beyond);
        std::memcpy(out + 2 * first, block, 2 * here);
    }
    return beyond;
}

}  // namespace peelray
