// The quadtree of terrain blocks: no overlap, no hole, no crack between levels, and always inside the textures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/terrain/terrain_lod.hpp"

namespace tyndall::scene {
namespace {

constexpr double kRadius_m = 6.36e6;
constexpr double kSummit_m = 4500.0;

struct Camera {
  glm::dvec2 map;
  double altitude_m;
  int coarseness = 1;
};
const Camera kCameras[] = {{{0.0, 0.0}, 2.0},          {{1234.5, -987.6}, 1500.0},    {{-100003.0, 40000.0}, 6000.0},
                           {{31.0, 33.0}, 30.0e3},     {{-5.0e5, 7.0e5}, 400.0e3},    {{511.999, 512.0}, 4499.0},
                           {{2.0e6, -3.0e6}, 12000.0}, {{1234.5, -987.6}, 1500.0, 2}, {{-100003.0, 40000.0}, 6000.0, 4},
                           {{31.0, 33.0}, 30.0e3, 4}};

struct Square {
  glm::dvec2 low, high;
  int layer;
};

Square square_of(const TerrainLod& lod, const TerrainBlock& block) {
  const double cell = lod.levels[static_cast<std::size_t>(block.layer)].cell_m;
  const glm::dvec2 low(block.x * cell, block.z * cell);
  return {low, low + glm::dvec2(lod.block_cells() * cell), block.layer};
}

double distance_of(const TerrainLod& lod, const glm::dvec2& p) {
  return std::hypot(glm::distance(p, lod.camera_map), lod.vertical_m);
}

// Returns the morph of a vertex as in shaders/scene/terrain_vertex.glsl: 0 in its own grid, 1 in the next coarser one.
double morph_of(const TerrainLod& lod, const glm::dvec2& p, int layer) {
  const double range = lod.range_m(lod.levels[static_cast<std::size_t>(layer)]);
  if (layer + 1 == static_cast<int>(lod.levels.size())) return 0.0;
  return std::clamp((distance_of(lod, p) - 0.75 * range) / (0.2 * range), 0.0, 1.0);
}

std::vector<TerrainBlock> all_blocks(const TerrainLod& lod, int finest) {
  std::vector<TerrainBlock> blocks;
  select_blocks(
      lod, finest, [](const glm::dvec2&, const glm::dvec2&) { return true; }, blocks);
  return blocks;
}

TEST(SceneTerrainLod, ThePlanReachesTheHorizonAndNests) {
  for (const Camera& camera : kCameras) {
    const TerrainLod lod = plan_terrain(camera.map, camera.altitude_m, kSummit_m, kRadius_m, camera.coarseness);
    ASSERT_FALSE(lod.levels.empty());
    ASSERT_LE(lod.levels.size(), static_cast<std::size_t>(kMaxLevels));
    // A summit behind the horizon is visible up to this distance (Pythagoras along the tangent).
    const double horizon = std::sqrt(2.0 * kRadius_m * camera.altitude_m + camera.altitude_m * camera.altitude_m);
    EXPECT_GT(lod.reach_m,
              0.98 * std::atan(horizon / kRadius_m) * kRadius_m + std::sqrt(2.0 * kRadius_m * kSummit_m) * 0.98);
    EXPECT_GE(lod.range_m(lod.levels.back()), lod.reach_m);
    for (std::size_t i = 0; i < lod.levels.size(); ++i) {
      EXPECT_EQ(lod.levels[i].origin.x % 2, 0);
      EXPECT_EQ(lod.levels[i].origin.y % 2, 0);
      EXPECT_EQ(lod.levels[i].cell_m, kFinestCell_m * std::exp2(lod.levels[i].level));
      if (i > 0) {
        EXPECT_EQ(lod.levels[i].level, lod.levels[i - 1].level + 1);
      }
    }
  }
}

TEST(SceneTerrainLod, BlocksTileTheReachOnce) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Camera& camera : kCameras) {
    const TerrainLod lod = plan_terrain(camera.map, camera.altitude_m, kSummit_m, kRadius_m, camera.coarseness);
    for (const int finest : {0, 2, 100}) {
      std::vector<Square> squares;
      for (const TerrainBlock& block : all_blocks(lod, finest)) squares.push_back(square_of(lod, block));
      ASSERT_FALSE(squares.empty());
      for (int i = 0; i < 2000; ++i) {
        // Positions are near and far, and some are exactly on the lines between blocks.
        const double distance = lod.reach_m * std::pow(1e-5, uniform(engine)) * 0.9999;
        const double angle = 6.283185307 * uniform(engine);
        const glm::dvec2 p = lod.camera_map + distance * glm::dvec2(std::cos(angle), std::sin(angle));
        const auto holders = std::count_if(squares.begin(), squares.end(), [&](const Square& s) {
          return p.x >= s.low.x && p.x < s.high.x && p.y >= s.low.y && p.y < s.high.y;
        });
        ASSERT_EQ(holders, 1) << "at " << p.x << " " << p.y << ", camera at " << camera.altitude_m << ", finest "
                              << finest;
      }
    }
  }
}

TEST(SceneTerrainLod, LevelsMeetWithoutCracks) {
  std::size_t meetings = 0;
  for (const Camera& camera : kCameras) {
    const TerrainLod lod = plan_terrain(camera.map, camera.altitude_m, kSummit_m, kRadius_m, camera.coarseness);
    for (const int finest : {0, 3}) {
      std::vector<Square> squares;
      for (const TerrainBlock& block : all_blocks(lod, finest)) squares.push_back(square_of(lod, block));
      for (const Square& fine : squares) {
        for (const Square& coarse : squares) {
          if (coarse.layer <= fine.layer) continue;
          const glm::dvec2 low = glm::max(fine.low, coarse.low);
          const glm::dvec2 high = glm::min(fine.high, coarse.high);
          if (low.x > high.x || low.y > high.y) continue;
          // Blocks that share an edge or a corner are one level apart; there the finer one has fully morphed into the
          // coarser grid, and the coarser one has not begun to morph.
          ASSERT_EQ(coarse.layer, fine.layer + 1);
          for (const double f : {0.0, 0.25, 0.5, 1.0}) {
            const glm::dvec2 p = glm::mix(low, high, f);
            ++meetings;
            ASSERT_EQ(morph_of(lod, p, fine.layer), 1.0);
            ASSERT_EQ(morph_of(lod, p, coarse.layer), 0.0);
          }
        }
      }
    }
  }
  EXPECT_GT(meetings, 1000U);
}

TEST(SceneTerrainLod, EveryVertexIsInsideItsTextures) {
  for (const Camera& camera : kCameras) {
    const TerrainLod lod = plan_terrain(camera.map, camera.altitude_m, kSummit_m, kRadius_m, camera.coarseness);
    for (const TerrainBlock& block : all_blocks(lod, 0)) {
      const auto layer = static_cast<std::size_t>(block.layer);
      // A gradient reads two samples beyond the vertex, in its own level and in the next coarser one.
      constexpr int kBeyond = 2;
      const glm::ivec2 grid(block.x, block.z);
      for (std::size_t k = layer; k < std::min(layer + 2, lod.levels.size()); ++k) {
        const int scale = k == layer ? 1 : 2;
        const glm::ivec2 first = grid / scale - lod.levels[k].origin - kBeyond;
        const glm::ivec2 last = (grid + lod.block_cells()) / scale - lod.levels[k].origin + kBeyond;
        ASSERT_GE(std::min(first.x, first.y), 0) << "layer " << layer << " in " << k;
        ASSERT_LT(std::max(last.x, last.y), lod.level_samples()) << "layer " << layer << " in " << k;
      }
    }
  }
}

// An eye above a sea floor sees as far as above ground at sea level.
TEST(SceneTerrainLod, ThePlanReachesTheHorizonOfGroundBelowSeaLevel) {
  const TerrainLod lod = plan_terrain({0.0, 0.0}, -200.0, -300.0, kRadius_m, 1, -430.0);
  EXPECT_GE(lod.reach_m, std::sqrt(2.0 * kRadius_m * 230.0) + std::sqrt(2.0 * kRadius_m * 130.0));
  const TerrainLod above = plan_terrain({0.0, 0.0}, 1500.0, kSummit_m, kRadius_m, 1, 200.0);
  EXPECT_EQ(above.reach_m, plan_terrain({0.0, 0.0}, 1500.0, kSummit_m, kRadius_m).reach_m);
}

TEST(SceneTerrainLod, OnlyVisibleBlocksAndNoneFinerThanRequested) {
  const TerrainLod lod = plan_terrain({0.0, 0.0}, 100.0, kSummit_m, kRadius_m);
  std::vector<TerrainBlock> blocks;
  const auto east = [](const glm::dvec2&, const glm::dvec2& high) { return high.x > 0.0; };
  select_blocks(lod, 2, east, blocks);
  ASSERT_FALSE(blocks.empty());
  for (const TerrainBlock& block : blocks) {
    EXPECT_GT(square_of(lod, block).high.x, 0.0);
    EXPECT_GE(block.layer, 2);
  }
  EXPECT_LT(blocks.size(), all_blocks(lod, 2).size());
  select_blocks(
      lod, 0, [](const glm::dvec2&, const glm::dvec2&) { return false; }, blocks);
  EXPECT_TRUE(blocks.empty());
}

// At 45 degrees a cell at the end of a level spans 1/448 rad times the coarseness, a pixel 0.828 / height.
TEST(TerrainLod, SmallPicturesHaveCoarserTerrain) {
  const double tan_half_height = std::tan(0.5 * 0.785398);
  EXPECT_EQ(coarseness_for_picture(720, tan_half_height), 1);
  EXPECT_EQ(coarseness_for_picture(371, tan_half_height), 2);
  EXPECT_EQ(coarseness_for_picture(372, tan_half_height), 1);
  EXPECT_EQ(coarseness_for_picture(185, tan_half_height), 4);
  EXPECT_EQ(coarseness_for_picture(186, tan_half_height), 2);
  EXPECT_EQ(coarseness_for_picture(0, tan_half_height), 4);
  EXPECT_EQ(coarseness_for_picture(720, std::tan(0.5 * 0.1)), 1) << "a telescope sees all detail";
}

}  // namespace
}  // namespace tyndall::scene
