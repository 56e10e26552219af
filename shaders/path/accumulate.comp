// Adds the camera's level to the picture; not if a queue overflowed, for then the band is done again. After the last sample also what
// a display shows: exposure, tone curve and sRGB encoding.
#version 460
#include "common/common.glsl"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool has_unlit = false;  // the scene has unlit materials
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
#include "view/camera.glsl"
#include "path/gather.glsl"
#include "path/shading.glsl"
#include "path/encode.glsl"

/// Adds to what the pixel sees of unlit surfaces; after the last sample its share of the `sum`, which stays right where post
/// passes change the picture.
vec3 unlitShare(uint at, vec3 radiance, vec3 sum) {
    if (params.sample_index > 0u) radiance += unlit[at];
    if (params.last != 0u) radiance = mix(radiance / max(sum, vec3(1e-30)), vec3(0), lessThanEqual(sum, vec3(0)));
    unlit[at] = radiance;
    return radiance;
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
    const float alpha = params.straight != 0u ? 1.0 - min(backdropShare(i, node), 1.0) : (node.flags & NODE_SURFACE) != 0u ? 1.0 : 0.0;
    vec4 sum = vec4(finite ? radiance : vec3(0), alpha);
    if (params.sample_index > 0u) sum += picture[at];
    picture[at] = sum;
    vec3 shown = vec3(0);
    // Not what is seen through it.
    if (has_unlit) shown = unlitShare(at, finite && (node.flags & NODE_UNLIT) != 0u ? node.radiance : vec3(0), sum.rgb);
    if (params.encodes != 0u) encoded[at] = encode(sum, shown, params.scale, params.share, params.curve, params.straight != 0u);
}
