// Materials and textures.
#ifndef PEELRAY_MATERIAL_H
#define PEELRAY_MATERIAL_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

struct GpuMaterial {
    vec3 base_color;
    float metallic;
    vec3 emissive;
    float roughness;
    vec3 absorption;  ///< per world unit inside the volume; 0: none
    float transmission;
    float ior;
    int texture;         ///< base colour, -1: none
    uint flags;          ///< MATERIAL_*
    float thickness;     ///< of a volume, world units; rays measure it, cube maps cannot
    float alpha;         ///< of the base colour
    float alpha_cutoff;  ///< 0: opaque
    vec3 f0;             ///< MATERIAL_SCHLICK: reflectance of the dielectric part at normal incidence; else: the fit's constant
    float f90;           ///< MATERIAL_SCHLICK: at grazing angles
    vec3 fresnel_fit;    ///< else: its reflectance is about f0 and these times the powers of (1 - cosine) in split_sum.h
};
SHARED_SIZE(GpuMaterial, 100);
#define MATERIAL_THIN 1u
#define MATERIAL_UNLIT 2u
#define MATERIAL_COLORED 4u        // vertices have colours
#define MATERIAL_SCHLICK 8u        // reflectance between f0 and f90; else by the index of refraction
#define MATERIAL_SINGLE_SIDED 16u  // rays from behind pass

struct GpuTexture {
    uint offset;  ///< first texel in the texel buffer
    uint width;
    uint height;
    uint flags;  ///< wrap u (2 bits: repeat, mirror, clamp), wrap v (2 bits), bit 4: nearest
};
SHARED_SIZE(GpuTexture, 16);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
