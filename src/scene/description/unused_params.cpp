#include "scene/description/unused_params.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "scene/description/camera_exposure.hpp"
#include "scene/description/model_registry.hpp"

namespace tyndall::scene {
namespace {

bool is_default(const ParamInfo& row, const void* structure, const void* defaults) {
  const char* const a = static_cast<const char*>(structure) + row.offset;
  const char* const b = static_cast<const char*>(defaults) + row.offset;
  if (row.type == ParamType::string)
    return *reinterpret_cast<const std::string*>(a) == *reinterpret_cast<const std::string*>(b);
  const std::size_t size = row.type == ParamType::dvec3   ? sizeof(DVec3)
                           : row.type == ParamType::vec3  ? sizeof(Vec3)
                           : row.type == ParamType::uvec4 ? sizeof(UVec4)
                                                          : sizeof(float);
  return std::memcmp(a, b, size) == 0;
}

// Returns "group.name" for every parameter that does not have its default value.
std::vector<std::string> changed(const Params& params, const SceneParams& scene) {
  static const Params kParams;
  static const SceneParams kScene;
  std::vector<std::string> out;
  const auto add = [&](std::span<const ParamInfo> table, const void* structure, const void* defaults) {
    for (const ParamInfo& row : table) {
      if (!is_default(row, structure, defaults)) out.push_back(std::string(row.group) + "." + std::string(row.name));
    }
  };
  add(scene_param_table(), &scene, &kScene);
  add(param_table(), &params, &kParams);
  return out;
}

template <typename T>
bool is_one_of(T value, std::initializer_list<T> list) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// Reports parameters of the atmosphere that others replace (docs/air.md).
template <typename Check>
void check_air(const AtmosphereParams& air, const Check& check) {
  const bool depth = air.aerosol_optical_depth > 0.0F;
  check(depth || air.visibility_m > 0.0F, {"atmosphere.aerosol_density"},
        depth ? "atmosphere.aerosol_optical_depth" : "atmosphere.visibility_m");
  check(!(air.single_scattering_albedo == Vec3(0.0F)) && (depth || air.visibility_m > 0.0F),
        {"atmosphere.aerosol_absorption", "atmosphere.mie_scattering", "atmosphere.mie_absorption"},
        "atmosphere.single_scattering_albedo");
  const bool draine = air.mie_phase == MiePhase::draine;
  const bool table = air.mie_phase == MiePhase::table;
  const std::string_view phase = draine  ? "atmosphere.mie_phase = draine"
                                 : table ? "atmosphere.mie_phase = table"
                                         : "this atmosphere.mie_phase";
  check(draine || table, {"atmosphere.mie_g"}, phase);
  check(!draine, {"atmosphere.droplet_diameter_um"}, phase);
  check(!table, {"atmosphere.phase_table"}, phase);
  check(air.ozone_du > 0.0F, {"atmosphere.ozone_absorption"}, "atmosphere.ozone_du");
  check(air.pressure_hpa > 0.0F, {"atmosphere.rayleigh_scattering"}, "atmosphere.pressure_hpa");
}

template <typename Check>
void check_terrain_and_meshes(const SceneParams& scene, const Check& check) {
  const std::string& source = scene.terrain.source;
  check(source == "none", {"terrain.seed", "terrain.exaggeration", "terrain.shading", "terrain.units"},
        "terrain.source = none");
  check(source == "procedural", {"terrain.units"}, "terrain.source = procedural");
  check(scene.meshes.source == "none", {"meshes.position_m", "meshes.scale", "meshes.yaw_deg", "meshes.sky_light"},
        "meshes.source = none");
}

// Reports parameters of scattering by the effect that others switch off.
template <typename Check>
void check_scattering(const Params& params, bool by_effect, bool homogeneous, const Check& check) {
  if (!by_effect) return;
  const ScatteringParams& scattering = params.scattering;
  const bool on = scattering.enabled.value != 0;
  check(!on,
        {"scattering.medium", "scattering.single", "scattering.multiple", "scattering.sections",
         "scattering.extinction", "scattering.downscale", "scattering.light_shafts", "scattering.only", "epipolar."},
        "scattering.enabled = false");
  if (!on) return;
  const bool epipolar = scattering.technique == Technique::epipolar;
  check(scattering.light_shafts.value == 0,
        {"shadows.cascade_processing", "epipolar.min_max_tree", "epipolar.min_max_format"},
        "scattering.light_shafts = false");
  check(epipolar && scattering.light_shafts.value != 0 && params.epipolar.min_max_tree.value == 0,
        {"epipolar.min_max_format"}, "epipolar.min_max_tree = false");
  check(homogeneous && scattering.single != SingleScattering::none, {"scattering.single"},
        "scattering.medium = homogeneous");
  check(!homogeneous && scattering.single == SingleScattering::integration &&
            scattering.multiple != MultipleScattering::occluded,
        {"scattering.sections"}, "scattering.single = integration");
}

// Reports parameters of an exposure that is given in another way.
template <typename Check>
void check_exposure(const TonemapParams& tonemap, const Check& check) {
  check(tonemap.aperture == 0.0F, {"tonemap.iso"}, "tonemap.aperture = 0");
  if (camera_ev100(tonemap)) {
    const bool by_value = tonemap.aperture == 0.0F;
    check(true, {"tonemap.exposure", "tonemap.light_adaptation", "tonemap.least_luminance"},
          by_value ? "tonemap.exposure_ev100" : "tonemap.aperture");
    return;
  }
  check(tonemap.auto_exposure.value != 0, {"tonemap.exposure"}, "tonemap.auto_exposure = true");
  check(tonemap.auto_exposure.value == 0,
        {"tonemap.middle_gray", "tonemap.light_adaptation", "tonemap.least_luminance"},
        "tonemap.auto_exposure = false");
}

}  // namespace

std::string without_effect(std::span<const std::string> keys, std::span<const std::string_view> names) {
  std::string list;
  int count = 0;
  for (const std::string& key : keys) {
    const bool named = std::any_of(names.begin(), names.end(), [&](std::string_view name) {
      return name.ends_with('.') ? key.starts_with(name) : key == name;
    });
    if (named) list += (count++ > 0 ? ", " : "") + key;
  }
  return count == 0 ? list : list + (count > 1 ? " have" : " has") + " no effect";
}

std::vector<std::string> unused_params(const Params& params, const SceneParams& scene) {
  const std::vector<std::string> set = changed(params, scene);
  std::vector<std::string> out;
  // Reports which of `names` were set although they have no effect.
  const auto check = [&](bool when, std::initializer_list<std::string_view> names, std::string_view because) {
    const std::string found = when ? without_effect(set, std::span(names.begin(), names.size())) : std::string();
    if (!found.empty()) out.push_back(found + " with " + std::string(because));
  };
  using Model = ScatteringModel;
  const Model model = scene.scattering.model;
  const bool by_effect = model == Model::atmosphere;
  check(!by_effect,
        {"scattering.medium", "scattering.downscale", "scattering.technique", "scattering.single",
         "scattering.multiple", "scattering.sections", "scattering.extinction", "scattering.light_shafts",
         "scattering.integration_steps", "shadows.cascade_processing", "tables.size", "tables.orders",
         "tables.parameterization", "atmosphere.ozone_du", "homogeneous_medium.", "epipolar.", "froxels."},
        "scattering.model = " + std::string(drawn_model(params, scene).name));
  check(by_effect, {"scattering.evaluate", "oneil.", "homogeneous."}, "scattering.model = atmosphere");
  check(model == Model::homogeneous, {"oneil."}, "scattering.model = homogeneous");
  check(model == Model::oneil, {"homogeneous.", "oneil.table_size"}, "scattering.model = oneil");
  check(model == Model::oneil && scene.oneil.scale_function == OneilScaleFunction::published, {"oneil.spacing"},
        "oneil.scale_function = published");
  check(model == Model::oneil_table, {"homogeneous.", "oneil.scale_function"}, "scattering.model = oneil-table");

  const bool homogeneous = by_effect && params.scattering.medium == MediumKind::homogeneous;
  check(by_effect && !homogeneous, {"homogeneous_medium."}, "scattering.medium = atmosphere");
  check(homogeneous, {"scattering.multiple", "scattering.sections", "scattering.extinction"},
        "scattering.medium = homogeneous");
  check(by_effect && params.scattering.technique == Technique::brute_force,
        {"scattering.downscale", "scattering.extinction", "epipolar."}, "scattering.technique = brute-force");
  check(by_effect && params.scattering.technique == Technique::froxels,
        {"scattering.downscale", "scattering.extinction", "epipolar."}, "scattering.technique = froxels");
  check_scattering(params, by_effect, homogeneous, check);
  check(by_effect && params.froxels.enabled.value == 0 && params.scattering.technique != Technique::froxels,
        {"froxels."}, "froxels.enabled = false");

  const bool custom = params.atmosphere.custom_coefficients.value != 0;
  check(!custom, {"atmosphere.rayleigh_scattering", "atmosphere.mie_scattering", "atmosphere.mie_absorption"},
        "atmosphere.custom_coefficients = false");
  check(custom, {"atmosphere.aerosol_absorption"}, "atmosphere.custom_coefficients = true");
  check_air(params.atmosphere, check);
  check_terrain_and_meshes(scene, check);

  check(!scene.sun.time.empty(), {"sun.elevation_deg", "sun.azimuth_deg"}, "sun.time");
  check(scene.sun.time.empty(), {"sun.place"}, "an empty sun.time");
  check(scene.moon.by_date.value != 0, {"moon.elevation_deg", "moon.azimuth_deg", "moon.angular_radius_deg"},
        "moon.by_date = true");
  check(scene.moon.light.value == 0, {"moon.light_below_deg"}, "moon.light = false");
  check(scene.moon.visible.value == 0 && scene.moon.light.value == 0,
        {"moon.elevation_deg", "moon.azimuth_deg", "moon.angular_radius_deg", "moon.by_date"}, "moon.visible = false");
  check(scene.sun.animate.value == 0, {"sun.animate_speed_deg"}, "sun.animate = false");
  using Op = TonemapOperator;
  const Op op = scene.tonemap.operator_;
  check_exposure(scene.tonemap, check);
  check(!is_one_of(op, {Op::reinhard_modified, Op::uncharted2, Op::logarithmic, Op::adaptive_logarithmic}),
        {"tonemap.white_point"}, "this tonemap.operator");
  check(is_one_of(op, {Op::uncharted2, Op::filmic_alu, Op::pbr_neutral, Op::exponential_channels}),
        {"tonemap.saturation"}, "this tonemap.operator");
  return out;
}

}  // namespace tyndall::scene
