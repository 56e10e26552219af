// A ray and what it hits.
#ifndef PEELRAY_RAY_GLSL
#define PEELRAY_RAY_GLSL

const uint PEELRAY_MISS = 0xffffffffu;

struct PeelrayHit {
    float t;        ///< in lengths of the ray's direction; +inf: a miss
    uint triangle;  ///< PEELRAY_MISS: a miss
    uint instance;
    vec2 uv;        ///< barycentric weights of the second and third corner (`exact`)
};

struct PeelrayRay {
    vec3 origin;     ///< world units
    float tmin;
    vec3 direction;  ///< any length but 0; components may be 0
    float tmax;
};

#endif
