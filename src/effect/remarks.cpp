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
  unfinished,
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
  cascade_sun,
  cascade_depth
};

// One line of text in place; what does not fit is cut off.
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
  // `parts` of the text are put together only when it is said.
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
           "Sun::irradiance is 0; expected light: the air will be black");
}

void remark_on_view(Speaker& s, const FrameInputs& inputs, const FrameState& state) {
  const Mat4& m = inputs.camera.world_from_view;
  const double radius = static_cast<double>(state.params.planet.radius_m);
  const Mat4 inverted = rigid_inverse(m);
  const double altitude = altitude_of(column_of(m, 3), radius);
  const double other = altitude_of(column_of(inverted, 3), radius);
  // A camera that is level across has a horizontal x axis; the inverse of its matrix has not, unless it looks
  // level as well.
  const bool level = std::abs(m.m[1]) < 1e-5F;
  const bool other_level = std::abs(inverted.m[1]) < 1e-5F;
  const bool inverse = altitude < -1.0 && other > 1.0 && ((!level && other_level) || altitude < -500.0);
  s.say_if(Kind::view_inverse, inverse, "Camera::world_from_view puts the camera ", altitude,
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

// The part of the view that the first marched cascade is for, in its map.
struct Footprint {
  double low[2] = {1e300, 1e300};
  double high[2] = {-1e300, -1e300};
};

Footprint footprint(const Cascade& cascade, const FrameInputs& inputs, const shared::FrameConstants& frame) {
  const DVec3 camera = column_of(inputs.camera.world_from_view, 3);
  const DVec3 forward = wide(frame.camera_forward);
  const double reach_m = std::min(static_cast<double>(cascade.far_m), 1e6);
  Footprint out;
  for (int i = 0; i < 5; ++i) {
    DVec3 place = camera;
    if (i < 4) {
      DVec3 ray = sum(wide(frame.ray_origin), wide(frame.ray_x), i % 2 == 0 ? 0.0 : frame.width);
      ray = sum(ray, wide(frame.ray_y), i < 2 ? 0.0 : frame.height);
      place = sum(camera, ray, reach_m / std::max(dot(ray, forward), 1e-6));
    }
    for (int axis = 0; axis < 2; ++axis) {
      const double at = dot(row_of(cascade.shadow_from_world, axis), place) +
                        static_cast<double>(cascade.shadow_from_world.m[12 + axis]);
      out.low[axis] = std::min(out.low[axis], at);
      out.high[axis] = std::max(out.high[axis], at);
    }
  }
  return out;
}

void remark_on_coverage(Speaker& s, const FrameInputs& inputs, const FrameState& state) {
  const Footprint f = footprint(inputs.cascades[inputs.first_marched_cascade], inputs, state.frame);
  // A map of clip space is around (0, 0), and reaches from -1 to 1.
  bool clip = std::min(f.low[0], f.low[1]) < -0.3;
  bool elsewhere = false;
  double sizes = 0.0;  // of the view in the map
  for (int axis = 0; axis < 2; ++axis) {
    clip = clip && f.low[axis] > -1.3 && f.high[axis] < 1.3 && std::abs(f.low[axis] + f.high[axis]) < 0.8;
    const double size = f.high[axis] - f.low[axis];
    const double slack = 0.25 * size + 0.02;
    elsewhere = elsewhere || f.low[axis] - slack > 1.0 || f.high[axis] + slack < 0.0;
    sizes = std::max(sizes, size);
  }
  // A map that is much smaller than the view ends at what casts shadows, which may be out of sight; and what
  // is seen from high up may have no ground to be shadowed.
  constexpr float kHigh_m = 10000.0F;
  elsewhere = elsewhere && sizes < 20.0 && state.frame.camera_altitude_m < kHigh_m;
  s.say_if(Kind::cascade_clip, clip, "FrameInputs::cascades[first_marched_cascade] puts the view at ", f.low[0], " to ",
           f.high[0],
           " of its map; expected texture coordinates, 0 to 1: does shadow_from_world lead to clip space, -1 "
           "to 1?");
  s.say_if(Kind::cascade_elsewhere, elsewhere && !clip,
           "FrameInputs::cascades[first_marched_cascade] puts the view at u ", f.low[0], " to ", f.high[0], " and v ",
           f.low[1], " to ", f.high[1],
           " of its map; expected the camera and what it sees within 0 to 1: nothing will be shadowed");
}

void remark_on_cascades(Speaker& s, const FrameInputs& inputs, const FrameState& state) {
  const std::size_t first = inputs.first_marched_cascade;
  const std::size_t count = inputs.cascades.size();
  const double sun_m = length(wide(inputs.sun.direction_to_sun));
  const DVec3 sun = sum({}, wide(inputs.sun.direction_to_sun), 1.0 / sun_m);
  std::size_t empty = count, unordered = count, astray = count, upside_down = count;
  double degrees = 0.0;
  for (std::size_t i = first; i < count; ++i) {
    const Cascade& c = inputs.cascades[i];
    if (!(c.far_m > c.near_m)) empty = std::min(empty, i);
    if (i > first && c.far_m <= inputs.cascades[i - 1].far_m) unordered = std::min(unordered, i);
    // All that falls on one texel lies along the light.
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
           " m from the camera; expected 0: the air before it is taken as lit");
  remark_on_coverage(s, inputs, state);
}

}  // namespace

void Remarks::on_frame(const FrameInputs& inputs, const FrameState& state, const DeviceInfo& device) {
  if (device.message == nullptr) return;
  Speaker s(device, said_[std::min(inputs.view, kMaxViews - 1)]);
  const ScatteringParams& p = state.params.scattering;
  remark_on_sun(s, inputs);
  remark_on_view(s, inputs, state);
  remark_on_projection(s, inputs, state);
  s.say_if(Kind::no_cascades, p.light_shafts && inputs.cascades.empty(),
           "scattering.light_shafts is on, but FrameInputs::cascades is empty; expected shadow cascades: "
           "nothing will be shadowed");
  s.say_if(Kind::no_shafts, inputs.shadow_colors.view != VK_NULL_HANDLE && (inputs.cascades.empty() || !p.light_shafts),
           "there are FrameInputs::shadow_colors, but no light shafts for them: nothing will be coloured");
  if (p.light_shafts && !inputs.cascades.empty()) remark_on_cascades(s, inputs, state);
  const bool needs_tables = p.enabled && !is_homogeneous(p) &&
                            (p.single == SingleScattering::table || p.multiple != MultipleScattering::none);
  s.say_if(Kind::tables, needs_tables && !state.tables_ready,
           "the scattering tables are not built; expected record_precompute() until its progress is "
           "complete: the air is black before");
  s.say_if(Kind::unfinished, state.unfinished.has_value(), "frame_index ", inputs.frame_index,
           " takes the constants of frame ", state.unfinished.value_or(0),
           ", whose commands have not completed or were never submitted; expected at most "
           "EffectDesc::frames_in_flight (",
           std::uint64_t{state.desc.frames_in_flight}, ") frames at a time");
}

}  // namespace tyndall
