#include "scene/elevation/elevation_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>

#include <gdal.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <ogr_spatialref.h>

#include "files/text.hpp"
#include "scene/elevation/elevation_fill.hpp"
#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

constexpr double kAssumedSpacing_m = 30.0;
constexpr int kFillReach_samples = 100;  // reach of GDAL's interpolation; larger holes are filled more coarsely

// The georeference of the samples. Without a coordinate system `srs` is empty and the transform is in metres.
struct Georeference {
  std::array<double, 6> transform = {};
  OGRSpatialReference srs;
  double height_unit_m = 1.0;
};

// The bounds of the raster in the file's coordinates.
struct Extent {
  double min_x, max_x, min_y, max_y;
};

Extent extent_of(const std::array<double, 6>& t, int width, int height) {
  const std::array<double, 4> x = {t[0], t[0] + t[1] * width, t[0] + t[2] * height,
                                   t[0] + t[1] * width + t[2] * height};
  const std::array<double, 4> y = {t[3], t[3] + t[4] * width, t[3] + t[5] * height,
                                   t[3] + t[4] * width + t[5] * height};
  const auto [min_x, max_x] = std::minmax_element(x.begin(), x.end());
  const auto [min_y, max_y] = std::minmax_element(y.begin(), y.end());
  return {*min_x, *max_x, *min_y, *max_y};
}

// Returns whether coordinates without a coordinate system are probably degrees. A survey that begins at 0,0 is local.
bool look_like_degrees(const std::array<double, 6>& t, const Extent& extent) {
  const bool local = extent.min_x == 0.0 && extent.min_y == 0.0;
  return !local && std::max(std::abs(extent.min_x), std::abs(extent.max_x)) <= 360.0 &&
         std::max(std::abs(extent.min_y), std::abs(extent.max_y)) <= 90.0 && std::abs(t[1]) + std::abs(t[2]) < 1.0;
}

bool is_invertible(const std::array<double, 6>& t) { return std::abs(t[1] * t[5] - t[2] * t[4]) > 0.0; }

// Sets the transform and the coordinate system of a file without a transform: from ground control points if an affine
// transform fits them to a quarter of a sample, otherwise by assumption.
Result<const OGRSpatialReference*> place_without_transform(const std::string& source_name, GDALDataset& file,
                                                           std::array<double, 6>& transform,
                                                           std::vector<std::string>& notes) {
  const int points = file.GetGCPCount();
  if (points > 0) {
    if (GDALGCPsToGeoTransform(points, file.GetGCPs(), transform.data(), FALSE) != 0 && is_invertible(transform))
      return file.GetGCPSpatialRef();
    return elevation_error(source_name, "is placed by " + std::to_string(points) +
                                            " ground control points that no affine transform fits; expected a raster "
                                            "that gdalwarp has resampled");
  }
  if (file.GetMetadata("GEOLOCATION") != nullptr)
    return elevation_error(source_name,
                           "is placed by arrays of coordinates; expected a raster that gdalwarp has resampled");
  notes.push_back("no georeferencing: samples 30 m apart and north up are assumed");
  transform = {0.0, kAssumedSpacing_m, 0.0, 0.0, 0.0, -kAssumedSpacing_m};
  return nullptr;
}

Result<Georeference> georeference(const std::string& source_name, GDALDataset& file, TerrainUnits units,
                                  std::vector<std::string>& notes) {
  Georeference geo;
  const OGRSpatialReference* srs = file.GetSpatialRef();
  if (file.GetGeoTransform(geo.transform.data()) != CE_None || !is_invertible(geo.transform)) {
    const Result<const OGRSpatialReference*> placed = place_without_transform(source_name, file, geo.transform, notes);
    if (!placed.ok()) return placed.error();
    srs = placed.value();
    if (file.GetGCPCount() == 0) return geo;
  }
  if (srs != nullptr && !srs->IsLocal()) {
    geo.srs = *srs;
    geo.srs.StripVertical();
  } else if (const char* unit = nullptr;
             srs != nullptr && units == TerrainUnits::automatic && std::abs(srs->GetLinearUnits(&unit) - 1.0) > 1e-9) {
    for (double& value : geo.transform) value *= srs->GetLinearUnits();
    notes.push_back("local coordinates in the unit '" + files::one_line(unit) + "' are converted to metres");
  } else {
    const Extent extent = extent_of(geo.transform, file.GetRasterXSize(), file.GetRasterYSize());
    const bool degrees =
        units == TerrainUnits::automatic ? look_like_degrees(geo.transform, extent) : units == TerrainUnits::degrees;
    if (units == TerrainUnits::automatic) {
      notes.push_back(degrees
                          ? "no coordinate system: degrees on WGS 84 are assumed; terrain.units=metres selects metres"
                          : "no coordinate system: metres are assumed; terrain.units=degrees selects degrees");
    }
    if (degrees) geo.srs.SetWellKnownGeogCS("WGS84");
  }
  geo.srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return geo;
}

// Refuses coordinates that cannot be on a planet. PROJ returns infinities for some, and a wrong scale for others.
Result<void> check_extent(const std::string& source_name, const Georeference& geo, int width, int height) {
  const Extent extent = extent_of(geo.transform, width, height);
  const auto text = [](double value) {
    std::array<char, 32> digits = {};
    std::snprintf(digits.data(), digits.size(), "%.6g", value);
    return std::string(digits.data());
  };
  if (geo.srs.IsGeographic() != 0) {
    const double half_x = 0.5 * (std::abs(geo.transform[1]) + std::abs(geo.transform[2]));
    const double half_y = 0.5 * (std::abs(geo.transform[4]) + std::abs(geo.transform[5]));
    const double per_degree = geo.srs.GetAngularUnits() / (std::numbers::pi / 180.0);
    if (std::max(-extent.min_y - half_y, extent.max_y - half_y) * per_degree > 90.0) {
      return elevation_error(source_name, "reaches from latitude " + text(extent.min_y * per_degree) + " to " +
                                              text(extent.max_y * per_degree) + "; expected -90 to 90 degrees");
    }
    if ((extent.max_x - extent.min_x - 2.0 * half_x) * per_degree > 360.0 ||
        std::abs(extent.min_x) * per_degree > 720.0) {
      return elevation_error(source_name, "reaches from longitude " + text(extent.min_x * per_degree) + " to " +
                                              text(extent.max_x * per_degree) + "; expected at most 360 degrees");
    }
    return {};
  }
  constexpr double kMaxExtent_m = 1.0e8, kMinSpacing_m = 1.0e-3;
  const double unit_m = geo.srs.IsEmpty() ? 1.0 : geo.srs.GetLinearUnits();
  const double size_m = std::max(extent.max_x - extent.min_x, extent.max_y - extent.min_y) * unit_m;
  const double spacing_m = std::hypot(geo.transform[1], geo.transform[4]) * unit_m;
  if (size_m <= kMaxExtent_m && spacing_m >= kMinSpacing_m) return {};
  return elevation_error(source_name, "covers " + text(size_m) + " m with samples " + text(spacing_m) +
                                          " m apart; expected at most 1e+08 m and at least 0.001 m");
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

// Returns whether GDAL reports signed bytes as unsigned ones, as it does before version 3.7.
bool has_signed_bytes(GDALRasterBand& band) {
  const char* const type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return type != nullptr && std::string_view(type) == "SIGNEDBYTE";
}

// Returns the mask or the opacity of a band: 0 where there are no heights. Empty if the band has neither.
Result<std::vector<std::uint8_t>> read_mask(const std::string& source_name, GDALRasterBand& band, int width, int height,
                                            const Messages& messages) {
  GDALRasterBand* source = nullptr;
  if ((band.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) != 0) source = band.GetMaskBand();
  // GDAL ignores opacities that are stored as real numbers.
  GDALDataset* const file = band.GetDataset();
  GDALRasterBand* const last = file == nullptr ? nullptr : file->GetRasterBand(file->GetRasterCount());
  if (source == nullptr && last != nullptr && last != &band && last->GetColorInterpretation() == GCI_AlphaBand)
    source = last;
  std::vector<std::uint8_t> mask;
  if (source == nullptr) return mask;
  mask.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (source->RasterIO(GF_Read, 0, 0, band.GetXSize(), band.GetYSize(), mask.data(), width, height, GDT_Byte, 0, 0,
                       nullptr) != CE_None)
    return elevation_error(source_name, "has a mask that cannot be read: truncated or damaged" + messages.reason());
  return mask;
}

// Reads the first band with at most max_samples on a side. Heights are in metres, and holes are NaN. Adapts the
// transform to the size.
Result<std::vector<float>> read_band(const std::string& source_name, GDALDataset& file, int max_samples,
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
  const bool signed_bytes = has_signed_bytes(band);
  if (shrink > 1.0) {
    // GDAL would average signed bytes as unsigned ones.
    how.eResampleAlg = signed_bytes ? GRIORA_NearestNeighbour : GRIORA_Average;
    notes.push_back("read at " + std::to_string(width) + " x " + std::to_string(height) + " of its " +
                    std::to_string(file_width) + " x " + std::to_string(file_height) + " samples");
  }
  std::vector<float> samples(static_cast<std::size_t>(width) * height);
  if (band.RasterIO(GF_Read, 0, 0, file_width, file_height, samples.data(), width, height, GDT_Float32, 0, 0, &how) !=
      CE_None)
    return elevation_error(source_name, "cannot be read: truncated or damaged" + messages.reason());
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
  const double scale = band.GetScale() * geo.height_unit_m;
  const double offset = band.GetOffset() * geo.height_unit_m;
  if (!std::isfinite(scale) || !std::isfinite(offset) || scale == 0.0) {
    return elevation_error(source_name, "has the scale " + std::to_string(band.GetScale()) + " and the offset " +
                                            std::to_string(band.GetOffset()) +
                                            " of heights; expected finite numbers, and a scale other than 0");
  }
  const Result<std::vector<std::uint8_t>> mask = read_mask(source_name, band, width, height, messages);
  if (!mask.ok()) return mask.error();
  std::size_t holes = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    float& v = samples[i];
    if (signed_bytes && v > 127.0F) v -= 256.0F;
    const double h = v * scale + offset;
    const bool hole = !std::isfinite(v) || (has_no_data != 0 && v == no_data_sample) || std::abs(h) > kMaxElevation_m ||
                      (!mask.value().empty() && mask.value()[i] == 0);
    v = hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(h);
    if (hole) ++holes;
  }
  if (holes == samples.size())
    return elevation_error(
        source_name,
        "has no elevations: every sample is a hole (no-data, NaN or beyond 25 km); expected at least one height");
  if (holes > 0) notes.push_back("filled " + std::to_string(holes) + " samples without data");
  return samples;
}

// Fills small holes by GDAL's interpolation, and the remaining ones with fill_holes().
void fill_all_holes(std::vector<float>& samples, int width, int height) {
  if (std::none_of(samples.begin(), samples.end(), [](float v) { return std::isnan(v); })) return;
  std::vector<float> valid(samples.size());
  std::transform(samples.begin(), samples.end(), valid.begin(), [](float v) { return std::isnan(v) ? 0.0F : 1.0F; });
  std::vector<float> filled = samples;
  std::replace_if(
      filled.begin(), filled.end(), [](float v) { return std::isnan(v); }, -1.0e30F);
  const Georeference nowhere;
  const Dataset values = make_memory(width, height, nowhere, filled);
  const Dataset mask = make_memory(width, height, nowhere, valid);
  if (values && mask &&
      GDALFillNodata(values->GetRasterBand(1), mask->GetRasterBand(1), kFillReach_samples, 0, 0, nullptr, nullptr,
                     nullptr) == CE_None) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (std::isnan(samples[i]) && std::abs(filled[i]) <= kMaxElevation_m) samples[i] = filled[i];
    }
  }
  fill_holes(samples, width, height);
}

// The azimuthal equidistant projection around the middle of the samples.
struct MapProjection {
  std::string wkt;     // empty: the file's coordinates are metres already
  double scale = 1.0;  // metres on the planet per unit of the projection
  std::optional<Place> centre;
};

// Returns the latitude and the longitude east of Greenwich of a point in a coordinate system. Systems may count
// longitudes from another meridian, such as that of Paris, or angles in other units than degrees.
Result<Place> place_of(const std::string& source_name, const OGRSpatialReference& srs, double x, double y) {
  std::unique_ptr<OGRSpatialReference> geographic(srs.CloneGeogCS());
  if (!geographic) return elevation_error(source_name, "has a coordinate system without latitudes and longitudes");
  // The base of a rotated grid is a system with the same body.
  if (srs.IsDerivedGeographic() != 0) {
    geographic = std::make_unique<OGRSpatialReference>();
    geographic->SetGeogCS("", "", "", srs.GetSemiMajor(), srs.GetInvFlattening());
  }
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (srs.IsGeographic() == 0 || srs.IsDerivedGeographic() != 0) {
    const std::unique_ptr<OGRCoordinateTransformation> to_angles(
        OGRCreateCoordinateTransformation(&srs, geographic.get()));
    if (!to_angles || to_angles->Transform(1, &x, &y) == 0)
      return elevation_error(source_name,
                             "has a coordinate system that cannot be converted to latitudes and longitudes");
  }
  const double degrees = geographic->GetAngularUnits() * (180.0 / std::numbers::pi);
  return Place{y * degrees, std::remainder(x * degrees + geographic->GetPrimeMeridian(), 360.0)};
}

Result<MapProjection> map_projection(const std::string& source_name, const Georeference& geo, int width, int height,
                                     double radius_m, std::vector<std::string>& notes) {
  MapProjection out;
  if (geo.srs.IsEmpty()) return out;
  const double x = geo.transform[0] + 0.5 * (width * geo.transform[1] + height * geo.transform[2]);
  const double y = geo.transform[3] + 0.5 * (width * geo.transform[4] + height * geo.transform[5]);
  Result<Place> middle = place_of(source_name, geo.srs, x, y);
  if (!middle.ok()) return std::move(middle).error();
  // PROJ does not convert between celestial bodies. The sphere therefore has the size of the file's body, and the
  // result is scaled to the planet. Latitudes and longitudes are unchanged.
  constexpr double kSameBody = 0.005;
  const double file_radius_m = geo.srs.GetSemiMajor();
  const bool same_body = std::abs(file_radius_m - radius_m) <= kSameBody * file_radius_m;
  const double sphere_m = same_body ? radius_m : file_radius_m;
  out.scale = radius_m / sphere_m;
  constexpr double kEarth_m = 6378137.0;
  if (std::abs(file_radius_m - kEarth_m) <= kSameBody * kEarth_m) out.centre = middle.value();
  std::array<char, 160> text = {};
  if (!same_body) {
    std::snprintf(
        text.data(), text.size(),
        "made for a body of radius %.0f km; its latitudes and longitudes are used on this planet of radius %.0f km",
        file_radius_m / 1000.0, radius_m / 1000.0);
    notes.emplace_back(text.data());
  }
  std::snprintf(text.data(), text.size(), "+proj=aeqd +lat_0=%.12g +lon_0=%.12g +R=%.12g +units=m +no_defs",
                middle.value().latitude_deg, middle.value().longitude_deg, sphere_m);
  OGRSpatialReference srs;
  char* wkt = nullptr;
  if (srs.importFromProj4(text.data()) == OGRERR_NONE && srs.exportToWkt(&wkt) == OGRERR_NONE) out.wkt = wkt;
  CPLFree(wkt);
  if (out.wkt.empty()) return elevation_error(source_name, "has a centre around which there is no map projection");
  return out;
}

// Resamples to square cells around the centre, in the map's projection if there is a coordinate system.
Result<ElevationRaster> warp(const std::string& source_name, GDALDataset& source, const Georeference& geo,
                             const ElevationRequest& request, const Messages& messages,
                             std::vector<std::string>& notes) {
  const int max_samples = request.max_samples;
  Result<MapProjection> projection = map_projection(source_name, geo, source.GetRasterXSize(), source.GetRasterYSize(),
                                                    request.planet_radius_m, notes);
  if (!projection.ok()) return std::move(projection).error();
  const std::string& wkt = projection.value().wkt;
  // Determine the extent and the spacing that preserve the resolution.
  void* transformer = GDALCreateGenImgProjTransformer(GDALDataset::ToHandle(&source), nullptr, nullptr,
                                                      wkt.empty() ? nullptr : wkt.c_str(), FALSE, 0.0, 1);
  std::array<double, 6> suggested = {};
  std::array<double, 4> extent = {};
  int width = 0;
  int height = 0;
  const bool suggests = transformer != nullptr &&
                        GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&source), GDALGenImgProjTransform, transformer,
                                                 suggested.data(), &width, &height, extent.data(), 0) == CE_None;
  if (transformer != nullptr) GDALDestroyGenImgProjTransformer(transformer);
  if (!suggests) return elevation_error(source_name, "cannot be projected onto the terrain's map" + messages.reason());
  const double centre_x = wkt.empty() ? 0.5 * (extent[0] + extent[2]) : 0.0;
  const double centre_y = wkt.empty() ? 0.5 * (extent[1] + extent[3]) : 0.0;
  const double half_x = std::max(centre_x - extent[0], extent[2] - centre_x);
  const double half_y = std::max(centre_y - extent[1], extent[3] - centre_y);
  const double spacing = std::max(suggested[1], 2.0 * std::max(half_x, half_y) / max_samples);
  if (!(spacing > 0.0) || !std::isfinite(half_x + half_y))
    return elevation_error(source_name, "cannot be projected onto the terrain's map" + messages.reason());

  ElevationRaster raster;
  raster.spacing_m = spacing * projection.value().scale;
  raster.centre = projection.value().centre;
  raster.width = std::clamp(static_cast<int>(std::lround(2.0 * half_x / spacing)), 2, max_samples);
  raster.height = std::clamp(static_cast<int>(std::lround(2.0 * half_y / spacing)), 2, max_samples);
  raster.heights.assign(static_cast<std::size_t>(raster.width) * raster.height,
                        std::numeric_limits<float>::quiet_NaN());
  Georeference target;
  target.transform = {centre_x - 0.5 * raster.width * spacing,  spacing, 0.0,
                      centre_y + 0.5 * raster.height * spacing, 0.0,     -spacing};
  const Dataset memory = make_memory(raster.width, raster.height, target, raster.heights);
  if (!memory || GDALReprojectImage(GDALDataset::ToHandle(&source), nullptr, GDALDataset::ToHandle(memory.get()),
                                    wkt.empty() ? nullptr : wkt.c_str(), GRA_Bilinear, 0.0, 0.0, nullptr, nullptr,
                                    nullptr) != CE_None)
    return elevation_error(source_name, "cannot be projected onto the terrain's map" + messages.reason());
  memory->FlushCache();
  return raster;
}

// Shifts longitudes by whole turns, so that the middle of the file lies between -180 and 180 degrees.
void unwind_longitudes(Georeference& geo, int width, int height) {
  if (geo.srs.IsGeographic() == 0) return;
  const Extent extent = extent_of(geo.transform, width, height);
  const double turn = 2.0 * std::numbers::pi / geo.srs.GetAngularUnits();
  geo.transform[0] -= std::round(0.5 * (extent.min_x + extent.max_x) / turn) * turn;
}

}  // namespace

Result<ElevationRaster> read_elevation_here(const std::string& source_name, const ElevationRequest& request) {
  const Messages messages;
  const NetworkGuard guard(source_name);
  Result<Dataset> opened = open_elevation(source_name, messages);
  if (!opened.ok()) return std::move(opened).error();
  GDALDataset* file = opened.value().get();
  if (Result<void> readable = check_samples(source_name, *file); !readable.ok()) return std::move(readable).error();

  std::vector<std::string> notes;
  Result<Dataset> decoded = decode_colours(source_name, *file, notes);
  if (!decoded.ok()) return std::move(decoded).error();
  if (decoded.value()) file = decoded.value().get();
  if (file->GetRasterCount() > 1)
    notes.push_back("has " + std::to_string(file->GetRasterCount()) + " bands; the first is used as elevation");
  Result<Georeference> placed = georeference(source_name, *opened.value(), request.units, notes);
  if (!placed.ok()) return std::move(placed).error();
  Georeference geo = std::move(placed).value();
  Result<void> somewhere = check_extent(source_name, geo, file->GetRasterXSize(), file->GetRasterYSize());
  if (!somewhere.ok()) return std::move(somewhere).error();
  unwind_longitudes(geo, file->GetRasterXSize(), file->GetRasterYSize());
  const Dataset declared = declare_no_data(*file, notes);
  if (declared) file = declared.get();
  geo.height_unit_m = height_unit_m(*opened.value(), *file, notes);
  int width = 0;
  int height = 0;
  Result<std::vector<float>> samples =
      read_band(source_name, *file, request.max_samples, geo, width, height, messages, notes);
  if (!samples.ok()) return std::move(samples).error();
  fill_all_holes(samples.value(), width, height);

  const Dataset memory = make_memory(width, height, geo, samples.value());
  if (!memory) return Error{ErrorCode::out_of_memory, "elevation file " + source_name + " does not fit into memory", 0};
  Result<ElevationRaster> warped = warp(source_name, *memory, geo, request, messages, notes);
  if (!warped.ok()) return std::move(warped).error();
  ElevationRaster raster = std::move(warped).value();
  if (std::all_of(raster.heights.begin(), raster.heights.end(), [](float v) { return std::isnan(v); }))
    return elevation_error(source_name, "cannot be projected onto the terrain's map" + messages.reason());
  fill_holes(raster.heights, raster.width, raster.height);
  const auto [low, high] = std::minmax_element(raster.heights.begin(), raster.heights.end());
  raster.min_m = *low;
  raster.max_m = *high;
  raster.notes = std::move(notes);
  return raster;
}

}  // namespace tyndall::scene
