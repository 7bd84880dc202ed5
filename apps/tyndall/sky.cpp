// `tyndall sky`: renders the sky as an environment map. docs/sky.md describes the picture.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "arguments.hpp"
#include "cli.hpp"
#include "effect/spectral_medium.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "image/image.hpp"
#include "make_tables.hpp"
#include "models/gpu_probe.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "scene/description/model_registry.hpp"
#include "scene/description/solar_position.hpp"
#include "scene/sky/sun_disc.hpp"
#include "sky_map.hpp"
#include "tables/pipeline_store.hpp"

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
      : host_(host), params_(params), medium_(spectral_medium_from_params(params)) {}

  Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) override {
    std::vector<models::Ray> rays;
    rays.reserve(queries.size());
    for (const RayQuery& query : queries) rays.push_back(models::ray_from_query(query));
    Result<std::vector<models::Answer>> found =
        models::single_scattering_on_gpu(host_, medium_, params_.scattering.color, rays);
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

// The sun's disc in the channels of the medium: with four wavelengths, the first three and the fourth, with an
// irradiance of 1.
struct SunFaces {
  SunFace first, fourth;
  std::array<double, 3> irradiance;  // above the atmosphere
};
SunFaces sun_faces(double radius_rad, const std::array<double, 3>& irradiance, const Params& params) {
  const Vec3& nm = params.atmosphere.wavelengths_nm;
  if (params.scattering.color == ColorMode::rgb) {
    const SunFace face = {
        radius_rad, {scene::limb_exponent(nm.x), scene::limb_exponent(nm.y), scene::limb_exponent(nm.z)}, irradiance};
    return {face, face, irradiance};
  }
  const FourChannels wavelengths_nm = spectral_wavelengths_nm();
  const auto exponent = [&](std::size_t i) { return scene::limb_exponent(static_cast<float>(wavelengths_nm[i])); };
  return {{radius_rad, {exponent(0), exponent(1), exponent(2)}},
          {radius_rad, {exponent(3), exponent(3), exponent(3)}},
          irradiance};
}

// Adds the sun's disc in all channels.
void draw_sun(image::Image& image, const SkyMap& map, const SunFaces& faces, const Params& params) {
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  if (params.scattering.color == ColorMode::rgb) {
    add_sun(image, map, faces.first, medium);
    return;
  }
  image::Image first(map.width, map.height);
  image::Image fourth(map.width, map.height);
  add_sun(first, map, faces.first, medium);
  add_sun(fourth, map, faces.fourth, models::medium_at_fourth(medium));
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
    if (first.rgb[i] == 0.0F && fourth.rgb[i] == 0.0F) continue;
    const std::array<double, 3> color =
        color_of_light({first.rgb[i], first.rgb[i + 1], first.rgb[i + 2], fourth.rgb[i]});
    for (std::size_t c = 0; c < 3; ++c) image.rgb[i + c] += static_cast<float>(faces.irradiance[c] * color[c]);
  }
}

// Returns the light of the disc in the channels of the image.
Sunlight sunlight_of(const SkyMap& map, const SunFaces& faces, const Params& params) {
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  const Sunlight first = sunlight(map, faces.first, medium);
  if (params.scattering.color == ColorMode::rgb) return first;
  const Sunlight fourth = sunlight(map, faces.fourth, models::medium_at_fourth(medium));
  const auto color = [&](const std::array<double, 3>& a, double b) {
    std::array<double, 3> out = color_of_light({a[0], a[1], a[2], b});
    for (std::size_t c = 0; c < 3; ++c) out[c] *= faces.irradiance[c];
    return out;
  };
  return {color(first.facing, fourth.facing[0]), color(first.horizontal, fourth.horizontal[0])};
}

std::array<double, 3> horizontal_irradiance(const image::Image& image, const SkyMap& map) {
  std::array<double, 3> sum = {};
  for (std::uint32_t y = 0; y < map.height; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      const PixelDirection direction = map.direction(x, y);
      const double weight = direction.solid_angle * std::max(std::cos(direction.zenith), 0.0);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * image.pixel(x, y)[c];
    }
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
void check_largest(image::Image& image, bool clamp) {
  const float largest = *std::max_element(image.rgb.begin(), image.rgb.end());
  if (largest <= kLargestHalf) return;
  if (!clamp) {
    note(concat({"the sun's disc has values up to ", files::number_text(largest),
                 "; programs that read the map in half precision are limited to 65504; --sun split separates the sun, "
                 "and --clamp true limits the values"}));
    return;
  }
  note(concat({"values up to ", files::number_text(largest), " were clamped to 65504; the map has less sunlight"}));
  for (float& value : image.rgb) value = std::min(value, kLargestHalf);
}

// Returns the sun as a light of its own, for --sun split.
nlohmann::ordered_json sun_json(const SkyMap& map, const SunFace& face, const Sunlight& light) {
  const double across = std::cos(map.sun_elevation_rad);
  nlohmann::ordered_json out;
  out["direction"] = {across * std::sin(map.sun_azimuth_rad), std::sin(map.sun_elevation_rad),
                      -across * std::cos(map.sun_azimuth_rad)};
  out["elevation_deg"] = map.sun_elevation_rad / kRadPerDeg;
  out["azimuth_deg"] = map.sun_azimuth_rad / kRadPerDeg;
  out["angular_radius_deg"] = face.angular_radius_rad / kRadPerDeg;
  out["irradiance"] = light.facing;
  out["horizontal_irradiance"] = light.horizontal;
  return out;
}

// Returns the metadata of the map: the settings, its projection, and what it shows.
image::Metadata sky_metadata(const config::Settings& settings, const SkyOptions& sky, Projection projection) {
  image::Metadata metadata = config::radiance_metadata(settings);
  metadata.emplace_back("tyndall.sky.projection", kProjections[static_cast<std::size_t>(projection)].text);
  metadata.emplace_back("tyndall.sky.model", sky.model);
  metadata.emplace_back("tyndall.sky.disc", sky.sun == "disc" ? "true" : "false");
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
  return arguments.parse(args);
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

  const Params& params = options.settings.effect;
  if (Result<void> r = check_altitude(sky.altitude_m, params, "--altitude"); !r) return fail(r.error());
  scene::SceneParams& scene = options.settings.scene;
  // The options of this verb hold.
  if (scene.sun.refraction.value != 0 || !scene.sun.time.empty()) {
    note("sun.place, sun.time and sun.refraction have no effect on sky; the sun is where the options place it");
  }
  scene.sun.place.clear();
  scene.sun.time.clear();
  scene.sun.refraction.value = 0;
  scene.sun.elevation_deg = static_cast<float>(sun.value().elevation_deg);
  scene.sun.azimuth_deg = static_cast<float>(sun.value().azimuth_deg);
  // camera.altitude_m does not accept values below sea level.
  if (sky.altitude_m >= 0.0)
    scene.camera.altitude_m = static_cast<float>(sky.altitude_m);
  else
    scene.camera.position_m = {0.0F, static_cast<float>(sky.altitude_m), 0.0F};
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
  if (Result<void> r = fill(image, map, irradiance, params.scattering.color, *source.value()); !r)
    return fail(r.error());
  const std::array<double, 3> diffuse = horizontal_irradiance(image, map);
  const SunFaces faces = sun_faces(scene.sun.angular_radius_deg * kRadPerDeg, irradiance, params);
  if (sky.sun == "disc") draw_sun(image, map, faces, params);
  check_largest(image, sky.clamp == "true");

  const nlohmann::ordered_json light = sun_json(map, faces.first, sunlight_of(map, faces, params));
  const bool latlong = projection.value() == Projection::latlong;
  const image::ExrOptions as = {.content = latlong ? image::ExrContent::environment_map : image::ExrContent::radiance};
  const image::Metadata metadata = sky_metadata(options.settings, sky, projection.value());
  if (Result<void> r = image::write_exr(options.output, image, metadata, as); !r) return fail(r.error());
  if (sky.sun == "split") {
    const std::string path = std::filesystem::path(options.output).replace_extension(".sun.json").string();
    if (Result<void> r = files::write_file(path, light.dump(2) + "\n"); !r) return fail(r.error());
  }
  if (!options.json) return kDone;
  nlohmann::ordered_json out;
  out["device"] = host.value()->device_name();
  out["model"] = sky.model;
  out["size"] = {map.width, map.height};
  out["altitude_m"] = sky.altitude_m;
  out["sun_elevation_deg"] = sun.value().elevation_deg;
  out["sun_azimuth_deg"] = sun.value().azimuth_deg;
  out["sky_irradiance"] = diffuse;
  out["sun_irradiance"] = light["irradiance"];
  out["sun_horizontal_irradiance"] = light["horizontal_irradiance"];
  if (const tables::Report* const made = source.value()->tables(); made != nullptr) {
    out["tables"] = {{"from", made->origin == tables::Origin::cache ? "cache" : "build"}, {"ms", made->milliseconds}};
  }
  return print(out.dump(2) + "\n");
}

}  // namespace tyndall::cli
