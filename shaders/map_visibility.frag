#version 460
layout(location = 0) flat in uint triangle;
layout(location = 0) out uint color;

void main() { color = triangle; }
