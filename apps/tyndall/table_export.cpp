#include "table_export.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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

// Converts a half (IEEE 754 binary16) to a float. NaN and infinity, which the tables do not contain, are not handled.
float float_from_half(std::uint16_t half) {
  const int exponent = (half >> 10U) & 31U;
  const auto mantissa = static_cast<float>(half & 1023U);
  const float magnitude = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0F + mantissa, exponent - 25);
  return (half & 0x8000U) != 0 ? -magnitude : magnitude;
}

Result<std::vector<std::uint16_t>> download(gpu::Host& host, Effect& effect) {
  const gpu::Device& device = host.device();
  const VkDeviceSize size = effect.table_bytes();
  Result<gpu::Buffer> to =
      gpu::create_buffer(device, "exported_tables", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback);
  if (!to) return std::move(to).error();
  const Result<void> copied = host.run([&](VkCommandBuffer cmd) -> Result<void> {
    if (Result<void> r = effect.record_save_tables(cmd, to.value().buffer.get()); !r) return r;
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                 VK_ACCESS_HOST_READ_BIT);
    return {};
  });
  if (!copied) return copied.error();
  std::vector<std::uint16_t> out(size / sizeof(std::uint16_t));
  std::memcpy(out.data(), to.value().mapped, size);
  return out;
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
        axes_(models::table_axes(params_)),
        factors_(models::table_factors(params_, axes_)),
        shapes_(models::angle_shapes(params_, axes_)) {}

  // Writes the files. `texels` are in the order of record_save_tables. Returns the names of the files, the index last.
  Result<std::vector<std::string>> write(std::span<const std::uint16_t> texels, const std::string& device) {
    struct Kind {
      TableId id;
      const char* quantity;
      const char* unit;
      std::array<double, 3> models::TableFactors::*factor;
    };
    constexpr const char* kOfSpecies =
        " once, without the phase function: L / E0 divided by P(cos_view_sun), where L is "
        "the radiance and E0 the sun's irradiance above the atmosphere";
    const std::string rayleigh = concat({"light scattered by air", kOfSpecies});
    const std::string mie = concat({"light scattered by aerosol", kOfSpecies});
    const Kind kinds[] = {
        {TableId::single_rayleigh, rayleigh.c_str(), "1", &models::TableFactors::single_rayleigh},
        {TableId::single_mie, mie.c_str(), "1", &models::TableFactors::single_mie},
        {TableId::high_orders, "light scattered twice and more, phase functions included: L / E0", "1/sr",
         &models::TableFactors::high_orders},
        {TableId::sun_transmittance,
         "fraction of the sunlight E0 that reaches a point; the sun's disc softens the edge at the horizon", "1",
         nullptr},
        {TableId::sky_irradiance, "light of the open sky on a horizontal surface: E / E0", "1", nullptr},
    };
    total_ = 3 * axes_.altitude_m.size() + 2;
    ordered_json tables = ordered_json::array();
    for (const Kind& kind : kinds) {
      const gpu::ImageDesc desc = table_desc(kind.id, params_);
      const std::size_t count = std::size_t{4} * desc.extent.width * desc.extent.height * desc.extent.depth;
      const std::span<const std::uint16_t> own = texels.first(count);
      texels = texels.subspan(count);
      ordered_json table;
      const std::string name = table_name(kind.id);
      table["name"] = name;
      table["quantity"] = kind.quantity;
      table["unit"] = kind.unit;
      Result<ordered_json> files = kind.factor != nullptr
                                       ? scattering_table(name, own, kind.factor, kind.id == TableId::high_orders)
                                       : light_table(name, own, desc.extent);
      if (!files) return std::move(files).error();
      table["axes"] = kind.factor != nullptr ? "scattering" : "light";
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
  Result<ordered_json> scattering_table(const std::string& name, std::span<const std::uint16_t> texels,
                                        std::array<double, 3> models::TableFactors::*factor, bool shaped) {
    const UVec4& size = params_.tables.size;
    ordered_json files = ordered_json::array();
    image::Image image(size.z * size.w, size.y);
    for (std::uint32_t altitude = 0; altitude < size.x; ++altitude) {
      for (std::uint32_t view = 0; view < size.y; ++view) {
        const std::array<double, 3>& scale = factors_[std::size_t{altitude} * size.y + view].*factor;
        float* out = image.pixel(0, view);
        for (std::uint32_t z = 0; z < image.width; ++z) {
          const std::size_t at = ((std::size_t{z} * size.y + view) * size.x + altitude) * 4;
          for (std::size_t c = 0; c < 3; ++c) {
            const double t = float_from_half(texels[at + c]);
            const double shape = shaped ? shapes_[z / size.z][c] : 1.0;
            *out++ = static_cast<float>(scale[c] * shape * t * t * t * t);
          }
        }
      }
      const std::string number = std::to_string(altitude);
      const std::string file = name + "_" + std::string(4 - number.size(), '0') + number + ".exr";
      if (Result<void> r = write_image(file, image); !r) return std::move(r).error();
      files.push_back({{"file", file}, {"altitude_index", altitude}, {"altitude_m", axes_.altitude_m[altitude]}});
    }
    return files;
  }

  Result<ordered_json> light_table(const std::string& name, std::span<const std::uint16_t> texels,
                                   const VkExtent3D& extent) {
    image::Image image(extent.width, extent.height);
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
      for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] = float_from_half(texels[4 * i + c]);
    }
    light_extent_ = extent;
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
      const bool matters =
          row != nullptr && row->owner == config::Owner::effect && row->info.affects == Affects::Tables;
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

    const models::LightTableAxes light = models::light_table_axes(params_, light_extent_.width, light_extent_.height);
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
  std::vector<models::TableFactors> factors_;
  std::vector<std::array<double, 3>> shapes_;
  VkExtent3D light_extent_ = {0, 0, 0};
  std::vector<std::string> names_;
  std::size_t total_ = 0;
};

}  // namespace

const char* table_name(TableId table) {
  constexpr const char* kNames[kTableCount] = {"single_rayleigh", "single_mie", "high_orders", "sun_transmittance",
                                               "sky_irradiance"};
  return kNames[static_cast<std::uint32_t>(table)];
}

Result<void> check_export(const std::string& directory) {
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
  const Result<std::vector<std::uint16_t>> texels = download(host, effect);
  if (!texels) return texels.error();
  Result<Staging> staging = Staging::create(directory);
  if (!staging) return std::move(staging).error();
  Exporter exporter(settings, staging.value(), progress);
  const Result<std::vector<std::string>> files = exporter.write(texels.value(), host.device_name());
  if (!files) return files.error();
  if (Result<void> r = staging.value().publish(files.value()); !r) return std::move(r).error();
  return files.value().size();
}

}  // namespace tyndall::cli
