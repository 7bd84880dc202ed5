// Decodes heights that are stored as colours, and detects "no data" samples that the file does not declare.
#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

// A part of a raster that is read at once. Files can declare two thousand million columns.
struct SampleBlock {
  int left, top, columns, rows;
  std::size_t samples() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

// Calls visit(block) for the blocks of a raster until it returns false. Returns whether every call returned true.
template <typename Visit>
bool for_each_block(int width, int height, const Visit& visit) {
  constexpr int kSamplesAtOnce = 1 << 20;
  const int columns = std::min(width, kSamplesAtOnce);
  const int rows = kSamplesAtOnce / columns;
  for (int top = 0; top < height;) {
    const int block_rows = std::min(rows, height - top);
    for (int left = 0; left < width;) {
      const int block_columns = std::min(columns, width - left);
      if (!visit(SampleBlock{left, top, block_columns, block_rows})) return false;
      left += block_columns;
    }
    top += block_rows;
  }
  return true;
}

// Reads a block of a band into `out`.
template <typename T>
bool read_block(GDALRasterBand& band, const SampleBlock& block, GDALDataType type, std::vector<T>& out) {
  out.resize(block.samples());
  return band.RasterIO(GF_Read, block.left, block.top, block.columns, block.rows, out.data(), block.columns, block.rows,
                       type, 0, 0, nullptr) == CE_None;
}

bool is_colour_image(GDALDataset& file) {
  const int bands = file.GetRasterCount();
  if (bands != 3 && bands != 4) return false;
  constexpr std::array<GDALColorInterp, 3> kColours = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
  for (int i = 0; i < 3; ++i) {
    GDALRasterBand& band = *file.GetRasterBand(i + 1);
    if (band.GetRasterDataType() != GDT_Byte || band.GetColorInterpretation() != kColours[static_cast<std::size_t>(i)])
      return false;
  }
  return true;
}

// Returns whether the samples of a band are indices of colours. A palette of greys may be meant as heights.
bool has_palette(GDALRasterBand& band) {
  const GDALColorTable* const palette = band.GetColorTable();
  if (palette == nullptr || band.GetColorInterpretation() != GCI_PaletteIndex) return false;
  for (int i = 0; i < palette->GetColorEntryCount(); ++i) {
    const GDALColorEntry& entry = *palette->GetColorEntry(i);
    if (entry.c1 != entry.c2 || entry.c1 != entry.c3) return true;
  }
  return false;
}

struct Encoding {
  const char* name;
  double offset_m, per_red_m, per_green_m, per_blue_m;
};
constexpr std::array<Encoding, 2> kEncodings = {
    {{"Terrarium (Mapzen)", -32768.0, 256.0, 1.0, 1.0 / 256.0}, {"Terrain-RGB (Mapbox)", -10000.0, 6553.6, 25.6, 0.1}}};
constexpr double kLowest_m = -11500.0, kHighest_m = 9500.0;

// Sets `holes` for samples that are transparent, masked or without data in all three bands. Returns whether that
// worked.
bool read_holes(GDALDataset& file, const SampleBlock& block, std::vector<bool>& holes) {
  std::vector<std::uint8_t> mask;
  holes.assign(block.samples(), true);
  for (int b = 1; b <= 3; ++b) {
    GDALRasterBand& band = *file.GetRasterBand(b);
    if ((band.GetMaskFlags() & GMF_ALL_VALID) != 0) {
      holes.assign(block.samples(), false);
      return true;
    }
    if (!read_block(*band.GetMaskBand(), block, GDT_Byte, mask)) return false;
    for (std::size_t i = 0; i < mask.size(); ++i) holes[i] = holes[i] && mask[i] == 0;
  }
  return true;
}

}  // namespace

Result<Dataset> decode_colours(const std::string& source, GDALDataset& file, std::vector<std::string>& notes) {
  if (has_palette(*file.GetRasterBand(1)))
    return elevation_error(source, "is an image with a palette of colours; expected one band of heights");
  if (!is_colour_image(file)) return Dataset();
  const int width = file.GetRasterXSize();
  const int height = file.GetRasterYSize();
  constexpr double kMaxPixels = 1 << 28;
  if (static_cast<double>(width) * height > kMaxPixels)
    return elevation_error(source, "is too large for an image of colours");
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("MEM");
  std::array<Dataset, kEncodings.size()> decoded;
  std::array<bool, kEncodings.size()> possible = {};
  for (std::size_t e = 0; e < kEncodings.size(); ++e) {
    if (driver != nullptr) decoded[e].reset(driver->Create("", width, height, 1, GDT_Float32, nullptr));
    possible[e] = decoded[e] != nullptr;
  }
  std::vector<std::uint8_t> colours;
  std::vector<float> heights;
  std::vector<bool> holes;
  bool has_holes = false;
  bool stored = true;
  const bool read = for_each_block(width, height, [&](const SampleBlock& block) {
    std::array<int, 3> bands = {1, 2, 3};
    colours.resize(3 * block.samples());
    heights.resize(block.samples());
    if (file.RasterIO(GF_Read, block.left, block.top, block.columns, block.rows, colours.data(), block.columns,
                      block.rows, GDT_Byte, 3, bands.data(), 3, GSpacing{3} * block.columns, 1, nullptr) != CE_None ||
        !read_holes(file, block, holes))
      return false;
    for (std::size_t e = 0; e < kEncodings.size(); ++e) {
      if (!possible[e]) continue;
      const Encoding& encoding = kEncodings[e];
      for (std::size_t i = 0; i < block.samples(); ++i) {
        const double h = encoding.offset_m + encoding.per_red_m * colours[3 * i] +
                         encoding.per_green_m * colours[3 * i + 1] + encoding.per_blue_m * colours[3 * i + 2];
        possible[e] = possible[e] && (holes[i] || (h >= kLowest_m && h <= kHighest_m));
        has_holes = has_holes || holes[i];
        heights[i] = holes[i] ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(h);
      }
      stored = stored && decoded[e]->GetRasterBand(1)->RasterIO(GF_Write, block.left, block.top, block.columns,
                                                                block.rows, heights.data(), block.columns, block.rows,
                                                                GDT_Float32, 0, 0, nullptr) == CE_None;
    }
    return stored;
  });
  if (!stored) return elevation_error(source, "does not fit into memory");
  if (!read) return elevation_error(source, "cannot be read: truncated or damaged");
  for (std::size_t e = 0; e < kEncodings.size(); ++e) {
    if (!possible[e]) continue;
    notes.push_back(std::string("heights are taken from its colours, encoded as ") + kEncodings[e].name);
    std::array<double, 6> transform = {};
    if (file.GetGeoTransform(transform.data()) == CE_None) decoded[e]->SetGeoTransform(transform.data());
    if (file.GetSpatialRef() != nullptr) decoded[e]->SetSpatialRef(file.GetSpatialRef());
    if (has_holes) decoded[e]->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
    return std::move(decoded[e]);
  }
  return elevation_error(source, "is a colour image without heights; expected one band of heights, or tiles encoded as "
                                 "Terrarium or Terrain-RGB");
}

namespace {

constexpr std::array<double, 6> kUsual = {-9999.0, -32768.0, -32767.0, -999.0, 32767.0, 9999.0};

// Statistics of the samples of a band, in units of the file, that decide about holes.
struct HoleStatistics {
  std::array<std::size_t, kUsual.size()> count = {};
  std::array<double, kUsual.size()> gap;  // to the nearest other sample
  std::size_t others = 0;
  // Heights that are impossible would otherwise be averaged with others in large files.
  double impossible = 0.0;
  std::size_t impossible_count = 0;
  bool several = false;  // different impossible samples
  double highest = -std::numeric_limits<double>::infinity(), lowest = std::numeric_limits<double>::infinity();

  HoleStatistics() { gap.fill(std::numeric_limits<double>::infinity()); }
  void add(double sample, double scale, double offset);
  bool add_ordinary(const std::vector<float>& samples, double scale, double offset);
};

void HoleStatistics::add(double sample, double scale, double offset) {
  bool usual = false;
  for (std::size_t k = 0; k < kUsual.size(); ++k) {
    const double distance = std::abs(sample - kUsual[k]);
    count[k] += distance == 0.0 ? 1 : 0;
    usual = usual || distance == 0.0;
    if (distance > 0.0 && distance < gap[k]) gap[k] = distance;
  }
  if (std::abs(sample * scale + offset) > kMaxElevation_m) {
    several = several || (impossible_count > 0 && sample != impossible);
    impossible = sample;
    ++impossible_count;
  } else if (std::isfinite(sample) && !usual) {
    highest = std::max(highest, sample);
    lowest = std::min(lowest, sample);
  }
  others += usual ? 0 : 1;
}

// Adds samples that are all possible heights, on one side of every usual value: their ends suffice. Returns false
// without a change for others. Most samples of large files are ordinary.
bool HoleStatistics::add_ordinary(const std::vector<float>& samples, double scale, double offset) {
  float low = std::numeric_limits<float>::max(), high = -low;
  bool numbers = true;
  for (const float sample : samples) {
    low = sample < low ? sample : low;
    high = sample > high ? sample : high;
    numbers = numbers && sample == sample;
  }
  const double lower = static_cast<double>(low), upper = static_cast<double>(high);
  const auto possible = [&](double sample) { return std::abs(sample * scale + offset) <= kMaxElevation_m; };
  if (!numbers || !possible(lower) || !possible(upper)) return false;
  if (std::any_of(kUsual.begin(), kUsual.end(), [&](double usual) { return usual >= lower && usual <= upper; }))
    return false;
  for (std::size_t k = 0; k < kUsual.size(); ++k)
    gap[k] = std::min(gap[k], std::max(lower - kUsual[k], kUsual[k] - upper));
  highest = std::max(highest, upper);
  lowest = std::min(lowest, lower);
  others += samples.size();
  return true;
}

}  // namespace

Dataset declare_no_data(GDALDataset& file, std::vector<std::string>& notes) {
  GDALRasterBand& band = *file.GetRasterBand(1);
  int declared = 0;
  static_cast<void>(band.GetNoDataValue(&declared));
  if (declared != 0) return nullptr;
  constexpr double kMinGap = 500.0;  // in units of the file; real heights have no such gap
  const double scale = band.GetScale(), offset = band.GetOffset();
  HoleStatistics found;
  std::vector<float> samples;
  const bool read = for_each_block(file.GetRasterXSize(), file.GetRasterYSize(), [&](const SampleBlock& block) {
    if (!read_block(band, block, GDT_Float32, samples)) return false;
    if (found.add_ordinary(samples, scale, offset)) return true;
    for (const float sample : samples) found.add(static_cast<double>(sample), scale, offset);
    return true;
  });
  if (!read || found.others == 0) return nullptr;  // read_band() will report the error
  const auto declare = [&](double no_data, std::size_t holes) {
    std::array<char, 32> value = {};
    std::snprintf(value.data(), value.size(), "%.9g", no_data);
    std::array<const char*, 5> arguments = {"-of", "VRT", "-a_nodata", value.data(), nullptr};
    GDALTranslateOptions* const options = GDALTranslateOptionsNew(const_cast<char**>(arguments.data()), nullptr);
    Dataset out(GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&file), options, nullptr)));
    GDALTranslateOptionsFree(options);
    if (out)
      notes.push_back(std::to_string(holes) + " samples of " + value.data() +
                      " are far from all others and treated as holes");
    return out;
  };
  for (std::size_t k = 0; k < kUsual.size(); ++k) {
    if (found.count[k] > 0 && found.gap[k] >= kMinGap) return declare(kUsual[k], found.count[k]);
  }
  const bool apart = found.impossible > found.highest + kMinGap || found.impossible < found.lowest - kMinGap;
  if (found.impossible_count > 0 && !found.several && apart && found.lowest <= found.highest)
    return declare(found.impossible, found.impossible_count);
  return nullptr;
}

}  // namespace tyndall::scene
