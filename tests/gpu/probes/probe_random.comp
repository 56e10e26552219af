// randomPair and its hash.
#version 460
#include "common/common.glsl"
#include "path/random.glsl"
#include "probe.glsl"
struct Input { uvec2 pixel; uint level, index, bits, purpose, picture; };
struct Output { uvec3 hash; uint branch; vec2 pair; };
PROBE(Input, Output)

Output probe(Input x) {
    const uint branch = branchSeed(pixelSeed(x.pixel), x.level & 3u, x.level), seed = x.level == 0u ? pixelSeed(x.pixel) : branch;
    return Output(hash3(uvec3(x.pixel, x.purpose)), branch, randomPair(seed, x.level, x.index, x.bits, x.purpose, x.picture));
}
