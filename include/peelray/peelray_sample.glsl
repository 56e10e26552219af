// Constants that the builder and the traversal of the cube must agree on.
#ifndef PEELRAY_SAMPLE_GLSL
#define PEELRAY_SAMPLE_GLSL

/// By pixel: how far a sample may lie off its own voxel and still be looked at, in voxels: rounding of coordinates up to 2048 voxels
/// and the quantised plane (slopes: 4e-5), see docs/data.md.
const float PEELRAY_POSITION_SLACK = 2e-3;
const float PEELRAY_PLANE_SLACK = 5e-4;
/// Of the distance to a sample's plane at the ends of a ray's way through a voxel, voxels: rounding of coordinates, and slopes that are
/// half floats (2.4e-4; 7.4e-4 where one is about -1).
const float PEELRAY_SEGMENT_SLACK = 3e-3;
/// A plane's values at both ends of a ray's way through a voxel, off by PEELRAY_SEGMENT_SLACK at most, must differ by this for the place
/// in between where it is hit to be known to PEELRAY_MARGIN pixels, by which the coverage is wider than the triangle.
const float PEELRAY_UNCERTAIN_PLACE = 0.1;
const float PEELRAY_MARGIN = 0.03;
/// The same in the finer voxels of a refined one, which are a fourth of it: rounding stays what it was, so that a place is known to twice
/// the share of a pixel from half the difference on (the margin in finer pixels).
const float PEELRAY_FINE_UNCERTAIN_PLACE = 0.5 * PEELRAY_UNCERTAIN_PLACE;
const float PEELRAY_FINE_MARGIN = 2.0 * PEELRAY_MARGIN;

/// Of a voxel's entry: it holds samples; it is refined, and the other bits are the number of its block of finer ones instead of its first
/// sample.
const uint PEELRAY_OCCUPIED = 0x80000000u, PEELRAY_REFINED = 0xc0000000u, PEELRAY_FIRST = 0x3fffffffu;
/// Slopes are stored in [-this, this]: beyond 1 only in the overlap band of `planar` (1 / LDC_OVERLAP).
const float PEELRAY_SLOPE_RANGE = 1.25;
/// Half-width of a sample's footprint for `planar` hits, in pixels.
const float PEELRAY_FOOTPRINT = 0.7;

/// The place of a cell among the 4x4x4 of its parent.
uint peelrayIn64(uvec3 at) { return (at.z & 3u) << 4u | (at.y & 3u) << 2u | (at.x & 3u); }

/// (x, y, z) as (u, v, w) of the LDI along `axis`, which is its w.
vec3 peelrayToLdi(vec3 p, uint axis) { return axis == 0u ? p.yzx : (axis == 1u ? p.zxy : p); }

/// Place of a pixel in an LDI of the by-pixel order, whose rows have `width` pixels (a multiple of 16): 8x8 tiles,
/// since rays walk in both directions.
uint peelrayPixelIndex(uvec2 pixel, uint width) {
    const uvec2 tile = pixel >> 3u, inside = pixel & 7u;
    return ((tile.y * (width >> 3u) + tile.x) << 6u) + (inside.y << 3u) + inside.x;
}

/// Cells along u and v of a level of an LDI's min/max pyramid: each covers 2^level x 2^level pixels.
uvec2 peelrayLevelSize(uvec2 pixels, uint level) { return (pixels + (1u << level) - 1u) >> level; }

#endif
