// Value types of the public interface. They need no mathematics library: an engine's own vectors and matrices convert
// with std::bit_cast.
// Conventions: right-handed world, x east, y up, z south, metres; matrices are column-major and
// multiply column vectors (clip = projection * view * world).
#pragma once

#include <cstdint>

namespace tyndall {

struct Vec3 {
  float x = 0.0F, y = 0.0F, z = 0.0F;

  constexpr Vec3() = default;
  constexpr explicit Vec3(float all) : x(all), y(all), z(all) {}
  constexpr Vec3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  constexpr bool operator==(const Vec3&) const = default;
};

// A position in double precision. Far from the origin of the world, a float would round to decimetres.
struct DVec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  constexpr DVec3() = default;
  constexpr DVec3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  constexpr bool operator==(const DVec3&) const = default;
};

struct UVec4 {
  std::uint32_t x = 0, y = 0, z = 0, w = 0;

  constexpr UVec4() = default;
  constexpr UVec4(std::uint32_t x_, std::uint32_t y_, std::uint32_t z_, std::uint32_t w_)
      : x(x_), y(y_), z(z_), w(w_) {}
  constexpr bool operator==(const UVec4&) const = default;
};

// Column-major: m[4 * column + row].
struct Mat4 {
  float m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  constexpr bool operator==(const Mat4&) const = default;
};

// A boolean of four bytes, so that parameter structures have the same layout in C++ and in GLSL.
struct Flag {
  std::uint32_t value = 0;

  constexpr Flag() = default;
  constexpr Flag(bool on) : value(on ? 1U : 0U) {}        // NOLINT(google-explicit-constructor)
  constexpr operator bool() const { return value != 0; }  // NOLINT(google-explicit-constructor)
};

}  // namespace tyndall
