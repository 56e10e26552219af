// What every shader of Peelray includes first.
#ifndef PEELRAY_COMMON_GLSL
#define PEELRAY_COMMON_GLSL

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// A storage buffer `name` of elements of `type`. Commands::run finds it by its name, less "_block".
#define BUFFER(access, index, type, name) \
    layout(set = 0, binding = index, scalar) access buffer name##_block { type name[]; };

// The same for a type whose size is a multiple of 8 or 16 bytes, and whose members lie as std430 has them: loaded at
// once, not word by word.
#define BUFFER_ALIGNED(access, index, type, name) \
    layout(set = 0, binding = index, std430) access buffer name##_block { type name[]; };

// An image of several layers, read texel by texel: `type` is texture2DArray or utexture2DArray.
#define IMAGE(index, type, name) layout(set = 0, binding = index) uniform type name;

// The pass's parameters: one struct from a header that C++ includes, too.
#define PARAMS(type) \
    layout(push_constant, scalar) uniform params_block { type params; };

// Workgroups come in rows of DISPATCH_ROW, since a device may run no more than 65535 in one direction (see groups_for).
#define DISPATCH_ROW 32768u
#define GROUP_INDEX (gl_WorkGroupID.y * DISPATCH_ROW + gl_WorkGroupID.x)
#define GLOBAL_INDEX (GROUP_INDEX * gl_WorkGroupSize.x + gl_LocalInvocationIndex)

#endif
