// Level of detail of the terrain: a clipmap of elevations around the camera, drawn as a quadtree of square blocks. With
// distance, vertices morph into the grid of the next level, so that there are no cracks (Strugar, "Continuous
// Distance-Dependent Level of Detail for Rendering Heightmaps", 2009). Pure functions on the CPU. Level k has cells of
// kFinestCell_m * 2^k. Grid indices are global, so that blocks of all levels nest and cells never move.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace tyndall::scene {

constexpr double kFinestCell_m = 4.0;
constexpr int kBlockCells = 64;      // cells along a block's side
constexpr int kRangeCells = 448;     // a level is drawn to a distance of this many of its cells
constexpr int kLevelSamples = 1280;  // samples along a side of a level's elevation texture
constexpr int kMaxLevels = 16;

struct ClipLevel {
  int level = 0;
  double cell_m = 0.0;
  glm::ivec2 origin = {};  // global grid index of the texture's first sample; even
};

struct TerrainLod {
  // 1, 2 or 4: divides the cells along a block, a level's reach and the size of its texture, for slow devices.
  int coarseness = 1;
  glm::dvec2 camera_map = {};     // coordinates of the camera on the map projection [m]
  double vertical_m = 0.0;        // height of the camera above the highest ground, at least 0
  double reach_m = 0.0;           // distance up to which ground is visible, on the map projection
  std::vector<ClipLevel> levels;  // from fine to coarse

  // Returns the distance up to which a level is drawn.
  [[nodiscard]] double range_m(const ClipLevel& level) const {
    const int cells = kRangeCells / coarseness;
    return cells * level.cell_m;
  }
  [[nodiscard]] int block_cells() const { return kBlockCells / coarseness; }
  [[nodiscard]] int level_samples() const { return kLevelSamples / coarseness; }
};

// A block of block_cells() × block_cells() cells, in the layout that shaders read.
struct TerrainBlock {
  std::int32_t x = 0, z = 0;  // global grid index of its first vertex
  std::int32_t layer = 0;     // index into TerrainLod::levels
  std::int32_t unused = 0;
};

// Returns the largest coarseness for which cells look no larger than two pixels where their level ends. Small pictures
// need few cells. `tan_half_height`: see View.
[[nodiscard]] int coarseness_for_picture(std::uint32_t height_px, double tan_half_height);

// Plans the levels for a camera at these coordinates of a map projection and this altitude, up to the horizon of the
// highest ground. `min_ground_m`: lowest ground; below sea level it makes the horizon more distant.
[[nodiscard]] TerrainLod plan_terrain(const glm::dvec2& camera_map, double altitude_m, double max_ground_m,
                                      double radius_m, int coarseness = 1, double min_ground_m = 0.0);

// Selects the blocks to draw, none finer than `finest_layer`. `visible` receives a block's bounding square in map
// coordinates (minimum and maximum corner).
void select_blocks(const TerrainLod& lod, int finest_layer,
                   const std::function<bool(const glm::dvec2&, const glm::dvec2&)>& visible,
                   std::vector<TerrainBlock>& out);

}  // namespace tyndall::scene
