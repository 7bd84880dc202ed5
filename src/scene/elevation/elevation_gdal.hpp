// Private to src/scene/elevation: declarations shared by the files that use GDAL.
#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/elevation/elevation_file.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(GDALDataset::ToHandle(dataset)); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

// Captures GDAL's messages on this thread during its lifetime: nothing goes to stderr, and the first failure is stored.
class Messages {
 public:
  Messages() { CPLPushErrorHandlerEx(&Messages::take, this); }
  ~Messages() { CPLPopErrorHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  // Returns the failure in parentheses, or an empty string.
  [[nodiscard]] std::string reason() const { return first_.empty() ? "" : " (" + first_ + ")"; }

 private:
  static void CPL_STDCALL take(CPLErr level, CPLErrorNum, const char* text) {
    auto* self = static_cast<Messages*>(CPLGetErrorHandlerUserData());
    if (level < CE_Failure || !self->first_.empty()) return;
    self->first_ = text;
    std::replace_if(
        self->first_.begin(), self->first_.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    while (!self->first_.empty() && (self->first_.back() == ' ' || self->first_.back() == '.')) self->first_.pop_back();
  }

  std::string first_;
};

inline Error elevation_error(std::string_view source, std::string_view what) {
  return Error{ErrorCode::io, "elevation file " + std::string(source) + " " + std::string(what), 0};
}

// During its lifetime, GDAL opens no network connections on this thread, unless `source` itself names a network file
// system. It must live until the samples have been read, because virtual rasters open their sources only then.
class NetworkGuard {
 public:
  explicit NetworkGuard(const std::string& source);
  ~NetworkGuard();
  NetworkGuard(const NetworkGuard&) = delete;
  NetworkGuard& operator=(const NetworkGuard&) = delete;

 private:
  bool closed_;
};

// Registers the allowed drivers, and removes all others from the process, because a virtual raster opens its sources
// with any registered driver.
void register_drivers();

// The functions of elevation_file.hpp, in this process, in which a damaged file may crash some drivers.
[[nodiscard]] Result<ElevationRaster> read_elevation_here(const std::string& source,
                                                          const ElevationRequest& request = {});
[[nodiscard]] std::vector<std::string> elevation_file_list_here(const std::string& source);

// Opens a file for reading with one of the drivers for local elevation files. Names of GDAL are also accepted:
// /vsizip/FILE.zip/NAME, /vsicurl/URL, NETCDF:FILE:VARIABLE. The network is only used if the name itself begins with a
// network file system such as /vsicurl/; virtual rasters (VRT) that refer to one are refused. Requires a NetworkGuard.
[[nodiscard]] Result<Dataset> open_elevation(const std::string& source, const Messages& messages);

// Returns an error for files with too few or too many samples, and for samples that are complex numbers.
[[nodiscard]] Result<void> check_samples(const std::string& source, GDALDataset& file);

// Decodes tiles with heights in the colours of an 8-bit image (Terrarium or Terrain-RGB) to one band in metres, and
// adds a note with the encoding. Returns null for files that are not colour images, and an error for pictures without
// heights.
[[nodiscard]] Result<Dataset> decode_colours(const std::string& source, GDALDataset& file,
                                             std::vector<std::string>& notes);

// Returns the metres per unit of the heights: of the band, of its coordinate system, or of a projection file beside the
// data set `stored`, from which `read` may be derived. Adds a note about unknown units, which are taken as metres.
[[nodiscard]] double height_unit_m(GDALDataset& stored, GDALDataset& read, std::vector<std::string>& notes);

// Returns a virtual raster over `file` that declares an undeclared "no data" value: -9999 or a similar value that is at
// least 500 units from every other sample. Adds a note with the value. Returns null if there is none. `file` must
// outlive the result.
[[nodiscard]] Dataset declare_no_data(GDALDataset& file, std::vector<std::string>& notes);

}  // namespace tyndall::scene
