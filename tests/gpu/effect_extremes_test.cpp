// Random combinations of parameters at the ends of their ranges, seen from everywhere, give finite light that is not
// negative.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

#include "effect_frame.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall {
namespace {

// Sets each number to its minimum, its maximum or its default value.
Params random_params(std::mt19937& engine) {
  Params params;
  const auto pick = [&](double least, double greatest, double normal) {
    switch (engine() % 3) {
      case 0: return least;
      case 1: return greatest;
      default: return normal;
    }
  };
  char* const bytes = reinterpret_cast<char*>(&params);
  for (const ParamInfo& row : param_table()) {
    char* const at = bytes + row.offset;
    const int floats = row.type == ParamType::vec3 ? 3 : row.type == ParamType::float32 ? 1 : 0;
    for (int i = 0; i < floats; ++i) {
      float value = 0.0F;
      std::memcpy(&value, at + 4 * i, sizeof value);
      value = static_cast<float>(pick(row.min, row.max, value));
      std::memcpy(at + 4 * i, &value, sizeof value);
    }
    if (floats == 0) {
      std::uint32_t value = 0;
      std::memcpy(&value, at, sizeof value);
      if (row.type == ParamType::flag) value = engine() % 2;
      if (row.type == ParamType::uint32) value = static_cast<std::uint32_t>(pick(row.min, row.max, value));
      if (row.type == ParamType::enumeration) {
        std::uint32_t choices = 1;
        for (const char c : row.choices) choices += c == '|' ? 1 : 0;
        value = engine() % choices;
      }
      std::memcpy(at, &value, sizeof value);
    }
  }
  if (params.atmosphere.mie_phase == MiePhase::table) {
    const double angles_deg[] = {0, 30, 90, 180}, wavelengths_nm[] = {450, 650}, values[] = {1, 1, 1, 1, 1, 1, 1, 1};
    Result<std::shared_ptr<const PhaseTable>> table = PhaseTable::create(angles_deg, wavelengths_nm, values);
    EXPECT_OK(table);
    if (table.ok()) params.phase_table = table.value();
  }
  // Measured quantities require wavelengths for which there are data, and some exclude each other.
  AtmosphereParams& air = params.atmosphere;
  if (!check_params(params).ok()) {
    air.wavelengths_nm = AtmosphereParams().wavelengths_nm;
    air.visibility_m = 0.0F;
  }
  if (!check_params(params).ok()) {
    air.aerosol_optical_depth = air.ozone_du = air.pressure_hpa = 0.0F;
    params.scattering.color = ColorMode::rgb;
  }
  // More than 200 steps would take minutes and test nothing more.
  params.scattering.integration_steps = std::min(params.scattering.integration_steps, 200U);
  // Millions of samples for 16 pixels would also take minutes. epipolar_views_test.cpp tests both ends of these ranges.
  params.epipolar.slices = std::min(params.epipolar.slices, 33U);
  params.epipolar.samples = std::min(params.epipolar.samples, 33U);
  params.froxels.columns = std::min(params.froxels.columns, 16U);
  params.froxels.rows = std::min(params.froxels.rows, 16U);
  params.froxels.slices = std::min(params.froxels.slices, 16U);
  return params;
}

// TYNDALL_EXTREMES=80 and more tries more combinations. Most of the time goes into their pipelines.
int combinations() {
  const char* const count = std::getenv("TYNDALL_EXTREMES");
  return count != nullptr ? std::atoi(count) : 25;
}

class EffectExtremes : public GpuTest {};

TEST_F(EffectExtremes, EveryAllowedParameterGivesFiniteRadiance) {
  std::mt19937 engine(42);
  TestFrame shape;
  shape.extent = {4, 4};
  for (const OutputFormat format : {OutputFormat::rgba32f, OutputFormat::rgba16f}) {
    EffectDesc desc = desc_for(shape, format);
    desc.max_cascades = kMaxCascades;
    desc.max_shadow_resolution = shape.shadow_resolution;
    Result<Effect> effect = Effect::create(info(), desc, {});
    ASSERT_OK(effect);
    for (int i = 0; i < combinations(); ++i) {
      const Params params = random_params(engine);
      ASSERT_OK(effect.value().set_params(params));
      const auto pick = [&](std::initializer_list<double> values) {
        return *(values.begin() + engine() % values.size());
      };
      TestFrame frame = shape;
      const double top = params.atmosphere.height_m;
      const double deepest = std::max(-11000.0, -0.25 * static_cast<double>(params.planet.radius_m));
      const double altitude =
          pick({0.0, 0.5, 1000.0, 0.5 * top, top, 1.01 * top, 10.0 * top, -0.5, 0.04 * deepest, deepest});
      frame.view = TestView::at(altitude, pick({0.0, 1.0, 3.14159265}), pick({-1.5707963, -0.1, 0.0, 0.3, 1.5707963}),
                                pick({0.01, 0.6, 5.0}));
      const double elevation = pick({-1.5707963, -0.1, 0.0, 0.05, 1.0, 1.5707963});
      frame.to_sun = {0.0, std::sin(elevation), -std::cos(elevation)};
      frame.background = Vec3(static_cast<float>(pick({0.0, 1.0, 1e4})));
      const double distance = pick({0.0, 2.0, 3000.0, 1e6});
      frame.distance_m = [=](std::uint32_t x, std::uint32_t) { return x % 2 == 0 ? distance : 0.0; };
      const auto count = static_cast<std::uint32_t>(engine() % (kMaxCascades + 1));
      for (std::uint32_t c = 0; c < count; ++c) {
        Cascade cascade;
        cascade.far_m = static_cast<float>(pick({1.0, 1e4, 1e6}));
        cascade.near_m = 0.0F;
        const auto scale = static_cast<float>(pick({1e-7, 1e-4, 1.0}));
        for (const int k : {0, 6, 9}) cascade.shadow_from_world.m[k] = scale;
        cascade.shadow_from_world.m[5] = cascade.shadow_from_world.m[10] = 0.0F;
        frame.cascades.push_back(cascade);
      }
      frame.first_marched = count > 0 ? engine() % count : 0;
      frame.shadow_depth = [](std::uint32_t, double u, double) { return u < 0.5 ? 0.0F : 1.0F; };
      const Result<std::vector<glm::dvec3>> image = render(host(), effect.value(), frame, format);
      ASSERT_OK(image);
      for (std::size_t p = 0; p < image.value().size(); ++p) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_TRUE(std::isfinite(image.value()[p][c]) && image.value()[p][c] >= 0.0)
              << "frame " << i << " pixel " << p << " channel " << c << " is " << image.value()[p][c] << ": radius "
              << params.planet.radius_m << ", height " << params.atmosphere.height_m << ", scale heights "
              << params.atmosphere.rayleigh_scale_height_m << " " << params.atmosphere.mie_scale_height_m
              << ", altitude " << altitude << ", sun " << elevation << ", cascades " << count << ", distance "
              << distance << ", custom " << params.atmosphere.custom_coefficients.value << ", pitch "
              << frame.view.forward.y << ", technique " << static_cast<std::uint32_t>(params.scattering.technique)
              << ", single " << static_cast<std::uint32_t>(params.scattering.single) << ", multiple "
              << static_cast<std::uint32_t>(params.scattering.multiple);
        }
      }
    }
  }
}

}  // namespace
}  // namespace tyndall
