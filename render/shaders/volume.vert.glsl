// Corners of lines, in clip space already.
layout(location = 0) in vec4 corner;

void main() { gl_Position = corner; }
