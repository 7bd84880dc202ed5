// Shadow cascades for a terrain on a curved planet, fitted on the CPU: pure functions.
//
// A cascade covers the part of its slice of the view that terrain can shadow: the slice's bounding sphere
// cut by the shell between the lowest and the highest ground. The sphere does not turn with the camera,
// and centre and size move in whole texels and in steps, so that shadows do not swim. Depth reaches from
// the farthest receiver to where the sun's rays leave the shell: casters outside the view count.
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
  double near_m = 0.0, far_m = 0.0;  // view-space depth that the cascade is for
  double texel_m = 0.0;              // the larger side of a texel
  bool holds_room = false;           // fitted to Ground::room instead of the view

  // To (u, v, depth); depth grows away from the sun, 0 to 1.
  [[nodiscard]] glm::dmat4 shadow_from_world() const;
};

// To Vulkan's clip space from (u, v, depth).
[[nodiscard]] glm::dmat4 clip_from_shadow();

struct Ground {
  double min_m = 0.0, max_m = 0.0;  // lowest and highest elevation
  double radius_m = 0.0;            // of the planet
  // World [m]. Not empty: nothing outside the hull of these points casts a shadow, so maps end there.
  std::span<const glm::dvec3> casters = {};
  // World [m]. Not empty: corners of what may be a room around the camera, which one cascade has to hold whole.
  std::span<const glm::dvec3> room = {};
};

// View depths at which the cascades end, the last being `far_m`: partitioning between even (0) and
// logarithmic (1) (Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps", 2006).
[[nodiscard]] std::vector<double> split_distances(double near_m, double far_m, std::uint32_t count,
                                                  double partitioning);

// `first_near_m` is where the first cascade's own range begins; every cascade is at the same time
// fitted so that it is whole from its near to its far depth. The cascade `first_marched` starts at the camera.
//
// With a room, the first cascade that is coarser than a map of the whole room becomes that map, and the next one starts
// where it would have started. A room that reaches farther than twice the shadows' distance gets none.
[[nodiscard]] std::vector<CascadeFit> fit_cascades(const View& view, const glm::dvec3& direction_to_sun,
                                                   const ShadowParams& shadows, const Ground& ground,
                                                   double first_near_m);
// The cascade from which on the air is marched: `first_marched`, or the room's, which holds the air at the camera too.
[[nodiscard]] std::uint32_t first_marched(const ShadowParams& shadows, std::span<const CascadeFit> cascades);

}  // namespace tyndall::scene
