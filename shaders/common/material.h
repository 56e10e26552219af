// Materials and textures.
#ifndef PEELRAY_MATERIAL_H
#define PEELRAY_MATERIAL_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

// What textures give, in the order of material_textures (src/scene/scene.h).
#define TEXTURE_BASE_COLOR 0
#define TEXTURE_EMISSIVE 1
#define TEXTURE_METALLIC 2
#define TEXTURE_ROUGHNESS 3
#define TEXTURE_TRANSMISSION 4
#define TEXTURE_THICKNESS 5
#define TEXTURE_NORMAL 6
#define TEXTURE_OCCLUSION 7
#define TEXTURE_SPECULAR 8
#define TEXTURE_SPECULAR_COLOR 9
#define TEXTURE_CLEARCOAT 10
#define TEXTURE_COAT_ROUGHNESS 11
#define TEXTURE_COAT_NORMAL 12
#define TEXTURE_SHEEN_COLOR 13
#define TEXTURE_SHEEN_ROUGHNESS 14
#define TEXTURE_IRIDESCENCE 15
#define TEXTURE_FILM_THICKNESS 16
#define TEXTURE_ANISOTROPY 17
#define TEXTURE_DIFFUSE_TRANSMISSION 18
#define TEXTURE_DIFFUSE_TRANSMISSION_COLOR 19
#define TEXTURE_USES 20
/// Does it give directions, which need the tangents? Else TextureFactors.
#define TEXTURE_TURNS(use) ((use) == TEXTURE_NORMAL || (use) == TEXTURE_COAT_NORMAL || (use) == TEXTURE_ANISOTROPY)

struct GpuMaterial {
    vec3 base_color;
    float metallic;
    vec3 emissive;
    float roughness;
    vec3 absorption;  ///< per world unit inside the volume; 0: none
    float transmission;
    float ior;
    int textures[TEXTURE_USES];  ///< by TEXTURE_*: an entry of the table of textures, -1: none
    uint channels[2];    ///< of those of single numbers, two bits each, in the same order, sixteen in one
    uint first_tangent;  ///< of the vertices' tangents, which lie behind the texture coordinates, two entries each
    float normal_scale;
    float occlusion_strength;
    float clearcoat;  ///< share of the surface that has a coat
    float coat_roughness;
    float coat_normal_scale;
    uint flags;          ///< MATERIAL_*
    float thickness;     ///< of a volume, world units; rays measure it, cube maps cannot
    float alpha;         ///< of the base colour
    float alpha_cutoff;  ///< 0: opaque
    vec3 f0;             ///< MATERIAL_SCHLICK: reflectance of the dielectric part at normal incidence; else: the fit's constant
    float f90;           ///< MATERIAL_SCHLICK: at grazing angles
    vec3 fresnel_fit;    ///< MATERIAL_SCHLICK: f0 before it is cut to 1 and scaled; else: its reflectance is about f0 and these times the powers of (1 - cosine) in tables.h
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence;       ///< share of the surface that a thin film covers
    float film_ior;
    float film_least;        ///< its thickness, nm, where the texture says 0
    float film_most;         ///< and 1
    float anisotropy;        ///< how much the lobe is stretched, [0, 1]
    vec2 anisotropy_along;   ///< cosine and sine of the direction's rotation from the tangent
    float spread;            ///< the index of blue less that of green, and of green less that of red
    float diffuse_transmission;  ///< share of the diffuse light that comes out behind
    vec3 diffuse_transmission_color;
};
SHARED_SIZE(GpuMaterial, 272);
#define MATERIAL_THIN 1u
#define MATERIAL_UNLIT 2u
#define MATERIAL_COLORED 4u       // vertices have colours
#define MATERIAL_SINGLE_SIDED 8u  // rays from behind pass
#define MATERIAL_SCHLICK 16u      // reflectance between f0 and f90; else by the index of refraction
#define MATERIAL_TEXTURED 32u     // by more than a base colour and what TEXTURE_TURNS
#define MATERIAL_BLENDED 64u      // covers what is behind it by its alpha only
#define MATERIAL_CATCHER 128u     // shows nothing but shadows and mirror images
/// Of all materials of a scene:
#define MATERIALS_TEXTURED 1u   // some have textures beside the base colour's
#define MATERIALS_SPECIFIED 2u  // some are MATERIAL_SCHLICK
#define MATERIALS_FILTERED 4u   // some have textures whose filter depends on how large they are seen
#define MATERIALS_BLENDED 8u    // some are MATERIAL_BLENDED
#define MATERIALS_COATED 16u    // some have a clear coat
#define MATERIALS_SHEEN 32u     // some have a sheen
#define MATERIALS_FILMED 64u    // some have a thin film
#define MATERIALS_STRETCHED 128u  // some have an anisotropic lobe
#define MATERIALS_DISPERSIVE 256u // some refract each colour differently
#define MATERIALS_SEEPING 512u    // some let diffuse light through
#define MATERIALS_FROSTED 1024u   // some are rough glass
#define MATERIALS_CATCHING 2048u  // some are MATERIAL_CATCHER

/// A texture as materials use it.
struct GpuTexture {
    uint offset;  ///< first word of its texels
    uint width;
    uint height;
    uint flags;     ///< wrap u (2 bits: repeat, mirror, clamp), wrap v (2 bits), USE_*
    uint first_uv;  ///< of its set of texture coordinates
    uint smaller;   ///< first word of levels 1, 2, ..., one after the other; USE_LEVELS
    vec2 u_axis;    ///< coordinates: u times this + v times the next + offset
    vec2 v_axis;
    vec2 uv_offset;
};
SHARED_SIZE(GpuTexture, 48);
#define USE_NEAREST 16u
#define USE_DATA 32u   // not encoded as sRGB
#define USE_DEEP 64u   // 16 bits a channel, two words a texel
#define USE_MOVED 128u // coordinates are transformed
#define USE_MIN_NEAREST 256u  // where it is made smaller
#define USE_LEVELS 512u       // and then the nearest of its levels serves,
#define USE_BETWEEN 1024u     // or two of them

/// Words of texels lie in the rows of an image of several layers, which no device limits to what a buffer may hold.
#define TEXEL_ROW_BITS 12u
#define TEXEL_LAYER_BITS 24u

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
