// Textures of the hall: leaded panes of its windows, and stone.
#pragma once

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// A window with a pointed arch: its half width, the height at which the arch begins, and the height of its tip [m].
struct Lancet {
  double half_width_m, spring_m, top_m;
  // Returns the half width of the opening at a height [m].
  [[nodiscard]] double half_at(double y_m) const;
};

// Returns the texture of a pointed window. u points across, and v downwards from the tip. Lead and stone are black,
// because they transmit no light. `design` selects the colours.
[[nodiscard]] MeshTexture lancet_glass(const Lancet& window, std::uint32_t design);
// Returns the texture of a round window, covering its bounding square.
[[nodiscard]] MeshTexture rose_glass(double radius_m);
// Return 4 m of ashlar wall and 2 m of floor tiles. Both can be repeated.
[[nodiscard]] MeshTexture ashlar();
[[nodiscard]] MeshTexture floor_tiles();

}  // namespace tyndall::scene
