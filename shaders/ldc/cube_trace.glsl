// peelrayTrace in a scene's cubes, where many small bodies may share one. Include after peelray/peelray.glsl and cube_fetch.glsl.
#ifndef PEELRAY_CUBE_TRACE_GLSL
#define PEELRAY_CUBE_TRACE_GLSL

PeelrayHit cubeTrace(PeelrayRay ray, uvec2 skip, PeelrayOptions options) {
#ifndef PEELRAY_ONLY_PIXELS
    if (merging && skip.x != PEELRAY_MISS && (instance_cubes[skip.x].tops & PEELRAY_MERGED) != 0u)
        skip = uvec2(params.merged_instance, skip.y + instance_cubes[skip.x].first_cell);
#endif
    PeelrayHit hit = peelrayTrace(params.tree, ray, skip, options);
    const uvec2 surface = cubeSurface(hit.instance, hit.triangle);
    hit.instance = surface.x;
    hit.triangle = surface.y;
    return hit;
}

#endif
