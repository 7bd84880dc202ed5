// `tyndall sky`: renders the sky as an environment map. docs/sky.md describes the picture.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "arguments.hpp"
#include "cli.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "image/image.hpp"
#include "make_tables.hpp"
#include "models/gpu_probe.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "picture_units.hpp"
#include "scene/description/model_registry.hpp"
#include "scene/description/solar_position.hpp"
#include "sky_light.hpp"
#include "sky_map.hpp"
#include "tables/pipeline_store.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::size_t kBatchRays = 131072;

struct SkyOptions {
  std::optional<double> sun_elevation_deg, sun_azimuth_deg;
  std::string place, time;
  double altitude_m = 0.0;
  std::string disc = "true";
  std::string sun, projection = "latlong", clamp = "false";
  std::string model;
  PictureUnits units;
};

// Evaluates rays: radiance / E0 of the atmosphere and the ground behind it.
class SkySource {
 public:
  virtual ~SkySource() = default;
  virtual Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) = 0;
  // Returns how the tables were obtained; nullptr if the source uses none.
  [[nodiscard]] virtual const tables::Report* tables() const { return nullptr; }
};

// Single scattering, and the ground in direct sunlight.
class SingleSource final : public SkySource {
 public:
  SingleSource(gpu::Host& host, const Params& params)
      : host_(host),
        params_(params),
        medium_(spectral_medium_from_params(params)),
        phase_(phase_rows(params, params.scattering.color)) {}

  Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) override {
    std::vector<models::Ray> rays;
    rays.reserve(queries.size());
    for (const RayQuery& query : queries) rays.push_back(models::ray_from_query(query));
    Result<std::vector<models::Answer>> found =
        models::single_scattering_on_gpu(host_, medium_, phase_, params_.scattering.color, rays);
    if (!found || medium_.ground_albedo == Vec3(0.0F)) return found;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      models::Answer& answer = found.value()[i];
      const models::Answer ground =
          models::in_all_channels(params_, medium_, [&](const shared::Medium& m) -> models::Answer {
            return {models::sunlit_ground(m, rays[i]), {}};
          });
      for (std::size_t c = 0; c < 3; ++c) answer.radiance[c] += answer.transmittance[c] * ground.radiance[c];
      answer.radiance_fourth += answer.transmittance_fourth * ground.radiance_fourth;
    }
    return found;
  }

 private:
  gpu::Host& host_;
  const Params params_;
  shared::SpectralMedium medium_;
  PhaseRows phase_;
};

// All orders of scattering from the tables, and the ground under sun and sky.
class PrecomputedSource final : public SkySource {
 public:
  explicit PrecomputedSource(models::PrecomputedModel model) : model_(std::move(model)) {}

  Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) override {
    return model_.answer(queries);
  }
  [[nodiscard]] const tables::Report* tables() const override { return &model_.origin(); }

 private:
  models::PrecomputedModel model_;
};

using MakeSource = Result<std::unique_ptr<SkySource>> (*)(gpu::Host& host, const config::Settings& settings);

Result<std::unique_ptr<SkySource>> make_single(gpu::Host& host, const config::Settings& settings) {
  return std::unique_ptr<SkySource>(std::make_unique<SingleSource>(host, settings.effect));
}

Result<std::unique_ptr<SkySource>> make_precomputed(gpu::Host& host, const config::Settings& settings) {
  Result<models::PrecomputedModel> model =
      models::PrecomputedModel::create(host, settings.effect, make_tables(settings.scene));
  if (!model) return std::move(model).error();
  for (const std::string& text : model.value().origin().notes) note(text);
  return std::unique_ptr<SkySource>(std::make_unique<PrecomputedSource>(std::move(model).value()));
}

// A model of the registry that can make maps.
struct SkyModel {
  scene::ModelId id;
  MakeSource make;
  [[nodiscard]] std::string_view name() const { return scene::model_info(id).name; }
};
constexpr SkyModel kModels[] = {{scene::ModelId::precomputed, make_precomputed}, {scene::ModelId::single, make_single}};

// The sun's elevation and azimuth [deg].
struct SunAngles {
  double elevation_deg, azimuth_deg;
};

Result<SunAngles> find_sun(const SkyOptions& options) {
  const bool any_angle = options.sun_elevation_deg || options.sun_azimuth_deg;
  const bool any_place = !options.place.empty() || !options.time.empty();
  constexpr std::string_view kNeeded =
      "expected either --sun-elevation-deg E --sun-azimuth-deg A or --at LAT,LON --time ISO8601";
  const auto error = [&](std::string_view what) { return input_error(what, "tyndall sky", kNeeded); };
  if (any_angle && any_place) return error("the sun is given both by angles and by place and time");
  if (!any_angle && !any_place) return error("missing position of the sun");
  if (any_angle) {
    if (!options.sun_elevation_deg) return error("missing option --sun-elevation-deg");
    if (!options.sun_azimuth_deg) return error("missing option --sun-azimuth-deg");
    return SunAngles{*options.sun_elevation_deg, *options.sun_azimuth_deg};
  }
  if (options.place.empty()) return error("missing option --at");
  if (options.time.empty()) return error("missing option --time");
  const Result<scene::Place> place = scene::parse_place(options.place, "--at");
  if (!place) return place.error();
  const Result<double> time = scene::parse_time(options.time, "--time");
  if (!time) return time.error();
  const scene::SolarPosition position = scene::solar_position(place.value(), time.value(), options.altitude_m);
  return SunAngles{position.elevation_deg, position.azimuth_deg};
}

// Returns the radiance of an answer in the channels of the image, per irradiance of the sun.
std::array<double, 3> channels_of(const models::Answer& answer, ColorMode color) {
  return color == ColorMode::spectral ? color_of_light(models::radiance_of(answer)) : answer.radiance;
}

// Fills the image with the source's radiance times the irradiance, in batches of rows.
Result<void> fill(image::Image& image, const SkyMap& map, const std::array<double, 3>& irradiance, ColorMode color,
                  SkySource& source) {
  Progress progress("sky");
  const std::uint32_t rows = static_cast<std::uint32_t>(std::max<std::size_t>(kBatchRays / map.width, 1));
  std::vector<RayQuery> queries;
  for (std::uint32_t first = 0; first < map.height; first += rows) {
    progress.update(first, map.height);
    const std::uint32_t last = std::min(first + rows, map.height);
    queries.clear();
    for (std::uint32_t y = first; y < last; ++y) {
      for (std::uint32_t x = 0; x < map.width; ++x) queries.push_back(map.query(x, y));
    }
    const Result<std::vector<models::Answer>> found = source.answer(queries);
    if (!found) return found.error();
    float* out = image.pixel(0, first);
    std::uint32_t pixel = first * map.width;
    for (const models::Answer& answer : found.value()) {
      const bool seen = map.direction(pixel % map.width, pixel / map.width).solid_angle > 0.0;
      ++pixel;
      const std::array<double, 3> radiance = channels_of(answer, color);
      for (std::size_t c = 0; c < 3; ++c) *out++ = seen ? static_cast<float>(irradiance[c] * radiance[c]) : 0.0F;
    }
  }
  return {};
}

// Returns the irradiance of the sky on a horizontal surface in the channels of an image.
Result<std::array<double, 3>> sky_irradiance(const SkyMap& map, const std::array<double, 3>& irradiance,
                                             ColorMode color, SkySource& source) {
  const SkyQuadrature quadrature = sky_quadrature(map.altitude_m, 0.5 * std::numbers::pi - map.sun_elevation_rad);
  const Result<std::vector<models::Answer>> found = source.answer(quadrature.queries);
  if (!found) return found.error();
  std::array<double, 3> sum = {};
  for (std::size_t i = 0; i < quadrature.weights.size(); ++i) {
    const std::array<double, 3> radiance = channels_of(found.value()[i], color);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += quadrature.weights[i] * irradiance[c] * radiance[c];
  }
  return sum;
}

struct ProjectionInfo {
  std::string_view name, text;
};
// In the order of Projection.
constexpr ProjectionInfo kProjections[] = {
    {"latlong", "latitude-longitude: zenith at the top, north at the left edge, azimuth clockwise to the right"},
    {"cube", "cube: the faces +X, -X, +Y, -Y, +Z, -Z from top to bottom, as in Vulkan; x east, y up, z south"},
    {"fisheye", "angular fish-eye of the upper hemisphere: zenith in the middle, north at the top, east on the left"}};

// Checks the options of the map against each other, and resolves `sun`.
Result<Projection> check_map(SkyOptions& sky, const Size& size) {
  if (!sky.sun.empty() && sky.disc == "false") {
    return input_error("the sun's disc is given by --sun and by --disc", "--disc", "expected one of them");
  }
  if (sky.sun.empty()) sky.sun = sky.disc == "true" ? "disc" : "none";
  const auto* const found = std::find_if(std::begin(kProjections), std::end(kProjections),
                                         [&](const ProjectionInfo& info) { return info.name == sky.projection; });
  const auto projection = static_cast<Projection>(found - std::begin(kProjections));
  if (projection == Projection::latlong) return projection;
  if (sky.sun == "disc") {
    return input_error(concat({"a ", sky.projection, " map has no sun's disc"}), "--sun", "expected split or none");
  }
  const std::uint32_t height = projection == Projection::cube ? 6 * size.width : size.width;
  if (size.height == height) return projection;
  return input_error(concat({"invalid size '", std::to_string(size.width), "x", std::to_string(size.height), "' of a ",
                             sky.projection, " map"}),
                     "--size", concat({"expected ", std::to_string(size.width), "x", std::to_string(height)}));
}

constexpr float kLargestHalf = 65504.0F;

// Limits the values to those of half precision, or notes that they exceed them.
void check_largest(image::Image& image, bool clamp, bool has_disc) {
  const float largest = *std::max_element(image.rgb.begin(), image.rgb.end());
  if (largest <= kLargestHalf) return;
  if (!clamp) {
    note(concat({has_disc ? "the sun's disc" : "the map", " has values up to ", files::number_text(largest),
                 "; programs that read the map in half precision are limited to 65504; ",
                 has_disc ? "--sun split separates the sun, and " : "", "--clamp true limits the values"}));
    return;
  }
  note(concat({"values up to ", files::number_text(largest), " were clamped to 65504; the map has less ",
               has_disc ? "sunlight" : "light"}));
  for (float& value : image.rgb) value = std::min(value, kLargestHalf);
}

// Returns the metadata of the map: the settings, its projection, and what it shows.
image::Metadata sky_metadata(const config::Settings& settings, const SkyOptions& sky, Projection projection) {
  image::Metadata metadata = sky.units.metadata(settings);
  metadata.emplace_back("tyndall.sky.projection", kProjections[static_cast<std::size_t>(projection)].text);
  metadata.emplace_back("tyndall.sky.model", sky.model);
  metadata.emplace_back("tyndall.sky.disc", sky.sun == "disc" ? "true" : "false");
  metadata.emplace_back("tyndall.sky.sun", sky.sun);
  metadata.emplace_back("tyndall.sky.clamp", sky.clamp);
  if (!sky.place.empty()) {
    metadata.emplace_back("tyndall.sky.at", files::one_line(sky.place));
    metadata.emplace_back("tyndall.sky.time", files::one_line(sky.time));
  }
  return metadata;
}

std::optional<int> parse_sky(Args args, CommonOptions& options, SkyOptions& sky) {
  options.size = {2048, 1024};
  sky.model = kModels[0].name();
  std::vector<std::string> model_names;
  for (const SkyModel& model : kModels) model_names.emplace_back(model.name());
  Arguments arguments("sky");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kOutput | kJson);
  arguments.number("--sun-elevation-deg", sky.sun_elevation_deg, -90.0, 90.0,
                   "elevation of the sun above the horizontal");
  arguments.number("--sun-azimuth-deg", sky.sun_azimuth_deg, -3600.0, 3600.0,
                   "azimuth of the sun, clockwise from north");
  arguments.text("--at", sky.place, "LAT,LON", "place in degrees, north and east positive; requires --time");
  arguments.text("--time", sky.time, "ISO8601", "time at the place, as in 2003-10-17T12:30:30-07:00; 1900 to 2100");
  arguments.number("--altitude", sky.altitude_m, kLowestAltitude_m, 1.0e9,
                   "altitude of the eye above sea level in m, negative below it");
  arguments.choice("--disc", sky.disc, {"true", "false"}, "draw the sun's disc; false is the same as --sun none");
  arguments.choice("--sun", sky.sun, {"disc", "split", "none"},
                   "draw the sun's disc, or leave it out and write its light to SKY.sun.json, or leave it out");
  arguments.choice("--projection", sky.projection, {"latlong", "cube", "fisheye"},
                   "projection of the map; a cube has 6 faces in a column, and a fish-eye the upper hemisphere");
  arguments.choice("--clamp", sky.clamp, {"true", "false"}, "limit values to those of half precision");
  arguments.choice("--model", sky.model, model_names, "model of the sky");
  sky.units.add_options(arguments);
  return arguments.parse(args);
}

// Places the sun and the eye of the options in the scene, for the metadata.
void place_in_scene(scene::SceneParams& scene, const SkyOptions& sky, const SunAngles& sun) {
  if (scene.sun.refraction.value != 0 || !scene.sun.time.empty()) {
    note("sun.place, sun.time and sun.refraction have no effect on sky; the sun is where the options place it");
  }
  scene.sun.place.clear();
  scene.sun.time.clear();
  scene.sun.refraction.value = 0;
  scene.sun.elevation_deg = static_cast<float>(sun.elevation_deg);
  scene.sun.azimuth_deg = static_cast<float>(sun.azimuth_deg);
  // camera.altitude_m does not accept values below sea level.
  if (sky.altitude_m >= 0.0)
    scene.camera.altitude_m = static_cast<float>(sky.altitude_m);
  else
    scene.camera.position_m = {0.0F, static_cast<float>(sky.altitude_m), 0.0F};
}

// The name of the file of --sun split.
std::string sun_path(const std::string& output) {
  return std::filesystem::path(output).replace_extension(".sun.json").string();
}

// Writes the map and, with --sun split, the file of the sun. Both are complete before either replaces an older file.
Result<void> write_files(const std::string& output, const image::Image& image, const image::Metadata& metadata,
                         const image::ExrOptions& as, const std::string* sun) {
  Result<files::AtomicFile> map = image::prepare_exr(output, image, metadata, as);
  if (!map) return std::move(map).error();
  if (sun == nullptr) return map.value().commit();
  Result<files::AtomicFile> light = files::AtomicFile::create(sun_path(output));
  if (!light) return std::move(light).error();
  if (Result<void> r = light.value().write(*sun); !r) return r;
  if (Result<void> r = light.value().commit(); !r) return r;
  return map.value().commit();
}

// The light of the map in its unit and primaries, and in lux.
struct SkyLight {
  std::array<double, 3> sky = {};
  Sunlight sun;
  Illuminance lux;
};

SkyLight in_units(const PictureUnits& units, const std::array<double, 3>& sky, const Sunlight& sun) {
  const auto lux = [&](const std::array<double, 3>& color) {
    return units.white_luminance() *
           luminance({static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])});
  };
  return {units.convert(sky),
          {units.convert(sun.facing), units.convert(sun.horizontal)},
          {lux(sun.facing), lux(sun.horizontal), lux(sky)}};
}

std::string lux_text(double lux) {
  char text[40];
  std::snprintf(text, sizeof text, lux < 1000.0 ? "%.4g lx" : "%.0f lx", lux);
  return text;
}

// Prints the illuminances, or with --json everything about the map.
int print_sky(const CommonOptions& options, const SkyOptions& sky, const SkyMap& map, const SkyLight& light,
              const std::string& device, const tables::Report* tables) {
  const bool has_lux = sky.units.white_luminance() > 0.0;
  if (!options.json) {
    if (!has_lux) return kDone;
    return print(concat({"sun: ", lux_text(light.lux.sun_lux), " on a surface that faces it, ",
                         lux_text(light.lux.sun_horizontal_lux),
                         " on a horizontal one\nsky: ", lux_text(light.lux.sky_lux), " on a horizontal one\n"}));
  }
  nlohmann::ordered_json out;
  out["device"] = device;
  out["model"] = sky.model;
  out["size"] = {map.width, map.height};
  out["altitude_m"] = sky.altitude_m;
  out["sun_elevation_deg"] = map.sun_elevation_rad / kRadPerDeg;
  out["sun_azimuth_deg"] = map.sun_azimuth_rad / kRadPerDeg;
  out["sky_irradiance"] = light.sky;
  out["sun_irradiance"] = light.sun.facing;
  out["sun_horizontal_irradiance"] = light.sun.horizontal;
  if (has_lux) {
    out["sky_illuminance_lux"] = light.lux.sky_lux;
    out["sun_illuminance_lux"] = light.lux.sun_lux;
    out["sun_horizontal_illuminance_lux"] = light.lux.sun_horizontal_lux;
    out["white_luminance_cd_per_m2"] = sky.units.white_luminance() / sky.units.factor();
  }
  if (tables != nullptr) {
    out["tables"] = {{"from", tables->origin == tables::Origin::cache ? "cache" : "build"},
                     {"ms", tables->milliseconds}};
  }
  return print(out.dump(2) + "\n");
}

}  // namespace

int run_sky(Args args) {
  CommonOptions options;
  SkyOptions sky;
  if (const std::optional<int> status = parse_sky(args, options, sky)) return *status;
  const Result<SunAngles> sun = find_sun(sky);
  if (!sun) return fail(sun.error());
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  if (Result<void> r = check_output(options, {".exr"}); !r) return fail(r.error());
  const Result<Projection> projection = check_map(sky, options.size);
  if (!projection) return fail(projection.error());
  if (sky.sun == "split") {
    if (Result<void> r = files::check_writable(sun_path(options.output)); !r) return fail(r.error());
  }
  if (Result<void> r = sky.units.resolve(options.settings); !r) return fail(r.error());

  const Params& params = options.settings.effect;
  const ColorMode color = params.scattering.color;
  if (Result<void> r = check_altitude(sky.altitude_m, params, "--altitude"); !r) return fail(r.error());
  scene::SceneParams& scene = options.settings.scene;
  place_in_scene(scene, sky, sun.value());
  const SkyMap map = {options.size.width,
                      options.size.height,
                      sky.altitude_m,
                      sun.value().elevation_deg * kRadPerDeg,
                      sun.value().azimuth_deg * kRadPerDeg,
                      projection.value()};
  const double scale = params.scattering.scale;
  const std::array<double, 3> irradiance = {scene.sun.irradiance.x * scale, scene.sun.irradiance.y * scale,
                                            scene.sun.irradiance.z * scale};

  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = options.device, .graphics = false});
  if (!host) return fail(host.error());
  const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
  if (!pipelines.note().empty()) note(pipelines.note());
  const SkyModel& model =
      *std::find_if(std::begin(kModels), std::end(kModels), [&](const SkyModel& m) { return m.name() == sky.model; });
  Result<std::unique_ptr<SkySource>> source = model.make(*host.value(), options.settings);
  if (!source) return fail(source.error());
  image::Image image(map.width, map.height);
  if (Result<void> r = fill(image, map, irradiance, color, *source.value()); !r) return fail(r.error());
  const Result<std::array<double, 3>> diffuse = sky_irradiance(map, irradiance, color, *source.value());
  if (!diffuse) return fail(diffuse.error());
  const SunFaces faces = sun_faces(scene.sun.angular_radius_deg * kRadPerDeg, irradiance, params);
  const bool has_disc = sky.sun == "disc";
  if (has_disc) draw_sun(image, map, faces, params);
  sky.units.convert(image);
  check_largest(image, sky.clamp == "true", has_disc);

  const SkyLight light = in_units(sky.units, diffuse.value(), sunlight_of(map, faces, params));
  const std::string sun_text =
      sun_json(map, faces.first, light.sun, sky.units.white_luminance() > 0.0 ? &light.lux : nullptr).dump(2) + "\n";
  const image::ExrOptions as = sky.units.exr(
      projection.value() == Projection::latlong ? image::ExrContent::environment_map : image::ExrContent::radiance);
  const image::Metadata metadata = sky_metadata(options.settings, sky, projection.value());
  if (Result<void> r = write_files(options.output, image, metadata, as, sky.sun == "split" ? &sun_text : nullptr); !r)
    return fail(r.error());
  return print_sky(options, sky, map, light, host.value()->device_name(), source.value()->tables());
}

}  // namespace tyndall::cli
