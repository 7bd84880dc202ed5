// The structures of shaders/shared in C++, in single precision, as they are uploaded to the GPU. vec3 is three floats
// (12 bytes, aligned to 4). The members are ordered so that the layout agrees with std430.
#pragma once

#include <cstdint>

#include "tyndall/types.hpp"

namespace tyndall::shared {

using uint = std::uint32_t;
using vec3 = Vec3;
using mat4 = Mat4;
struct vec2 {
  float x, y;
};
struct vec4 {
  float x = 0.0F, y = 0.0F, z = 0.0F, w = 0.0F;
  constexpr vec4() = default;
  constexpr vec4(double a, double b, double c, double d)
      : x(static_cast<float>(a)), y(static_cast<float>(b)), z(static_cast<float>(c)), w(static_cast<float>(d)) {}
};
struct ivec2 {
  std::int32_t x, y;
};
struct ivec3 {
  std::int32_t x, y, z;
};

#include "shared/atmosphere.h"
#include "shared/constant_ids.h"
#include "shared/counters.h"
#include "shared/epipolar.h"
#include "shared/frame_constants.h"
#include "shared/homogeneous.h"
#include "shared/medium.h"
#include "shared/oneil.h"
#include "shared/probe.h"
#include "shared/tables.h"

#include "shared/sky_probe.h"  // uses TableShape

// The Medium of shaders for scattering.color = spectral. Others read the first part of it.
struct SpectralMedium : Medium {
  vec4 fourth_channel;
};

static_assert(sizeof(OneilScale) == 32 && sizeof(Oneil) == 96, "the layout of Oneil must agree with std430");
static_assert(sizeof(AtmosphereConstants) == 256, "the layout of AtmosphereConstants must agree with std140");
static_assert(sizeof(SpectralMedium) == sizeof(Medium) + 16 && sizeof(FrameConstants) % 16 == 0,
              "the layouts of spectral quantities must agree with std430");
static_assert(sizeof(Medium) == 96, "the layout of Medium must agree with std430");
static_assert(sizeof(Homogeneous) == 64, "the layout of Homogeneous must agree with std430");
static_assert(sizeof(QuadratureRay) == 80 + 40 * sizeof(RayNode) && sizeof(RayNode) == 32 && sizeof(TableShape) == 32,
              "the layouts of tables must agree with std430");
static_assert(sizeof(EpipolarConstants) == 128 && sizeof(EpipolarSlice) == 32 && sizeof(SliceLine) == 32,
              "the layouts of epipolar sampling must agree with std430");
static_assert(sizeof(SkyProbeConstants) == 112, "the layout of sky probes must agree with std430");
static_assert(sizeof(ProbeRay) == 32 && sizeof(ProbeResult) == 32, "the layouts of probes must agree with std430");

}  // namespace tyndall::shared
