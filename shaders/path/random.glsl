// Random numbers of the tree of rays: Owen-scrambled Sobol points, padded, in the Morton order of the pixels. So a pixel's samples are
// spread evenly, and what is left of their error differs between neighbours like blue noise (Ahmed, Wonka: Screen-Space Blue-Noise
// Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels, 2020).
#ifndef PEELRAY_RANDOM_GLSL
#define PEELRAY_RANDOM_GLSL

#include "path/shading.glsl"

/// Bits 0 to 11 of a number, to the even places.
uint spreadBits(uint v) {
    v &= 0xfffu;
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

/// Of the camera's ray through a pixel.
uint pixelSeed(uvec2 pixel) { return (spreadBits(pixel.x) | spreadBits(pixel.y) << 1) << RANDOM_BRANCH_BITS; }

/// Of branch `which` of a path that has come to this level.
uint branchSeed(uint seed, uint which, uint level) {
    const uint mask = (1u << RANDOM_BRANCH_BITS) - 1u;
    return (seed & ~mask) | (hash3(uvec3(seed & mask, which, level)).x & mask);
}

/// A nested uniform scramble of a number whose bits are reversed: each bit is flipped or not by a hash of those below it (Laine,
/// Karras: Stratified Sampling for Stochastic Transparency, 2011; Burley: Practical Hash-based Owen Scrambling, JCGT 2020; the constants
/// are Vegdahl's).
uint scrambledReversed(uint v, uint key) {
    v ^= v * 0x3d20adeau;
    v += key;
    v *= (key >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// The second dimension of Sobol's sequence, bits reversed: Pascal's triangle modulo 2, which is a sum over subsets of the bits' places.
uint sobolReversed(uint i) {
    i ^= (i >> 1) & 0x55555555u;
    i ^= (i >> 2) & 0x33333333u;
    i ^= (i >> 4) & 0x0f0f0f0fu;
    i ^= (i >> 8) & 0x00ff00ffu;
    i ^= (i >> 16) & 0x0000ffffu;
    return i;
}

/// Two numbers in [0, 1) of sample `index` (below 2^bits) of a path; `purpose`: RANDOM_*.
vec2 randomPair(uint seed, uint level, uint index, uint bits, uint purpose, uint picture) {
    const uint mask = (1u << RANDOM_BRANCH_BITS) - 1u;
    const uvec3 key = hash3(uvec3((seed & mask) | level << RANDOM_BRANCH_BITS, purpose, picture));
    const uint at = (bits < 32u ? (seed >> RANDOM_BRANCH_BITS) << bits : 0u) | index;
    const uint i = bitfieldReverse(scrambledReversed(bitfieldReverse(at), key.x));
    const uint x = bitfieldReverse(scrambledReversed(i, key.y));
    const uint y = bitfieldReverse(scrambledReversed(sobolReversed(i), key.z));
    return vec2(x >> 8, y >> 8) * (1.0 / 16777216.0);
}

#endif
