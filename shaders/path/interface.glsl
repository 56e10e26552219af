// Fresnel reflectance of a material's dielectric part and of its metal. Include after the scene's buffers.
#ifndef PEELRAY_INTERFACE_GLSL
#define PEELRAY_INTERFACE_GLSL

#include "common/material.glsl"
#include "path/shading.glsl"
#include "path/thin_film.glsl"

/// Does light pass through the material?
bool transmits(Material m) { return m.transmission > 0.0 && m.metallic < 1.0; }

/// The same of what is no mirror.
bool transmitsRough(Material m) { return frosted && transmits(m); }

/// What the light that is not reflected is multiplied by on its way through.
vec3 transmissionTint(Material m, vec3 base_color) { return (1.0 - m.metallic) * m.transmission * base_color; }

/// Is a ray that meets the material's surface inside of its volume? Volumes are left where the ray meets their back; opaque and
/// thin surfaces are the same from both sides.
bool leavesVolume(Material m, bool front) { return transmits(m) && (m.flags & MATERIAL_THIN) == 0u && !front; }

/// Of the dielectric part at normal incidence.
vec3 normalReflectance(Material m) {
    const float root = (m.ior - 1.0) / (m.ior + 1.0);
    return (m.flags & MATERIAL_SCHLICK) != 0u ? m.f0 : vec3(root * root);
}

/// Index of refraction of the dielectric part below a film.
vec3 filmBase(Material m) { return (m.flags & MATERIAL_SCHLICK) != 0u ? metalIndex(m.f0) : vec3(m.ior); }

/// Reflectance at `cosine` ≥ 0 outside, of a film between air and what has these indices; a lossless one's is the same from below.
vec3 filmReflectance(Material m, vec3 index, float cosine) { return thinFilm(m.film_thickness, m.film_ior, index, cosine); }

/// Of what has these indices behind it over that before it.
vec3 channelReflectance(vec3 etas, float cosine) {
    return vec3(fresnelDielectric(cosine, etas.r), fresnelDielectric(cosine, etas.g), fresnelDielectric(cosine, etas.b));
}

/// The cosine outside of a volume whose index over that of air is 1 / eta, for one within; below 0: total internal reflection.
float cosineOutside(float cosine, float eta) {
    const float sine2 = (1.0 - cosine * cosine) / (eta * eta);
    return sine2 >= 1.0 ? -1.0 : sqrt(1.0 - sine2);
}

/// Of the dielectric part, by the cosine outside: as KHR_materials_specular states it, or `plain`, and of its film.
vec3 filmedReflectance(Material m, vec3 plain, float cosine) {
    if ((m.flags & MATERIAL_SCHLICK) != 0u) plain = fresnelSchlick(m.f0, m.f90, cosine);
    return filmed && m.iridescence > 0.0 ? mix(plain, filmReflectance(m, filmBase(m), cosine), m.iridescence) : plain;
}

/// Reflectance of one face of indices `etas` at `cosine` ≥ 0 on the incoming side; `leaving`: from inside of the volume. By the index of
/// refraction alone it is the exact one; KHR_materials_specular and an infinite index are Schlick's between f0 and f90, at the
/// angle outside.
vec3 faceReflectance(Material m, vec3 etas, float cosine, bool leaving) {
    vec3 plain = vec3(0);
    if ((m.flags & MATERIAL_SCHLICK) == 0u) {
        plain = dispersive ? channelReflectance(etas, cosine) : vec3(fresnelDielectric(cosine, etas.g));
        if (!filmed || m.iridescence == 0.0) return plain;
    }
    if (!leaving) return filmedReflectance(m, plain, cosine);
    if (!dispersive || all(equal(etas, etas.ggg))) {
        const float outside = cosineOutside(cosine, etas.g);
        return outside < 0.0 ? vec3(1) : filmedReflectance(m, plain, outside);
    }
    vec3 each = vec3(1);
    for (int k = 0; k < 3; k++) {
        const float outside = cosineOutside(cosine, etas[k]);
        if (outside >= 0.0) each[k] = filmedReflectance(m, plain, outside)[k];
    }
    return each;
}

/// A surface as a ray meets it.
struct Interface {
    float eta;      ///< index of refraction behind it over that before it
    bool leaving;   ///< into air
    bool between;   ///< two media, neither of them air
    vec3 etas;      ///< eta of red, green and blue, those of a ray that has one of them alone the same
    bool disperses; ///< these differ
};

Interface interfaceOf(vec3 etas, bool leaving, bool between) {
    return Interface(etas.g, leaving, between, etas, dispersive && (etas.r != etas.g || etas.b != etas.g));
}

/// Of a body in air, for a ray of this RAY_CHANNEL.
Interface interfaceInAir(Material m, bool front, uint channel) {
    const bool leaving = leavesVolume(m, front);
    vec3 indices = vec3(m.ior);
    if (dispersive && (m.flags & MATERIAL_THIN) == 0u) {
        indices = channelIndices(m.ior, m.spread);
        if (channel > 0u) indices = vec3(indices[channel - 1u]);
    }
    return interfaceOf(leaving ? 1.0 / indices : indices, leaving, false);
}

/// Of what a ray meets: between two media by their indices, else as the material says; of a thin wall both faces.
vec3 interfaceReflectance(Material m, Interface face, float cosine) {
    if (face.between) return dispersive ? channelReflectance(face.etas, cosine) : vec3(fresnelDielectric(cosine, face.eta));
    const vec3 once = faceReflectance(m, face.etas, cosine, face.leaving);
    return transmits(m) && (m.flags & MATERIAL_THIN) != 0u ? 2.0 * once / (1.0 + once) : once;
}

/// Of the metal.
vec3 metalReflectance(Material m, Interface face, vec3 base_color, float cosine) {
    const vec3 plain = fresnelSchlick(base_color, 1.0, cosine);
    if (!filmed || m.iridescence == 0.0 || face.between) return plain;
    const float outside = face.leaving ? cosineOutside(cosine, face.eta) : cosine;
    return outside < 0.0 ? vec3(1) : mix(plain, filmReflectance(m, metalIndex(base_color), outside), m.iridescence);
}

#endif
