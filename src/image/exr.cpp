// EXR files through OpenEXR's C++ interface. Its exceptions are converted to errors here.
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <vector>

#include "files/files.hpp"
#include "files/text.hpp"
#include "image/codec.hpp"
#include "image/exr_header.hpp"
#include "image/primaries.hpp"

namespace tyndall::image {
namespace {

constexpr int kRowsAtOnce = 64;

// A file in memory as an OpenEXR stream.
class BytesIn : public Imf::IStream {
 public:
  BytesIn(std::string_view bytes, const std::string& path) : Imf::IStream(path.c_str()), bytes_(bytes) {}

  // isMemoryMapped() must stay false. Otherwise OpenEXR reads beyond blocks that are shorter than the header requires.
  bool read(char target[], int size) override {
    std::memcpy(target, take(size), static_cast<std::size_t>(size));
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  const char* take(int size) {
    if (size < 0 || position_ > bytes_.size() || bytes_.size() - position_ < static_cast<std::size_t>(size)) {
      throw std::runtime_error("the file is cut off");
    }
    const char* const start = bytes_.data() + position_;
    position_ += static_cast<std::size_t>(size);
    return start;
  }

  std::string_view bytes_;
  std::size_t position_ = 0;
};

// Carries an error of the atomic file through OpenEXR as an exception.
struct FileFailure : std::runtime_error {
  explicit FileFailure(Error failed) : std::runtime_error(failed.message), error(std::move(failed)) {}
  Error error;
};

class BytesOut : public Imf::OStream {
 public:
  BytesOut(files::AtomicFile& file, const std::string& path) : Imf::OStream(path.c_str()), file_(file) {}

  void write(const char data[], int size) override {
    require(file_.write(data, static_cast<std::size_t>(size)));
    position_ += static_cast<std::uint64_t>(size);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override {
    if (position == position_) return;
    require(file_.seek(position));
    position_ = position;
  }
  // The first write error. OpenEXR's destructors write the offset table and swallow exceptions.
  [[nodiscard]] const Error* error() const { return failed_ ? &error_ : nullptr; }

 private:
  void require(Result<void> result) {
    if (result) return;
    failed_ = true;
    error_ = result.error();
    throw FileFailure(std::move(result).error());
  }

  files::AtomicFile& file_;
  std::uint64_t position_ = 0;
  bool failed_ = false;
  Error error_;
};

// The conversion of a file's channels to red, green and blue.
enum class Channels : std::uint32_t { rgb, grey, luminance_chroma };

Channels kind_of_channels(const Imf::ChannelList& channels) {
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  if (!has("R") && has("Y") && has("RY") && has("BY")) return Channels::luminance_chroma;
  if (!has("R") && has("Y")) {
    if (has("RY") || has("BY")) throw std::runtime_error("its chroma has only one of the channels RY and BY");
    return Channels::grey;
  }
  for (const char* const name : {"R", "G", "B"}) {
    const Imf::Channel* const channel = channels.findChannel(name);
    if (channel == nullptr) throw std::runtime_error("it has neither the channels R, G, B nor Y");
    if (channel->xSampling != 1 || channel->ySampling != 1) throw std::runtime_error("its channels are subsampled");
  }
  return Channels::rgb;
}

// Returns which parts of a file are ignored: channels that carry no colour, and primaries. Empty if there are none.
std::string ignored_parts(const Imf::Header& header, Channels kind) {
  std::string names;
  int count = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const std::string_view name = it.name();
    const bool read = kind == Channels::rgb    ? name == "R" || name == "G" || name == "B"
                      : kind == Channels::grey ? name == "Y"
                                               : name == "Y" || name == "RY" || name == "BY";
    if (read) continue;
    constexpr int kNamed = 4;
    if (count < kNamed) names.append(count > 0 ? ", " : "").append(name);
    ++count;
    if (count == kNamed + 1) names.append(", ...");
  }
  std::string out;
  if (count > 0)
    out = files::concat({count > 1 ? "its channels " : "its channel ", names, count > 1 ? " are" : " is", " ignored"});
  const Imf::Chromaticities rec709;
  if (Imf::hasChromaticities(header) && kind != Channels::grey) {
    const Imf::Chromaticities& own = Imf::chromaticities(header);
    constexpr float kSame = 1e-3F;
    const bool same =
        own.red.equalWithAbsError(rec709.red, kSame) && own.green.equalWithAbsError(rec709.green, kSame) &&
        own.blue.equalWithAbsError(rec709.blue, kSame) && own.white.equalWithAbsError(rec709.white, kSame);
    if (!same) out.append(out.empty() ? "" : "; ").append("its primaries are not those of Rec. 709, and are ignored");
  }
  return out;
}

Metadata string_attributes(const Imf::Header& header) {
  Metadata metadata;
  for (Imf::Header::ConstIterator it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text != nullptr) metadata.emplace_back(it.name(), text->value());
  }
  return metadata;
}

// Returns a slice for one channel of the rows stored at `rows`, which begin at row `top` of the data window.
template <typename T>
Imf::Slice slice(Imf::PixelType type, T* rows, const Imath::Box2i& window, int top, std::size_t stride) {
  const std::ptrdiff_t x_stride = static_cast<std::ptrdiff_t>(stride * sizeof(T));
  const std::ptrdiff_t width = std::ptrdiff_t{window.max.x} - window.min.x + 1;
  char* const base = reinterpret_cast<char*>(rows) - window.min.x * x_stride - top * width * x_stride;
  return {type, base, static_cast<std::size_t>(x_stride), static_cast<std::size_t>(width * x_stride)};
}

std::int64_t width_of(const Imath::Box2i& window) { return std::int64_t{window.max.x} - window.min.x + 1; }
std::int64_t height_of(const Imath::Box2i& window) { return std::int64_t{window.max.y} - window.min.y + 1; }

void check_window(const Imath::Box2i& window, std::int64_t max_pixels, const char* problem) {
  const bool fits = width_of(window) >= 1 && height_of(window) >= 1 && width_of(window) <= kLargestSide &&
                    height_of(window) <= kLargestSide && width_of(window) * height_of(window) <= max_pixels;
  if (!fits) throw std::runtime_error(problem);
}

// Appends the rows of the data window in blocks as the file is read, so that a false header allocates little.
void read_rows(Imf::InputFile& input, const Imath::Box2i& window, bool grey, Image& image) {
  for (int top = window.min.y; top <= window.max.y; top += kRowsAtOnce) {
    const int bottom = std::min(top + kRowsAtOnce - 1, window.max.y);
    const std::size_t start = image.rgb.size();
    image.rgb.resize(start + std::size_t{3} * image.width * static_cast<std::size_t>(bottom - top + 1));
    Imf::FrameBuffer target;
    for (std::size_t channel = 0; channel < (grey ? 1 : 3); ++channel) {
      const char* const name = grey ? "Y" : channel == 0 ? "R" : channel == 1 ? "G" : "B";
      target.insert(name, slice(Imf::FLOAT, image.rgb.data() + start + channel, window, top, 3));
    }
    input.setFrameBuffer(target);
    input.readPixels(top, bottom);
    for (std::size_t i = start; grey && i < image.rgb.size(); i += 3) {
      image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    }
  }
}

// Reads luminance and subsampled chroma, which OpenEXR converts to RGB in half precision.
void read_luminance_chroma(std::string_view bytes, const std::string& path, const Imath::Box2i& window, Image& image) {
  BytesIn stream(bytes, path);
  Imf::RgbaInputFile input(stream);
  for (const char* name : {"RY", "BY"}) {
    const Imf::Channel* const chroma = input.header().channels().findChannel(name);
    if (chroma != nullptr && (chroma->xSampling != 2 || chroma->ySampling != 2)) {
      throw std::runtime_error("its chroma is not stored for every second pixel and row, as OpenEXR reads it");
    }
  }
  const Imf::Channel* const luminance = input.header().channels().findChannel("Y");
  const bool whole = luminance != nullptr && luminance->type != Imf::HALF;
  const std::size_t width = image.width;
  std::vector<Imf::Rgba> row(width);
  for (int y = window.min.y; y <= window.max.y; ++y) {
    input.setFrameBuffer(
        row.data() - window.min.x - static_cast<std::ptrdiff_t>(y) * static_cast<std::ptrdiff_t>(width), 1, width);
    input.readPixels(y);
    for (const Imf::Rgba& pixel : row) {
      image.rgb.insert(image.rgb.end(), {pixel.r, pixel.g, pixel.b});
      if (whole && !(pixel.r.isFinite() && pixel.g.isFinite() && pixel.b.isFinite())) {
        throw std::runtime_error(
            "its luminance exceeds half precision, to which OpenEXR converts it, or is not finite");
      }
    }
  }
}

// Returns the number of images in a file. Only the first is read.
int number_of_parts(const Imf::InputFile& input, std::string_view bytes, const std::string& path) {
  if (!Imf::isMultiPart(input.version())) return 1;
  BytesIn stream(bytes, path);
  return Imf::MultiPartInputFile(stream).parts();
}

std::string window_text(const Imath::Box2i& window) {
  return files::concat({std::to_string(width_of(window)), "x", std::to_string(height_of(window)), " from ",
                        std::to_string(window.min.x), ",", std::to_string(window.min.y)});
}

// Returns the pixels of the display window. `data` holds those of the data window; pixels outside of it are black.
Image displayed(const Image& data, const Imath::Box2i& window, const Imath::Box2i& display) {
  Image out(static_cast<std::uint32_t>(width_of(display)), static_cast<std::uint32_t>(height_of(display)));
  const int left = std::max(window.min.x, display.min.x), right = std::min(window.max.x, display.max.x);
  const int top = std::max(window.min.y, display.min.y), bottom = std::min(window.max.y, display.max.y);
  for (int y = top; y <= bottom && left <= right; ++y) {
    const float* const from =
        data.pixel(static_cast<std::uint32_t>(left - window.min.x), static_cast<std::uint32_t>(y - window.min.y));
    std::copy_n(
        from, 3 * (static_cast<std::size_t>(right - left) + 1),
        out.pixel(static_cast<std::uint32_t>(left - display.min.x), static_cast<std::uint32_t>(y - display.min.y)));
  }
  return out;
}

File decode(std::string_view bytes, const std::string& path) {
  if (const std::string problem = exr_header_problem(bytes); !problem.empty()) throw std::runtime_error(problem);
  BytesIn stream(bytes, path);
  Imf::Header::setMaxImageSize(static_cast<int>(kLargestSide), static_cast<int>(kLargestSide));
  Imf::Header::setMaxTileSize(4096, 4096);
  Imf::InputFile input(stream);
  const int parts = number_of_parts(input, bytes, path);
  const Imath::Box2i window = input.header().dataWindow();
  const Imath::Box2i display = input.header().displayWindow();
  const Channels channels = kind_of_channels(input.header().channels());
  check_window(window, static_cast<std::int64_t>(kMaxPixels), "it is too large");

  File file;
  file.kind = FileKind::exr;
  file.metadata = string_attributes(input.header());
  file.note = ignored_parts(input.header(), channels);
  if (parts > 1) {
    if (!file.note.empty()) file.note.append("; ");
    file.note += files::concat({"of its ", std::to_string(parts), " parts only the first is read"});
  }
  file.image.width = static_cast<std::uint32_t>(width_of(window));
  file.image.height = static_cast<std::uint32_t>(height_of(window));
  if (channels == Channels::luminance_chroma) {
    read_luminance_chroma(bytes, path, window, file.image);
  } else {
    read_rows(input, window, channels == Channels::grey, file.image);
  }
  if (window != display) {
    // Pixels without data have a tighter limit.
    constexpr std::int64_t kMaxEmptyPixels = std::int64_t{1} << 25;
    check_window(display, std::max(kMaxEmptyPixels, width_of(window) * height_of(window)),
                 "its display window is too large");
    file.image = displayed(file.image, window, display);
    if (!file.note.empty()) file.note.append("; ");
    file.note += files::concat({"its data window is ", window_text(window), " and its display window ",
                                window_text(display), "; the display window is read, black where there are no data"});
  }
  return file;
}

Imf::Chromaticities attribute_of(Primaries primaries) {
  const Chromaticities& c = chromaticities_of(primaries);
  const auto point = [](const double(&xy)[2]) {
    return Imath::V2f(static_cast<float>(xy[0]), static_cast<float>(xy[1]));
  };
  return {point(c.red), point(c.green), point(c.blue), point(c.white)};
}

void encode(Imf::OStream& stream, const Image& image, const Metadata& metadata, const ExrOptions& options) {
  const Imf::PixelType type = options.precision == ExrPrecision::half16 ? Imf::HALF : Imf::FLOAT;
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, value] : metadata) header.insert(name.c_str(), Imf::StringAttribute(value));
  if (options.content != ExrContent::data) Imf::addChromaticities(header, attribute_of(options.primaries));
  if (options.white_luminance > 0.0) Imf::addWhiteLuminance(header, static_cast<float>(options.white_luminance));
  if (options.content == ExrContent::environment_map) Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  for (const char* const name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(type));
  const Imath::Box2i window = header.dataWindow();
  Imf::OutputFile output(stream, header);
  std::vector<half> halves;
  for (int top = 0; top <= window.max.y; top += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, window.max.y - top + 1);
    const std::size_t start = std::size_t{3} * image.width * static_cast<std::size_t>(top);
    const std::size_t count = std::size_t{3} * image.width * static_cast<std::size_t>(rows);
    if (type == Imf::HALF) halves.assign(image.rgb.data() + start, image.rgb.data() + start + count);
    Imf::FrameBuffer source;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const char* const name = channel == 0 ? "R" : channel == 1 ? "G" : "B";
      float* const floats = const_cast<float*>(image.rgb.data()) + start + channel;  // OpenEXR only reads
      source.insert(name, type == Imf::HALF ? slice(type, halves.data() + channel, window, top, 3)
                                            : slice(type, floats, window, top, 3));
    }
    output.setFrameBuffer(source);
    output.writePixels(rows);
  }
}

}  // namespace

bool exr_supported() { return true; }

Result<File> decode_exr(std::string_view bytes, const std::string& path) {
  try {
    return decode(bytes, path);
  } catch (const std::bad_alloc&) {
    return read_error(path, "EXR: not enough memory");
  } catch (const std::exception& exception) {
    return read_error(path, files::concat({"EXR: ", exception.what()}));
  }
}

Result<files::AtomicFile> prepare_exr(const std::string& path, const Image& image, const Metadata& metadata,
                                      const ExrOptions& options) {
  if (Result<void> fits = check_writable_image(path, image, metadata); !fits) return std::move(fits).error();
  if (options.precision == ExrPrecision::half16) {
    constexpr float kLargestHalf = 65504.0F;
    const auto too_large = [](float value) { return std::isfinite(value) && std::fabs(value) > kLargestHalf; };
    const auto first = std::find_if(image.rgb.begin(), image.rgb.end(), too_large);
    if (first != image.rgb.end()) {
      return write_error(ErrorCode::invalid_argument, path,
                         files::concat({"the value ", files::number_text(*first),
                                        " does not fit into 16 bits; expected at most 65504"}));
    }
  }
  Result<files::AtomicFile> file = files::AtomicFile::create(path);
  if (!file) return std::move(file).error();
  BytesOut stream(file.value(), path);
  try {
    encode(stream, image, metadata, options);
  } catch (const FileFailure& failure) {
    return failure.error;
  } catch (const std::bad_alloc&) {
    return write_error(ErrorCode::out_of_memory, path, "not enough memory");
  } catch (const std::exception& exception) {
    if (stream.error() != nullptr) return *stream.error();
    return write_error(ErrorCode::io, path, files::concat({"EXR: ", exception.what()}));
  }
  if (stream.error() != nullptr) return *stream.error();
  return file;
}

Result<void> write_exr(const std::string& path, const Image& image, const Metadata& metadata,
                       const ExrOptions& options) {
  Result<files::AtomicFile> file = prepare_exr(path, image, metadata, options);
  if (!file) return std::move(file).error();
  return file.value().commit();
}

}  // namespace tyndall::image
