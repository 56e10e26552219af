// Work of a fixed number of clock cycles: how long it takes tells the device's clock (src/bench/clock_probe.h).
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
PARAMS(uint)
BUFFER(writeonly, 0, float, results)

void main() {
    float x = float(gl_LocalInvocationIndex) * 1e-3;
    for (uint i = 0u; i < params; i++) x = x * 0.999 + 0.25;  // each waits for the one before
    results[GLOBAL_INDEX] = x;
}
