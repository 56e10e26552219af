// The hierarchy over the instances' boxes: their order along a space-filling curve, and the boxes of eight.
#ifndef PEELRAY_TREE_GLSL
#define PEELRAY_TREE_GLSL

const PeelrayBox NO_BOX = PeelrayBox(vec3(1e30), 0u, vec3(-1e30), 0u);

/// Place of a point of [0, 1]³ on the Morton curve of 2^bits cells per side.
uint mortonCode(vec3 p, uint bits) {
    const float cells = float(1u << bits);
    const uvec3 cell = uvec3(clamp(p * cells, vec3(0), vec3(cells - 1.0)));
    uint code = 0u;
    for (uint i = 0u; i < bits; i++) {
        const uvec3 bit = cell >> i & 1u;
        code |= (bit.x | bit.y << 1u | bit.z << 2u) << (3u * i);
    }
    return code;
}

bool isBox(PeelrayBox box) { return box.lower.x <= box.upper.x; }

vec3 middleOf(PeelrayBox box) { return 0.5 * box.lower + 0.5 * box.upper; }

/// Where `p` lies in the box from `lower` to `upper`, [0, 1]³.
vec3 placeIn(vec3 p, vec3 lower, vec3 upper) {
    const vec3 size = upper - lower;
    return vec3(size.x > 0.0 ? (p.x - lower.x) / size.x : 0.0, size.y > 0.0 ? (p.y - lower.y) / size.y : 0.0,
                size.z > 0.0 ? (p.z - lower.z) / size.z : 0.0);
}

PeelrayBox unionOf(PeelrayBox a, PeelrayBox b) { return PeelrayBox(min(a.lower, b.lower), 0u, max(a.upper, b.upper), 0u); }

#endif
