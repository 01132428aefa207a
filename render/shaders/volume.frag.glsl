layout(location = 0) out vec3 colour;

void main() { colour = vec3(1.0, 0.75, 0.1); }
