// Which ways light takes as photons.
#ifndef PEELRAY_FOLLOWED_GLSL
#define PEELRAY_FOLLOWED_GLSL

#include "path/interface.glsl"

/// Are photons reflected by an opaque lobe? Those that samples of pixels follow.
bool photonsFollow(float roughness, float metallic) { return roughness < TRACED_ROUGHNESS || metallic > MOSTLY_METAL; }
/// The same of a material's lobe below its coat.
bool photonsFollow(Material m, float roughness) { return transmits(m) || photonsFollow(roughness, m.metallic); }

/// How much light a surface scatters: where that is nothing, photons are not gathered.
float photonsStay(Material m) { return (m.flags & MATERIAL_UNLIT) != 0u ? 0.0 : (1.0 - m.metallic) * (1.0 - m.transmission); }

#endif
