// Light of the sky from the coefficients of tyndall::SkyProbe. Include this file in your own shaders, and declare the
// buffer there:  layout(std140, set = S, binding = B) uniform Sky { vec4 sky_coefficients[9]; };
// The cube map of SkyProbe::cube(), if there is one, is a  uniform samplerCube.
// Directions are unit vectors in the axes in which SkyProbeInputs were given.
#ifndef TYNDALL_SKY_PROBE_GLSL
#define TYNDALL_SKY_PROBE_GLSL

// Returns the real spherical harmonics up to order 2 in the direction `d`, orthonormal over the sphere, as in
// R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps" (2001), equation 3. The
// order is (l, m) = (0, 0), (1, -1), (1, 0), (1, 1), (2, -2), (2, -1), (2, 0), (2, 1), (2, 2): 1, y, z, x, xy, yz,
// 3z^2 - 1, xz, x^2 - y^2, each with its factor.
void tyndall_sky_basis(vec3 d, out float basis[9]) {
  basis[0] = 0.282094791773878;
  basis[1] = 0.488602511902920 * d.y;
  basis[2] = 0.488602511902920 * d.z;
  basis[3] = 0.488602511902920 * d.x;
  basis[4] = 1.092548430592079 * d.x * d.y;
  basis[5] = 1.092548430592079 * d.y * d.z;
  basis[6] = 0.315391565252520 * (3.0 * d.z * d.z - 1.0);
  basis[7] = 1.092548430592079 * d.x * d.z;
  basis[8] = 0.546274215296040 * (d.x * d.x - d.y * d.y);
}

// Returns the coefficients of the clamped cosine, by which those of the radiance become those of the irradiance
// (equation 8): pi, 2 pi / 3 and pi / 4 for l = 0, 1 and 2.
float tyndall_sky_cosine(int index) {
  return index == 0 ? 3.141592653589793 : index < 4 ? 2.094395102393195 : 0.785398163397448;
}

// Returns the irradiance of a surface with the normal `normal`, without direct sunlight. Divide by pi and multiply by
// the albedo for the radiance of a diffuse surface.
vec3 tyndall_sky_irradiance(vec4 coefficients[9], vec3 normal) {
  float basis[9];
  tyndall_sky_basis(normal, basis);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 9; ++i) sum += tyndall_sky_cosine(i) * basis[i] * coefficients[i].rgb;
  return max(sum, vec3(0.0));
}

// Returns the radiance in the direction `d` at the resolution of the coefficients, about 90 degrees.
vec3 tyndall_sky_radiance(vec4 coefficients[9], vec3 d) {
  float basis[9];
  tyndall_sky_basis(d, basis);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 9; ++i) sum += basis[i] * coefficients[i].rgb;
  return max(sum, vec3(0.0));
}

// Returns the level of the cube map for a surface with this perceptual roughness, the square root of the alpha of GGX.
float tyndall_sky_level(samplerCube cube, float roughness) {
  return clamp(roughness, 0.0, 1.0) * float(textureQueryLevels(cube) - 4);
}

// Returns the radiance around the direction `d`, into which the view is reflected, for a surface with this roughness.
// Multiply it by the reflectance of the surface, as in the split-sum approximation of Karis.
vec3 tyndall_sky_reflection(samplerCube cube, vec3 d, float roughness) {
  return textureLod(cube, d, tyndall_sky_level(cube, roughness)).rgb;
}

#endif
