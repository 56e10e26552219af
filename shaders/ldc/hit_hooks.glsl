// What the traversal asks about the material of a hit. Include after base_color_buffers.glsl, the specialisation constants `masked` and
// `single_sided` (the scene has such materials), and before peelray/peelray.glsl. HITS_TO_LIGHT: the rays go from surfaces to lights.
#include "common/alpha_test.glsl"
#include "common/sidedness.glsl"
#define PEELRAY_ACCEPT(triangle, uv) (!masked || alphaPresent(triangle, uv))
#ifdef HITS_TO_LIGHT
// Light comes the other way: it meets the front where the ray meets the back.
#define PEELRAY_SHOWN(triangle, front) (!single_sided || !(front) || !singleSided(triangle))
#else
#define PEELRAY_SHOWN(triangle, front) (!single_sided || (front) || !singleSided(triangle))
#endif
