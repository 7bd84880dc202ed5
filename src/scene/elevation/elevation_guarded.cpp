// The public functions: GDAL reads in a child process, which sends the result as bytes.
#include <cstring>
#include <mutex>
#include <type_traits>

#include "scene/elevation/elevation_child.hpp"
#include "scene/elevation/elevation_file.hpp"
#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

// Held while a child is started and runs. If another thread were inside of GDAL during the fork, the child would
// inherit its locks and wait for them forever.
std::mutex& gdal_mutex() {
  static std::mutex mutex;
  return mutex;
}

class Writer {
 public:
  template <typename T>
  void number(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&value, sizeof value);
  }
  void text(const std::string& value) {
    number(value.size());
    raw(value.data(), value.size());
  }
  void raw(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads what a Writer has written. After the end, everything is zero or empty and good() is false.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  template <typename T>
  T number() {
    T value = {};
    raw(&value, sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<std::size_t>();
    if (size > rest_.size()) good_ = false;
    std::string out(good_ ? size : 0, '\0');
    raw(out.data(), out.size());
    return out;
  }
  void raw(void* data, std::size_t size) {
    good_ = good_ && size <= rest_.size();
    if (!good_ || size == 0) return;
    std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  bool good_ = true;
};

std::string written(const Result<ElevationRaster>& result) {
  Writer out;
  out.number(result.ok());
  if (!result.ok()) {
    out.number(result.error().code);
    out.text(result.error().message);
    return out.take();
  }
  const ElevationRaster& raster = result.value();
  out.number(raster.width);
  out.number(raster.height);
  out.number(raster.spacing_m);
  out.number(raster.min_m);
  out.number(raster.max_m);
  out.number(raster.centre.has_value());
  out.number(raster.centre.value_or(Place()));
  out.number(raster.notes.size());
  for (const std::string& note : raster.notes) out.text(note);
  out.raw(raster.heights.data(), sizeof(float) * raster.heights.size());
  return out.take();
}

Result<ElevationRaster> read_back(const std::string& source, std::string_view bytes) {
  Reader in(bytes);
  if (!in.number<bool>()) {
    const auto code = in.number<ErrorCode>();
    return Error{code, in.text(), 0};
  }
  ElevationRaster raster;
  raster.width = in.number<int>();
  raster.height = in.number<int>();
  raster.spacing_m = in.number<double>();
  raster.min_m = in.number<float>();
  raster.max_m = in.number<float>();
  const bool placed = in.number<bool>();
  const auto centre = in.number<Place>();
  if (placed) raster.centre = centre;
  for (auto count = in.number<std::size_t>(); count > 0 && in.good(); --count) raster.notes.push_back(in.text());
  const std::size_t samples = static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
  if (!in.good() || in.left() != sizeof(float) * samples) return elevation_error(source, "cannot be read");
  raster.heights.resize(samples);
  in.raw(raster.heights.data(), sizeof(float) * samples);
  return raster;
}

}  // namespace

Result<ElevationRaster> read_elevation_file(const std::string& source, const ElevationRequest& request) {
  Result<std::string> bytes = [&] {
    const std::lock_guard<std::mutex> lock(gdal_mutex());
    register_drivers();  // once in this process, instead of in each child
    return in_child(source, [&] { return written(read_elevation_here(source, request)); });
  }();
  if (!bytes.ok()) return std::move(bytes).error();
  return read_back(source, bytes.value());
}

std::vector<std::string> elevation_file_list(const std::string& source) {
  const Result<std::string> bytes = [&] {
    const std::lock_guard<std::mutex> lock(gdal_mutex());
    register_drivers();
    return in_child(source, [&] {
      Writer out;
      for (const std::string& file : elevation_file_list_here(source)) out.text(file);
      return out.take();
    });
  }();
  if (!bytes.ok()) return {source};
  std::vector<std::string> out;
  for (Reader in(bytes.value()); in.left() > 0 && in.good();) out.push_back(in.text());
  return out;
}

}  // namespace tyndall::scene
