// Fresnel reflectance of a material's dielectric part. Without bindings.
#ifndef PEELRAY_INTERFACE_GLSL
#define PEELRAY_INTERFACE_GLSL

#include "common/material.glsl"
#include "path/shading.glsl"

/// Does light pass through the material?
bool transmits(Material m) { return m.transmission > 0.0 && m.metallic < 1.0; }

/// What the light that is not reflected is multiplied by on its way through.
vec3 transmissionTint(Material m, vec3 base_color) { return (1.0 - m.metallic) * m.transmission * base_color; }

/// Is a ray that meets the material's surface inside of its volume? Volumes are left where the ray meets their back; opaque and
/// thin surfaces are the same from both sides.
bool leavesVolume(Material m, bool front) { return transmits(m) && (m.flags & MATERIAL_THIN) == 0u && !front; }

/// Reflectance of one face at `cosine` ≥ 0 on the incoming side; `leaving`: from inside of the volume. By the index of refraction
/// alone it is the exact one; KHR_materials_specular and an infinite index are Schlick's between f0 and f90, at the angle outside.
vec3 dielectricReflectance(Material m, float cosine, bool leaving) {
    const float eta = leaving ? 1.0 / m.ior : m.ior;
    if ((m.flags & MATERIAL_SCHLICK) == 0u) return vec3(fresnelDielectric(cosine, eta));
    if (leaving) {
        const float sine2 = (1.0 - cosine * cosine) / (eta * eta);
        if (sine2 >= 1.0) return vec3(1);
        cosine = sqrt(1.0 - sine2);
    }
    return fresnelSchlick(m.f0, m.f90, cosine);
}

/// The same of what a ray meets: of a thin wall both faces.
vec3 wallReflectance(Material m, float cosine, bool leaving) {
    const vec3 face = dielectricReflectance(m, cosine, leaving);
    return transmits(m) && (m.flags & MATERIAL_THIN) != 0u ? 2.0 * face / (1.0 + face) : face;
}

/// A surface as a ray meets it.
struct Interface {
    float eta;     ///< index of refraction behind it over that before it
    bool leaving;  ///< into air
    bool between;  ///< two media, neither of them air
};

/// Of a body in air.
Interface interfaceInAir(Material m, bool front) {
    const bool leaving = leavesVolume(m, front);
    return Interface(leaving ? 1.0 / m.ior : m.ior, leaving, false);
}

/// Between two media by their indices; in air as the material says.
vec3 interfaceReflectance(Material m, Interface face, float cosine) {
    return face.between ? vec3(fresnelDielectric(cosine, face.eta)) : wallReflectance(m, cosine, face.leaving);
}

#endif
