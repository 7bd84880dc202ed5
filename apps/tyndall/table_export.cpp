#include "table_export.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "effect/medium.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "image/image.hpp"
#include "models/table_axes.hpp"
#include "models/table_values.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;
using nlohmann::ordered_json;

constexpr const char* kIndex = "tables.json";
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

Error directory_error(const std::string& directory, const std::string& why) {
  return Error{ErrorCode::io, concat({"'", files::one_line(directory, 200), "': cannot write: ", why,
                                      "; expected a directory, or a new name in an existing one"})};
}

// A folder inside the directory that holds the files until all are complete.
class Staging {
 public:
  static Result<Staging> create(const std::string& directory) {
    Staging out;
    out.directory_ = directory;
    std::error_code failed;
    out.made_directory_ = fs::create_directory(out.directory_, failed);
    if (failed) return directory_error(directory, failed.message());
    out.folder_ = out.directory_ / concat({".tyndall-", std::to_string(::getpid())});
    fs::create_directory(out.folder_, failed);
    if (failed) return directory_error(directory, failed.message());
    // The lock shows files::remove_leftovers() that this run is alive.
    out.lock_ = ::open(out.folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (out.lock_ >= 0) static_cast<void>(::flock(out.lock_, LOCK_EX | LOCK_NB));
    files::remove_leftovers(directory);
    return out;
  }
  Staging(Staging&& other) noexcept
      : directory_(std::move(other.directory_)),
        folder_(std::exchange(other.folder_, {})),
        made_directory_(other.made_directory_),
        lock_(std::exchange(other.lock_, -1)) {}
  Staging& operator=(Staging&& other) = delete;
  Staging(const Staging&) = delete;
  ~Staging() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
    if (lock_ >= 0) ::close(lock_);
    if (made_directory_ && !directory_.empty() && fs::is_empty(directory_, ignored)) fs::remove(directory_, ignored);
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  // Moves all files at once, as far as a file system allows. The old index is removed first and the new one added last,
  // so that an index never stands beside files that it does not describe.
  [[nodiscard]] Result<void> publish(const std::vector<std::string>& files) const {
    std::error_code failed;
    for (const std::string& file : files) {
      if (fs::is_directory(directory_ / file, failed))
        return directory_error((directory_ / file).string(), "it is a directory");
    }
    fs::remove(directory_ / kIndex, failed);
    for (const std::string& file : files) {
      fs::rename(folder_ / file, directory_ / file, failed);
      if (failed) return directory_error(directory_.string(), failed.message());
    }
    return {};
  }

 private:
  Staging() = default;
  fs::path directory_, folder_;
  bool made_directory_ = false;
  int lock_ = -1;  // descriptor of the folder
};

ordered_json cosines(std::span<const double> values) {
  ordered_json out;
  out["cosine"] = values;
  ordered_json angles = ordered_json::array();
  for (const double value : values) angles.push_back(std::acos(std::clamp(value, -1.0, 1.0)) * kDegPerRad);
  out["deg"] = std::move(angles);
  return out;
}

// Returns the components as JSON numbers with the digits of a float.
ordered_json floats(const Vec3& v) {
  ordered_json out = ordered_json::array();
  for (const float value : {v.x, v.y, v.z}) {
    double number = 0.0;
    static_cast<void>(files::read_number(files::number_text(value), number));
    out.push_back(number);
  }
  return out;
}

class Exporter {
 public:
  Exporter(const config::Settings& settings, const Staging& staging,
           const std::function<void(std::size_t, std::size_t)>& progress)
      : settings_(settings),
        params_(settings.effect),
        staging_(staging),
        progress_(progress),
        axes_(models::table_axes(params_)) {}

  // Writes the files of all tables. Returns the names of the files, the index last.
  Result<std::vector<std::string>> write(std::span<const models::TableValues> values, const std::string& device) {
    struct Kind {
      const char* quantity;
      const char* unit;
      bool light;  // one of the look-up tables of light
    };
    constexpr const char* kOfSpecies =
        " once, without the phase function: L / E0 divided by P(cos_view_sun), where L is "
        "the radiance and E0 the sun's irradiance above the atmosphere";
    const std::string rayleigh = concat({"light scattered by air", kOfSpecies});
    const std::string mie = concat({"light scattered by aerosol", kOfSpecies});
    const Kind kinds[] = {
        {rayleigh.c_str(), "1", false},
        {mie.c_str(), "1", false},
        {"light scattered twice and more, phase functions included: L / E0", "1/sr", false},
        {"fraction of the sunlight E0 that reaches a point; the sun's disc softens the edge at the horizon", "1", true},
        {"light of the open sky on a horizontal surface: E / E0", "1", true},
    };
    total_ = 3 * axes_.altitude_m.size() + 2;
    ordered_json tables = ordered_json::array();
    for (const models::TableValues& table_of : values) {
      const Kind& kind = kinds[static_cast<std::uint32_t>(table_of.id)];
      const std::string name = models::table_name(table_of.id);
      ordered_json table;
      table["name"] = name;
      table["quantity"] = kind.quantity;
      table["unit"] = kind.unit;
      Result<ordered_json> files = kind.light ? light_table(name, table_of) : scattering_table(name, table_of);
      if (!files) return std::move(files).error();
      table["axes"] = kind.light ? "light" : "scattering";
      table["files"] = std::move(files).value();
      tables.push_back(std::move(table));
    }
    const std::string index = describe(device, std::move(tables)).dump(1) + "\n";
    if (Result<void> r = files::write_file(staging_.at(kIndex), index); !r) return std::move(r).error();
    names_.emplace_back(kIndex);
    return names_;
  }

 private:
  Result<void> write_image(const std::string& name, const image::Image& image) {
    progress_(names_.size(), total_);
    names_.push_back(name);
    return image::write_exr(staging_.at(name), image, config::metadata(settings_));
  }

  // Writes one picture per altitude.
  Result<ordered_json> scattering_table(const std::string& name, const models::TableValues& table) {
    ordered_json files = ordered_json::array();
    image::Image image(table.size[2] * table.size[3], table.size[1]);
    for (std::uint32_t altitude = 0; altitude < table.size[0]; ++altitude) {
      const auto own = std::span(table.values).subspan(altitude * image.rgb.size(), image.rgb.size());
      std::copy(own.begin(), own.end(), image.rgb.begin());
      const std::string number = std::to_string(altitude);
      const std::string file = name + "_" + std::string(4 - number.size(), '0') + number + ".exr";
      if (Result<void> r = write_image(file, image); !r) return std::move(r).error();
      files.push_back({{"file", file}, {"altitude_index", altitude}, {"altitude_m", axes_.altitude_m[altitude]}});
    }
    return files;
  }

  Result<ordered_json> light_table(const std::string& name, const models::TableValues& table) {
    image::Image image(table.size[3], table.size[2]);
    std::copy(table.values.begin(), table.values.end(), image.rgb.begin());
    light_size_ = {table.size[3], table.size[2]};
    const std::string file = name + ".exr";
    if (Result<void> r = write_image(file, image); !r) return std::move(r).error();
    return ordered_json::array({{{"file", file}}});
  }

  ordered_json describe(const std::string& device, ordered_json tables) const {
    const UVec4& size = params_.tables.size;
    ordered_json out;
    out["format"] = "tyndall tables 1";
    out["device"] = device;
    out["channels_nm"] = floats(params_.atmosphere.wavelengths_nm);
    out["size"] = {size.x, size.y, size.z, size.w};
    ordered_json& parameters = out["parameters"];
    for (const auto& [name, value] : config::metadata(settings_)) {
      const config::Row* const row = name.starts_with("tyndall.") ? config::find_row(name.substr(8)) : nullptr;
      const bool matters = row != nullptr && row->owner == config::Owner::effect &&
                           (row->info.affects == Affects::Tables || row->info.affects == Affects::Everything);
      if (matters) parameters[row->key()] = value;
      if (name == "tyndall.version") out["version"] = value;
    }
    const shared::Medium medium = medium_from_params(params_);
    out["medium"] = {{"rayleigh_scattering_per_m", floats(medium.rayleigh_scattering)},
                     {"mie_scattering_per_m", floats(medium.mie_scattering)},
                     {"mie_extinction_per_m", floats(medium.mie_extinction)},
                     {"ozone_absorption_per_m", floats(medium.ozone_absorption)}};

    ordered_json& scattering = out["axes"]["scattering"];
    scattering["file"] = "altitude";
    scattering["row"] = "view zenith angle, from the top; its values belong to the altitude of the file";
    scattering["column"] = "sun zenith angle at the density-weighted mean distance along the ray + " +
                           std::to_string(size.z) + " * angle between view and sun";
    scattering["sun_at_origin"] =
        "with r = radius + altitude and r_m = sqrt(r^2 + d^2 + 2 r d cos_view_zenith), d = mean_distance_m of the row: "
        "cos_sun_zenith at the ray's origin = (r_m cos_sun_zenith - d cos_view_sun) / r";
    scattering["continued"] = "no geometry has the three angles where, at the ray's origin, |cos_view_sun - "
                              "cos_view_zenith cos_sun_zenith| > "
                              "sin_view_zenith sin_sun_zenith; such texels continue the table for interpolation";
    scattering["altitude_m"] = axes_.altitude_m;
    ordered_json views = ordered_json::array();
    for (std::size_t i = 0; i < size.x; ++i) {
      const std::size_t first = i * size.y;
      ordered_json view = cosines(std::span(axes_.cos_view_zenith).subspan(first, size.y));
      ordered_json& ends = view["ends_on_ground"] = ordered_json::array();
      for (std::size_t k = 0; k < size.y; ++k) ends.push_back(static_cast<bool>(axes_.ends_on_ground[first + k]));
      view["mean_distance_m"] = std::span(axes_.mean_distance_m).subspan(first, size.y);
      views.push_back(std::move(view));
    }
    scattering["view_zenith_by_altitude"] = std::move(views);
    scattering["sun_zenith"] = cosines(axes_.cos_sun_zenith);
    scattering["view_sun"] = cosines(axes_.cos_view_sun);

    const models::LightTableAxes light = models::light_table_axes(params_, light_size_[0], light_size_[1]);
    ordered_json& lights = out["axes"]["light"];
    lights["row"] = "sun zenith angle: its cosine is cos_horizon of the column + cos_sun_from_horizon of the row, "
                    "within -1 to 1";
    lights["column"] = "altitude";
    lights["altitude_m"] = light.altitude_m;
    lights["cos_horizon"] = light.cos_horizon;
    lights["cos_sun_from_horizon"] = light.cos_sun_from_horizon;
    out["tables"] = std::move(tables);
    return out;
  }

  const config::Settings& settings_;
  const Params& params_;
  const Staging& staging_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  models::TableAxes axes_;
  std::array<std::uint32_t, 2> light_size_ = {};  // altitudes, suns
  std::vector<std::string> names_;
  std::size_t total_ = 0;
};

}  // namespace

Result<void> check_export(const std::string& directory, const Params& params) {
  if (params.scattering.color == ColorMode::spectral) {
    return files::input_error("scattering.color = spectral has tables at four wavelengths", "-o",
                              "expected scattering.color = rgb, whose three channels the exported files have");
  }
  if (Result<void> r = image::check_exr_supported(directory); !r) return r;
  std::error_code failed;
  const fs::file_status status = fs::status(directory, failed);
  if (fs::is_directory(status)) return files::check_writable((fs::path(directory) / kIndex).string());
  if (fs::exists(status)) return directory_error(directory, "it is a file");
  // If a file of this name could be written, the directory can be created.
  fs::path name = directory;
  if (!name.has_filename()) name = name.parent_path();  // a trailing slash
  return files::check_writable(name.string());
}

Result<std::size_t> export_tables(const std::string& directory, gpu::Host& host, Effect& effect,
                                  const config::Settings& settings,
                                  const std::function<void(std::size_t, std::size_t)>& progress) {
  const Result<std::vector<models::TableValues>> values = models::table_values(host, effect, settings.effect);
  if (!values) return values.error();
  Result<Staging> staging = Staging::create(directory);
  if (!staging) return std::move(staging).error();
  Exporter exporter(settings, staging.value(), progress);
  const Result<std::vector<std::string>> files = exporter.write(values.value(), host.device_name());
  if (!files) return files.error();
  if (Result<void> r = staging.value().publish(files.value()); !r) return std::move(r).error();
  return files.value().size();
}

}  // namespace tyndall::cli
