// Shows an image of the scene unchanged over the whole window.
#version 460

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

layout(binding = 0) uniform sampler2D image;

void main() { color = vec4(textureLod(image, uv, 0.0).rgb, 1.0); }
