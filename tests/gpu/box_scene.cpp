#include "box_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "image/metrics.hpp"

namespace tyndall {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kPlanetRadius_m = 6.36e6;  // the default of planet.radius_m

double hit_box(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& from, const glm::dvec3& direction) {
  double enter = -kNone;
  double leave = kNone;
  for (int i = 0; i < 3; ++i) {
    const double step = std::abs(direction[i]) > 1e-12 ? direction[i] : 1e-12;
    const double a = (low[i] - from[i]) / step;
    const double b = (high[i] - from[i]) / step;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave && leave > 0.0 ? std::max(enter, 0.0) : kNone;
}

double hit_planet(double altitude_m, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 p = from + glm::dvec3(0.0, kPlanetRadius_m, 0.0);
  const double b = glm::dot(p, direction);
  const double c = from.x * from.x + from.z * from.z + from.y * (from.y + 2.0 * kPlanetRadius_m) -
                   altitude_m * (altitude_m + 2.0 * kPlanetRadius_m);
  const double square = b * b - c;
  if (square < 0.0 || b > 0.0) return kNone;
  return std::max(c / (-b + std::sqrt(square)), 0.0);
}

// Buildings up to 30 km north of the camera, which is at the origin. Light shafts pass through the gaps between them.
const std::vector<Box> kBuildings = {
    {{-2500, 0, -9000}, {-1700, 2600, -8200}},   {{-900, 0, -9500}, {-300, 3400, -8900}},
    {{600, 0, -9200}, {900, 2200, -8800}},       {{1500, 0, -7500}, {2600, 1700, -7000}},
    {{-5200, 0, -14000}, {-4000, 4200, -12500}}, {{300, 0, -16000}, {1900, 4800, -15500}},
    {{3500, 0, -15000}, {4200, 3900, -14000}},   {{-700, 0, -4200}, {-350, 1500, -3900}},
    {{6000, 0, -26000}, {9500, 5000, -24000}},   {{-12000, 0, -29000}, {-7000, 5500, -27000}},
    {{900, 1500, -5200}, {1500, 1800, -4800}},  // hovers
    {{-4000, 0, 3000}, {4000, 2500, 4000}},     // behind the camera
};

double first_hit(const BoxScene& scene, bool ground, const glm::dvec3& from, const glm::dvec3& direction) {
  double nearest = ground ? hit_planet(scene.ground_altitude_m, from, direction) : kNone;
  if (!scene.buildings) return nearest;
  const glm::dvec3 above = from - glm::dvec3(0.0, scene.ground_altitude_m, 0.0);
  for (const Box& box : scene.own_buildings.empty() ? kBuildings : scene.own_buildings) {
    nearest =
        std::min(nearest, scene.building_size * hit_box(box.low, box.high, above / scene.building_size, direction));
  }
  return nearest;
}

glm::dvec3 direction_to_sun(const BoxScene& scene, const TestView& view) {
  if (scene.sun.in_view) {
    const glm::dvec3 towards = view.forward + view.right * (scene.sun.x * view.tan_half_width) -
                               view.up * (scene.sun.y * view.tan_half_height);
    return glm::normalize(scene.sun.behind ? -towards : towards);
  }
  const double e = scene.sun.elevation_deg * kRad;
  const double a = scene.sun.azimuth_deg * kRad;
  return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

// A square shadow map that covers the view up to a depth of far_m.
struct Map {
  glm::dvec3 middle, right, up, to_sun;
  double half_m, half_depth_m;
};

float shown(double linear) {
  const double clamped = std::clamp(linear, 0.0, 1.0);
  const double encoded = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055;
  return static_cast<float>(std::round(255.0 * encoded) / 255.0);
}

}  // namespace

BoxScene sun_at(const std::string& name, double x, double y, double pitch_deg, bool behind) {
  BoxScene scene;
  scene.name = name;
  scene.sun.in_view = true;
  scene.sun.x = x;
  scene.sun.y = y;
  scene.sun.behind = behind;
  scene.pitch_deg = pitch_deg;
  return scene;
}

TestFrame frame_of(const BoxScene& scene, const glm::dvec2& jitter_px) {
  TestFrame frame;
  frame.extent = scene.extent;
  frame.view = TestView::at(scene.altitude_m, scene.yaw_deg * kRad, scene.pitch_deg * kRad, scene.tan_half_height);
  frame.view.tan_half_width = scene.tan_half_height * scene.extent.width / scene.extent.height;
  frame.view.jitter_px = jitter_px;
  frame.convention = scene.convention;
  frame.shadow_depth_reversed = scene.shadow_depth_reversed;
  frame.shadow_resolution = scene.shadow_resolution;
  frame.first_marched = scene.first_marched;
  frame.to_sun = direction_to_sun(scene, frame.view);
  frame.irradiance = Vec3(10.0F);
  frame.lowest_ground_m = std::min(scene.ground_altitude_m, 0.0);
  frame.background = {0.02F, 0.03F, 0.05F};
  frame.distance_m = [scene, view = frame.view](std::uint32_t x, std::uint32_t y) {
    const double t = first_hit(scene, scene.ground, view.position, view.ray(x, y, scene.extent));
    return t < kNone ? std::max(t, 2.0) : 0.0;
  };
  std::vector<Map> maps;
  for (std::uint32_t i = 0; i < scene.cascades; ++i) {
    Cascade cascade;
    // Each cascade is twice as deep as the previous one.
    const auto end = [&](std::uint32_t c) {
      return scene.far_m * std::ldexp(1.0, static_cast<int>(c) - static_cast<int>(scene.cascades) + 1);
    };
    cascade.near_m = i <= scene.first_marched ? 0.0F : static_cast<float>(end(i - 1));
    cascade.far_m = static_cast<float>(end(i));
    Map map;
    map.to_sun = frame.to_sun;
    const glm::dvec3 helper = std::abs(map.to_sun.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    map.right = glm::normalize(glm::cross(helper, map.to_sun));
    map.up = glm::cross(map.to_sun, map.right);
    map.middle = frame.view.position + frame.view.forward * (0.5 * end(i));
    // The map contains the camera and the corners of the view at the end of the cascade.
    const double corner = std::hypot(frame.view.tan_half_width, frame.view.tan_half_height);
    map.half_m = end(i) * (0.5 + 0.5 * corner);
    map.half_depth_m = 2.0 * scene.far_m + 10000.0;
    const glm::dvec3 rows[3] = {map.right * (0.5 / map.half_m), map.up * (0.5 / map.half_m),
                                map.to_sun * (-0.5 / map.half_depth_m)};
    for (int r = 0; r < 3; ++r) {
      const double offset = 0.5 - glm::dot(rows[r], map.middle);
      const bool flipped = r == 2 && scene.shadow_depth_reversed;
      for (int c = 0; c < 3; ++c) {
        cascade.shadow_from_world.m[4 * c + r] = static_cast<float>(flipped ? -rows[r][c] : rows[r][c]);
      }
      cascade.shadow_from_world.m[12 + r] = static_cast<float>(flipped ? 1.0 - offset : offset);
    }
    maps.push_back(map);
    frame.cascades.push_back(cascade);
  }
  frame.shadow_depth = [scene, maps](std::uint32_t c, double u, double v) {
    const Map& map = maps[c];
    const glm::dvec3 from = map.middle + map.right * ((2.0 * u - 1.0) * map.half_m) +
                            map.up * ((2.0 * v - 1.0) * map.half_m) + map.to_sun * map.half_depth_m;
    const double t = first_hit(scene, scene.ground && scene.ground_casts, from, -map.to_sun);
    const double depth = t < kNone ? std::min(t / (2.0 * map.half_depth_m), 1.0) : 1.0;
    return static_cast<float>(scene.shadow_depth_reversed ? 1.0 - depth : depth);
  };
  if (scene.panes_m > 0.0) {
    frame.shadow_color = [scene, maps](std::uint32_t c, double u, double v) {
      const Map& map = maps[c];
      const glm::dvec3 place =
          map.middle + map.right * ((2.0 * u - 1.0) * map.half_m) + map.up * ((2.0 * v - 1.0) * map.half_m);
      const auto column = static_cast<long>(std::floor(glm::dot(place, map.right) / scene.panes_m));
      const auto row = static_cast<long>(std::floor(glm::dot(place, map.up) / scene.panes_m));
      constexpr glm::dvec3 kPanes[] = {
          {1.0, 0.15, 0.1}, {0.1, 0.4, 1.0}, {1.0, 1.0, 1.0}, {1.0, 0.75, 0.1}, {0.1, 0.8, 0.3}};
      return kPanes[static_cast<std::size_t>((column * 2 + row * 3) % 5 + 5) % 5];
    };
  }
  return frame;
}

Likeness compare(const std::vector<glm::dvec3>& picture, const std::vector<glm::dvec3>& reference, VkExtent2D extent) {
  double mean = 0.0;
  for (const glm::dvec3& pixel : reference) mean += glm::dot(pixel, glm::dvec3(0.2126, 0.7152, 0.0722));
  mean /= static_cast<double>(reference.size());
  const double exposure = mean > 0.0 ? -std::log(1.0 - 0.18) / mean : 1.0;
  image::Image shown_a(extent.width, extent.height);
  image::Image shown_b = shown_a;
  image::Image linear_a = shown_a;
  image::Image linear_b = shown_a;
  Likeness out;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = 3 * i + static_cast<std::size_t>(c);
      shown_a.rgb[at] = shown(1.0 - std::exp(-exposure * picture[i][c]));
      shown_b.rgb[at] = shown(1.0 - std::exp(-exposure * reference[i][c]));
      linear_a.rgb[at] = static_cast<float>(picture[i][c]);
      linear_b.rgb[at] = static_cast<float>(reference[i][c]);
      const double scale = std::max({reference[i][c], 0.01 * mean, 1e-30});
      out.worst_relative_error = std::max(out.worst_relative_error, std::abs(picture[i][c] - reference[i][c]) / scale);
    }
  }
  out.psnr_db = image::compare(shown_a, shown_b).psnr_db;
  out.mean_relative_error = image::compare(linear_a, linear_b).mean_relative_error;
  return out;
}

}  // namespace tyndall
