#include "effect/table_steps.hpp"

#include <algorithm>

#include "air/phase.hpp"
#include "effect/table_plan.hpp"
#include "effect_shaders.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kAltitudesPerStep = 8;  // of the gathering grid
// No step has more invocations, so that none takes long enough for the time-out of a driver.
constexpr std::uint32_t kMaxInvocations = 131072;

constexpr const char* kSunLight = "sun_light";
constexpr const char* kGridNodes = "grid_nodes";
constexpr const char* kPhaseMatrix = "phase_matrix";
constexpr const char* kGatherSingle = "gather_single";
constexpr const char* kGatherMultiple = "gather_multiple";
constexpr const char* kScatter = "scatter";
constexpr const char* kGatherLate = "gather_late";
constexpr const char* kScatterLate = "scatter_late";
constexpr const char* kSkyLight = "sky_light";
constexpr const char* kRayNodes = "ray_nodes";
constexpr const char* kTableSingle = "table_single";
constexpr const char* kTableHigh = "table_high";
constexpr const char* kStepNames[] = {kSunLight,       kGridNodes, kPhaseMatrix, kGatherSingle,
                                      kGatherMultiple, kScatter,   kGatherLate,  kScatterLate,
                                      kSkyLight,       kRayNodes,  kTableSingle, kTableHigh};

// Makes the steps of a build for one representation of light.
struct StepMaker {
  ColorMode color;
  bool tabulated;  // the aerosol's phase function is read from a table

  Step operator()(const char* name, const gpu::Shader& shader, Resource rays, VkExtent3D invocations,
                  std::array<std::uint32_t, 2> push = {}) const;
};

Step StepMaker::operator()(const char* name, const gpu::Shader& shader, Resource rays, VkExtent3D invocations,
                           std::array<std::uint32_t, 2> push) const {
  Specialisation constants;
  constants[shared::kRaysOfTablesId] = rays == Resource::table_rays ? 1 : 0;
  constants[shared::kPhaseTableId] = tabulated ? 1 : 0;
  Step step;
  step.name = name;
  step.pipeline = pipeline_key(variant_for(shader, Target::cpu, color), constants);
  step.chosen = rays;
  step.invocations = invocations;
  step.push = push;
  return step;
}

// Fills the tables altitude by altitude. Their other axes are sun, angle and view; each row of a step has all suns of a
// few angles of one view.
void append_tables(const Params& params, bool single, bool high, std::vector<Step>& out) {
  const StepMaker step_of = {params.scattering.color, air::tabulated(params.atmosphere)};
  const UVec4& size = params.tables.size;
  const std::uint32_t groups = (size.w + shared::kAnglesPerInvocation - 1) / shared::kAnglesPerInvocation;
  const std::uint32_t rows = groups * size.y;
  const std::uint32_t width = shaders::table_high_comp.local_size[0];
  const std::uint32_t rows_per_step = kMaxInvocations / ((size.z + width - 1) / width * width);
  for (std::uint32_t altitude = 0; altitude < size.x; ++altitude) {
    out.push_back(step_of(kRayNodes, shaders::ray_nodes_comp, Resource::table_rays, {size.y, 1, 1}, {altitude, 0}));
    for (std::uint32_t first = 0; first < rows; first += rows_per_step) {
      const VkExtent3D invocations = {size.z, std::min(rows_per_step, rows - first), 1};
      const std::array<std::uint32_t, 2> push = {altitude, first};
      if (single)
        out.push_back(step_of(kTableSingle, shaders::table_single_comp, Resource::table_rays, invocations, push));
      if (high) out.push_back(step_of(kTableHigh, shaders::table_high_comp, Resource::table_rays, invocations, push));
    }
  }
}

}  // namespace

std::vector<Step> table_steps(const Params& params, std::uint32_t stale) {
  const StepMaker step_of = {params.scattering.color, air::tabulated(params.atmosphere)};
  const bool high = (stale & kHighTables) != 0;
  const bool single = (stale & kSingleTables) != 0;
  std::vector<Step> out;
  if ((stale & bit(TableId::sun_transmittance)) != 0) {
    out.push_back(step_of(kSunLight, shaders::sun_light_comp, Resource::none, kSunLightExtent));
  }
  if (high) {
    // The orders of scattering, solved on the gathering grid.
    constexpr std::uint32_t altitudes = shared::kGatherAltitudes;
    constexpr std::uint32_t azimuth_groups = shared::kGatherAzimuths / shared::kAnglesPerInvocation;
    out.push_back(
        step_of(kGridNodes, shaders::ray_nodes_comp, Resource::grid_rays, {shared::kGatherZeniths, altitudes, 1}));
    out.push_back(
        step_of(kPhaseMatrix, shaders::phase_matrix_comp, Resource::none, {shared::kSourceZeniths, altitudes, 1}));
    const std::uint32_t orders = params.tables.orders;
    const bool late = orders > 2;
    // Without late orders, the last iteration scatters nothing, but adds the irradiance of the last order.
    for (std::uint32_t order = 2; order <= (late ? orders : orders + 1); ++order) {
      for (std::uint32_t first = 0; first < altitudes; first += kAltitudesPerStep) {
        const std::uint32_t count = std::min(kAltitudesPerStep, altitudes - first);
        out.push_back(step_of(order == 2 ? kGatherSingle : kGatherMultiple,
                              order == 2 ? shaders::gather_single_comp : shaders::gather_multiple_comp,
                              Resource::grid_rays,
                              {shared::kGatherSuns, azimuth_groups, count * shared::kGatherZeniths}, {first, order}));
      }
      for (std::uint32_t first = 0; first < altitudes; first += kAltitudesPerStep) {
        const std::uint32_t count = std::min(kAltitudesPerStep, altitudes - first);
        const gpu::Shader& scatter = shaders::scatter_comp;
        out.push_back(step_of(kScatter, scatter, Resource::none,
                              {shared::kGatherSuns * scatter.local_size[0], count, 1}, {first, order}));
      }
    }
    for (std::uint32_t order = orders + 1; late && order <= orders + shared::kLateOrders; ++order) {
      out.push_back(step_of(kGatherLate, shaders::gather_late_comp, Resource::grid_rays,
                            {shared::kGatherSuns, shared::kGatherZeniths, altitudes}, {0, order}));
      out.push_back(step_of(kScatterLate, shaders::scatter_late_comp, Resource::none,
                            {shared::kGatherSuns, shared::kSourceZeniths, altitudes}, {0, order}));
    }
    out.push_back(step_of(kSkyLight, shaders::sky_light_comp, Resource::none, kSkyLightExtent));
  }
  append_tables(params, single, high, out);
  return out;
}

std::span<const char* const> table_step_names() { return kStepNames; }

}  // namespace tyndall
