#include "scene/terrain/terrain_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace tyndall::scene {
namespace {

// surface_shape() reads two texels beyond a pixel's position; one more is for rounding.
constexpr double kSlopeMargin = 3.0;
// The distances at which sky_visibility() reads elevations [m], and the size of its cells relative to the distance.
constexpr double kSkyReaches_m[] = {200.0, 800.0, 3200.0};
constexpr double kSkyCell = 0.125;

}  // namespace

bool TerrainTiles::start(const TerrainLod& lod) {
  const int side = lod.level_samples() / kTileSamples;
  bool moved = side != side_;
  if (moved) levels_.clear();
  side_ = side;
  const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  levels_.resize(lod.levels.size());
  for (std::size_t i = 0; i < lod.levels.size(); ++i) {
    const ClipLevel& level = lod.levels[i];
    Level& own = levels_[i];
    if (own.tiles.size() != count || own.level.cell_m != level.cell_m || own.level.origin != level.origin) {
      own = {level, std::vector<Tile>(count, Tile::unknown)};
      moved = true;
    }
    std::replace(own.tiles.begin(), own.tiles.end(), Tile::needed, Tile::unknown);
  }
  return moved;
}

void TerrainTiles::add(int layer, const glm::dvec2& low, const glm::dvec2& high) {
  const auto tile = [&](double texel) {
    return std::clamp(static_cast<int>(std::floor(texel / kTileSamples)), 0, side_ - 1);
  };
  Level& level = levels_[static_cast<std::size_t>(layer)];
  for (int z = tile(low.y); z <= tile(high.y); ++z) {
    for (int x = tile(low.x); x <= tile(high.x); ++x) {
      Tile& state = level.tiles[index_of(x, z)];
      if (state == Tile::unknown) state = Tile::needed;
    }
  }
}

void TerrainTiles::add_area(const TerrainLod& lod, const TerrainBlock& block, int layer, double margin) {
  const double scale =
      lod.levels[static_cast<std::size_t>(block.layer)].cell_m / lod.levels[static_cast<std::size_t>(layer)].cell_m;
  const glm::dvec2 low =
      glm::dvec2(block.x, block.z) * scale - glm::dvec2(lod.levels[static_cast<std::size_t>(layer)].origin);
  add(layer, low - margin, low + lod.block_cells() * scale + margin);
}

void TerrainTiles::add_drawn(const TerrainLod& lod, const TerrainBlock& block) {
  const int parent = std::min(block.layer + 1, static_cast<int>(lod.levels.size()) - 1);
  add_area(lod, block, block.layer, kSlopeMargin);
  add_area(lod, block, parent, kSlopeMargin);
}

void TerrainTiles::add_shaded(const TerrainLod& lod, const TerrainBlock& block) {
  add_drawn(lod, block);
  int layer = block.layer;
  for (const double reach : kSkyReaches_m) {
    while (layer + 1 < static_cast<int>(lod.levels.size()) &&
           lod.levels[static_cast<std::size_t>(layer)].cell_m < kSkyCell * reach) {
      ++layer;
    }
    add_area(lod, block, layer, reach / lod.levels[static_cast<std::size_t>(layer)].cell_m + 1.0);
  }
}

std::vector<TerrainTile> TerrainTiles::missing() const {
  std::vector<TerrainTile> out;
  for (std::size_t layer = 0; layer < levels_.size(); ++layer) {
    for (int z = 0; z < side_; ++z) {
      for (int x = 0; x < side_; ++x) {
        if (levels_[layer].tiles[index_of(x, z)] != Tile::needed) continue;
        out.push_back({x * kTileSamples, z * kTileSamples, static_cast<std::int32_t>(layer), 0});
      }
    }
  }
  return out;
}

void TerrainTiles::mark_filled() {
  for (Level& level : levels_) std::replace(level.tiles.begin(), level.tiles.end(), Tile::needed, Tile::filled);
}

bool TerrainTiles::filled(int layer, int x, int z) const {
  return levels_[static_cast<std::size_t>(layer)].tiles[index_of(x / kTileSamples, z / kTileSamples)] == Tile::filled;
}

}  // namespace tyndall::scene
