in vec3 lit;
layout(location = 0) out vec3 colour;

void main() { colour = lit; }
