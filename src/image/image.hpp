// Images in memory and on disk: EXR for linear radiance, PNG for pictures. Pixels are float RGB, row by row from the
// top left. Nothing here prints or throws; an error is one line that names the file. Files are written completely or
// not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "files/files.hpp"
#include "tyndall/result.hpp"

namespace tyndall::image {

constexpr std::uint32_t kLargestSide = 32768;                 // pixels, read or written
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;  // for reading; 3.2 GB in memory

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> rgb;  // 3 * width * height

  Image() = default;
  Image(std::uint32_t width_px, std::uint32_t height_px)
      : width(width_px), height(height_px), rgb(std::size_t{3} * width_px * height_px) {}

  // Returns the three components of a pixel. Precondition: x < width, y < height.
  [[nodiscard]] float* pixel(std::uint32_t x, std::uint32_t y) { return rgb.data() + 3 * (std::size_t{y} * width + x); }
  [[nodiscard]] const float* pixel(std::uint32_t x, std::uint32_t y) const {
    return rgb.data() + 3 * (std::size_t{y} * width + x);
  }
};

// Names and values in UTF-8, in order: string attributes of an EXR, text chunks of a PNG. Names have at most 79 ASCII
// characters, as PNG requires.
using Metadata = std::vector<std::pair<std::string, std::string>>;

enum class FileKind : std::uint32_t { png, exr };

// Returns whether the program was built with OpenEXR. Without it, no EXR can be read or written.
[[nodiscard]] bool exr_supported();
// Fails with invalid_argument if the program was built without OpenEXR. `path` is for the message.
[[nodiscard]] Result<void> check_exr_supported(const std::string& path);

// Returns the kind for a file name's extension (.png or .exr, in either case). Refuses .exr as check_exr_supported()
// does.
[[nodiscard]] Result<FileKind> kind_of_name(const std::string& path);

// The meaning of the values that are written to a PNG.
enum class Encoding : std::uint32_t {
  linear,  // linear light, 0 black to 1 white: the sRGB curve is applied
  srgb,    // already encoded, 0 to 1
};

struct PngOptions {
  Encoding encoding = Encoding::linear;
  // Adds noise of at most one 8-bit step, equal in every run, against banding in smooth skies. The mean over neighbours
  // is exact, and 0 and 1 stay exact. Without it, values are rounded to the nearest step.
  bool dither = true;
};

// Writes an 8-bit sRGB PNG with the metadata as text chunks. Values outside [0; 1] are clamped. Fails with
// invalid_argument if a value is not finite, because PNG cannot store it.
[[nodiscard]] Result<void> write_png(const std::string& path, const Image& image, const Metadata& metadata,
                                     const PngOptions& options = {});

enum class ExrPrecision : std::uint32_t { half16, float32 };

// The meaning of an EXR's channels, which decides the standard attributes of its header.
enum class ExrContent : std::uint32_t {
  data,            // numbers that are not colours: no attribute
  radiance,        // linear colours: `chromaticities`
  environment_map  // radiance by latitude and longitude: `chromaticities` and `envmap`
};

// The colour space of radiance; see primaries.hpp.
enum class Primaries : std::uint32_t { rec709, xyz, rec2020, acescg };

struct ExrOptions {
  ExrPrecision precision = ExrPrecision::float32;
  ExrContent content = ExrContent::data;
  Primaries primaries = Primaries::rec709;  // those of the image, which is not converted
  double white_luminance = 0.0;             // [cd/m^2] - of the colour (1, 1, 1), `whiteLuminance`; 0: not known
};

// Writes an EXR with channels R, G, B, ZIP compression and the metadata as string attributes. Values that are not
// finite are stored as they are (count_non_finite() finds them). Fails with invalid_argument if a finite value exceeds
// the range of half16 (65504).
[[nodiscard]] Result<void> write_exr(const std::string& path, const Image& image, const Metadata& metadata,
                                     const ExrOptions& options = {});
// Writes the file as write_exr() does, but leaves it to the caller to commit it, so that several files appear together.
[[nodiscard]] Result<files::AtomicFile> prepare_exr(const std::string& path, const Image& image,
                                                    const Metadata& metadata, const ExrOptions& options = {});

// The content of an image file.
struct File {
  FileKind kind = FileKind::png;  // by content, not by name
  Image image;                    // PNG: encoded values, scaled to [0; 1]; EXR: linear values
  Metadata metadata;              // PNG: text chunks; EXR: string attributes
  // A one-line remark on the pixels, empty for most files: transparency, a gamma, channels or primaries are ignored,
  // the data window of an EXR differs from its display window, or luminance and chroma were converted to RGB.
  std::string note;
};

// Reads a PNG (any depth and colour type; grey becomes RGB, transparency is dropped) or an EXR (scan lines or tiles;
// channels R, G, B of any type, Y alone as grey, or Y, RY and BY as luminance and chroma; the first of several parts).
// The image of an EXR is its display window. Pixels outside the data window are black, and data outside the display
// window is dropped.
// Errors: io for files that are missing, damaged, of another kind or larger than kMaxPixels; out_of_memory. The
// header's claims are checked against the file's length first, so that small files cannot use much memory.
[[nodiscard]] Result<File> read(const std::string& path);

// Returns the number of values that are NaN or infinite.
[[nodiscard]] std::size_t count_non_finite(const Image& image);

// Applies the sRGB transfer curve (IEC 61966-2-1): linear [0; 1] to encoded [0; 1].
[[nodiscard]] float srgb_from_linear(float linear);

// Returns the 8-bit value that write_png stores for an encoded value at a pixel and channel. Not for NaN.
[[nodiscard]] std::uint8_t quantize(float encoded, std::uint32_t x, std::uint32_t y, std::uint32_t channel,
                                    bool dither);

}  // namespace tyndall::image
