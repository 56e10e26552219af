// Boxes that many threads grow together: floats as integers of the same order, for atomics.
#ifndef PEELRAY_BOUNDS_GLSL
#define PEELRAY_BOUNDS_GLSL

uint orderedBits(float x) {
    const uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float orderedFloat(uint bits) { return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits); }

uvec3 orderedBits(vec3 p) { return uvec3(orderedBits(p.x), orderedBits(p.y), orderedBits(p.z)); }
vec3 orderedFloats(uvec3 bits) { return vec3(orderedFloat(bits.x), orderedFloat(bits.y), orderedFloat(bits.z)); }

/// What bounds a box; NaN and infinite points do not.
bool isBounded(vec3 p) { return abs(p.x) < 1e30 && abs(p.y) < 1e30 && abs(p.z) < 1e30; }

#endif
