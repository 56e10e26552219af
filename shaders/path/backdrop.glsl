// What the camera sees where nothing is before it, or nothing but blended surfaces. Include after frame.glsl.
#ifndef PEELRAY_BACKDROP_GLSL
#define PEELRAY_BACKDROP_GLSL

#include "path/frame.h"
#include "path/path_params.h"
#include "path/shading_numbers.h"

/// Did a ray of this RayState::medium and level come straight from the camera?
bool isStraight(uint medium, uint level) { return (medium & RAY_PASSES) / RAY_PASSED == level; }

/// Does such a ray see something else than the environment?
bool seesBackdrop(uint medium, uint level) { return frame[0].backdrop != BACKDROP_ENVIRONMENT && isStraight(medium, level); }

vec3 backdropRadiance(vec3 d) {
    if (frame[0].backdrop == BACKDROP_BLURRED) return environmentPicture(equirectangular(d), frame[0].backdrop_first, uvec2(BLURRED_WIDTH, BLURRED_HEIGHT));
    return frame[0].backdrop == BACKDROP_COLOR ? frame[0].backdrop_color : vec3(0);
}

/// What a ray of this RayState::medium and level sees that hits nothing; `sky`: of the environment.
vec3 missRadiance(vec3 d, uint medium, uint level, vec3 sky) { return seesBackdrop(medium, level) ? backdropRadiance(d) : sky; }

/// Its node; `passed`: of the light that comes along it.
PathNode missNode(vec3 d, uint medium, uint level, vec3 sky, vec3 passed) {
    const bool open = frame[0].backdrop == BACKDROP_NONE && isStraight(medium, level);
    return PathNode(passed * missRadiance(d, medium, level, sky), open ? floatBitsToUint(luminance(passed)) : 0u, open ? NODE_BACKDROP : 0u);
}

#endif
