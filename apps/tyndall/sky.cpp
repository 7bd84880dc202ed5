// `tyndall sky`: renders the sky as an environment map. docs/sky.md describes the picture.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "batch.hpp"
#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "image/image.hpp"
#include "input_files.hpp"
#include "interruption.hpp"
#include "make_tables.hpp"
#include "math/angles.hpp"
#include "picture_units.hpp"
#include "scene/description/solar_position.hpp"
#include "sky_light.hpp"
#include "sky_list.hpp"
#include "sky_map.hpp"
#include "sky_source.hpp"
#include "tables/pipeline_store.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

struct SkyOptions {
  std::optional<double> sun_elevation_deg, sun_azimuth_deg;
  std::string place, time, list;
  double altitude_m = 0.0;
  std::string disc = "true";
  std::string sun, projection = "latlong", clamp = "false";
  std::string model;
  PictureUnits units;
  BatchOptions batch;
};

Result<SunAngles> find_sun(const SkyOptions& options) {
  const bool any_angle = options.sun_elevation_deg || options.sun_azimuth_deg;
  const bool any_place = !options.place.empty() || !options.time.empty();
  constexpr std::string_view kNeeded =
      "expected either --sun-elevation-deg E --sun-azimuth-deg A or --at LAT,LON --time ISO8601, or --list LIST.csv";
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

// Returns the skies of the options: those of the list, or one.
Result<std::vector<SkyEntry>> find_skies(const SkyOptions& options) {
  if (options.list.empty()) {
    const Result<SunAngles> sun = find_sun(options);
    if (!sun) return sun.error();
    return std::vector<SkyEntry>{{sun.value(), options.place, options.time, {}}};
  }
  if (options.sun_elevation_deg || options.sun_azimuth_deg || !options.place.empty() || !options.time.empty()) {
    return input_error("the sun is given both by a list and by other options", "--list",
                       "expected no --sun-elevation-deg, --sun-azimuth-deg, --at and --time");
  }
  return read_sky_list(options.list, options.altitude_m);
}

struct ProjectionInfo {
  std::string_view name, text;
};
// The names of the projections, in the order of Projection.
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

// Limits the values to those of half precision. Returns a remark for the user if they exceed them.
std::string check_largest(image::Image& image, bool clamp, bool has_disc) {
  const float largest = *std::max_element(image.rgb.begin(), image.rgb.end());
  if (largest <= kLargestHalf) return {};
  if (!clamp) {
    return concat({has_disc ? "the sun's disc" : "the map", " has values up to ", files::number_text(largest),
                   "; programs that read the map in half precision are limited to 65504; ",
                   has_disc ? "--sun split separates the sun, and " : "", "--clamp true limits the values"});
  }
  for (float& value : image.rgb) value = std::min(value, kLargestHalf);
  return concat({"values up to ", files::number_text(largest), " were clamped to 65504; the map has less ",
                 has_disc ? "sunlight" : "light"});
}

// Returns the metadata of the map: the settings, its projection, and what it shows.
image::Metadata sky_metadata(const config::Settings& settings, const SkyOptions& sky, const SkyEntry& entry,
                             Projection projection) {
  image::Metadata metadata = sky.units.metadata(settings);
  metadata.emplace_back("tyndall.sky.projection", kProjections[static_cast<std::size_t>(projection)].text);
  metadata.emplace_back("tyndall.sky.model", sky.model);
  metadata.emplace_back("tyndall.sky.disc", sky.sun == "disc" ? "true" : "false");
  metadata.emplace_back("tyndall.sky.sun", sky.sun);
  metadata.emplace_back("tyndall.sky.clamp", sky.clamp);
  if (!entry.place.empty()) {
    metadata.emplace_back("tyndall.sky.at", files::one_line(entry.place));
    metadata.emplace_back("tyndall.sky.time", files::one_line(entry.time));
  }
  if (!entry.name.empty()) metadata.emplace_back("tyndall.sky.name", files::one_line(entry.name, 200));
  return metadata;
}

std::optional<int> parse_sky(Args args, CommonOptions& options, SkyOptions& sky) {
  options.size = {2048, 1024};
  sky.model = sky_models().front();
  const std::vector<std::string> model_names = sky_models();
  Arguments arguments("sky");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kOutput | kJson);
  arguments.number("--sun-elevation-deg", sky.sun_elevation_deg, -90.0, 90.0,
                   "elevation of the sun above the horizontal");
  arguments.number("--sun-azimuth-deg", sky.sun_azimuth_deg, -3600.0, 3600.0,
                   "azimuth of the sun, clockwise from north");
  arguments.text("--at", sky.place, "LAT,LON", "place in degrees, north and east positive; requires --time");
  arguments.text("--time", sky.time, "ISO8601", "time at the place, as in 2003-10-17T12:30:30-07:00; 1900 to 2100");
  arguments.text("--list", sky.list, "LIST.csv",
                 "one map for each row: latitude_deg, longitude_deg, time or sun_elevation_deg, sun_azimuth_deg; name");
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
  add_batch_options(arguments, sky.batch, "maps of the list");
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
  if (sky.altitude_m >= 0.0) {
    scene.camera.altitude_m = static_cast<float>(sky.altitude_m);
  } else {
    scene.camera.altitude_m = -1.0F;  // that of position_m
    scene.camera.position_m = {0.0F, static_cast<float>(sky.altitude_m), 0.0F};
  }
}

// Returns the name of the file that --sun split writes for the sun.
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

// Returns the illuminances as text; nothing with three channels.
std::string light_text(const SkyOptions& sky, const SkyLight& light) {
  if (sky.units.white_luminance() <= 0.0) return {};
  return concat({"sun: ", lux_text(light.lux.sun_lux), " on a surface that faces it, ",
                 lux_text(light.lux.sun_horizontal_lux), " on a horizontal one\nsky: ", lux_text(light.lux.sky_lux),
                 " on a horizontal one\n"});
}

// Returns everything about a map.
nlohmann::ordered_json map_json(const SkyOptions& sky, const SkyMap& map, const SkyLight& light,
                                const std::string& device, const tables::Report* tables) {
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
  if (sky.units.white_luminance() > 0.0) {
    out["sky_illuminance_lux"] = light.lux.sky_lux;
    out["sun_illuminance_lux"] = light.lux.sun_lux;
    out["sun_horizontal_illuminance_lux"] = light.lux.sun_horizontal_lux;
    out["white_luminance_cd_per_m2"] = sky.units.white_luminance() / sky.units.factor();
  }
  if (tables != nullptr) {
    out["tables"] = {{"from", tables->origin == tables::Origin::cache ? "cache" : "build"},
                     {"ms", tables->milliseconds}};
  }
  return out;
}

// The data that all maps of a run share.
struct SkyRun {
  CommonOptions& options;
  const SkyOptions& sky;
  Projection projection;
  SkySource& source;
  std::string device;
  std::string label;   // label of the progress bar
  std::string remark;  // remark on the values of maps, printed once for all maps
};

// Computes and writes a map. Returns what is printed about it.
Result<std::string> make_map(SkyRun& run, const SkyEntry& entry, const std::string& path, std::string_view file) {
  const SkyOptions& sky = run.sky;
  const Params& params = run.options.settings.effect;
  const ColorMode color = params.scattering.color;
  scene::SceneParams& scene = run.options.settings.scene;
  place_in_scene(scene, sky, entry.sun);
  const SkyMap map = {run.options.size.width,
                      run.options.size.height,
                      sky.altitude_m,
                      entry.sun.elevation_deg * kRadPerDeg,
                      entry.sun.azimuth_deg * kRadPerDeg,
                      run.projection};
  const double scale = params.scattering.scale;
  const std::array<double, 3> irradiance = {scene.sun.irradiance.x * scale, scene.sun.irradiance.y * scale,
                                            scene.sun.irradiance.z * scale};
  image::Image image(map.width, map.height);
  if (Result<void> r = fill(image, map, irradiance, color, run.source, run.label); !r) return std::move(r).error();
  const Result<std::array<double, 3>> diffuse = sky_irradiance(map, irradiance, color, run.source);
  if (!diffuse) return diffuse.error();
  const SunFaces faces = sun_faces(scene.sun.angular_radius_deg * kRadPerDeg, irradiance, params);
  const bool has_disc = sky.sun == "disc";
  if (has_disc) draw_sun(image, map, faces, params);
  sky.units.convert(image);
  const std::string remark = check_largest(image, sky.clamp == "true", has_disc);
  if (run.remark.empty() && !remark.empty()) note(run.remark = remark);

  const SkyLight light = in_units(sky.units, diffuse.value(), sunlight_of(map, faces, params));
  const std::string sun_text =
      sun_json(map, faces.first, light.sun, sky.units.white_luminance() > 0.0 ? &light.lux : nullptr).dump(2) + "\n";
  const image::ExrOptions as = sky.units.exr(run.projection == Projection::latlong ? image::ExrContent::environment_map
                                                                                   : image::ExrContent::radiance);
  const image::Metadata metadata = sky_metadata(run.options.settings, sky, entry, run.projection);
  if (Result<void> r = write_files(path, image, metadata, as, sky.sun == "split" ? &sun_text : nullptr); !r)
    return std::move(r).error();
  if (!run.options.json) {
    const std::string text = light_text(sky, light);
    return text.empty() || file.empty() ? text : concat({file, ":\n", text});
  }
  nlohmann::ordered_json json = map_json(sky, map, light, run.device, run.source.tables());
  if (file.empty()) return json.dump(2) + "\n";
  nlohmann::ordered_json of_list = {{"file", files::one_line(file, 1000)}};
  if (!entry.name.empty()) of_list["name"] = files::one_line(entry.name, 1000);
  of_list.update(json);
  return of_list.dump(2);
}

// Checks everything before the work, and starts the batch.
Result<Batch> begin_sky(CommonOptions& options, SkyOptions& sky, const std::vector<SkyEntry>& skies) {
  options.frames = static_cast<std::uint32_t>(skies.size());
  options.items = "maps";
  if (Result<void> r = check_output(options, {".exr"}); !r) return std::move(r).error();
  const std::string first = frame_path(options.output, 0);
  if (!sky.list.empty()) {
    for (std::uint32_t i = 0; i < options.frames; ++i) {
      if (Result<void> r = check_not_input(frame_path(options.output, i), "-o", {{"the list", sky.list}}); !r)
        return std::move(r).error();
    }
  }
  if (sky.sun == "split") {
    if (Result<void> r = files::check_writable(sun_path(first)); !r) return std::move(r).error();
  }
  if (Result<void> r = sky.units.resolve(options.settings); !r) return std::move(r).error();
  if (Result<void> r = check_altitude(sky.altitude_m, options.settings.effect, "--altitude"); !r)
    return std::move(r).error();
  BatchDesc desc = {sky.batch, "sky", "maps", options.output, skies.size(), sky.batch.shard.items(skies.size()), {}};
  if (sky.batch.active()) {
    if (Result<void> r = check_batch_output(options.output); !r) return std::move(r).error();
    desc.inputs = common_inputs(options);
    for (const auto& [name, value] : {std::pair<const char*, std::string>("--size", size_text(options.size)),
                                      {"--projection", sky.projection},
                                      {"--sun", sky.sun},
                                      {"--clamp", sky.clamp},
                                      {"--model", sky.model},
                                      {"--altitude", files::number_text(sky.altitude_m)}}) {
      desc.inputs.emplace_back(name, value);
    }
    sky.units.add_inputs(desc.inputs);
    if (sky.list.empty()) {
      desc.inputs.emplace_back("the sun's elevation", files::number_text(skies.front().sun.elevation_deg));
      desc.inputs.emplace_back("the sun's azimuth", files::number_text(skies.front().sun.azimuth_deg));
      desc.inputs.emplace_back("--at", files::one_line(sky.place));
      desc.inputs.emplace_back("--time", files::one_line(sky.time));
    } else {
      add_file(desc.inputs, "--list", sky.list);
      desc.items_input = "--list";
      desc.item_inputs = [&skies](std::uint64_t number) { return checksum(skies.at(number)); };
    }
  }
  return Batch::begin(std::move(desc));
}

}  // namespace

int run_sky(Args args) {
  Interruption interruption;
  CommonOptions options;
  SkyOptions sky;
  if (const std::optional<int> status = parse_sky(args, options, sky)) return *status;
  const Result<std::vector<SkyEntry>> skies = find_skies(sky);
  if (!skies) return fail(skies.error());
  if (Result<void> r = resolve(options, scene::find_model(sky.model)); !r) return fail(r.error());
  const Result<Projection> projection = check_map(sky, options.size);
  if (!projection) return fail(projection.error());
  Result<Batch> batch = begin_sky(options, sky, skies.value());
  if (!batch) return fail(batch.error());
  interruption.describe_by(batch.value().describe());

  std::string printed;
  if (!batch.value().numbers().empty()) {
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = options.device, .graphics = false});
    if (!host) return fail(host.error());
    batch.value().set_device(host.value()->device_name());
    const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
    if (!pipelines.note().empty()) note(pipelines.note());
    const Result<std::unique_ptr<SkySource>> source = make_sky_source(sky.model, *host.value(), options.settings);
    if (!source) return fail(source.error());
    SkyRun run = {options, sky, projection.value(), *source.value(), host.value()->device_name(), {}, {}};
    const bool listed = !sky.list.empty();
    std::size_t made = 0;
    for (const std::uint64_t number : batch.value().numbers()) {
      run.label = listed
                      ? concat({"map ", std::to_string(++made), " of ", std::to_string(batch.value().numbers().size())})
                      : std::string("sky");
      const std::string path = frame_path(options.output, static_cast<std::uint32_t>(number));
      const SkyEntry& entry = skies.value()[number];
      const Result<std::string> text = make_map(run, entry, path, listed ? std::string_view(path) : std::string_view());
      if (!text) return fail(text.error());
      if (listed && options.json) printed += printed.empty() ? "" : ",\n";
      printed += text.value();
      std::vector<std::string> paths = {path};
      if (sky.sun == "split") paths.push_back(sun_path(path));
      if (Result<void> r = batch.value().finished(number, paths, entry.name); !r) return fail(r.error());
    }
  }
  if (Result<void> r = batch.value().end(); !r) return fail(r.error());
  if (!sky.list.empty() && options.json) printed = printed.empty() ? "[]\n" : concat({"[\n", printed, "\n]\n"});
  return printed.empty() ? kDone : print(printed);
}

}  // namespace tyndall::cli
