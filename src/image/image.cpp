// Code that PNG and EXR files share: choice of the kind, checks, quantisation.
#include "image/image.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>

#include "files/files.hpp"
#include "files/text.hpp"
#include "image/codec.hpp"

namespace tyndall::image {
namespace {

// The size of a 32768 x 16384 EXR in float RGB without compression, in bytes.
constexpr std::uint64_t kLargestFile = std::uint64_t{6} << 30U;
constexpr std::size_t kLongestName = 79;

bool ends_with_ignoring_case(const std::string& text, std::string_view ending) {
  if (text.size() < ending.size()) return false;
  return std::equal(ending.begin(), ending.end(), text.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

std::string shown(const std::string& path) { return files::concat({"'", files::one_line(path, 200), "'"}); }

// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", SIGGRAPH
// 2014): uniform in [0, 1), and evenly distributed over every 3 x 3 neighbourhood.
double gradient_noise(std::uint32_t x, std::uint32_t y) {
  const double phase = 0.06711056 * x + 0.00583715 * y;
  const double value = 52.9829189 * (phase - std::floor(phase));
  return value - std::floor(value);
}

}  // namespace

Error read_error(const std::string& path, std::string_view why) {
  return Error{ErrorCode::io, files::concat({shown(path), ": cannot read: ", files::one_line(why, 300),
                                             "; expected a complete PNG or EXR"})};
}

Error write_error(ErrorCode code, const std::string& path, std::string_view why) {
  return Error{code, files::concat({shown(path), ": cannot write: ", files::one_line(why, 300)})};
}

Result<void> check_exr_supported(const std::string& path) {
  if (exr_supported()) return {};
  return Error{ErrorCode::invalid_argument,
               files::concat({shown(path), ": built without OpenEXR; EXR files cannot be read or written; expected a ",
                              "program built with OpenEXR"})};
}

Result<FileKind> kind_of_name(const std::string& path) {
  if (ends_with_ignoring_case(path, ".png")) return FileKind::png;
  if (ends_with_ignoring_case(path, ".exr")) {
    if (Result<void> supported = check_exr_supported(path); !supported) return supported.error();
    return FileKind::exr;
  }
  return Error{ErrorCode::invalid_argument,
               files::concat({shown(path), ": unknown image format; expected a name that ends in .png or .exr"})};
}

Result<void> check_writable_image(const std::string& path, const Image& image, const Metadata& metadata) {
  const bool side_fits =
      image.width > 0 && image.height > 0 && image.width <= kLargestSide && image.height <= kLargestSide;
  if (!side_fits || image.rgb.size() != std::size_t{3} * image.width * image.height) {
    return write_error(
        ErrorCode::invalid_argument, path,
        files::concat({"the image is ", std::to_string(image.width), "x", std::to_string(image.height),
                       "; expected 1x1 to ", std::to_string(kLargestSide), "x", std::to_string(kLargestSide)}));
  }
  for (const auto& [name, value] : metadata) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (!plain || name.empty() || name.size() > kLongestName || !files::is_utf8(value) ||
        value.find('\0') != std::string::npos) {
      return write_error(ErrorCode::invalid_argument, path,
                         files::concat({"metadata '", files::one_line(name), "' is invalid; expected names of 1 to 79 ",
                                        "characters of ASCII and values in UTF-8"}));
    }
  }
  return {};
}

Result<File> read(const std::string& path) {
  constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";
  constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";
  try {
    Result<std::string> bytes = files::read_file(path, kLargestFile);
    if (!bytes) return std::move(bytes).error();
    if (bytes.value().starts_with(kPngMagic)) return decode_png(bytes.value(), path);
    if (bytes.value().starts_with(kExrMagic)) return decode_exr(bytes.value(), path);
    return read_error(path, bytes.value().empty() ? "it is empty" : "it is neither PNG nor EXR");
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, files::concat({shown(path), ": cannot read: not enough memory"})};
  }
}

std::size_t count_non_finite(const Image& image) {
  return static_cast<std::size_t>(
      std::count_if(image.rgb.begin(), image.rgb.end(), [](float value) { return !std::isfinite(value); }));
}

float srgb_from_linear(float linear) {
  if (linear <= 0.0031308F) return 12.92F * linear;
  return 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

std::uint8_t quantize(float encoded, std::uint32_t x, std::uint32_t y, std::uint32_t channel, bool dither) {
  const double steps = 255.0 * std::clamp(static_cast<double>(encoded), 0.0, 1.0);
  double noise = 0.0;
  if (dither) {
    // The channels use distant parts of the pattern, so that the noise is not grey.
    const double uniform = gradient_noise(x + 5113 * channel, y + 3571 * channel);
    // Triangular noise two steps wide makes mean and variance independent of the value. Within half a step of black and
    // white it would be clipped; noise one step wide still has the exact mean there.
    const bool near_end = steps < 0.5 || steps > 254.5;
    const double triangular = uniform < 0.5 ? std::sqrt(2.0 * uniform) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * uniform);
    noise = near_end ? uniform - 0.5 : triangular;
  }
  return static_cast<std::uint8_t>(std::clamp(std::floor(steps + noise + 0.5), 0.0, 255.0));
}

}  // namespace tyndall::image
