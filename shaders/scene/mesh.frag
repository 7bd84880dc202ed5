// Shades meshes as the camera sees them. Writes the radiance of the surface or, for clear glass, the factor by which
// the picture behind it is multiplied.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/constant_ids.h"
#include "scene/mesh_light.glsl"
#include "scene/mesh_push.glsl"

layout(location = 0) in vec3 local_position;
layout(location = 1) in vec3 local_normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 vertex_color;
layout(location = 4) flat in float handed;
layout(location = 0) out vec4 radiance;

layout(binding = 3) uniform sampler2D base_color;

layout(constant_id = kLayerId) const uint kLayer = kOpaqueLayer;

const float kPerPi = 0.318309886;

// Sunlight through diffusing glass: a part is scattered uniformly, the rest into a lobe of some 20 degrees around its
// old direction (Henyey-Greenstein, g = 0.85, integral 1).
const float kForward = 0.85;
const float kForwardShare = 0.3;
float forward_lobe(float cosine) {
  const float g = kForward;
  float d = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * 3.14159265 * d * sqrt(d));
}

void main() {
  bool front = gl_FrontFacing == (handed > 0.0);
  vec4 base = texture(base_color, uv) * push.color * vertex_color;
  // The triangle's normal on the side of the eye. Computed before any discard, because derivatives need neighbours.
  vec3 shape = cross(dFdx(local_position), dFdy(local_position));
  vec3 to_eye = mesh.camera_position - local_position;
  shape = dot(shape, shape) > 0.0 ? normalize(shape) : vec3(0.0, 1.0, 0.0);
  if (dot(shape, to_eye) < 0.0) shape = -shape;
  if (!front && push.double_sided == 0u) discard;
  if (base.a < push.alpha_cutoff) discard;

  vec3 transmitted = passing(base);
  if (kLayer == kClearLayer) {
    radiance = vec4(transmitted, 1.0);
    return;
  }
  vec3 normal = front ? local_normal : -local_normal;
  float length_of_normal = length(normal);
  normal = length_of_normal > 1e-3 ? normal / length_of_normal : shape;
  if (dot(normal, shape) < 0.0) normal = shape;

  SurfaceLight light = surface_light(local_position);
  uint cascade;
  vec3 near = irradiance(light, local_position, shape, normal, mesh.sky_light, push.kind >= kBlend, cascade);
  vec3 albedo = base.rgb;
  if (push.kind == kGlass) albedo *= 1.0 - push.transmission;
  if (push.kind == kBlend) albedo *= base.a;
  if (mesh.show_cascades != 0u && cascade < mesh.cascade_count) albedo = 0.75 * albedo + 0.25 * cascade_color(cascade);
  vec3 sum = albedo * kPerPi * near;
  if (kLayer == kOpaqueLayer && push.kind == kGlass) {
    // Seen from behind, the other side is the outside, under the whole sky.
    vec3 far = (front ? mesh.sky_light : 1.0) * light.sky * 0.5 * (1.0 - dot(normal, light.up));
    far += (front ? mesh.sky_light : 1.0) * light.bounced * 0.5 * (1.0 + dot(normal, light.up));
    sum += transmitted * kPerPi * far;
    float against = -dot(normal, mesh.direction_to_sun);
    if (against > 0.0) {
      uint outside;
      float lit = sun_light_at(local_position, -shape, outside);
      float lobe = forward_lobe(-dot(normalize(to_eye), mesh.direction_to_sun));
      sum += transmitted * light.sun * (lit * against) * mix(kPerPi, lobe, kForwardShare);
    }
  }
  radiance = vec4(sum * mesh.sun_irradiance, 1.0);
}
