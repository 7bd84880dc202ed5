// Every texel of the clipmap that the shaders of a frame read lies in a tile that has been filled.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/terrain/terrain_tiles.hpp"

namespace tyndall::scene {
namespace {

struct Case {
  glm::dvec2 map;
  double altitude_m;
  int coarseness;
};
const Case kCases[] = {{{0.0, 0.0}, 2.0, 1},      {{1234.5, -987.6}, 1500.0, 1}, {{-100003.0, 40000.0}, 6000.0, 4},
                       {{31.0, 33.0}, 30.0e3, 2}, {{2.0e6, -3.0e6}, 12000.0, 1}, {{-5.0e5, 7.0e5}, 400.0e3, 1}};

class TerrainTilesTest : public testing::Test {
 protected:
  static TerrainLod plan(const Case& c) { return plan_terrain(c.map, c.altitude_m, 4500.0, 6.36e6, c.coarseness); }

  // Fills the tiles for a random third of the blocks and returns these blocks.
  std::vector<TerrainBlock> fill_some(const TerrainLod& lod, bool shaded) {
    std::vector<TerrainBlock> blocks;
    select_blocks(
        lod, 0, [](const glm::dvec2&, const glm::dvec2&) { return true; }, blocks);
    std::shuffle(blocks.begin(), blocks.end(), random_);
    blocks.resize(blocks.size() / 3);
    for (const TerrainBlock& block : blocks) {
      if (shaded) {
        tiles_.add_shaded(lod, block);
      } else {
        tiles_.add_drawn(lod, block);
      }
    }
    tiles_.mark_filled();
    return blocks;
  }
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  // Counts the texels around a texel coordinate, as surface_shape() reads them, that are not filled.
  int holes_around(const TerrainLod& lod, int layer, const glm::dvec2& texel) const {
    int holes = 0;
    const glm::ivec2 base(glm::floor(texel - 0.5));
    for (int dz = -1; dz <= 2; ++dz) {
      for (int dx = -1; dx <= 2; ++dx) holes += hole(lod, layer, base + glm::ivec2(dx, dz));
    }
    return holes;
  }
  int hole(const TerrainLod& lod, int layer, const glm::ivec2& texel) const {
    const int last = lod.level_samples() - 1;
    EXPECT_TRUE(texel.x >= 0 && texel.y >= 0 && texel.x <= last && texel.y <= last) << texel.x << ' ' << texel.y;
    return tiles_.filled(layer, std::clamp(texel.x, 0, last), std::clamp(texel.y, 0, last)) ? 0 : 1;
  }

  std::mt19937 random_{7};
  TerrainTiles tiles_;
};

TEST_F(TerrainTilesTest, VerticesAndPixelsReadFilledTilesOnly) {
  for (const Case& c : kCases) {
    const TerrainLod lod = plan(c);
    tiles_.start(lod);
    int holes = 0;
    for (const TerrainBlock& block : fill_some(lod, true)) {
      const auto layer = static_cast<std::size_t>(block.layer);
      const std::size_t parent = std::min(layer + 1, lod.levels.size() - 1);
      const ClipLevel& level = lod.levels[layer];
      const glm::dvec2 at(block.x + uniform() * lod.block_cells(), block.z + uniform() * lod.block_cells());
      holes += holes_around(lod, block.layer, at - glm::dvec2(level.origin) + 0.5);
      if (parent != layer) {
        holes += holes_around(lod, block.layer + 1, at * 0.5 - glm::dvec2(lod.levels[parent].origin) + 0.5);
      }
      for (const double reach : {200.0, 800.0, 3200.0}) {
        std::size_t read = layer;
        while (read + 1 < lod.levels.size() && lod.levels[read].cell_m < 0.125 * reach) ++read;
        const double angle = 6.283185307 * uniform();
        const glm::dvec2 map = at * level.cell_m + reach * glm::dvec2(std::cos(angle), std::sin(angle));
        const glm::ivec2 texel(glm::floor(map / lod.levels[read].cell_m + 0.5));
        holes += hole(lod, static_cast<int>(read), texel - lod.levels[read].origin);
      }
    }
    EXPECT_EQ(holes, 0) << "camera at " << c.map.x << ' ' << c.map.y << ", " << c.altitude_m << " m";
  }
}

TEST_F(TerrainTilesTest, ShadowMapsReadTheirVerticesOnly) {
  for (const Case& c : kCases) {
    const TerrainLod lod = plan(c);
    tiles_.start(lod);
    int holes = 0;
    for (const TerrainBlock& block : fill_some(lod, false)) {
      const auto layer = static_cast<std::size_t>(block.layer);
      const std::size_t parent = std::min(layer + 1, lod.levels.size() - 1);
      for (int i = 0; i < 2; ++i) {
        const glm::ivec2 grid(block.x + i * lod.block_cells(), block.z + i * lod.block_cells());
        holes += hole(lod, block.layer, grid - lod.levels[layer].origin);
        if (parent != layer) holes += hole(lod, block.layer + 1, grid / 2 - lod.levels[parent].origin);
      }
    }
    EXPECT_EQ(holes, 0);
  }
}

TEST_F(TerrainTilesTest, OnlyNewTilesAreMissing) {
  TerrainLod lod = plan(kCases[1]);
  EXPECT_TRUE(tiles_.start(lod));
  std::vector<TerrainBlock> blocks;
  select_blocks(
      lod, 0, [](const glm::dvec2&, const glm::dvec2&) { return true; }, blocks);
  tiles_.add_drawn(lod, blocks[0]);
  EXPECT_FALSE(tiles_.missing().empty());
  tiles_.mark_filled();
  EXPECT_FALSE(tiles_.start(lod)) << "no level has moved";
  tiles_.add_drawn(lod, blocks[0]);
  EXPECT_TRUE(tiles_.missing().empty());

  // Tiles that were missing and have not been filled are missing again in the next frame, but only if it needs them.
  tiles_.add_drawn(lod, blocks.back());
  const std::size_t missing = tiles_.missing().size();
  EXPECT_GT(missing, 0U);
  EXPECT_FALSE(tiles_.start(lod));
  EXPECT_TRUE(tiles_.missing().empty());
  tiles_.add_drawn(lod, blocks.back());
  EXPECT_EQ(tiles_.missing().size(), missing);

  // Moving by two cells of the finest level empties that level alone.
  lod = plan_terrain(lod.camera_map + 2.0 * lod.levels[0].cell_m, kCases[1].altitude_m, 4500.0, 6.36e6, 1);
  EXPECT_TRUE(tiles_.start(lod));
  tiles_.add_drawn(lod, blocks[0]);
  for (const TerrainTile& tile : tiles_.missing()) EXPECT_LT(tile.layer, 3);
}

}  // namespace
}  // namespace tyndall::scene
