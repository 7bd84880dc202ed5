#include "scene/elevation/elevation_source.hpp"

#include <algorithm>
#include <cmath>

#include "scene/elevation/terrain_glsl.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint32_t kProcedural = 0;
constexpr std::uint32_t kFile = 1;
constexpr double kUnitsPerM = 64.0;
constexpr double kLargestPlace_m = 1.0e12;

glm::ivec2 units_of(double x_m, double z_m) {
  const auto units = [](double v) {
    const double bounded = std::isnan(v) ? 0.0 : std::clamp(v, -kLargestPlace_m, kLargestPlace_m);
    // Values beyond 32 bits wrap around, as in the shader.
    const auto whole = static_cast<std::int64_t>(std::floor(bounded * kUnitsPerM + 0.5));
    return static_cast<int>(static_cast<std::uint32_t>(whole));
  };
  return {units(x_m), units(z_m)};
}

terrain64::BoundSource bind(const fill::TerrainSource& s, const ElevationAtlas& atlas) {
  terrain64::BoundSource b;
  b.raster_size = {s.raster_size.x, s.raster_size.y};
  b.raster_spacing_m = s.raster_spacing_m;
  b.raster_min_m = s.raster_min_m;
  b.raster_max_m = s.raster_max_m;
  b.outside_offset_m = s.outside_offset_m;
  b.kind = s.kind;
  b.seed = s.seed;
  b.exaggeration = s.exaggeration;
  b.raster_levels = s.raster_levels;
  b.atlas = atlas.texels.data();
  b.atlas_width = atlas.width;
  return b;
}

struct Block {
  int x = 0, y = 0, width = 0, height = 0;
};

// Returns the positions of the levels of detail in the atlas. Each level has half the size of the previous one, until
// one is a single sample wide or high.
std::vector<Block> atlas_blocks(int width, int height) {
  std::vector<Block> blocks = {{0, 0, width, height}};
  while (std::min(blocks.back().width, blocks.back().height) > 1) {
    const Block& last = blocks.back();
    const bool first = blocks.size() == 1;
    blocks.push_back({width, first ? 0 : last.y + last.height, (last.width + 1) / 2, (last.height + 1) / 2});
  }
  return blocks;
}

ElevationAtlas build_atlas(const ElevationRaster& raster, const std::vector<Block>& blocks) {
  ElevationAtlas atlas;
  atlas.width = raster.width + blocks[1].width;
  atlas.height = std::max(raster.height, blocks.back().y + blocks.back().height);
  atlas.texels.assign(static_cast<std::size_t>(atlas.width) * atlas.height, 0.0F);
  const auto at = [&](int x, int y) -> float& { return atlas.texels[static_cast<std::size_t>(y) * atlas.width + x]; };
  for (int y = 0; y < raster.height; ++y) {
    const auto row = raster.heights.begin() + static_cast<std::ptrdiff_t>(y) * raster.width;
    std::copy(row, row + raster.width, &at(0, y));
  }
  for (std::size_t level = 1; level < blocks.size(); ++level) {
    const Block& fine = blocks[level - 1];
    const Block& coarse = blocks[level];
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const int x0 = fine.x + 2 * x;
        const int x1 = fine.x + std::min(2 * x + 1, fine.width - 1);
        const int y0 = fine.y + 2 * y;
        const int y1 = fine.y + std::min(2 * y + 1, fine.height - 1);
        at(coarse.x + x, coarse.y + y) = 0.25F * (at(x0, y0) + at(x1, y0) + at(x0, y1) + at(x1, y1));
      }
    }
  }
  return atlas;
}

// Returns the mean height of the file's border above the procedural terrain there.
float border_offset(const ElevationRaster& raster, std::uint32_t seed) {
  constexpr int kSamplesPerSide = 64;
  const double half_x = 0.5 * raster.width * raster.spacing_m;
  const double half_z = 0.5 * raster.height * raster.spacing_m;
  const double spacing_m = std::max(half_x, half_z) / kSamplesPerSide;
  const auto file = [&](double u, double v) {  // u, v in [-1; 1]
    const int x = static_cast<int>(std::lround((0.5 + 0.5 * u) * (raster.width - 1)));
    const int y = static_cast<int>(std::lround((0.5 + 0.5 * v) * (raster.height - 1)));
    return raster.heights[static_cast<std::size_t>(y) * raster.width + x];
  };
  double sum = 0.0;
  for (int i = 0; i < kSamplesPerSide; ++i) {
    const double t = 2.0 * (i + 0.5) / kSamplesPerSide - 1.0;
    for (const double depth : {0.84, 1.0}) {
      for (const double side : {-depth, depth}) {
        sum += file(t, side) - terrain64::terrain_height_at(units_of(t * half_x, side * half_z), spacing_m, seed);
        sum += file(side, t) - terrain64::terrain_height_at(units_of(side * half_x, t * half_z), spacing_m, seed);
      }
    }
  }
  return static_cast<float>(sum / (8.0 * kSamplesPerSide));
}

}  // namespace

Result<ElevationSource> ElevationSource::create(const ElevationDesc& desc) {
  if (!(desc.exaggeration >= 0.0 && desc.exaggeration <= 100.0))
    return Error{ErrorCode::invalid_argument, "terrain.exaggeration: the value is out of range; expected 0 to 100", 0};
  ElevationSource source;
  fill::TerrainSource& c = source.constants_;
  c.kind = kProcedural;
  c.seed = desc.seed;
  c.exaggeration = static_cast<float>(desc.exaggeration);
  c.raster_spacing_m = 1.0F;
  c.raster_levels = 1;
  const terrain64::vec2 procedural = terrain64::terrain_height_bounds();
  double low = procedural.x;
  double high = procedural.y;

  if (desc.source != "procedural") {
    Result<ElevationRaster> read =
        read_elevation_file(desc.source, {desc.planet_radius_m, desc.max_samples, desc.units});
    if (!read.ok()) return std::move(read).error();
    const ElevationRaster& raster = read.value();
    const std::vector<Block> blocks = atlas_blocks(raster.width, raster.height);
    c.kind = kFile;
    c.raster_size = {raster.width, raster.height};
    c.raster_spacing_m = static_cast<float>(raster.spacing_m);
    c.raster_min_m = raster.min_m;
    c.raster_max_m = raster.max_m;
    c.raster_levels = static_cast<std::int32_t>(blocks.size());
    c.outside_offset_m = border_offset(raster, desc.seed);
    source.atlas_ = build_atlas(raster, blocks);
    source.notes_ = raster.notes;
    source.place_ = raster.centre;
    const double margin_m = 0.2 * raster.spacing_m;  // the same as in terrain_raster_height()
    low = std::min(low + std::min(c.outside_offset_m, 0.0F), raster.min_m - margin_m);
    high = std::max(high + std::max(c.outside_offset_m, 0.0F), raster.max_m + margin_m);
  }
  source.min_height_m_ = static_cast<float>(low * desc.exaggeration);
  source.max_height_m_ = static_cast<float>(high * desc.exaggeration);
  return source;
}

float ElevationSource::height_m(double x_m, double z_m, double spacing_m) const {
  return height_m(0, x_m, z_m, spacing_m);
}

float ElevationSource::height_m(int projection, double x_m, double z_m, double spacing_m) const {
  const double spacing = std::max(spacing_m, 1.0 / kUnitsPerM);
  return static_cast<float>(terrain64::terrain_projection_height(
      bind(constants_, atlas_), static_cast<std::uint32_t>(projection), units_of(x_m, z_m), spacing));
}

double ElevationSource::file_share(double x_m, double z_m) const {
  return terrain64::terrain_file_weight(bind(constants_, atlas_), units_of(x_m, z_m));
}

}  // namespace tyndall::scene
