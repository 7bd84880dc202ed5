// Fits shadow cascades to a terrain on a curved planet, on the CPU. Pure functions.
//
// A cascade covers the part of its depth range of the view that terrain can shadow: the bounding sphere of the range,
// intersected with the shell between the lowest and the highest ground. The sphere does not turn with the camera, its
// centre moves by whole texels and its size changes in steps, so that shadows do not shimmer. Depth reaches from the
// farthest receiver to the point where the sun's rays leave the shell, so that it includes casters outside the view.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/view/camera.hpp"

namespace tyndall::scene {

// An orthographic view along the sun's rays. Light space: z towards the sun.
struct CascadeFit {
  glm::dmat3 world_from_light = glm::dmat3(1.0);
  glm::dvec3 centre = {};            // light space [m]; z is the plane of depth 0.5
  glm::dvec3 half_extent = {};       // light space [m]
  double near_m = 0.0, far_m = 0.0;  // range of view-space depths
  double texel_m = 0.0;              // the larger side of a texel
  bool holds_room = false;           // fitted to Ground::room instead of the view

  // Maps to (u, v, depth); depth increases away from the sun, from 0 to 1.
  [[nodiscard]] glm::dmat4 shadow_from_world() const;
};

// Maps (u, v, depth) to Vulkan's clip space.
[[nodiscard]] glm::dmat4 clip_from_shadow();

struct Ground {
  double min_m = 0.0, max_m = 0.0;  // lowest and highest elevation
  double radius_m = 0.0;            // radius of the planet
  // World [m]. If not empty, nothing outside the hull of these points casts a shadow, and the maps end there.
  std::span<const glm::dvec3> casters = {};
  // World [m]. If not empty, the corners of a room that may surround the camera; one cascade has to contain it
  // entirely.
  std::span<const glm::dvec3> room = {};
};

// Returns the view depths at which the cascades end; the last is `far_m`. Partitions between uniformly (0) and
// logarithmically (1) (Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps", 2006).
[[nodiscard]] std::vector<double> split_distances(double near_m, double far_m, std::uint32_t count,
                                                  double partitioning);

// Returns the cascades of a view. Each is fitted so that it is complete between its near and far depth. `first_near_m`:
// start of the first cascade. The cascade `first_marched` starts at the camera.
//
// If there is a room, the first cascade that is coarser than a map of the whole room is replaced by that map, and the
// next cascade starts where the replaced one would have started. A room larger than twice the distance of the shadows
// has no map.
[[nodiscard]] std::vector<CascadeFit> fit_cascades(const View& view, const glm::dvec3& direction_to_sun,
                                                   const ShadowParams& shadows, const Ground& ground,
                                                   double first_near_m);
// Returns the first cascade that light shafts are marched through: shadows.first_marched, or the cascade of the room if
// that comes earlier, because it contains the camera as well.
[[nodiscard]] std::uint32_t first_marched(const ShadowParams& shadows, std::span<const CascadeFit> cascades);

}  // namespace tyndall::scene
