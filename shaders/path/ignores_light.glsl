// What light is not looked for. Include after frame.glsl and lobe.glsl.
#ifndef PEELRAY_IGNORES_LIGHT_GLSL
#define PEELRAY_IGNORES_LIGHT_GLSL

/// Has the surface neither a lobe that holds a lamp, nor anything that scatters, as mirrors and clear glass?
bool ignoresLight(Surface s, Material m) {
    return m.roughness < MIRROR_ROUGHNESS && (m.metallic == 1.0 || m.transmission == 1.0) && m.clearcoat == 0.0 && m.sheen_color == vec3(0) && s.stretch == 0.0;
}

#endif
