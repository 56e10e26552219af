// What the passes of depth peeling share.
#ifndef PEELRAY_LDC_PEEL_GLSL
#define PEELRAY_LDC_PEEL_GLSL

const uint LDC_NOTHING = 0xffffffffu;  // as the target of ids is cleared

/// Depth as the target stores it: voxels, or the share of the LDI's depth in 16 bits.
float peelStored(float w, float voxels) { return params.by_pixel == 2u ? ldcHalf(w / voxels) : w; }
/// In voxels.
float peelDepth(float stored, float voxels) { return params.by_pixel == 2u ? stored * voxels : stored; }
/// What the depth test and the rejection both compare: a power of two, so that different depths stay different.
float peelKey(float w) { return clamp(w, 1e-20, 4095.0) / 4096.0; }

#endif
