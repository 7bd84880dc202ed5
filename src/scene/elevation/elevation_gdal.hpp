// Private to src/scene/elevation: what the files that speak to GDAL share.
#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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

  // The failure in brackets, or nothing.
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

// While it lives, GDAL connects to nothing on this thread, unless `source` itself names a network file system. Files
// that a virtual raster refers to are opened only when samples are read: to be held until then.
class NetworkGuard {
 public:
  explicit NetworkGuard(const std::string& source);
  ~NetworkGuard();
  NetworkGuard(const NetworkGuard&) = delete;
  NetworkGuard& operator=(const NetworkGuard&) = delete;

 private:
  bool closed_;
};

// Opens a file for reading with one of the drivers that hold elevations and read local files. Also accepted are names
// of GDAL's own: /vsizip/FILE.zip/NAME, /vsicurl/URL, NETCDF:FILE:VARIABLE. Only a name that itself begins with a
// network file system (/vsicurl/ and the like) leads to network access: virtual rasters (VRT) that refer to one are
// refused. Call with a NetworkGuard.
[[nodiscard]] Result<Dataset> open_elevation(const std::string& source, const Messages& messages);

// Decodes tiles that hold heights in the colours of an 8-bit image, Terrarium or Terrain-RGB, to one band of metres; a
// note says which. Null for files that are no colour image; an error for pictures that hold no heights.
[[nodiscard]] Result<Dataset> decode_colours(const std::string& source, GDALDataset& file,
                                             std::vector<std::string>& notes);

// Returns a virtual raster over `file`, which must outlive it, that declares the sample that evidently stands for "no
// data" although the file does not say so: -9999 and its like, at least 500 units from every other sample. A note says
// which. Null when there is none.
[[nodiscard]] Dataset declare_no_data(GDALDataset& file, std::vector<std::string>& notes);

}  // namespace tyndall::scene
