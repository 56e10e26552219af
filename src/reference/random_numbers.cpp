#include "reference/random_numbers.h"

#include <array>
#include <bit>

#include "path/shading_numbers.h"

namespace peelray::inline PRECISION {
namespace {

/// x in the even bits, y in the odd ones.
uint32_t morton(uint32_t x, uint32_t y) {
    uint32_t code = 0;
    for (uint32_t bit = 0; bit < 16; bit++) code |= (x >> bit & 1) << 2 * bit | (y >> bit & 1) << (2 * bit + 1);
    return code;
}

constexpr uint32_t reversed(uint32_t v) {
    v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
    v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(v);
}

/// Each bit is flipped or not by a hash of the bits above it (Burley, Practical Hash-based Owen Scrambling, JCGT 2020;
/// the hash of Laine and Karras with constants by Vegdahl); of bits in reversed order.
uint32_t scrambled_reversed(uint32_t r, uint32_t key) {
    r ^= r * 0x3d20adeau;
    r += key;
    r *= key >> 16 | 1;
    r ^= r * 0x05526c56u;
    return r ^ r * 0x53a22864u;
}

/// What each value of each byte of an index brings to the second dimension, in reversed order: each direction number is
/// the one before, exclusive or itself a place lower. Bit by bit they took a twentieth of a picture's time.
constexpr auto kSobolOfBytes = [] {
    std::array<std::array<uint32_t, 256>, 4> table{};
    uint32_t number = 1u << 31;
    for (auto& of_byte : table)
        for (uint32_t bit = 0; bit < 8; bit++, number ^= number >> 1)
            for (uint32_t value = 0; value < 256; value++)
                if (value >> bit & 1) of_byte[value] ^= reversed(number);
    return table;
}();

uint32_t sobol_reversed(uint32_t index) {
    return kSobolOfBytes[0][index & 255] ^ kSobolOfBytes[1][index >> 8 & 255] ^ kSobolOfBytes[2][index >> 16 & 255] ^
           kSobolOfBytes[3][index >> 24];
}

}  // namespace

glm::uvec3 hash3(glm::uvec3 v) {
    const auto mix = [&] {
        v.x += v.y * v.z;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
    };
    v = v * 1664525u + 1013904223u;
    mix();
    v ^= v >> 16u;
    mix();
    return v;
}

uint32_t path_seed(uint32_t x, uint32_t y) {
    return morton(x, y) << RANDOM_BRANCH_BITS;
}

uint32_t branch_seed(uint32_t seed, uint32_t which, uint32_t level) {
    constexpr uint32_t branches = (1u << RANDOM_BRANCH_BITS) - 1;
    return (seed & ~branches) | (hash3({seed & branches, which, level}).x & branches);
}

uint32_t PixelSample::bits_for(uint32_t spp) {
    return uint32_t(std::bit_width(spp - 1));
}

Vec2 random_pair(uint32_t seed, uint32_t level, uint32_t purpose, const PixelSample& sample) {
    const uint32_t branch = seed & ((1u << RANDOM_BRANCH_BITS) - 1);
    const glm::uvec3 key = hash3({branch | level << RANDOM_BRANCH_BITS, purpose, sample.picture});
    const uint32_t index = (seed >> RANDOM_BRANCH_BITS) << sample.bits | sample.number;
    const uint32_t shuffled_reversed = scrambled_reversed(reversed(index), key.x),
                   shuffled = reversed(shuffled_reversed);
    const uint32_t x = reversed(scrambled_reversed(shuffled, key.y)),
                   y = reversed(scrambled_reversed(sobol_reversed(shuffled), key.z));
    // Signed: below it is a slower conversion.
    return Vec2(int(x >> 8), int(y >> 8)) / 16777216.0;
}

}  // namespace peelray::inline PRECISION
