// Adds the camera's level to the picture; not if a queue overflowed, for then the band is done again. After the last sample also what
// a display shows: exposure, tone curve and sRGB encoding.
#version 460
#include "common/common.glsl"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool has_unlit = false;    // the scene has unlit materials
layout(constant_id = 1) const bool has_moments = false;  // of the samples' luminances are asked for
PARAMS(AccumulateParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, PathNode, nodes)
BUFFER(readonly, 2, PathBranches, branches)
BUFFER(readonly, 3, PathNode, next_nodes)
BUFFER(readonly, 4, vec3, shadow_light)
BUFFER(readonly, 5, uint, queue)
BUFFER(, 6, vec4, picture)
BUFFER(writeonly, 7, uint, encoded)
BUFFER(, 8, vec3, unlit)
BUFFER(, 9, vec2, moments)  // mean of the luminances, sum of their squared deviations from it
#include "view/camera.glsl"
#include "path/gather.glsl"
#include "path/shading.glsl"
#include "path/encode.glsl"

/// Adds a sample to the pixel's moments (Welford 1962): without the difference of large sums, which single precision would lose.
void addToMoments(uint at, vec3 radiance) {
    const float luminance = dot(radiance, vec3(LUMINANCE_RED, LUMINANCE_GREEN, LUMINANCE_BLUE));
    vec2 sums = params.sample_index > 0u ? moments[at] : vec2(0);
    const float before = luminance - sums.x;
    sums.x += before / float(params.sample_index + 1u);
    sums.y += before * (luminance - sums.x);
    moments[at] = sums;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity || queue[QUEUE_OVERFLOW] != 0u) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = pixel.y * frame[0].width + pixel.x;
    PathNode node = nodes[i];
    if ((node.flags & NODE_CATCHER) != 0u) node = caughtNode(i, node);
    const vec3 radiance = litRadiance(node) + childrenRadiance(i, node);
    // One bad number must not poison a pixel for good.
    const bool finite = radiance.r < 1e30 && radiance.g < 1e30 && radiance.b < 1e30 && radiance.r >= 0.0 && radiance.g >= 0.0 && radiance.b >= 0.0;
    const float largest = max(radiance.r, max(radiance.g, radiance.b));
    const float kept = largest > params.limit ? params.limit / largest : 1.0;
    const vec3 added = finite ? radiance * kept : vec3(0);
    const float alpha = params.straight != 0u ? 1.0 - min(backdropShare(i, node), 1.0) : (node.flags & NODE_SURFACE) != 0u ? 1.0 : 0.0;
    vec4 sum = vec4(added, alpha);
    if (params.sample_index > 0u) sum += picture[at];
    picture[at] = sum;
    if (has_moments) addToMoments(at, added);
    vec3 shown = vec3(0);
    if (has_unlit) {
        // Not what is seen through it.
        if (finite && (node.flags & NODE_UNLIT) != 0u) shown = node.radiance * kept;
        if (params.sample_index > 0u) shown += unlit[at];
        unlit[at] = shown;
    }
    if (params.encodes != 0u)
        encoded[at] = encode(sum, has_unlit ? unlitShare(shown, sum.rgb) : shown, params.scale, params.share, params.curve, params.straight != 0u);
}
