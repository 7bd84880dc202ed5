#include "scene/elevation/elevation_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <string_view>
#include <system_error>

#include <cpl_error.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>
#include <ogr_spatialref.h>

#include "scene/elevation/elevation_fill.hpp"

namespace tyndall::scene {
namespace {

constexpr double kImpossible_m = 20000.0;
constexpr double kAssumedSpacing_m = 30.0;
constexpr int kFillReach_samples = 100;  // of GDAL's interpolation; larger holes are filled more coarsely

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

// Takes GDAL's messages while it lives, on this thread: nothing goes to stderr, the first failure is kept.
class Messages {
 public:
  Messages() { CPLPushErrorHandlerEx(&Messages::take, this); }
  ~Messages() { CPLPopErrorHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  // The failure in brackets, or nothing.
  [[nodiscard]] std::string reason() const { return first_.empty() ? "" : " (" + first_ + ")"; }

 private:
  static void CPL_STDCALL take(CPLErr level, CPLErrorNum, const char* text) {
    auto* self = static_cast<Messages*>(CPLGetErrorHandlerUserData());
    if (level < CE_Failure || !self->first_.empty()) return;
    self->first_ = text;
    std::replace_if(
        self->first_.begin(), self->first_.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    while (!self->first_.empty() && (self->first_.back() == ' ' || self->first_.back() == '.'))
      self->first_.pop_back();
  }

  std::string first_;
};

Error fail(const std::filesystem::path& path, const std::string& what) {
  return Error{ErrorCode::io, "elevation file " + path.string() + " " + what, 0};
}

Result<void> check_path(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) return fail(path, "does not exist");
  if (std::filesystem::is_directory(status)) return fail(path, "is a directory, a file is needed");
  if (!std::filesystem::is_regular_file(status)) return fail(path, "is not a regular file");
  if (std::filesystem::file_size(path, ignored) == 0) return fail(path, "is empty");
  return {};
}

// Metres per unit of the heights; notes what is unknown.
double vertical_unit_m(GDALRasterBand& band, const OGRSpatialReference* srs,
                       std::vector<std::string>& notes) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr double kFoot = 0.3048;
  constexpr double kSurveyFoot = 1200.0 / 3937.0;
  constexpr std::array<Unit, 23> kUnits = {{{"m", 1.0},
                                            {"metre", 1.0},
                                            {"meter", 1.0},
                                            {"metres", 1.0},
                                            {"meters", 1.0},
                                            {"ft", kFoot},
                                            {"foot", kFoot},
                                            {"feet", kFoot},
                                            {"international foot", kFoot},
                                            {"us survey foot", kSurveyFoot},
                                            {"us survey feet", kSurveyFoot},
                                            {"us_survey_foot", kSurveyFoot},
                                            {"foot_us", kSurveyFoot},
                                            {"us-ft", kSurveyFoot},
                                            {"ftus", kSurveyFoot},
                                            {"mm", 0.001},
                                            {"cm", 0.01},
                                            {"centimetre", 0.01},
                                            {"centimeter", 0.01},
                                            {"dm", 0.1},
                                            {"decimetre", 0.1},
                                            {"decimeter", 0.1},
                                            {"km", 1000.0}}};
  std::string name = band.GetUnitType();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!name.empty()) {
    for (const Unit& unit : kUnits) {
      if (unit.name == name) return unit.metres;
    }
    notes.push_back("heights are in the unknown unit '" + name + "', taken as metres");
    return 1.0;
  }
  if (srs != nullptr && srs->IsCompound() != 0) {
    const double metres = srs->GetTargetLinearUnits("VERT_CS");
    if (metres > 0.0) return metres;
  }
  return 1.0;
}

// Where the samples lie. Without a coordinate system `srs` is empty and the transform is in metres.
struct Georeference {
  std::array<double, 6> transform = {};
  OGRSpatialReference srs;
};

Georeference georeference(GDALDataset& file, std::vector<std::string>& notes) {
  Georeference geo;
  const bool placed =
      file.GetGeoTransform(geo.transform.data()) == CE_None &&
      std::abs(geo.transform[1] * geo.transform[5] - geo.transform[2] * geo.transform[4]) > 0.0;
  const OGRSpatialReference* srs = file.GetSpatialRef();
  if (!placed) {
    notes.push_back("no georeferencing: samples taken as 30 m apart, north up");
    geo.transform = {0.0, kAssumedSpacing_m, 0.0, 0.0, 0.0, -kAssumedSpacing_m};
    return geo;
  }
  if (srs != nullptr && !srs->IsLocal()) {
    geo.srs = *srs;
    geo.srs.StripVertical();
  } else {
    const std::array<double, 6>& t = geo.transform;
    const double east = t[0] + t[1] * file.GetRasterXSize() + t[2] * file.GetRasterYSize();
    const double south = t[3] + t[4] * file.GetRasterXSize() + t[5] * file.GetRasterYSize();
    const bool degrees = std::max(std::abs(t[0]), std::abs(east)) <= 360.0 &&
                         std::max(std::abs(t[3]), std::abs(south)) <= 90.0 &&
                         std::abs(t[1]) + std::abs(t[2]) < 1.0;
    notes.push_back(degrees ? "no coordinate system: taken as degrees on WGS 84"
                            : "no coordinate system: taken as metres");
    if (degrees) geo.srs.SetWellKnownGeogCS("WGS84");
  }
  geo.srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return geo;
}

Dataset make_memory(int width, int height, const Georeference& geo, std::vector<float>& samples) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  if (driver == nullptr) return nullptr;
  Dataset memory(driver->Create("", width, height, 0, GDT_Float32, nullptr));
  if (!memory) return nullptr;
  std::array<char, 64> pointer = {};
  const int length = CPLPrintPointer(pointer.data(), samples.data(), static_cast<int>(pointer.size()) - 1);
  pointer[static_cast<std::size_t>(length)] = '\0';
  const std::string option = std::string("DATAPOINTER=") + pointer.data();
  std::array<char*, 2> options = {const_cast<char*>(option.c_str()), nullptr};
  if (memory->AddBand(GDT_Float32, options.data()) != CE_None) return nullptr;
  std::array<double, 6> transform = geo.transform;
  memory->SetGeoTransform(transform.data());
  if (!geo.srs.IsEmpty()) memory->SetSpatialRef(&geo.srs);
  return memory;
}

// The first band at no more than max_samples, in metres, holes as NaN; adapts the transform to the size.
Result<std::vector<float>> read_band(const std::filesystem::path& path, GDALDataset& file, int max_samples,
                                     Georeference& geo, int& width, int& height, const Messages& messages,
                                     std::vector<std::string>& notes) {
  GDALRasterBand& band = *file.GetRasterBand(1);
  const int file_width = file.GetRasterXSize();
  const int file_height = file.GetRasterYSize();
  const double shrink = std::max(1.0, static_cast<double>(std::max(file_width, file_height)) / max_samples);
  width = std::max(2, static_cast<int>(file_width / shrink));
  height = std::max(2, static_cast<int>(file_height / shrink));
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  if (shrink > 1.0) {
    how.eResampleAlg = GRIORA_Average;
    notes.push_back("read at " + std::to_string(width) + " x " + std::to_string(height) + " of its " +
                    std::to_string(file_width) + " x " + std::to_string(file_height) + " samples");
  }
  std::vector<float> samples(static_cast<std::size_t>(width) * height);
  if (band.RasterIO(GF_Read, 0, 0, file_width, file_height, samples.data(), width, height, GDT_Float32, 0, 0,
                    &how) != CE_None)
    return fail(path, "cannot be read: truncated or damaged" + messages.reason());
  const double sx = static_cast<double>(file_width) / width;
  const double sy = static_cast<double>(file_height) / height;
  geo.transform[1] *= sx;
  geo.transform[4] *= sx;
  geo.transform[2] *= sy;
  geo.transform[5] *= sy;

  int has_no_data = 0;
  const double no_data = band.GetNoDataValue(&has_no_data);
  const float no_data_sample =
      static_cast<float>(std::clamp(no_data, -static_cast<double>(std::numeric_limits<float>::max()),
                                    static_cast<double>(std::numeric_limits<float>::max())));
  const double unit = vertical_unit_m(band, file.GetSpatialRef(), notes);
  const double scale = band.GetScale() * unit;
  const double offset = band.GetOffset() * unit;
  std::size_t holes = 0;
  for (float& v : samples) {
    const double h = v * scale + offset;
    const bool hole =
        !std::isfinite(v) || (has_no_data != 0 && v == no_data_sample) || std::abs(h) > kImpossible_m;
    v = hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(h);
    if (hole) ++holes;
  }
  if (holes == samples.size())
    return fail(path, "holds no elevation: every sample is a hole (no-data, NaN or beyond 20 km)");
  if (holes > 0) notes.push_back("filled " + std::to_string(holes) + " samples without data");
  return samples;
}

// GDAL's interpolation for small holes, ours for what it leaves.
void fill(std::vector<float>& samples, int width, int height) {
  if (std::none_of(samples.begin(), samples.end(), [](float v) { return std::isnan(v); })) return;
  std::vector<float> valid(samples.size());
  std::transform(samples.begin(), samples.end(), valid.begin(),
                 [](float v) { return std::isnan(v) ? 0.0F : 1.0F; });
  std::vector<float> filled = samples;
  std::replace_if(
      filled.begin(), filled.end(), [](float v) { return std::isnan(v); }, -1.0e30F);
  const Georeference nowhere;
  const Dataset values = make_memory(width, height, nowhere, filled);
  const Dataset mask = make_memory(width, height, nowhere, valid);
  if (values && mask &&
      GDALFillNodata(values->GetRasterBand(1), mask->GetRasterBand(1), kFillReach_samples, 0, 0, nullptr,
                     nullptr, nullptr) == CE_None) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (std::isnan(samples[i]) && std::abs(filled[i]) <= kImpossible_m) samples[i] = filled[i];
    }
  }
  fill_holes(samples, width, height);
}

// The azimuthal equidistant projection around the middle of the samples, as PROJ writes it.
Result<std::string> map_projection(const std::filesystem::path& path, const Georeference& geo, int width,
                                   int height, double radius_m) {
  double x = geo.transform[0] + 0.5 * (width * geo.transform[1] + height * geo.transform[2]);
  double y = geo.transform[3] + 0.5 * (width * geo.transform[4] + height * geo.transform[5]);
  if (geo.srs.IsGeographic() == 0) {
    const std::unique_ptr<OGRSpatialReference> geographic(geo.srs.CloneGeogCS());
    if (!geographic) return fail(path, "has a coordinate system without latitudes and longitudes");
    geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> to_degrees(
        OGRCreateCoordinateTransformation(&geo.srs, geographic.get()));
    if (!to_degrees || to_degrees->Transform(1, &x, &y) == 0)
      return fail(path, "has a coordinate system that cannot be converted to latitudes and longitudes");
  }
  std::array<char, 160> text = {};
  std::snprintf(text.data(), text.size(), "+proj=aeqd +lat_0=%.12g +lon_0=%.12g +R=%.12g +units=m +no_defs",
                y, x, radius_m);
  return std::string(text.data());
}

// Resamples to square cells around the centre, on the map's projection unless there is no coordinate system.
Result<ElevationRaster> warp(const std::filesystem::path& path, GDALDataset& source, const Georeference& geo,
                             int max_samples, double radius_m, const Messages& messages) {
  std::string projection;
  if (!geo.srs.IsEmpty()) {
    Result<std::string> made =
        map_projection(path, geo, source.GetRasterXSize(), source.GetRasterYSize(), radius_m);
    if (!made.ok()) return std::move(made).error();
    projection = std::move(made).value();
  }
  std::string wkt;
  if (!projection.empty()) {
    OGRSpatialReference srs;
    char* text = nullptr;
    if (srs.importFromProj4(projection.c_str()) == OGRERR_NONE && srs.exportToWkt(&text) == OGRERR_NONE)
      wkt = text;
    CPLFree(text);
  }
  // Extent and spacing that keep the resolution.
  void* transformer = GDALCreateGenImgProjTransformer(GDALDataset::ToHandle(&source), nullptr, nullptr,
                                                      wkt.empty() ? nullptr : wkt.c_str(), FALSE, 0.0, 1);
  std::array<double, 6> suggested = {};
  std::array<double, 4> extent = {};
  int width = 0;
  int height = 0;
  const bool suggests =
      transformer != nullptr &&
      GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&source), GDALGenImgProjTransform, transformer,
                               suggested.data(), &width, &height, extent.data(), 0) == CE_None;
  if (transformer != nullptr) GDALDestroyGenImgProjTransformer(transformer);
  if (!suggests) return fail(path, "cannot be projected onto the terrain's map" + messages.reason());
  const double centre_x = wkt.empty() ? 0.5 * (extent[0] + extent[2]) : 0.0;
  const double centre_y = wkt.empty() ? 0.5 * (extent[1] + extent[3]) : 0.0;
  const double half_x = std::max(centre_x - extent[0], extent[2] - centre_x);
  const double half_y = std::max(centre_y - extent[1], extent[3] - centre_y);
  const double spacing = std::max(suggested[1], 2.0 * std::max(half_x, half_y) / max_samples);
  if (!(spacing > 0.0) || !std::isfinite(half_x + half_y))
    return fail(path, "cannot be projected onto the terrain's map" + messages.reason());

  ElevationRaster raster;
  raster.spacing_m = spacing;
  raster.width = std::clamp(static_cast<int>(std::lround(2.0 * half_x / spacing)), 2, max_samples);
  raster.height = std::clamp(static_cast<int>(std::lround(2.0 * half_y / spacing)), 2, max_samples);
  raster.heights.assign(static_cast<std::size_t>(raster.width) * raster.height,
                        std::numeric_limits<float>::quiet_NaN());
  Georeference target;
  target.transform = {centre_x - 0.5 * raster.width * spacing,  spacing, 0.0,
                      centre_y + 0.5 * raster.height * spacing, 0.0,     -spacing};
  const Dataset memory = make_memory(raster.width, raster.height, target, raster.heights);
  if (!memory || GDALReprojectImage(GDALDataset::ToHandle(&source), nullptr,
                                    GDALDataset::ToHandle(memory.get()), wkt.empty() ? nullptr : wkt.c_str(),
                                    GRA_Bilinear, 0.0, 0.0, nullptr, nullptr, nullptr) != CE_None)
    return fail(path, "cannot be projected onto the terrain's map" + messages.reason());
  memory->FlushCache();
  return raster;
}

}  // namespace

Result<ElevationRaster> read_elevation_file(const std::filesystem::path& path, double planet_radius_m,
                                            int max_samples) {
  Result<void> exists = check_path(path);
  if (!exists.ok()) return std::move(exists).error();
  const Messages messages;
  GDALAllRegister();
  const Dataset file(static_cast<GDALDataset*>(
      GDALOpenEx(path.string().c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                 nullptr, nullptr)));
  if (!file) return fail(path, "is in no format that GDAL reads, or damaged" + messages.reason());
  if (file->GetRasterCount() < 1) return fail(path, "holds no raster; a file with one raster is needed");
  if (file->GetRasterXSize() < 2 || file->GetRasterYSize() < 2)
    return fail(path, "has " + std::to_string(file->GetRasterXSize()) + " x " +
                          std::to_string(file->GetRasterYSize()) + " samples, at least 2 x 2 are needed");
  if (GDALDataTypeIsComplex(file->GetRasterBand(1)->GetRasterDataType()) != 0)
    return fail(path, "holds complex numbers, real elevations are needed");

  std::vector<std::string> notes;
  if (file->GetRasterCount() > 1)
    notes.push_back("has " + std::to_string(file->GetRasterCount()) +
                    " bands, the first is taken as elevation");
  Georeference geo = georeference(*file, notes);
  int width = 0;
  int height = 0;
  Result<std::vector<float>> samples =
      read_band(path, *file, max_samples, geo, width, height, messages, notes);
  if (!samples.ok()) return std::move(samples).error();
  fill(samples.value(), width, height);

  const Dataset memory = make_memory(width, height, geo, samples.value());
  if (!memory)
    return Error{ErrorCode::out_of_memory, "elevation file " + path.string() + " does not fit into memory",
                 0};
  Result<ElevationRaster> warped = warp(path, *memory, geo, max_samples, planet_radius_m, messages);
  if (!warped.ok()) return std::move(warped).error();
  ElevationRaster raster = std::move(warped).value();
  if (std::all_of(raster.heights.begin(), raster.heights.end(), [](float v) { return std::isnan(v); }))
    return fail(path, "cannot be projected onto the terrain's map" + messages.reason());
  fill_holes(raster.heights, raster.width, raster.height);
  const auto [low, high] = std::minmax_element(raster.heights.begin(), raster.heights.end());
  raster.min_m = *low;
  raster.max_m = *high;
  raster.notes = std::move(notes);
  return raster;
}

}  // namespace tyndall::scene
