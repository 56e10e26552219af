// Rays from a surface to what lights it. Include after frame.glsl, and define randomAt(seed, purpose) before.
#ifndef PEELRAY_LIGHT_RAYS_GLSL
#define PEELRAY_LIGHT_RAYS_GLSL

/// The same to light `index`: to where the ray meets its ball.
Ray lampRay(uint index, Surface s, vec3 direction, bool seeps) {
    Ray ray = lightRay(s, direction, seeps);
    if (lights[index].kind == 0u) return ray;
    const vec3 centre = lights[index].position - ray.origin;
    const float radius = soft_lamps ? lights[index].sine : 0.0, along = dot(centre, direction);
    ray.tmax = along - sqrt(max(0.0, radius * radius - (dot(centre, centre) - along * along)));
    return ray;
}

/// A ray to the sky in front of the surface or behind it. One cosine-distributed direction per sample: its mean is the sky that the
/// surface really sees.
Ray skyRay(Surface s, uint seed, bool seeps) {
    const vec3 sampled = cosineDirection(s.normal, randomAt(seed, RANDOM_SKY));
    const vec3 direction = aboveSurface(sampled, s.geometric);
    const float infinity = uintBitsToFloat(0x7f800000u);
    return seeps ? leavingRay(s, s.position, -direction, infinity) : leavingRay(s, s.shadow_start, direction, infinity);
}

#endif
