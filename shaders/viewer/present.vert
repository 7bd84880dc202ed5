// A triangle that covers the window; uv runs from 0 to 1 across the window.
#version 460

layout(location = 0) out vec2 uv;

void main() {
  uv = vec2(gl_VertexIndex == 1 ? 2.0 : 0.0, gl_VertexIndex == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
