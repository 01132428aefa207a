// A triangle over the whole picture, at the far end of the depth range: it shows where nothing else was drawn.
out vec3 ray;

void main() {
  ray = ray_ecef[gl_VertexID].xyz;
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
