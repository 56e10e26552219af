// The triangles that a ray has passed, which do not count again (mediaForget in media_walk.glsl): as many as coincide.
#ifndef PEELRAY_MEDIA_FORGET_GLSL
#define PEELRAY_MEDIA_FORGET_GLSL

uvec4 media_forgotten = uvec4(0xffffffffu);

bool mediaForgotten(uint triangle) { return any(equal(media_forgotten, uvec4(triangle))); }
void mediaForget(uint triangle) { media_forgotten = uvec4(triangle, media_forgotten.xyz); }

#endif
