#include "image/exr_header.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall::image {
namespace {

constexpr const char* kCutOff = "the file is cut off";

// Reads little-endian values and zero-terminated names in sequence.
class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : rest_(bytes) {}

  std::optional<std::string_view> name() {
    constexpr std::size_t kLongest = 255;
    const std::size_t end = rest_.substr(0, kLongest + 1).find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return found;
  }
  std::optional<std::uint32_t> word() {
    if (rest_.size() < 4) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<unsigned char>(rest_[i]);
    rest_.remove_prefix(4);
    return value;
  }
  std::optional<std::string_view> take(std::size_t size) {
    if (rest_.size() < size) return std::nullopt;
    const std::string_view found = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return found;
  }

  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// The attributes of one part that determine into how many pieces its pixels are divided.
struct Layout {
  std::int64_t width = 0, height = 0;
  std::uint8_t compression = 0;
  std::int64_t pixel_bytes = 0;                  // of all channels; 0: some are subsampled
  std::int64_t tile_width = 0, tile_height = 0;  // 0: scan lines
};

// Returns the bytes of all channels of a pixel, or 0 if there are none, unknown ones or subsampled ones.
std::int64_t bytes_of_pixel(std::string_view channels) {
  HeaderReader reader(channels);
  std::int64_t bytes = 0;
  for (;;) {
    const std::optional<std::string_view> name = reader.name();
    if (!name) return 0;
    if (name->empty()) return bytes;
    const std::optional<std::uint32_t> type = reader.word(), linear = reader.word();
    const std::optional<std::uint32_t> x = reader.word(), y = reader.word();
    if (!type || !linear || !x || !y || *type > 2 || *x != 1 || *y != 1) return 0;
    constexpr std::uint32_t kHalf = 1;
    bytes += *type == kHalf ? 2 : 4;
  }
}

// Returns whether the values of a type of attribute have this size. OpenEXR ignores the size that a file claims for
// types of fixed size, and would read what follows as other attributes, such as a text of 2 GB.
bool has_size_of_type(std::string_view type, std::uint32_t size) {
  struct Fixed {
    std::string_view type;
    std::uint32_t size;
  };
  constexpr Fixed kFixed[] = {{"box2f", 16},
                              {"box2i", 16},
                              {"chromaticities", 32},
                              {"compression", 1},
                              {"deepImageState", 1},
                              {"double", 8},
                              {"envmap", 1},
                              {"float", 4},
                              {"int", 4},
                              {"keycode", 28},
                              {"lineOrder", 1},
                              {"m33d", 72},
                              {"m33f", 36},
                              {"m44d", 128},
                              {"m44f", 64},
                              {"rational", 8},
                              {"tiledesc", 9},
                              {"timecode", 8},
                              {"v2d", 16},
                              {"v2f", 8},
                              {"v2i", 8},
                              {"v3d", 24},
                              {"v3f", 12},
                              {"v3i", 12}};
  const Fixed* const found =
      std::find_if(std::begin(kFixed), std::end(kFixed), [&](const Fixed& fixed) { return fixed.type == type; });
  return found == std::end(kFixed) || found->size == size;
}

void read_attribute(Layout& layout, std::string_view name, std::string_view value) {
  HeaderReader reader(value);
  const auto signed_word = [&] { return std::int64_t{static_cast<std::int32_t>(reader.word().value_or(0))}; };
  if (name == "channels") layout.pixel_bytes = bytes_of_pixel(value);
  if (name == "dataWindow" && value.size() == 16) {
    const std::int64_t left = signed_word(), top = signed_word(), right = signed_word(), bottom = signed_word();
    layout.width = right - left + 1;
    layout.height = bottom - top + 1;
  } else if (name == "compression" && value.size() == 1) {
    layout.compression = static_cast<std::uint8_t>(value[0]);
  } else if (name == "tiles" && value.size() == 9) {
    layout.tile_width = reader.word().value_or(0);
    layout.tile_height = reader.word().value_or(0);
  }
}

// Returns the scan lines per piece, by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
std::int64_t lines_of(std::uint8_t compression) {
  constexpr std::int64_t kLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return compression < std::size(kLines) ? kLines[compression] : 256;
}

// Returns the number of pieces at full resolution.
std::int64_t piece_count(const Layout& layout) {
  const auto pieces = [](std::int64_t size, std::int64_t each) { return (size + each - 1) / each; };
  if (layout.tile_width > 0 && layout.tile_height > 0) {
    return pieces(layout.width, layout.tile_width) * pieces(layout.height, layout.tile_height);
  }
  return pieces(layout.height, lines_of(layout.compression));
}

// Returns the bytes to which run-length encoding expands: a negative count and that many bytes, or a count and a byte
// that is repeated once more than the count.
std::uint64_t run_length_size(std::string_view data) {
  std::uint64_t size = 0;
  while (!data.empty()) {
    const int count = static_cast<signed char>(data[0]);
    const auto used = static_cast<std::size_t>(count < 0 ? 1 - count : 2);
    if (data.size() < used) break;
    size += static_cast<std::uint64_t>(count < 0 ? -count : count + 1);
    data.remove_prefix(used);
  }
  return size;
}

// Returns the bytes to which data inflates, up to `limit`. They are not stored.
std::uint64_t inflated_size(std::string_view data, std::uint64_t limit) {
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) return 0;
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::vector<unsigned char> scratch(std::size_t{1} << 16U);
  stream.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<unsigned>(data.size());
  std::uint64_t size = 0;
  for (int state = Z_OK; state == Z_OK && size < limit;) {
    stream.next_out = scratch.data();
    stream.avail_out = static_cast<unsigned>(scratch.size());
    state = inflate(&stream, Z_NO_FLUSH);
    size += scratch.size() - stream.avail_out;
  }
  return size;
}

// Returns whether the blocks of rows, which follow the header, contain as many bytes as the header requires. With the
// compressions none, RLE, ZIPS and ZIP, OpenEXR does not detect blocks that are too short, and returns uninitialised
// memory as pixels. The other compressions check their data.
bool are_whole(const Layout& layout, std::string_view bytes, std::string_view offsets) {
  HeaderReader reader(offsets);
  const std::int64_t lines = lines_of(layout.compression);
  for (std::int64_t row = 0; row < layout.height; row += lines) {
    const std::optional<std::uint32_t> low = reader.word(), high = reader.word();
    if (!low || !high) return false;
    const std::uint64_t at = std::uint64_t{*high} << 32U | *low;
    if (at == 0 || at > bytes.size()) return false;
    HeaderReader block(bytes.substr(at));
    static_cast<void>(block.word());  // the number of the row
    const std::optional<std::uint32_t> size = block.word();
    if (!size) return false;
    const std::optional<std::string_view> data = block.take(*size);
    const auto expected =
        static_cast<std::uint64_t>(std::min(lines, layout.height - row) * layout.width * layout.pixel_bytes);
    if (!data) return false;
    if (data->size() >= expected) continue;  // not compressed; too many bytes are an error of OpenEXR
    if (layout.compression == 0) return false;
    const std::uint64_t got = layout.compression == 1 ? run_length_size(*data) : inflated_size(*data, expected);
    if (got < expected) return false;
  }
  return true;
}

}  // namespace

std::string exr_header_problem(std::string_view bytes) {
  HeaderReader reader(bytes);
  static_cast<void>(reader.word());  // the magic number
  const std::optional<std::uint32_t> version = reader.word();
  if (!version) return kCutOff;
  constexpr std::uint32_t kMultiPart = 0x1000;
  constexpr std::uint32_t kDeep = 0x800;
  if ((*version & kDeep) != 0) return "it contains deep pixels";
  const bool many = (*version & kMultiPart) != 0;
  std::int64_t pieces = 0;
  Layout last;
  for (bool more = true; more;) {
    Layout layout;
    bool empty = true;
    for (;;) {
      const std::optional<std::string_view> name = reader.name();
      if (!name) return kCutOff;
      if (name->empty()) break;
      empty = false;
      const std::optional<std::string_view> type = reader.name();
      const std::optional<std::uint32_t> size = reader.word();
      if (!type || !size) return kCutOff;
      const std::optional<std::string_view> value = reader.take(*size);
      if (!value) return kCutOff;
      if (!has_size_of_type(*type, *size)) return "an attribute of its header has the wrong size";
      read_attribute(layout, *name, *value);
    }
    more = many && !empty;
    if (empty) break;
    if (layout.width < 1 || layout.height < 1) return "its data window is empty";
    pieces += piece_count(layout);
    last = layout;
  }
  // Each piece has an 8-byte offset in a table and a header of at least 8 bytes.
  constexpr std::int64_t kMinBytes = 16;
  if (pieces > static_cast<std::int64_t>(bytes.size()) / kMinBytes) return kCutOff;
  constexpr std::uint8_t kZip = 3;
  const bool rows = !many && last.tile_width == 0 && last.compression <= kZip && last.pixel_bytes > 0;
  return rows && !are_whole(last, bytes, reader.rest()) ? kCutOff : "";
}

}  // namespace tyndall::image
