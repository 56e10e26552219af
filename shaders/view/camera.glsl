// The camera's rays and the order of a band's pixels: 8x8 tiles, row by row, so that neighbours in the queue are neighbours
// in the picture.
#include "common/ray.h"

/// Pixel of record `index` of a band; it may lie outside the picture.
uvec2 recordPixel(uint index, uint first_row) {
    const uint tile = index >> 6u, lane = index & 63u, tiles = frame[0].row_pixels >> 3u;
    return uvec2((tile % tiles) * 8u + (lane & 7u), first_row + (tile / tiles) * 8u + (lane >> 3u));
}

/// The same in every pass, bit by bit: what one finds another intersects again.
Ray cameraRay(vec2 pixel) {
    precise vec2 p = vec2(2.0 * pixel.x / float(frame[0].width) - 1.0, 1.0 - 2.0 * pixel.y / float(frame[0].height));
    precise vec3 offset = frame[0].right * p.x + frame[0].up * p.y;
    precise vec3 origin = frame[0].eye + offset, direction = frame[0].forward + offset;
    const float infinity = uintBitsToFloat(0x7f800000u);
    if (frame[0].orthographic != 0u) return Ray(origin, 0.0, frame[0].forward, infinity);
    return Ray(frame[0].eye, 0.0, normalize(direction), infinity);
}
