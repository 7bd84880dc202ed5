// PNG files through libpng. libpng reports errors by longjmp, so the functions that call it hold no objects with
// destructors; their callers own these.
#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <optional>

#include "files/files.hpp"
#include "files/text.hpp"
#include "image/codec.hpp"

namespace tyndall::image {
namespace {

constexpr std::size_t kMessageSize = 200;

// The first error that a libpng callback reports.
struct Problem {
  char message[kMessageSize] = "";
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  Problem* problem = static_cast<Problem*>(png_get_error_ptr(png));
  std::strncpy(problem->message, message, kMessageSize - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct PngReader {
  std::string_view bytes;
  std::size_t position = 0;
  Problem problem;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::uint32_t width = 0, height = 0;
  unsigned char* samples = nullptr;  // RGB, 8 or 16 bits in native byte order
  int depth = 8;
  bool transparent = false;
  double gamma = 0.0;            // exponent of the encoding if the file has one instead of the sRGB curve; otherwise 0
  bool other_primaries = false;  // cHRM differs from Rec. 709
  char profile[80] = "";         // name of the ICC profile
  std::array<unsigned char, 4> code_points = {};  // of cICP: primaries, transfer function, matrix, range
  bool has_code_points = false;
};

// Returns why the chunks of a PNG must be wrong, or an empty string. libpng would allocate the claimed size of a chunk
// before it notices the end of the file.
const char* chunk_problem(std::string_view bytes) {
  constexpr std::size_t kSignature = 8, kAround = 12;  // kAround: length, kind and checksum around a chunk's data
  if (bytes.size() < kSignature) return "the file is cut off";
  std::size_t at = kSignature;
  while (bytes.size() - at >= kAround) {
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8U | static_cast<unsigned char>(bytes[at + i]);
    if (length > bytes.size() - at - kAround) return "the file is cut off";
    if (bytes.substr(at + 4, 4) == "IEND") return "";
    at += kAround + length;
  }
  return "the file is cut off";
}

void on_read(png_structp png, png_bytep target, png_size_t size) {
  PngReader* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (reader->bytes.size() - reader->position < size) png_error(png, "the file is cut off");
  std::memcpy(target, reader->bytes.data() + reader->position, size);
  reader->position += size;
}

// Takes the chunk of code points of ITU-T H.273 in the third edition of PNG, which libpng 1.6 does not know.
int on_unknown_chunk(png_structp png, png_unknown_chunkp chunk) {
  if (std::memcmp(chunk->name, "cICP", 4) != 0 || chunk->size != 4) return 0;
  PngReader* reader = static_cast<PngReader*>(png_get_user_chunk_ptr(png));
  std::memcpy(reader->code_points.data(), chunk->data, 4);
  reader->has_code_points = true;
  return 1;
}

// Reads the chunks that describe another colour space than sRGB. The order of precedence is cICP, iCCP, sRGB, and cHRM
// with gAMA (PNG, third edition, section 4.3).
void read_color_space(PngReader* reader) {
  if (png_get_valid(reader->png, reader->info, PNG_INFO_sRGB) != 0) return;
  png_charp name = nullptr;
  png_bytep profile = nullptr;
  png_uint_32 size = 0;
  int compression = 0;
  if (png_get_iCCP(reader->png, reader->info, &name, &compression, &profile, &size) != 0) {
    std::strncpy(reader->profile, name, sizeof(reader->profile) - 1);
    return;
  }
  png_get_gAMA(reader->png, reader->info, &reader->gamma);
  double own[8] = {};
  if (png_get_cHRM(reader->png, reader->info, &own[0], &own[1], &own[2], &own[3], &own[4], &own[5], &own[6], &own[7]) ==
      0)
    return;
  constexpr double kRec709[8] = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};  // white, red, green, blue
  constexpr double kSame = 2e-3;
  for (int i = 0; i < 8; ++i)
    reader->other_primaries = reader->other_primaries || std::abs(own[i] - kRec709[i]) > kSame;
}

bool read_samples(PngReader* reader) {
  if (setjmp(png_jmpbuf(reader->png)) != 0) return false;
  png_set_read_fn(reader->png, reader, on_read);
  png_set_user_limits(reader->png, kLargestSide, kLargestSide);
  constexpr png_alloc_size_t kMaxChunk = 8U << 20U;  // bytes of one decompressed text chunk or profile
  png_set_chunk_malloc_max(reader->png, kMaxChunk);
  png_set_read_user_chunk_fn(reader->png, reader, on_unknown_chunk);
  png_read_info(reader->png, reader->info);
  reader->width = png_get_image_width(reader->png, reader->info);
  reader->height = png_get_image_height(reader->png, reader->info);
  reader->transparent = (png_get_color_type(reader->png, reader->info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                        png_get_valid(reader->png, reader->info, PNG_INFO_tRNS) != 0;
  read_color_space(reader);
  png_set_expand(reader->png);
  png_set_gray_to_rgb(reader->png);
  png_set_strip_alpha(reader->png);
  const std::uint16_t probe = 1;
  unsigned char low = 0;
  std::memcpy(&low, &probe, 1);
  if (low == 1) png_set_swap(reader->png);
  const int passes = png_set_interlace_handling(reader->png);
  png_read_update_info(reader->png, reader->info);
  reader->depth = png_get_bit_depth(reader->png, reader->info);
  const std::size_t row_size = png_get_rowbytes(reader->png, reader->info);
  if (row_size != std::size_t{3} * reader->width * static_cast<std::size_t>(reader->depth) / 8) {
    png_error(reader->png, "its pixels have an unknown layout");
  }
  // Deflate expands by at most a factor of 1032.
  constexpr std::size_t kMaxRatio = 1032;
  if (reader->height > reader->bytes.size() * kMaxRatio / row_size + 1) png_error(reader->png, "the file is cut off");
  if (std::uint64_t{reader->width} * reader->height > kMaxPixels) png_error(reader->png, "it is too large");
  // Zeroed pages use no memory until data arrives.
  reader->samples = static_cast<unsigned char*>(std::calloc(reader->height, row_size));
  if (reader->samples == nullptr) png_error(reader->png, "not enough memory");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::uint32_t y = 0; y < reader->height; ++y) {
      png_read_row(reader->png, reader->samples + y * row_size, nullptr);
    }
  }
  png_read_end(reader->png, reader->info);
  return true;
}

// Returns which properties of a file are ignored, or an empty string.
std::string ignored_parts(const PngReader& reader) {
  std::string out;
  const auto add = [&out](std::string_view part) { out.append(out.empty() ? "" : "; ").append(part); };
  if (reader.transparent) add("its transparency is ignored");
  const std::string profile = files::one_line(reader.profile);
  if (reader.has_code_points) {
    // Primaries of Rec. 709, the curve of sRGB, RGB, full range.
    const std::array<unsigned char, 4>& own = reader.code_points;
    if (own != std::array<unsigned char, 4>{1, 13, 0, 1})
      add(files::concat({"its colour space (cICP ", std::to_string(own[0]), ", ", std::to_string(own[1]), ", ",
                         std::to_string(own[2]), ", ", std::to_string(own[3]), ") is ignored, and sRGB is assumed"}));
  } else if (!profile.empty()) {
    if (files::lower_case(profile).find("srgb") == std::string::npos)
      add(files::concat({"its colour profile '", profile, "' is ignored, and sRGB is assumed"}));
  } else {
    constexpr double kCloseToSrgb = 0.01;
    if (reader.other_primaries) add("its primaries are not those of sRGB, and are ignored");
    if (reader.gamma > 0.0 && std::abs(reader.gamma - 1.0 / 2.2) > kCloseToSrgb)
      add("its gamma is ignored, and the sRGB curve is assumed");
  }
  return out;
}

Metadata text_chunks(const PngReader& reader) {
  Metadata metadata;
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
  for (int i = 0; i < count; ++i) {
    const char* const value = texts[i].text;
    metadata.emplace_back(texts[i].key, value == nullptr ? "" : value);
  }
  return metadata;
}

struct Writer {
  files::AtomicFile* file = nullptr;
  const Image* image = nullptr;
  PngOptions options;
  Problem problem;
  bool file_failed = false;
  Error file_error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  png_textp texts = nullptr;
  int text_count = 0;
  unsigned char* row = nullptr;
};

// Separate from on_write, so that no object is alive where libpng jumps.
bool write_bytes(Writer* writer, const unsigned char* data, std::size_t size) {
  Result<void> result = writer->file->write(data, size);
  writer->file_failed = !result;
  if (!result) writer->file_error = std::move(result).error();
  return !writer->file_failed;
}

void on_write(png_structp png, png_bytep data, png_size_t size) {
  if (!write_bytes(static_cast<Writer*>(png_get_io_ptr(png)), data, size)) png_error(png, "write failed");
}

void on_flush(png_structp) {}

void quantize_row(const Writer& writer, std::uint32_t y) {
  const bool linear = writer.options.encoding == Encoding::linear;
  for (std::uint32_t x = 0; x < writer.image->width; ++x) {
    const float* const value = writer.image->pixel(x, y);
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
      const float encoded = linear ? srgb_from_linear(value[channel]) : value[channel];
      writer.row[3 * std::size_t{x} + channel] = quantize(encoded, x, y, channel, writer.options.dither);
    }
  }
}

bool write_samples(Writer* writer) {
  if (setjmp(png_jmpbuf(writer->png)) != 0) return false;
  png_set_write_fn(writer->png, writer, on_write, on_flush);
  png_set_user_limits(writer->png, kLargestSide, kLargestSide);
  png_set_IHDR(writer->png, writer->info, writer->image->width, writer->image->height, 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(writer->png, writer->info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (writer->text_count > 0) png_set_text(writer->png, writer->info, writer->texts, writer->text_count);
  png_write_info(writer->png, writer->info);
  for (std::uint32_t y = 0; y < writer->image->height; ++y) {
    quantize_row(*writer, y);
    png_write_row(writer->png, writer->row);
  }
  png_write_end(writer->png, nullptr);
  return true;
}

// Returns tEXt for ASCII values and iTXt (UTF-8) for others. libpng copies the strings.
std::vector<png_text> png_texts(const Metadata& metadata) {
  std::vector<png_text> texts;
  for (const auto& [name, value] : metadata) {
    bool ascii = true;
    for (const char c : value) ascii = ascii && static_cast<unsigned char>(c) < 0x80U;
    png_text text{};
    text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(name.c_str());
    text.text = const_cast<char*>(value.c_str());
    (ascii ? text.text_length : text.itxt_length) = value.size();
    texts.push_back(text);
  }
  return texts;
}

}  // namespace

Result<File> decode_png(std::string_view bytes, const std::string& path) {
  if (const char* const problem = chunk_problem(bytes); *problem != '\0') {
    return read_error(path, files::concat({"PNG: ", problem}));
  }
  PngReader reader;
  reader.bytes = bytes;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader.problem, on_error, on_warning);
  reader.info = reader.png == nullptr ? nullptr : png_create_info_struct(reader.png);
  const bool done = reader.info != nullptr && read_samples(&reader);
  const std::unique_ptr<unsigned char, void (*)(void*)> samples(reader.samples, std::free);
  std::optional<File> file;
  try {
    if (done) {
      file.emplace();
      file->kind = FileKind::png;
      file->image = Image(reader.width, reader.height);
      file->metadata = text_chunks(reader);
      file->note = ignored_parts(reader);
    }
  } catch (const std::bad_alloc&) {
    file.reset();
    std::strcpy(reader.problem.message, "not enough memory");
  }
  png_destroy_read_struct(&reader.png, &reader.info, nullptr);
  if (!file) return read_error(path, files::concat({"PNG: ", reader.problem.message}));
  for (std::size_t i = 0; i < file->image.rgb.size(); ++i) {
    if (reader.depth == 16) {
      std::uint16_t value = 0;
      std::memcpy(&value, samples.get() + 2 * i, sizeof(value));
      file->image.rgb[i] = static_cast<float>(value) / 65535.0F;
    } else {
      file->image.rgb[i] = static_cast<float>(samples.get()[i]) / 255.0F;
    }
  }
  return std::move(*file);
}

Result<void> write_png(const std::string& path, const Image& image, const Metadata& metadata,
                       const PngOptions& options) {
  if (Result<void> fits = check_writable_image(path, image, metadata); !fits) return fits;
  if (const std::size_t bad = count_non_finite(image); bad > 0) {
    std::size_t first = 0;
    while (std::isfinite(image.rgb[first])) ++first;
    const std::size_t pixel = first / 3;
    return write_error(ErrorCode::invalid_argument, path,
                       files::concat({std::to_string(bad), " values are not finite, the first at pixel ",
                                      std::to_string(pixel % image.width), ",", std::to_string(pixel / image.width),
                                      "; expected finite values, or an EXR file"}));
  }
  Result<files::AtomicFile> file = files::AtomicFile::create(path);
  if (!file) return std::move(file).error();
  std::vector<png_text> texts = png_texts(metadata);
  std::vector<unsigned char> row(std::size_t{3} * image.width);
  Writer writer;
  writer.file = &file.value();
  writer.image = &image;
  writer.options = options;
  writer.texts = texts.data();
  writer.text_count = static_cast<int>(texts.size());
  writer.row = row.data();
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer.problem, on_error, on_warning);
  writer.info = writer.png == nullptr ? nullptr : png_create_info_struct(writer.png);
  const bool done = writer.info != nullptr && write_samples(&writer);
  png_destroy_write_struct(&writer.png, &writer.info);
  if (!done && writer.file_failed) return writer.file_error;
  if (!done) return write_error(ErrorCode::out_of_memory, path, files::concat({"PNG: ", writer.problem.message}));
  return file.value().commit();
}

}  // namespace tyndall::image
