#version 460
layout(vertices = 4) out;
layout(constant_id = 3) const uint LEVEL = 1;

void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    for (int i = 0; i < 4; i++) gl_TessLevelOuter[i] = float(LEVEL);
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = float(LEVEL);
}
