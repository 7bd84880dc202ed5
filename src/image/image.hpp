// Images in memory and on disk: EXR for linear radiance, PNG for pictures.
// Pixels are float RGB, row by row from the top left. Nothing here prints or throws; errors are one
// line that names the file. Files are written whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::image {

constexpr std::uint32_t kLargestSide = 32768;                 // pixels, read or written
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;  // read; 3.2 GB in memory

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> rgb;  // 3 * width * height

  Image() = default;
  Image(std::uint32_t width_px, std::uint32_t height_px)
      : width(width_px), height(height_px), rgb(std::size_t{3} * width_px * height_px) {}

  // The three components of a pixel. Precondition: x < width, y < height.
  [[nodiscard]] float* pixel(std::uint32_t x, std::uint32_t y) { return rgb.data() + 3 * (std::size_t{y} * width + x); }
  [[nodiscard]] const float* pixel(std::uint32_t x, std::uint32_t y) const {
    return rgb.data() + 3 * (std::size_t{y} * width + x);
  }
};

// Names and values in UTF-8, in order: string attributes of an EXR, text chunks of a PNG. Names are at
// most 79 characters of ASCII (what PNG allows).
using Metadata = std::vector<std::pair<std::string, std::string>>;

enum class FileKind : std::uint32_t { png, exr };

// The kind that a file name asks for by its ending (.png, .exr, in either case).
[[nodiscard]] Result<FileKind> kind_of_name(const std::string& path);

// What the values of a picture are that goes into a PNG.
enum class Encoding : std::uint32_t {
  linear,  // linear light, 0 black to 1 white: the sRGB curve is applied
  srgb,    // already encoded, 0 to 1
};

struct PngOptions {
  Encoding encoding = Encoding::linear;
  // Noise of at most one step of 8 bits, the same in every run, so that smooth skies do not band. The
  // mean over neighbours is the exact value; 0 and 1 stay exact. Off: rounded to the nearest step.
  bool dither = true;
};

// 8-bit sRGB PNG with the metadata as text chunks. Values beyond 0..1 are clamped.
// Fails (invalid_argument) when a value is not finite: there is no way to store it.
[[nodiscard]] Result<void> write_png(const std::string& path, const Image& image, const Metadata& metadata,
                                     const PngOptions& options = {});

enum class ExrPrecision : std::uint32_t { half16, float32 };

// What the channels of an EXR hold, which its header then says by OpenEXR's standard attributes.
enum class ExrContent : std::uint32_t {
  data,            // numbers that are no colours: no attribute
  radiance,        // to be shown as linear Rec. 709: `chromaticities`
  environment_map  // radiance by latitude and longitude: `chromaticities` and `envmap`
};

struct ExrOptions {
  ExrPrecision precision = ExrPrecision::float32;
  ExrContent content = ExrContent::data;
};

// EXR with channels R, G, B, ZIP compression and the metadata as string attributes. Values that are not
// finite are stored as they are (count_non_finite() finds them). Fails (invalid_argument) when a finite
// value is beyond what half16 holds (65504).
[[nodiscard]] Result<void> write_exr(const std::string& path, const Image& image, const Metadata& metadata,
                                     const ExrOptions& options = {});

// An image file as read.
struct File {
  FileKind kind = FileKind::png;  // by content, not by name
  Image image;                    // PNG: its own encoded values, scaled to 0..1; EXR: linear values
  Metadata metadata;              // PNG: text chunks; EXR: string attributes
  // What the reader should know of the pixels, one line, empty for most files: an EXR whose data window is not its
  // display window, luminance and chroma made to RGB.
  std::string note;
};

// Reads a PNG (any depth and colour type; grey becomes RGB, transparency is dropped) or an EXR (scan
// lines or tiles; channels R, G, B of any type, Y alone as grey, or Y, RY and BY as luminance and chroma; of several
// parts the first). The image of an EXR is its display window: black where the data window has no pixels, without
// what lies outside.
// Errors: io for what is missing, damaged, of another kind or larger than kMaxPixels; out_of_memory. What the header
// of a file claims is checked against its length first, so that small files cost little memory.
[[nodiscard]] Result<File> read(const std::string& path);

// How many values are NaN or infinite.
[[nodiscard]] std::size_t count_non_finite(const Image& image);

// sRGB transfer curve (IEC 61966-2-1): linear 0..1 to encoded 0..1.
[[nodiscard]] float srgb_from_linear(float linear);

// The 8-bit step for an encoded value at a pixel and channel: what write_png stores. Not for NaN.
[[nodiscard]] std::uint8_t quantize(float encoded, std::uint32_t x, std::uint32_t y, std::uint32_t channel,
                                    bool dither);

}  // namespace tyndall::image
