// Tracks which parts of the elevation clipmap the shaders of a frame read, and which of these parts are filled.
// Elevations are filled in square tiles, because a view and its shadow maps use only a small part of each level. Pure
// functions on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/terrain/terrain_lod.hpp"

namespace tyndall::scene {

constexpr int kTileSamples = 64;  // samples along a side of a tile; divides TerrainLod::level_samples()

// A tile of a level's elevation texture, in the layout that terrain_heights.comp reads.
struct TerrainTile {
  std::int32_t x = 0, z = 0;  // its first texel
  std::int32_t layer = 0;     // index into TerrainLod::levels
  std::int32_t unused = 0;
};

class TerrainTiles {
 public:
  // Starts a frame. Tiles stay filled in levels that have not moved. Returns whether any level has moved.
  bool start(const TerrainLod& lod);
  // Adds the tiles that the vertices of a block read (terrain_vertex.glsl).
  void add_drawn(const TerrainLod& lod, const TerrainBlock& block);
  // Adds the tiles that the vertices and the pixels of a block read (also terrain_surface.glsl).
  void add_shaded(const TerrainLod& lod, const TerrainBlock& block);
  // Returns the tiles that have been added and are not filled.
  [[nodiscard]] std::vector<TerrainTile> missing() const;
  // Marks the tiles that have been added as filled.
  void mark_filled();
  // Returns whether a texel of a layer is filled.
  [[nodiscard]] bool filled(int layer, int x, int z) const;
  // Forgets everything.
  void clear() { levels_.clear(); }

 private:
  enum class Tile : std::uint8_t { unknown, needed, filled };
  struct Level {
    ClipLevel level;
    std::vector<Tile> tiles;  // row by row
  };
  // Returns the index of a tile in Level::tiles.
  [[nodiscard]] std::size_t index_of(int x, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }
  // Adds the texels of a layer from `low` to `high`, both included, as far as they exist.
  void add(int layer, const glm::dvec2& low, const glm::dvec2& high);
  // Adds the area of a block in the texture of `layer`, widened by `margin` texels on each side.
  void add_area(const TerrainLod& lod, const TerrainBlock& block, int layer, double margin);

  int side_ = 0;  // tiles along a side of a level
  std::vector<Level> levels_;
};

}  // namespace tyndall::scene
