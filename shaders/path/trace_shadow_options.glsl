// How the trace_shadow passes walk: their specialisation constants.
layout(constant_id = 0) const uint hit_test = 0u;   // PEELRAY_EXACT, ...
layout(constant_id = 1) const uint traversal = 0u;  // PEELRAY_VOXELS, ...
layout(constant_id = 2) const uint batch = 0u;      // PEELRAY_ONE, ...
layout(constant_id = 3) const bool masked = false;  // the scene has masked materials
layout(constant_id = 8) const bool single_sided = false;  // ... and single-sided ones
layout(constant_id = 4) const uint instance_count = 0u;  // up to 8; 0: any number
layout(constant_id = 18) const bool refined = false;       // some voxels are
layout(constant_id = 5) const bool deferred = false;     // triangles are tested after their list's samples
#define PEELRAY_DEFER deferred
#define shadowOptions(any) PeelrayOptions(any, hit_test, traversal, params.tolerance, params.block, batch, instance_count, bare_count, refined)
layout(constant_id = 6) const bool counting = false;
layout(constant_id = 7) const uint bare_count = 0u;  // of up to 8 instances
#define COUNT_FIRST_BINDING 40
#include "common/counting.glsl"
