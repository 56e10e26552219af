// Workgroups of 8x8 pixels, row by row. Wants the parameters DenoiseParams.

ivec2 tilePixel() {
    const uint columns = (params.width + 7u) / 8u;
    return ivec2(8u * uvec2(GROUP_INDEX % columns, GROUP_INDEX / columns) + gl_LocalInvocationID.xy);
}

bool isInside(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, ivec2(params.width, params.height))); }

uint pixelIndex(ivec2 p) { return uint(p.y) * params.width + uint(p.x); }
