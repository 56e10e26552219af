// The rasteriser's view of a point.

/// Clip coordinates of `p`, which is relative to the eye, with reversed depth; `shift` moves the picture, in [-1, 1]².
vec4 project(vec3 p, vec2 shift) {
    const vec3 right = frame[0].right, up = frame[0].up;
    const vec2 plane = vec2(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up));
    const float depth = dot(p, frame[0].forward);
    vec4 clip;
    if (frame[0].orthographic != 0u)
        clip = vec4(plane * vec2(1, -1) + shift, (frame[0].far - depth) / frame[0].far, 1);
    else
        clip = vec4(plane * vec2(1, -1) + shift * depth, frame[0].near, depth);
    return clip;
}
