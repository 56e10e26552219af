// What the shaders of the device's own ray tracing share: who hands what to whom.
#ifndef PEELRAY_KHR_RAY_GLSL
#define PEELRAY_KHR_RAY_GLSL

/// Payload of rays that look for the nearest hit. On the way in `triangle` and `instance` are those that do not count.
struct KhrRay {
    uint triangle;  ///< NO_TRIANGLE: a miss
    uint instance;
    float t;
    vec2 weights;
};

/// Payload number of those rays, and of rays that only ask whether there is anything (a uint: 1 yes, 0 no).
#define KHR_NEAREST 0
#define KHR_OCCLUDED 1

/// Where the bindings of scene_buffers.glsl begin: the same in all passes, for their hit shaders read some of them.
#define KHR_SCENE_FIRST_BINDING 6

#endif
