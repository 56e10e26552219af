#version 460
layout(location = 0) flat in uvec2 surface;
layout(location = 0) out uvec2 color;

void main() { color = surface; }
