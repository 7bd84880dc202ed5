// The elevation of the ground, from procedural mountains or from an elevation file: the CPU side of
// shaders/scene/terrain_heights.comp, compiled from the same source, and the data that the shader needs. Map
// coordinates are metres along the sphere from the origin of the world, azimuthal equidistant, x east, z south. The
// centre of a file is at the origin; around the file it blends into procedural terrain over 20 % of its width.
// Immutable after creation, so any thread may read it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/elevation/elevation_file.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

// The structures of shaders/scene/terrain_fill.h, as they are uploaded.
namespace fill {
using uint = std::uint32_t;
struct ivec2 {
  std::int32_t x = 0, y = 0;
};
struct vec2 {
  float x = 0.0F, y = 0.0F;
};
#include "scene/terrain_fill.h"
static_assert(sizeof(TerrainSource) == 40 && sizeof(TerrainFillLevel) == 24 && sizeof(TerrainFill) == 40 + 16 * 24,
              "the layouts must agree with std430");
}  // namespace fill

struct ElevationDesc {
  std::string source = "procedural";  // or the name of an elevation file
  std::uint32_t seed = 1;
  double exaggeration = 1.0;
  double planet_radius_m = 6360000.0;
  int max_samples = kMaxElevationSamples;        // limit for each side of a file; its atlas is 1.5 times as wide
  TerrainUnits units = TerrainUnits::automatic;  // units of a file without a coordinate system
};

// An R32F image with the samples of a file and its coarser levels, in the layout of terrain_source.glsl. For procedural
// terrain it has one texel.
struct ElevationAtlas {
  int width = 1, height = 1;
  std::vector<float> texels = {0.0F};
};

class ElevationSource {
 public:
  static Result<ElevationSource> create(const ElevationDesc& desc);

  // Returns the elevation of the ground [m], without detail finer than about twice `spacing_m` (at least 1/64 m).
  // Positions are rounded to 1/64 m.
  [[nodiscard]] float height_m(double x_m, double z_m, double spacing_m) const;
  // Returns the elevation on one of the planet's map projections (src/scene/description/map_projection.hpp). Projection
  // 0 is the map, and the others have different procedural mountains.
  [[nodiscard]] float height_m(int projection, double x_m, double z_m, double spacing_m) const;
  // Returns the weight of the elevation file: 1 inside, 0 outside, and a value between at its border.
  [[nodiscard]] double file_share(double x_m, double z_m) const;

  // Bounds of the elevations at every spacing.
  [[nodiscard]] float min_height_m() const { return min_height_m_; }
  [[nodiscard]] float max_height_m() const { return max_height_m_; }

  // Returns where the origin of the world is on the Earth, if the file says so.
  [[nodiscard]] const std::optional<Place>& place() const { return place_; }

  [[nodiscard]] bool from_file() const { return constants_.kind != 0; }
  // Returns the constants for TerrainFill::source, and the data of the image elevation_atlas.
  [[nodiscard]] const fill::TerrainSource& constants() const { return constants_; }
  [[nodiscard]] const ElevationAtlas& atlas() const { return atlas_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  fill::TerrainSource constants_ = {};
  ElevationAtlas atlas_;
  float min_height_m_ = 0.0F, max_height_m_ = 0.0F;
  std::optional<Place> place_;
  std::vector<std::string> notes_;
};

}  // namespace tyndall::scene
