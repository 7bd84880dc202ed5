#include "effect/remarks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "effect/frame_geometry.hpp"
#include "effect/modes.hpp"

namespace tyndall {
namespace {

enum class Kind : std::uint32_t {
  sun_length,
  sun_radius,
  sun_dark,
  no_cascades,
  no_shafts,
  tables,
  depth_bits,
  view_inverse,
  view_mirrored,
  below_sea,
  far_away,
  y_up,
  eye_moved,
  near_plane,
  far_plane,
  cascade_start,
  cascade_range,
  cascade_order,
  cascade_unit,
  cascade_clip,
  cascade_elsewhere,
  camera_outside,
  cascade_narrow,
  cascade_gap,
  cascade_sun,
  cascade_depth,
  cloud_sun,
  cloud_depth,
  cloud_unused
};

// One line of text in a fixed buffer. Text that does not fit is cut off.
class Text {
 public:
  template <typename... Parts>
  explicit Text(const Parts&... parts) {
    (append(parts), ...);
  }
  [[nodiscard]] std::string_view view() const { return {text_.data(), used_}; }

 private:
  void append(std::string_view part) {
    const std::size_t n = std::min(part.size(), text_.size() - used_);
    std::copy_n(part.begin(), n, text_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += n;
  }
  void append(const char* part) { append(std::string_view(part)); }
  void append(double number) {
    char digits[32];
    const std::to_chars_result end =
        std::to_chars(digits, digits + sizeof digits, number, std::chars_format::general, 4);
    append(std::string_view(digits, static_cast<std::size_t>(end.ptr - digits)));
  }
  void append(std::uint64_t number) {
    char digits[32];
    const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, number);
    append(std::string_view(digits, static_cast<std::size_t>(end.ptr - digits)));
  }

  std::array<char, 512> text_ = {};
  std::size_t used_ = 0;
};

class Speaker {
 public:
  Speaker(const DeviceInfo& device, std::uint64_t& said) : device_(&device), said_(&said) {}
  // The text is composed of `parts` only if the remark is made.
  template <typename... Parts>
  void say_if(Kind kind, bool wrong, const Parts&... parts) {
    const std::uint64_t bit = std::uint64_t{1} << static_cast<std::uint32_t>(kind);
    if (wrong && (*said_ & bit) == 0) {
      device_->message(device_->message_user, Severity::warning, Text(parts...).view());
    }
    *said_ = wrong ? *said_ | bit : *said_ & ~bit;
  }

 private:
  const DeviceInfo* device_;
  std::uint64_t* said_;
};

double altitude_of(const DVec3& p, double radius) { return std::hypot(p.x, p.y + radius, p.z) - radius; }

DVec3 wide(const Vec3& v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }

DVec3 sum(const DVec3& a, const DVec3& b, double times) {
  return {a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

void remark_on_sun(Speaker& s, const FrameInputs& inputs) {
  const Sun& sun = inputs.sun;
  s.say_if(Kind::sun_length, std::abs(length(wide(sun.direction_to_sun)) - 1.0) > 5e-4, "Sun::direction_to_sun is ",
           length(wide(sun.direction_to_sun)),
           " long; expected unit length: it is normalised, but is it a direction, and towards the sun?");
  s.say_if(Kind::sun_radius, sun.angular_radius_rad > 0.1F, "Sun::angular_radius_rad is ",
           static_cast<double>(sun.angular_radius_rad), "; expected about 0.0047: is it in degrees?");
  s.say_if(Kind::sun_dark, sun.irradiance.x + sun.irradiance.y + sun.irradiance.z <= 0.0F,
           "Sun::irradiance is 0; expected light: there will be no in-scattering");
}

DVec3 minus(const DVec3& a, const DVec3& b) { return sum(a, b, -1.0); }

// Returns how far the camera's x axis is from horizontal, by the world's y axis or by the planet's zenith at the
// camera, whichever is nearer: 0 for a camera without roll.
double roll_of(const Mat4& m, double radius) {
  const DVec3 x = column_of(m, 0);
  const DVec3 p = column_of(m, 3);
  const DVec3 up = {p.x, p.y + radius, p.z};
  return std::min(std::abs(x.y), std::abs(dot(x, up)) / length(up));
}

// Returns whether the camera turns about one axis of the world only.
bool turns_about_an_axis(const Mat4& m) {
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (std::abs(m.m[4 * column + row]) > 1.0F - 1e-6F) return true;
    }
  }
  return false;
}

// Returns the position of a point in a shadow map: (u, v, depth).
DVec3 in_map(const Cascade& cascade, const DVec3& place) {
  const Mat4& m = cascade.shadow_from_world;
  return sum({dot(row_of(m, 0), place), dot(row_of(m, 1), place), dot(row_of(m, 2), place)}, column_of(m, 3), 1.0);
}

bool inside(const DVec3& in_map) {
  return in_map.x > 0.0 && in_map.x < 1.0 && in_map.y > 0.0 && in_map.y < 1.0 && in_map.z > 0.0 && in_map.z < 1.0;
}

// Returns whether a camera and the middle of its view are inside the first marched cascade.
bool is_in_cascade(const Mat4& world_from_view, const FrameInputs& inputs) {
  const Cascade& c = inputs.cascades[inputs.first_marched_cascade];
  const DVec3 camera = column_of(world_from_view, 3);
  const double reach_m = -0.5 * static_cast<double>(c.far_m);
  return inside(in_map(c, camera)) && inside(in_map(c, sum(camera, column_of(world_from_view, 2), reach_m)));
}

// Returns whether the camera matrix is probably inverted, that is, a matrix from world to view space. No single
// criterion is certain, so each one is chosen such that correct cameras do not meet it.
bool looks_inverted(const FrameInputs& inputs, const FrameState& state, const Mat4* before) {
  const Mat4& m = inputs.camera.world_from_view;
  const double radius = static_cast<double>(state.params.planet.radius_m);
  const Mat4 inverted = rigid_inverse(m);
  const double altitude = altitude_of(column_of(m, 3), radius);
  const double other = altitude_of(column_of(inverted, 3), radius);
  if (altitude < -500.0 && other > 1.0) return true;
  // Few cameras are rolled. The inverse of a camera without roll is rolled, unless it is rotated about one axis only.
  if (!turns_about_an_axis(m) && roll_of(m, radius) > 1e-3 && roll_of(inverted, radius) < 1e-5) return true;
  const bool marched = state.params.scattering.light_shafts && !inputs.cascades.empty() && other > 0.0;
  if (marched && !is_in_cascade(m, inputs) &&
      !inside(in_map(inputs.cascades[inputs.first_marched_cascade], column_of(m, 3))) &&
      is_in_cascade(inverted, inputs)) {
    return true;
  }
  // If a camera turns in place, the position of its inverse moves around the origin, partly below the sea.
  if (before == nullptr || altitude > 0.0 || other < 0.0) return false;
  const DVec3 place = column_of(inverted, 3);
  const double turned = length(minus(column_of(m, 2), column_of(*before, 2)));
  const double moved = length(minus(place, column_of(rigid_inverse(*before), 3)));
  return turned > 1e-3 && moved < 1e-5 * (length(place) + 1.0) &&
         length(minus(column_of(m, 3), column_of(*before, 3))) > 100.0 * moved + 0.1;
}

void remark_on_view(Speaker& s, const FrameInputs& inputs, const FrameState& state, bool inverse) {
  const Mat4& m = inputs.camera.world_from_view;
  const double radius = static_cast<double>(state.params.planet.radius_m);
  const double altitude = altitude_of(column_of(m, 3), radius);
  const double other = altitude_of(column_of(rigid_inverse(m), 3), radius);
  s.say_if(Kind::view_inverse, inverse, "Camera::world_from_view looks like its inverse: it puts the camera ", altitude,
           " m above sea level, and its inverse ", other,
           " m; expected the camera's place and axes in the world: is it the view matrix, view_from_world?");
  s.say_if(Kind::below_sea, !inverse && altitude < -500.0, "Camera::world_from_view puts the camera ", -altitude,
           " m below sea level; expected above -500 m: is y up, and the unit the metre?");
  s.say_if(Kind::far_away, altitude > 1e9, "Camera::world_from_view puts the camera ", altitude,
           " m above sea level; expected less than 1e9 m: is the unit the metre?");
  s.say_if(Kind::view_mirrored, determinant3(m) < 0.0,
           "Camera::world_from_view is mirrored, its determinant is -1; expected +1, unless the view is a "
           "planar reflection");
}

void remark_on_projection(Speaker& s, const FrameInputs& inputs, const FrameState& state) {
  const Projection p = projection_of(inputs.camera.clip_from_view);
  const double sky = static_cast<double>(state.desc.sky_depth);
  const bool mirrored = determinant3(inputs.camera.world_from_view) < 0.0;
  s.say_if(Kind::y_up, p.y_up && !mirrored,
           "Camera::clip_from_view has y up, as OpenGL's projections have; expected Vulkan's clip space, y "
           "down and depth 0 to 1: "
           "negate its second row, unless the images are upside down");
  s.say_if(Kind::eye_moved, length(p.centre) > 0.01, "the rays of Camera::clip_from_view meet at ", p.centre.x, ", ",
           p.centre.y, ", ", p.centre.z,
           " m in the view; expected its origin: an eye's offset belongs into world_from_view");
  const double near_m = distance_at_depth(p, 1.0 - sky);
  const double far_m = distance_at_depth(p, sky);
  s.say_if(Kind::near_plane, !p.oblique && (near_m < 1e-3 || near_m > 1e4),
           "Camera::clip_from_view has its near plane at ", near_m,
           " m; expected 0.001 m to 10 km: is the unit the metre?");
  s.say_if(Kind::far_plane, !p.oblique && (far_m < 4.0 * near_m || far_m < 50.0),
           "Camera::clip_from_view has its far plane at ", far_m, " m and its near plane at ", near_m,
           " m; expected the whole scene between them: is depth 0 to 1, and the unit the metre?");
  const VkFormat format = state.desc.depth_format;
  const bool short_depth =
      format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_D16_UNORM_S8_UINT || format == VK_FORMAT_R16_UNORM;
  const double step = (sky == 0.0 ? 0.5 : -0.5) / 65535.0;
  const double sky_m = distance_at_depth(p, sky + step);
  constexpr double kVisible_m = 1e5;
  s.say_if(Kind::depth_bits, short_depth && !p.oblique && sky_m < std::min(0.5 * far_m, kVisible_m),
           "EffectDesc::depth_format has 16 bits, with which all that is farther than ", sky_m,
           " m reads as sky; expected D32_SFLOAT or D24, or a far plane near that distance");
}

// The bounds, in the map of a cascade, of the part of the view that belongs to the cascade.
struct Footprint {
  double low[2] = {1e300, 1e300};
  double high[2] = {-1e300, -1e300};
  double size = 0.0;        // length of the larger side
  double reached_m = -1.0;  // depth up to which the middle of the view is in the map; -1: not at all
};

// Returns the footprint of the part of the view between two depths.
Footprint footprint(const Cascade& cascade, double near_m, double far_m, const FrameInputs& inputs,
                    const shared::FrameConstants& frame) {
  constexpr int kDepths = 16;
  const DVec3 camera = column_of(inputs.camera.world_from_view, 3);
  const DVec3 forward = wide(frame.camera_forward);
  Footprint out;
  for (int i = 0; i < 5; ++i) {
    const double across = i == 4 ? 0.5 : i % 2;
    const double down = i == 4 ? 0.5 : i / 2;
    DVec3 ray = sum(wide(frame.ray_origin), wide(frame.ray_x), across * frame.width);
    ray = sum(ray, wide(frame.ray_y), down * frame.height);
    for (int step = 0; step <= kDepths; ++step) {
      const double depth_m = near_m + (far_m - near_m) * step / kDepths;
      const DVec3 at = in_map(cascade, sum(camera, ray, depth_m / std::max(dot(ray, forward), 1e-6)));
      const double uv[2] = {at.x, at.y};
      for (int axis = 0; axis < 2; ++axis) {
        out.low[axis] = std::min(out.low[axis], uv[axis]);
        out.high[axis] = std::max(out.high[axis], uv[axis]);
      }
      const bool in = std::min(at.x, at.y) > -0.02 && std::max(at.x, at.y) < 1.02;
      if (i == 4 && in) out.reached_m = depth_m;
    }
  }
  out.size = std::max(out.high[0] - out.low[0], out.high[1] - out.low[1]);
  return out;
}

// Makes remarks on maps that do not cover their part of the view. A map may omit positions that nothing shadows, such
// as the atmosphere above the terrain, and it may end where the casters of shadows end. Remarks are made only on maps
// that cannot be explained in this way.
void remark_on_coverage(Speaker& s, const FrameInputs& inputs, const FrameState& state) {
  constexpr float kHigh_m = 10000.0F;  // above this altitude of the camera, the visible ground may have no shadows
  constexpr float kLow_m = 200.0F;     // below this altitude of the camera, the camera may be in shadow
  constexpr double kMuchSmaller = 20.0;
  const std::size_t first = inputs.first_marched_cascade;
  const std::size_t count = inputs.cascades.size();
  const DVec3 camera = column_of(inputs.camera.world_from_view, 3);
  std::size_t clip = count, elsewhere = count, outside = count, narrow = 0;
  Footprint of_clip, of_elsewhere;
  double out_by = 0.0, reached_m = 0.0;
  bool growing = true;
  double size_before_m = 0.0;
  for (std::size_t i = first; i < count; ++i) {
    const Cascade& c = inputs.cascades[i];
    const double near_m = i > first ? static_cast<double>(inputs.cascades[i - 1].far_m) : 0.0;
    const double far_m = std::min(static_cast<double>(c.far_m), 1e6);
    if (far_m <= near_m) continue;
    const Footprint f = footprint(c, near_m, far_m, inputs, state.frame);
    // In clip space, a map would extend from -1 to 1.
    bool is_clip = std::min(f.low[0], f.low[1]) < -0.3;
    bool misses = false;
    for (int axis = 0; axis < 2; ++axis) {
      is_clip = is_clip && f.low[axis] > -1.3 && f.high[axis] < 1.3 && std::abs(f.low[axis] + f.high[axis]) < 0.8;
      const double slack = 0.25 * (f.high[axis] - f.low[axis]) + 0.02;
      misses = misses || f.low[axis] - slack > 1.0 || f.high[axis] + slack < 0.0;
    }
    misses = misses && f.size < kMuchSmaller && state.frame.camera_altitude_m < kHigh_m;
    if (is_clip && clip == count) {
      clip = i;
      of_clip = f;
    }
    if (misses && !is_clip && elsewhere == count) {
      elsewhere = i;
      of_elsewhere = f;
    }
    if (i == first && !misses && !is_clip && f.size <= 1.0 && state.frame.camera_altitude_m < kLow_m) {
      const DVec3 at = in_map(c, camera);
      out_by = std::max({-at.x, at.x - 1.0, -at.y, at.y - 1.0});
      if (out_by > 0.5) outside = i;
    }
    // The size of maps that are fitted to the view increases from cascade to cascade. Maps that are fitted to the
    // casters have constant size.
    const double size_m = 1.0 / length(row_of(c.shadow_from_world, 0));
    growing = growing && size_m > 1.2 * size_before_m;
    size_before_m = size_m;
    if (f.reached_m < near_m + 0.5 * (far_m - near_m) && (i > first || f.reached_m >= 0.0)) ++narrow;
    if (i == first) reached_m = f.reached_m;
  }
  // Only level views are tested, because a map need not contain positions above or below the ground.
  const double radius = static_cast<double>(state.params.planet.radius_m);
  const DVec3 zenith = {camera.x, camera.y + radius, camera.z};
  const bool level = std::abs(dot(wide(state.frame.camera_forward), zenith)) < 0.03 * length(zenith) &&
                     state.frame.camera_altitude_m < kLow_m;
  const bool all_narrow = level && count - first > 1 && growing && narrow == count - first;
  const auto number = [](std::size_t i) { return static_cast<std::uint64_t>(i); };
  s.say_if(Kind::cascade_clip, clip < count, "FrameInputs::cascades[", number(clip), "] puts the view at ",
           of_clip.low[0], " to ", of_clip.high[0],
           " of its map; expected texture coordinates, 0 to 1: does shadow_from_world lead to clip space, -1 "
           "to 1?");
  s.say_if(Kind::cascade_elsewhere, elsewhere < count && !all_narrow, "FrameInputs::cascades[", number(elsewhere),
           "] puts its part of the view at u ", of_elsewhere.low[0], " to ", of_elsewhere.high[0], " and v ",
           of_elsewhere.low[1], " to ", of_elsewhere.high[1],
           " of its map; expected it within 0 to 1: nothing will be shadowed there");
  s.say_if(Kind::camera_outside, outside < count, "FrameInputs::cascades[", number(outside),
           "], the first that is marched, leaves the camera outside of its map by ", out_by,
           " of the map's width; expected the camera inside: is shadow_from_world of this frame, and from the world?");
  s.say_if(Kind::cascade_narrow, all_narrow,
           "the maps of FrameInputs::cascades reach less far than their ranges, the first to ", reached_m, " of ",
           static_cast<double>(inputs.cascades[first].far_m),
           " m; expected maps that hold the view down to far_m: are near_m and far_m depths in the view, in metres?");
}

void remark_on_cascades(Speaker& s, const FrameInputs& inputs, const FrameState& state, bool inverse) {
  const std::size_t first = inputs.first_marched_cascade;
  const std::size_t count = inputs.cascades.size();
  const double sun_m = length(wide(inputs.sun.direction_to_sun));
  const DVec3 sun = sum({}, wide(inputs.sun.direction_to_sun), 1.0 / sun_m);
  std::size_t empty = count, unordered = count, apart = count, astray = count, upside_down = count;
  double degrees = 0.0;
  for (std::size_t i = first; i < count; ++i) {
    const Cascade& c = inputs.cascades[i];
    if (!(c.far_m > c.near_m)) empty = std::min(empty, i);
    if (i > first && c.far_m <= inputs.cascades[i - 1].far_m) unordered = std::min(unordered, i);
    const bool both = c.far_m > c.near_m && i > first && inputs.cascades[i - 1].far_m > inputs.cascades[i - 1].near_m;
    if (both && c.near_m > 1.001F * inputs.cascades[i - 1].far_m) apart = std::min(apart, i);
    // All points of a texel are on a line parallel to the light.
    const DVec3 light = cross(row_of(c.shadow_from_world, 0), row_of(c.shadow_from_world, 1));
    const DVec3 depth = row_of(c.shadow_from_world, 2);
    const double along = std::abs(dot(light, sun)) / length(light);
    const double depth_along = dot(depth, sun) / length(depth);
    const double off = std::acos(std::min(along, 1.0)) * 180.0 / std::numbers::pi;
    if ((off > 3.0 || std::abs(depth_along) < 0.5) && astray == count) {
      astray = i;
      degrees = off;
    }
    if (depth_along * (state.desc.shadow_depth_reversed ? -1.0 : 1.0) > 0.0) upside_down = std::min(upside_down, i);
  }
  const auto number = [](std::size_t i) { return static_cast<std::uint64_t>(i); };
  s.say_if(Kind::cascade_range, empty < count, "FrameInputs::cascades[", number(empty),
           "] has an empty range of depths; expected near_m below far_m: nothing will be shadowed there");
  s.say_if(Kind::cascade_order, unordered < count, "FrameInputs::cascades[", number(unordered),
           "] ends before the one in front of it; expected cascades from near to far");
  s.say_if(
      Kind::cascade_gap, apart < count, "FrameInputs::cascades[", number(apart), "] starts at ",
      apart < count ? static_cast<double>(inputs.cascades[apart].near_m) : 0.0, " m, and the one before it ends at ",
      apart < count ? static_cast<double>(inputs.cascades[apart - 1].far_m) : 0.0,
      " m; expected ranges that meet or overlap: what lies between is looked up in a map that was not drawn for it");
  s.say_if(Kind::cascade_sun, astray < count, "FrameInputs::cascades[", number(astray), "] looks ", degrees,
           " degrees past the sun; expected a map and a depth along Sun::direction_to_sun");
  s.say_if(Kind::cascade_depth, upside_down < count && astray == count, "FrameInputs::cascades[", number(upside_down),
           "] has depth ", state.desc.shadow_depth_reversed ? "0" : "1", " nearest to the sun; expected ",
           state.desc.shadow_depth_reversed ? "1" : "0", ": EffectDesc::shadow_depth_reversed is ",
           state.desc.shadow_depth_reversed ? "on" : "off");
  const double last_m = static_cast<double>(inputs.cascades.back().far_m);
  s.say_if(Kind::cascade_unit, last_m > 0.0 && last_m < 1.0, "the last of FrameInputs::cascades ends ", last_m,
           " m from the camera; expected at least 1 m: is the unit the metre?");
  const double start_m = static_cast<double>(inputs.cascades[first].near_m);
  s.say_if(Kind::cascade_start, start_m > 1.0, "FrameInputs::cascades[first_marched_cascade] starts ", start_m,
           " m from the camera; expected 0: the atmosphere in front of it is taken as lit");
  if (!inverse) remark_on_coverage(s, inputs, state);  // an inverted camera has caused a remark already
}

void remark_on_clouds(Speaker& s, const FrameInputs& inputs, const ScatteringParams& p) {
  const bool any = inputs.clouds.map.view != VK_NULL_HANDLE;
  const Mat4& m = inputs.clouds.map_from_world;
  const double sun_m = length(wide(inputs.sun.direction_to_sun));
  const DVec3 sun = sum({}, wide(inputs.sun.direction_to_sun), 1.0 / sun_m);
  const DVec3 light = cross(row_of(m, 0), row_of(m, 1));
  const double along = any ? std::abs(dot(light, sun)) / length(light) : 1.0;
  const double depth_along = any ? dot(row_of(m, 2), sun) / length(row_of(m, 2)) : -1.0;
  const double off = std::acos(std::min(along, 1.0)) * 180.0 / std::numbers::pi;
  s.say_if(Kind::cloud_sun, off > 3.0, "FrameInputs::clouds looks ", off,
           " degrees past the sun; expected a map along Sun::direction_to_sun");
  // Depths are compared along the sunlight only, so they may be altitudes, even with a sun at the horizon.
  s.say_if(Kind::cloud_depth, depth_along > -1e-3 && off <= 3.0,
           "the depth of FrameInputs::clouds does not grow away from the sun; expected 0 nearest to the sun, whatever "
           "EffectDesc::shadow_depth_reversed is");
  const bool occluded = !is_homogeneous(p) && p.multiple == MultipleScattering::occluded;
  s.say_if(Kind::cloud_unused, any && p.single == SingleScattering::none && !occluded,
           "there are FrameInputs::clouds, but scattering.single is none and scattering.multiple is not occluded: "
           "nothing will be darkened");
}

}  // namespace

void Remarks::on_frame(const FrameInputs& inputs, const FrameState& state, const DeviceInfo& device) {
  if (device.message == nullptr) return;
  const std::uint32_t view = std::min(inputs.view, kMaxViews - 1);
  Speaker s(device, said_[view]);
  const ScatteringParams& p = state.params.scattering;
  remark_on_sun(s, inputs);
  // The remark requires two frames in succession (or the first frame), because a rolling camera may pass through such a
  // position.
  Before& before = before_[view];
  const bool suspect = looks_inverted(inputs, state, before.known ? &before.world_from_view : nullptr);
  const bool inverse = suspect && (before.suspect || !before.known);
  before = {true, suspect, inputs.camera.world_from_view};
  remark_on_view(s, inputs, state, inverse);
  remark_on_projection(s, inputs, state);
  s.say_if(Kind::no_cascades, p.light_shafts && inputs.cascades.empty(),
           "scattering.light_shafts is on, but FrameInputs::cascades is empty; expected shadow cascades: "
           "nothing will be shadowed");
  s.say_if(Kind::no_shafts, inputs.shadow_colors.view != VK_NULL_HANDLE && (inputs.cascades.empty() || !p.light_shafts),
           "there are FrameInputs::shadow_colors, but no light shafts for them: nothing will be coloured");
  if (p.light_shafts && !inputs.cascades.empty()) remark_on_cascades(s, inputs, state, inverse);
  remark_on_clouds(s, inputs, p);
  s.say_if(Kind::tables, p.enabled && reads_tables(p) && !state.tables_ready,
           "the scattering tables are not built; expected record_precompute() until its progress is "
           "complete: there is no in-scattering before");
}

}  // namespace tyndall
