// Opens elevation files. Restricts the allowed names and drivers.
#include <cpl_conv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "scene/elevation/elevation_file.hpp"
#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

// Formats of elevation files, and of images that may contain elevations. None of these drivers opens network
// connections by itself. GDAL's other drivers (WMS, WCS, HTTP, STAC, databases, ...) are not needed and are removed.
constexpr std::array<const char*, 63> kDrivers = {
    "AAIGrid",        "AIG",     "BAG",       "BMP",  "BT",       "COG",     "CTG",      "DTED",
    "EHdr",           "ENVI",    "ERS",       "EXR",  "GenBin",   "GFF",     "GMT",      "GPKG",
    "GRASSASCIIGrid", "GRIB",    "GS7BG",     "GSAG", "GSBG",     "GTiff",   "GXF",      "HDF4",
    "HDF4Image",      "HDF5",    "HDF5Image", "HFA",  "ILWIS",    "ISG",     "ISIS2",    "ISIS3",
    "JP2OpenJPEG",    "JPEG",    "KRO",       "LCP",  "Leveller", "MEM",     "netCDF",   "NGSGEOID",
    "NWT_GRC",        "NWT_GRD", "PCIDSK",    "PDS",  "PDS4",     "PNG",     "RMF",      "ROI_PAC",
    "RRASTER",        "RST",     "S102",      "SAGA", "SDTS",     "SRTMHGT", "Terragen", "USGSDEM",
    "VICAR",          "VRT",     "WEBP",      "XYZ",  "Zarr",     "ZMap",    nullptr};

bool is_allowed(std::string_view name) {
  for (const char* const driver : kDrivers) {
    if (driver != nullptr && name == driver) return true;
  }
  return false;
}

bool begins_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

// Returns whether a name belongs to a virtual file system that does not use a network.
bool is_local_vsi(std::string_view name) {
  for (const std::string_view local :
       {"/vsizip/", "/vsigzip/", "/vsitar/", "/vsimem/", "/vsisubfile/", "/vsisparse/"}) {
    if (begins_with(name, local)) return true;
  }
  return false;
}

// Returns whether a text names a virtual file system that uses a network.
bool names_network(std::string_view text) {
  for (std::size_t at = text.find("/vsi"); at != std::string_view::npos; at = text.find("/vsi", at + 1)) {
    if (!is_local_vsi(text.substr(at))) return true;
  }
  return false;
}

// Returns whether a source names a part of a file, such as "NETCDF:file.nc:variable": it begins with the name of a
// driver and a colon, and there is no file with this name.
bool is_subdataset(const std::string& source) {
  const std::size_t colon = source.find(':');
  if (colon == std::string::npos || colon < 2) return false;
  for (const char c : source.substr(0, colon)) {
    if (std::isupper(static_cast<unsigned char>(c)) == 0 && std::isdigit(static_cast<unsigned char>(c)) == 0 &&
        c != '_')
      return false;
  }
  std::error_code ignored;
  return !std::filesystem::exists(source, ignored);
}

Result<void> check_path(const std::string& source) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(source, ignored);
  if (!std::filesystem::exists(status)) return elevation_error(source, "does not exist");
  if (std::filesystem::is_directory(status)) return elevation_error(source, "is a directory; expected a file");
  if (!std::filesystem::is_regular_file(status)) return elevation_error(source, "is not a regular file");
  if (std::filesystem::file_size(source, ignored) == 0) return elevation_error(source, "is empty");
  return {};
}

// Returns whether a file is a virtual raster, a text that refers to other files.
bool is_virtual_raster(const std::string& source) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(source, ignored)) return false;
  std::ifstream file(source, std::ios::binary);
  std::string text(64, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text.find("<VRTDataset") != std::string::npos;
}

// Refuses virtual rasters that refer to a network file system.
Result<void> check_references(const std::string& source) {
  constexpr std::size_t kMaxText = std::size_t{16} << 20;
  if (!is_virtual_raster(source)) return {};
  std::ifstream file(source, std::ios::binary);
  std::string text;
  text.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  if (text.size() > kMaxText)
    return elevation_error(source, "is a virtual raster of more than 16 MiB; expected a smaller one");
  if (!names_network(text)) return {};
  return elevation_error(
      source, "is a virtual raster that refers to a network file system; expected references to local files");
}

}  // namespace

// The network file systems of GDAL read this option before they connect.
constexpr const char* kAllowedNames = "CPL_VSIL_CURL_ALLOWED_FILENAME";

NetworkGuard::NetworkGuard(const std::string& source) : closed_(!names_network(source)) {
  if (closed_) CPLSetThreadLocalConfigOption(kAllowedNames, "none");
}

NetworkGuard::~NetworkGuard() {
  if (closed_) CPLSetThreadLocalConfigOption(kAllowedNames, nullptr);
}

void register_drivers() {
  GDALAllRegister();
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = manager.GetDriverCount() - 1; i >= 0; --i) {
    GDALDriver* const driver = manager.GetDriver(i);
    const bool raster = driver->GetMetadataItem(GDAL_DCAP_RASTER) != nullptr;
    if (!raster || is_allowed(driver->GetDescription())) continue;
    manager.DeregisterDriver(driver);
    delete driver;
  }
}

Result<Dataset> open_elevation(const std::string& source, const Messages& messages) {
  const bool virtual_name = begins_with(source, "/vsi");
  if (!virtual_name && !is_subdataset(source)) {
    if (Result<void> exists = check_path(source); !exists.ok()) return std::move(exists).error();
    if (Result<void> local = check_references(source); !local.ok()) return std::move(local).error();
  }
  register_drivers();
  Dataset file(static_cast<GDALDataset*>(GDALOpenEx(
      source.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, kDrivers.data(), nullptr, nullptr)));
  if (!file) return elevation_error(source, "has an unsupported format or is damaged" + messages.reason());
  if (file->GetRasterCount() < 1) {
    char** const inside = file->GetMetadata("SUBDATASETS");
    const char* const first = inside != nullptr ? CSLFetchNameValue(inside, "SUBDATASET_1_NAME") : nullptr;
    if (first != nullptr)
      return elevation_error(source,
                             std::string("contains several rasters; expected the name of one, such as ") + first);
    return elevation_error(source, "contains no raster; expected a file with one raster");
  }
  return file;
}

Result<void> check_samples(const std::string& source, GDALDataset& file) {
  // A minute of reading. A virtual raster of a few hundred bytes can declare 4e18 samples.
  constexpr double kMaxSamples = 1.0e10;
  const int width = file.GetRasterXSize();
  const int height = file.GetRasterYSize();
  const std::string size = "has " + std::to_string(width) + " x " + std::to_string(height) + " samples";
  if (width < 2 || height < 2) return elevation_error(source, size + ", at least 2 x 2 are needed");
  if (static_cast<double>(width) * height > kMaxSamples)
    return elevation_error(source, size + "; expected at most 10000 million: crop or reduce it with gdal_translate");
  if (GDALDataTypeIsComplex(file.GetRasterBand(1)->GetRasterDataType()) != 0)
    return elevation_error(source, "contains complex numbers; expected real elevations");
  return {};
}

bool elevation_files_supported() { return true; }

std::vector<std::string> elevation_file_list_here(const std::string& source) {
  const Messages messages;
  const NetworkGuard guard(source);
  std::vector<std::string> out;
  // Virtual rasters may refer to others, which list their own files only.
  std::vector<std::string> left = {source};
  constexpr std::size_t kMaxFiles = 10000;
  while (!left.empty() && out.size() < kMaxFiles) {
    const std::string name = std::move(left.back());
    left.pop_back();
    if (std::find(out.begin(), out.end(), name) != out.end()) continue;
    out.push_back(name);
    if (name != source && !is_virtual_raster(name)) continue;
    const Result<Dataset> file = open_elevation(name, messages);
    if (!file) continue;
    char** const files = file.value()->GetFileList();
    for (char** f = files; f != nullptr && *f != nullptr; ++f) left.emplace_back(*f);
    CSLDestroy(files);
  }
  return out;
}

}  // namespace tyndall::scene
