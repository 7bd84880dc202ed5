// shaders/post/tonemap_curves.glsl compiled as C++ in double precision.
#include <glm/glm.hpp>

#include "tyndall/post_settings.hpp"

namespace tyndall::post {
namespace glsl {

using uint = std::uint32_t;
using vec3 = glm::dvec3;
using mat3 = glm::dmat3;
using glm::clamp;
using glm::dot;
using glm::exp;
using glm::log;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::pow;

#define IN(type) const type&
#define OUT(type) type&
#define INOUT(type) type&
#ifdef __clang__
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float double
namespace {
#include "post/tonemap_curves.glsl"
}  // namespace
#undef float
#undef IN
#undef OUT
#undef INOUT

}  // namespace glsl

std::array<double, 3> tonemapped(const TonemapSettings& settings, double exposure,
                                 const std::array<double, 3>& radiance) {
  const glsl::vec3 scaled = glsl::tonemap_scaled({radiance[0], radiance[1], radiance[2]}, exposure);
  const double white_point = static_cast<double>(settings.white_point);
  const double saturation = static_cast<double>(settings.saturation);
  const glsl::vec3 mapped =
      glm::clamp(glsl::tonemap_apply(static_cast<glsl::uint>(settings.op), scaled, white_point, saturation), 0.0, 1.0);
  return {mapped.x, mapped.y, mapped.z};
}

}  // namespace tyndall::post
