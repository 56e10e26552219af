// One ray through the device's own ray tracing, with the meaning that peelrayTrace gives it. Include after khr_ray.glsl; ray
// generation only.
#include "common/ray.h"
layout(set = 0, binding = 0) uniform accelerationStructureEXT structures;
layout(location = KHR_NEAREST) rayPayloadEXT KhrRay traced;

/// Makes the ray one that Vulkan takes: t counts in lengths of a direction whose largest component is in [1, 2), by `scale`, from
/// tmin >= 0, which lies `before` on the ray. False: it is none (peelrayTrace), and misses.
bool khrPrepare(inout Ray ray, out float scale, out float before) {
    scale = 1.0;
    before = 0.0;
    const vec3 d = abs(ray.direction), o = abs(ray.origin);
    const float d_max = max(d.x, max(d.y, d.z));
    // Written so that a NaN fails.
    if (!(d_max > 0.0 && d_max < 3e38 && d.x <= d_max && d.y <= d_max && d.z <= d_max)) return false;
    if (!(ray.tmin < ray.tmax && abs(ray.tmin) < 3e38 && o.x < 3e38 && o.y < 3e38 && o.z < 3e38)) return false;
    const int exponent = int((floatBitsToUint(d_max) >> 23) & 255u) - 127;
    scale = exponent < -126 ? 1.0 / d_max : ldexp(1.0, -exponent);
    before = min(ray.tmin, 0.0) / scale;
    ray.direction *= scale;
    ray.origin += before * ray.direction;
    ray.tmin = ray.tmin / scale - before;
    ray.tmax = ray.tmax / scale - before;
    return true;
}

/// The nearest hit with tmin < t < tmax; with gl_RayFlagsTerminateOnFirstHitEXT in `flags` some hit. `skip`: a triangle that does not
/// count.
Hit khrTrace(Ray ray, SurfaceId skip, uint flags) {
    const Hit miss = Hit(uintBitsToFloat(0x7f800000u), NO_TRIANGLE, NO_TRIANGLE, 0.0, 0.0);
    float scale, before;
    if (!khrPrepare(ray, scale, before)) return miss;
    // Rays start off the triangle that they leave, so that it is seldom met: hits are asked about only then.
    while (true) {
        traced.triangle = skip.triangle;
        traced.instance = skip.instance;
        traceRayEXT(structures, flags, 0xffu, 0, 0, 0, ray.origin, ray.tmin, ray.direction, ray.tmax, KHR_NEAREST);
        if (traced.triangle == NO_TRIANGLE) return miss;
        const bool counts = (traced.triangle != skip.triangle || traced.instance != skip.instance) && traced.t > ray.tmin;
        if (counts || (flags & gl_RayFlagsNoOpaqueEXT) != 0u) break;
        flags |= gl_RayFlagsNoOpaqueEXT;
    }
    return Hit((traced.t + before) * scale, traced.triangle, traced.instance, traced.weights.x, traced.weights.y);
}
