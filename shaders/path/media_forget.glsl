// The triangles that a ray has passed, which do not count again (mediaForget in media_walk.glsl): as many as coincide. With
// their instances: those of one body share their triangles.
#ifndef PEELRAY_MEDIA_FORGET_GLSL
#define PEELRAY_MEDIA_FORGET_GLSL

uvec4 media_forgotten = uvec4(0xffffffffu), media_forgotten_in = uvec4(0xffffffffu);
uint media_visited = 0xffffffffu;  // the instance that the ray is in

bool mediaForgotten(uint instance, uint triangle) {
    const bvec4 same = equal(media_forgotten, uvec4(triangle)), here = equal(media_forgotten_in, uvec4(instance));
    return any(bvec4(same.x && here.x, same.y && here.y, same.z && here.z, same.w && here.w));
}
void mediaForget(uint instance, uint triangle) {
    media_forgotten = uvec4(triangle, media_forgotten.xyz);
    media_forgotten_in = uvec4(instance, media_forgotten_in.xyz);
}

#endif
