#include "random_inputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

namespace tyndall {
namespace {

std::uint32_t choices_of(const ParamInfo& row) {
  return 1 + static_cast<std::uint32_t>(std::count(row.choices.begin(), row.choices.end(), '|'));
}

// Changes one parameter, within the range of its row.
void change(Params& params, const ParamInfo& row, Random& random) {
  static const Params defaults;
  char* const at = reinterpret_cast<char*>(&params) + row.offset;
  const char* const usual = reinterpret_cast<const char*>(&defaults) + row.offset;
  const std::size_t floats = row.type == ParamType::vec3 ? 3 : row.type == ParamType::float32 ? 1 : 0;
  for (std::size_t i = 0; i < floats; ++i) {
    float value = 0.0F;
    std::memcpy(&value, usual + 4 * i, sizeof value);
    value = std::clamp(static_cast<float>(random.number(row.min, row.max, static_cast<double>(value))),
                       static_cast<float>(row.min), static_cast<float>(row.max));
    std::memcpy(at + 4 * i, &value, sizeof value);
  }
  if (floats > 0) return;
  if (row.type == ParamType::uvec4) {
    // tables.size, small: larger tables take long and do nothing else.
    const std::array<std::uint32_t, 4> size = {2 + random.below(5), 4 + 2 * random.below(7), 2 + random.below(9),
                                               2 + random.below(5)};
    std::memcpy(at, size.data(), sizeof size);
    return;
  }
  std::uint32_t value = 0;
  std::memcpy(&value, usual, sizeof value);
  if (row.type == ParamType::flag) value = random.below(2);
  if (row.type == ParamType::enumeration) value = random.below(choices_of(row));
  if (row.type == ParamType::uint32)
    value = static_cast<std::uint32_t>(random.number(row.min, row.max, static_cast<double>(value)));
  std::memcpy(at, &value, sizeof value);
}

// Returns whether a change of this row compiles pipelines, which takes most of the time on a CPU device.
bool is_slow(const ParamInfo& row) { return row.affects == Affects::Pipeline || row.affects == Affects::Everything; }

}  // namespace

void shorten(Params& params) {
  if (params.tables.size == Params().tables.size) params.tables.size = {4, 8, 8, 4};
  params.epipolar.slices = std::min(params.epipolar.slices, 64U);
  params.epipolar.samples = std::min(params.epipolar.samples, 64U);
  params.froxels.columns = std::min(params.froxels.columns, 16U);
  params.froxels.rows = std::min(params.froxels.rows, 16U);
  params.froxels.slices = std::min(params.froxels.slices, 16U);
  params.scattering.integration_steps = std::min(params.scattering.integration_steps, 64U);
  params.tables.orders = std::min(params.tables.orders, 3U);
}

Params changed(const Params& from, Random& random) {
  Params params = from;
  const std::span<const ParamInfo> rows = param_table();
  for (std::uint32_t count = 1 + random.below(4); count > 0; --count) {
    const ParamInfo& row = rows[random.below(static_cast<std::uint32_t>(rows.size()))];
    if (!is_slow(row) || random.one_in(3)) change(params, row, random);
  }
  if (random.one_in(10)) params = Params();
  shorten(params);
  return params;
}

TestFrame random_frame(const Params& params, VkExtent2D limit, Random& random) {
  TestFrame frame;
  frame.extent = {1 + random.below(limit.width), 1 + random.below(limit.height)};
  frame.shadow_resolution = 1 + random.below(kLargestShadows);
  const double top = static_cast<double>(params.atmosphere.height_m);
  const double deepest = std::max(-11000.0, -0.25 * static_cast<double>(params.planet.radius_m));
  const std::array<double, 9> altitudes = {0.0,        0.5,        1000.0, random.uniform(0.0, top),    top,
                                           1.01 * top, 10.0 * top, -0.5,   random.uniform(deepest, 0.0)};
  frame.view = TestView::at(altitudes[random.below(9)], random.uniform(-4.0, 4.0), random.uniform(-1.5707, 1.5707),
                            std::pow(10.0, random.uniform(-2.0, 0.7)));
  const double elevation = random.uniform(-1.5707, 1.5707);
  const double azimuth = random.uniform(-3.2, 3.2);
  frame.to_sun = {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                  -std::cos(elevation) * std::cos(azimuth)};
  frame.irradiance = Vec3(static_cast<float>(random.number(0.0, 1e5, 10.0)));
  frame.background = Vec3(static_cast<float>(random.number(0.0, 1e4, 0.0)));
  const std::array<double, 2> distances = {random.number(0.0, 1e7, 3000.0), random.number(0.0, 1e5, 20.0)};
  const std::uint32_t stripe = 1 + random.below(8);
  frame.distance_m = [=](std::uint32_t x, std::uint32_t y) {
    return (x + y) % stripe == 0 ? 0.0 : distances[x / stripe % 2];
  };
  const std::uint32_t count = random.below(5);
  double near_m = 0.0;
  for (std::uint32_t c = 0; c < count; ++c) {
    const double far_m = near_m + random.number(1.0, 1e6, 5000.0);
    frame.cascades.push_back(
        sun_cascade(frame.to_sun, frame.view.position, random.number(1.0, 1e6, 20000.0), near_m, far_m));
    near_m = far_m;
  }
  frame.first_marched = count > 0 ? random.below(count) : 0;
  const double waves = random.uniform(0.0, 20.0);
  frame.shadow_depth = [=](std::uint32_t c, double u, double v) {
    return static_cast<float>(0.5 + 0.5 * std::sin(waves * (u + 0.3 * v + c)));
  };
  return frame;
}

}  // namespace tyndall
