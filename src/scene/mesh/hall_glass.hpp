// Pictures of leaded panes for the windows of the hall, and of the stone around them.
#pragma once

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// A window with a pointed arch: its half width, the height where the arch begins and that of its tip [m].
struct Lancet {
  double half_width_m, spring_m, top_m;
  // Half the width of the opening at a height [m].
  [[nodiscard]] double half_at(double y_m) const;
};

// u runs across, v down from the tip; lead and stone are black, so that they let nothing pass. `design` chooses
// colours.
[[nodiscard]] MeshTexture lancet_glass(const Lancet& window, std::uint32_t design);
// A round window over its bounding square.
[[nodiscard]] MeshTexture rose_glass(double radius_m);
// 4 m of ashlar wall, and 2 m of floor tiles; both repeat.
[[nodiscard]] MeshTexture ashlar();
[[nodiscard]] MeshTexture floor_tiles();

}  // namespace tyndall::scene
