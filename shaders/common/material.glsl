// Materials at a hit: nothing else reads their records. Include after what it reads: triangles and the buffers of
// base_color_buffers.glsl. Which sides of a triangle are shown stands apart (sidedness.glsl), for shaders that read no textures.
#ifndef PEELRAY_MATERIAL_GLSL
#define PEELRAY_MATERIAL_GLSL

#include "common/material.h"

#include "common/sidedness.glsl"
#include "common/textures.glsl"
#include "path/shading_numbers.h"

// --- Opacity: where a triangle has a surface (the alpha test of masked materials) ---

/// May the triangle have holes?
bool alphaMasked(uint triangle) { return materials[triangle_materials[triangle]].alpha_cutoff > 0.0; }

/// Is there a surface at the point with these weights of the triangle's second and third corner?
bool alphaPresent(uint triangle, vec2 weights) {
    const uint index = triangle_materials[triangle];
    const float cutoff = materials[index].alpha_cutoff;
    if (cutoff <= 0.0) return true;
    const uvec3 corners = triangles[triangle];
    float alpha = materials[index].alpha;
    if ((materials[index].flags & MATERIAL_COLORED) != 0u) {
        const float a = colors[corners.x].a;
        alpha *= a + (colors[corners.y].a - a) * weights.x + (colors[corners.z].a - a) * weights.y;
    }
    const int texture_index = materials[index].textures[TEXTURE_BASE_COLOR];
    if (texture_index >= 0) {
        const GpuTexture info = texture_infos[texture_index];
        const vec2 a = uvs[corners.x + info.first_uv], b = uvs[corners.y + info.first_uv], c = uvs[corners.z + info.first_uv];
        alpha *= sampleLevel(info, movedCoordinates(info, a + (b - a) * weights.x + (c - a) * weights.y), (info.flags & USE_NEAREST) != 0u).a;
    }
    return alpha >= cutoff - ALPHA_ROUNDING;
}

/// May light pass through the triangle somewhere, as through glass?
bool mayTransmit(uint triangle) {
    const uint index = triangle_materials[triangle];
    return materials[index].transmission > 0.0 && (materials[index].metallic < 1.0 || materials[index].textures[TEXTURE_METALLIC] >= 0);
}

/// The same, or beside it, since it is blended?
bool mayPass(uint triangle) { return (materials[triangle_materials[triangle]].flags & MATERIAL_BLENDED) != 0u || mayTransmit(triangle); }

// --- What shading asks for ---

#ifdef MATERIAL_EVALUATION
// MATERIALS_*: what some material of the scene is. What none is costs nothing: without textures other than of the base
// colour a material is read again wherever it is needed rather than kept.
layout(constant_id = 20) const uint material_kinds = 0u;
const bool textured = (material_kinds & MATERIALS_TEXTURED) != 0u, specified = (material_kinds & MATERIALS_SPECIFIED) != 0u,
           filtered = (material_kinds & MATERIALS_FILTERED) != 0u, blended = (material_kinds & MATERIALS_BLENDED) != 0u,
           coated = (material_kinds & MATERIALS_COATED) != 0u, sheened = (material_kinds & MATERIALS_SHEEN) != 0u,
           filmed = (material_kinds & MATERIALS_FILMED) != 0u, stretched = (material_kinds & MATERIALS_STRETCHED) != 0u,
           dispersive = (material_kinds & MATERIALS_DISPERSIVE) != 0u, seeping = (material_kinds & MATERIALS_SEEPING) != 0u,
           frosted = (material_kinds & MATERIALS_FROSTED) != 0u, catching = (material_kinds & MATERIALS_CATCHING) != 0u;

/// A material at a point; its base colour is the surface's.
struct Material {
    float metallic;
    vec3 emissive;
    float roughness;
    vec3 absorption;  ///< per world unit inside the volume; 0: none
    float transmission;
    float ior;
    float thickness;
    float occlusion;  ///< share of the sky's diffuse light that arrives
    vec3 f0;          ///< see GpuMaterial
    float f90;
    vec3 fresnel_fit;
    float clearcoat;
    float coat_roughness;
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence;
    float film_ior;
    float film_thickness;  ///< nm
    float spread;          ///< of the indices, see GpuMaterial
    float seeping_share;   ///< of the diffuse light: it comes out behind,
    vec3 seeping_color;    ///< times this
    uint flags;  ///< MATERIAL_*
};
/// What a point's textures give; the record's factors times this.
struct TextureFactors {
    vec3 emissive, specular_color, sheen_color, seeping_color;
    float metallic, roughness, transmission, thickness, occlusion, specular, clearcoat, coat_roughness, sheen_roughness, iridescence,
        film, seeping_share;
};

/// With the vertices' own colours; the fourth: alpha of what is blended, else 1.
vec4 baseColor(uint material, TexturePlace place) {
    vec4 color = vec4(materials[material].base_color, materials[material].alpha);
    if ((materials[material].flags & MATERIAL_COLORED) != 0u)
        color *= colors[place.corners.x] * place.weights.x + colors[place.corners.y] * place.weights.y + colors[place.corners.z] * place.weights.z;
    const int index = materials[material].textures[TEXTURE_BASE_COLOR];
    if (index >= 0) color *= textureAt(index, place);
    if (!blended || (materials[material].flags & MATERIAL_BLENDED) == 0u || color.a >= ALPHA_WHOLE) color.a = 1.0;
    return color;
}

/// All textures of a material but the base colour's and the normal's.
TextureFactors textureFactors(uint material, TexturePlace place) {
    TextureFactors f = TextureFactors(vec3(1), vec3(1), vec3(1), vec3(1), 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0);
    if (!textured || (materials[material].flags & MATERIAL_TEXTURED) == 0u) return f;
    int last = -1;  // several uses that follow each other are often one image
    vec4 value = vec4(1);
    for (int use = TEXTURE_EMISSIVE; use < TEXTURE_USES; use++) {
        const int index = materials[material].textures[use];
        if (index < 0 || TEXTURE_TURNS(use)) continue;
        if (index != last) value = textureAt(index, place);
        last = index;
        const float number = value[materials[material].channels[use >> 4] >> uint(2 * (use & 15)) & 3u];
        if (use == TEXTURE_EMISSIVE) f.emissive = value.rgb;
        if (use == TEXTURE_METALLIC) f.metallic = number;
        if (use == TEXTURE_ROUGHNESS) f.roughness = number;
        if (use == TEXTURE_TRANSMISSION) f.transmission = number;
        if (use == TEXTURE_THICKNESS) f.thickness = number;
        if (use == TEXTURE_OCCLUSION) f.occlusion = number;
        if (use == TEXTURE_SPECULAR) f.specular = number;
        if (use == TEXTURE_SPECULAR_COLOR) f.specular_color = value.rgb;
        if (use == TEXTURE_CLEARCOAT) f.clearcoat = number;
        if (use == TEXTURE_COAT_ROUGHNESS) f.coat_roughness = number;
        if (use == TEXTURE_SHEEN_COLOR) f.sheen_color = value.rgb;
        if (use == TEXTURE_SHEEN_ROUGHNESS) f.sheen_roughness = number;
        if (use == TEXTURE_IRIDESCENCE) f.iridescence = number;
        if (use == TEXTURE_FILM_THICKNESS) f.film = number;
        if (use == TEXTURE_DIFFUSE_TRANSMISSION) f.seeping_share = number;
        if (use == TEXTURE_DIFFUSE_TRANSMISSION_COLOR) f.seeping_color = value.rgb;
    }
    return f;
}

/// The material where its textures give these factors.
Material evaluate(uint material, TextureFactors f) {
    const GpuMaterial r = materials[material];
    Material m = Material(r.metallic, r.emissive, r.roughness, r.absorption, r.transmission, r.ior, r.thickness, 1.0, r.f0, r.f90, r.fresnel_fit, coated ? r.clearcoat : 0.0, r.coat_roughness,
                          sheened ? r.sheen_color : vec3(0), r.sheen_roughness, filmed ? r.iridescence : 0.0, r.film_ior, r.film_most, r.spread,
                          seeping ? r.diffuse_transmission : 0.0, r.diffuse_transmission_color, r.flags);
    if (!specified) m.flags &= ~MATERIAL_SCHLICK;  // none has it: the compiler may know
    if (textured) {
        m.metallic *= f.metallic;
        m.emissive *= f.emissive;
        m.roughness *= f.roughness;
        m.transmission *= f.transmission;
        m.thickness *= f.thickness;
        m.clearcoat *= f.clearcoat;
        m.coat_roughness *= f.coat_roughness;
        m.sheen_color *= f.sheen_color;
        m.sheen_roughness *= f.sheen_roughness;
        m.iridescence *= f.iridescence;
        m.film_thickness = mix(r.film_least, r.film_most, f.film);
        m.seeping_share *= f.seeping_share;
        m.seeping_color *= f.seeping_color;
        if ((m.flags & MATERIAL_SCHLICK) != 0u) {  // KHR_materials_specular
            m.f90 *= f.specular;
            m.f0 = min(r.fresnel_fit * f.specular_color, vec3(1)) * m.f90;
        }
        m.occlusion += r.occlusion_strength * (f.occlusion - 1.0);
    }
    return m;
}

/// Indices of refraction of red, green and blue (KHR_materials_dispersion); `middle`: green's.
vec3 channelIndices(float middle, float spread) { return max(vec3(1), middle + vec3(-1, 0, 1) * spread); }

/// Index of refraction of the volume of a material for a ray of this RAY_CHANNEL.
float materialIndex(uint material, uint channel) {
    const float middle = materials[material].ior;
    return dispersive && channel > 0u ? channelIndices(middle, materials[material].spread)[channel - 1u] : middle;
}

/// Absorption inside the volume of a material.
vec3 materialAbsorption(uint material) { return materials[material].absorption; }

/// Does the material bend the surface's normals, or with TEXTURE_COAT_NORMAL those of its coat?
bool bendsNormals(uint material, int use) { return textured && materials[material].textures[use] >= 0; }

/// Has the material a coat, somewhere at least?
bool isCoated(uint material) { return coated && materials[material].clearcoat > 0.0; }

/// Is the material's lobe stretched, somewhere at least?
bool isStretched(uint material) { return stretched && materials[material].anisotropy > 0.0; }

/// The direction along which the lobe is stretched, in the tangent's and the bitangent's parts, and how much.
vec3 stretch(uint material, TexturePlace place) {
    vec3 texel = vec3(1.0, 0.5, 1.0);
    const int index = materials[material].textures[TEXTURE_ANISOTROPY];
    if (index >= 0) texel = textureAt(index, place).rgb;
    const vec2 d = texel.rg * 2.0 - 1.0, along = materials[material].anisotropy_along;
    return vec3(along.x * d.x - along.y * d.y, along.y * d.x + along.x * d.y, materials[material].anisotropy * texel.b);
}

/// A vertex's tangent, and the side of its bitangent.
vec4 tangentOf(uint material, uint vertex) {
    const uint at = materials[material].first_tangent + 2u * vertex;
    return vec4(uvs[at], uvs[at + 1u]);
}

/// The normal's parts along the tangent, the bitangent and the interpolated normal (glTF 2.0, section 3.9.3).
vec3 normalParts(uint material, int use, TexturePlace place) {
    const float scale = use == TEXTURE_NORMAL ? materials[material].normal_scale : materials[material].coat_normal_scale;
    return (textureAt(materials[material].textures[use], place).rgb * 2.0 - 1.0) * vec3(scale, scale, 1);
}
#endif

#endif
