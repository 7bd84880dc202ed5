// The parameters that a terrain is loaded for. When one of them changes, the terrain is stale; all other parameters
// take effect without loading it again.
#pragma once

#include <cstdint>
#include <string>

#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

struct TerrainKey {
  std::string source;
  std::uint32_t seed = 0;
  float exaggeration = 1.0F;
  TerrainUnits units = TerrainUnits::automatic;
  float radius_m = 0.0F;  // radius of the planet

  bool operator==(const TerrainKey&) const = default;
};

[[nodiscard]] inline TerrainKey terrain_key(const TerrainParams& terrain, const PlanetParams& planet) {
  return {terrain.source, terrain.seed, terrain.exaggeration, terrain.units, planet.radius_m};
}

// Sets the parameters to those of the key.
inline void set_terrain_key(const TerrainKey& key, TerrainParams& terrain, PlanetParams& planet) {
  terrain.source = key.source;
  terrain.seed = key.seed;
  terrain.exaggeration = key.exaggeration;
  terrain.units = key.units;
  planet.radius_m = key.radius_m;
}

}  // namespace tyndall::scene
