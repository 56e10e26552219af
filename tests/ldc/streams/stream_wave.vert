// Corners of four square patches over [-1, 1]².
#version 460
void main() {
    const uint patch_index = uint(gl_VertexIndex) / 4u, k = uint(gl_VertexIndex) % 4u;
    gl_Position = vec4(vec2(patch_index & 1u, patch_index >> 1u) - 1.0 + vec2(k & 1u, k >> 1u), patch_index, 1);
}
