#include "scene/mesh/hall_glass.hpp"

#include <algorithm>
#include <cmath>

#include "math/angles.hpp"

namespace tyndall::scene {
namespace {

constexpr double kTexel_m = 0.01;
constexpr double kLead_m = 0.024;  // width of the lead between panes

// Transmission of each kind of glass, linear.
constexpr glm::vec3 kRuby = {0.70F, 0.035F, 0.03F};
constexpr glm::vec3 kCobalt = {0.03F, 0.10F, 0.70F};
constexpr glm::vec3 kAmber = {0.90F, 0.45F, 0.05F};
constexpr glm::vec3 kGreen = {0.06F, 0.50F, 0.14F};
constexpr glm::vec3 kViolet = {0.38F, 0.07F, 0.55F};
constexpr glm::vec3 kPale = {0.80F, 0.72F, 0.48F};
constexpr glm::vec3 kAzure = {0.12F, 0.45F, 0.75F};

std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  return x ^ (x >> 16U);
}

std::uint32_t hash(int a, int b, int c = 0) {
  return hash(static_cast<std::uint32_t>(a) * 0x9e3779b9U ^
              hash(static_cast<std::uint32_t>(b) * 0x85ebca6bU ^ hash(static_cast<std::uint32_t>(c))));
}

double unit(std::uint32_t h) { return static_cast<double>(h) / 4294967295.0; }

// A pane. There is lead between panes with different `id`; 0 is stone.
struct Pane {
  std::uint32_t id = 0;
  glm::vec3 color = {};
};

Pane pane(const glm::vec3& color, int a, int b, int c = 0) {
  const std::uint32_t id = hash(a, b, c) | 1U;
  // The brightness of old glass varies from pane to pane.
  return {id, color * static_cast<float>(0.72 + 0.28 * unit(hash(id)))};
}

std::uint8_t srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055)));
}

// Returns a texture in which each texel is at(x, y), where x and y are the coordinates of its middle [m].
template <typename At>
MeshTexture paint(double width_m, double height_m, double texel_m, const At& at) {
  MeshTexture out;
  out.width = static_cast<std::uint32_t>(std::lround(width_m / texel_m));
  out.height = static_cast<std::uint32_t>(std::lround(height_m / texel_m));
  out.rgba.reserve(std::size_t{4} * out.width * out.height);
  for (std::uint32_t j = 0; j < out.height; ++j) {
    for (std::uint32_t i = 0; i < out.width; ++i) {
      const glm::vec3 color = at((i + 0.5) / out.width * width_m, (j + 0.5) / out.height * height_m);
      for (int c = 0; c < 3; ++c) out.rgba.push_back(srgb(static_cast<double>(color[c])));
      out.rgba.push_back(255);
    }
  }
  return out;
}

// Returns the colour of the pane at a position, or black on the lead at its edge.
template <typename PaneAt>
glm::vec3 leaded(const PaneAt& pane_at, double x, double y) {
  const Pane here = pane_at(x, y);
  if (here.id == 0) return {};
  const double r = 0.5 * kLead_m;
  for (const auto& [dx, dy] : {std::pair{r, 0.0}, {-r, 0.0}, {0.0, r}, {0.0, -r}}) {
    if (pane_at(x + dx, y + dy).id != here.id) return {};
  }
  return here.color;
}

Pane lancet_pane(const Lancet& window, std::uint32_t design, double x, double y) {
  const glm::vec3 first[] = {kRuby, kCobalt, kViolet, kGreen};
  const glm::vec3 second[] = {kCobalt, kRuby, kAmber, kRuby};
  const glm::vec3 third[] = {kAmber, kGreen, kAzure, kAmber};
  const double edge = window.half_at(y) - std::abs(x);
  const int side = x < 0.0 ? -1 : 1;
  if (edge < 0.03 || std::abs(x) < 0.055) return {};       // frame and mullion
  if (std::abs(std::remainder(y, 0.9)) < 0.02) return {};  // saddle bars
  if (edge < 0.10) return pane(kPale, static_cast<int>(std::floor(y / 0.45)), side, 1);
  if (edge < 0.24) {
    const int step = static_cast<int>(std::floor(y / 0.225));
    return pane((step & 1) != 0 ? first[design] : second[design], step, side, 2);
  }
  // Medallions, one between each pair of bars, in both halves of the window.
  const double middle = 0.45 + 0.9 * std::floor(y / 0.9);
  const double dx = std::abs(x) - 0.43;
  const double dy = y - middle;
  const double r = std::hypot(dx, dy);
  const int row = static_cast<int>(std::lround(middle / 0.9)) * 2 + (side > 0 ? 1 : 0);
  if (window.half_at(middle + 0.3) > 0.75) {
    if (r < 0.11) return pane(third[design], row, 0, 3);
    if (r < 0.30) {
      const int sector = static_cast<int>(std::floor((std::atan2(dy, dx) + kPi) / (2.0 * kPi) * 8.0 + (row & 1) * 0.5));
      return pane((sector & 1) != 0 ? first[design] : second[design], row, sector, 4);
    }
    if (r < 0.35) return pane(kPale, row, static_cast<int>(std::floor((std::atan2(dy, dx) + kPi) * 2.0)), 5);
  }
  // Diamonds.
  const double u = (x * 1.25 + y) / 0.26;
  const double v = (x * 1.25 - y) / 0.26;
  const int a = static_cast<int>(std::floor(u));
  const int b = static_cast<int>(std::floor(v));
  const std::uint32_t pick = hash(a, b, static_cast<int>(design)) % 8U;
  const glm::vec3 color = pick < 3U ? second[design] : pick < 5U ? third[design] : pick < 7U ? kAzure : kPale;
  return pane(color, a, b, 6);
}

Pane rose_pane(double radius_m, double x, double y) {
  const double r = std::hypot(x, y) / radius_m;
  const double angle = (std::atan2(y, x) + kPi) / (2.0 * kPi);
  const auto sector = [&](int count, double shift) {
    return static_cast<int>(std::floor(angle * count + shift)) % count;
  };
  // Returns the distance to the spoke between two of `count` sectors [m].
  const auto spoke = [&](int count, double shift) {
    return std::abs(std::remainder(angle * count + shift, 1.0)) / count * 2.0 * kPi * r * radius_m;
  };
  if (r > 0.985) return {};
  if (r > 0.90) return pane((sector(48, 0.0) & 1) != 0 ? kRuby : kCobalt, sector(48, 0.0), 1, 10);
  if (r > 0.885 || std::abs(r - 0.53) < 0.012 || std::abs(r - 0.2) < 0.012) return {};  // stone rings
  if (r > 0.53) {
    if (spoke(12, 0.0) < 0.06) return {};
    const int s = sector(12, 0.0);
    const double axis = (s + 0.5) / 12.0 * 2.0 * kPi - kPi;
    const double dx = x / radius_m - 0.72 * std::cos(axis);
    const double dy = y / radius_m - 0.72 * std::sin(axis);
    const double d = std::hypot(dx, dy);
    if (d < 0.05) return pane(kAmber, s, 0, 11);
    if (d < 0.13) {
      const int petal = static_cast<int>(std::floor((std::atan2(dy, dx) - axis + 4.0 * kPi) / (2.0 * kPi) * 6.0)) % 6;
      return pane((s & 1) != 0 ? kRuby : kViolet, s, petal, 12);
    }
    return pane((s & 1) != 0 ? kCobalt : kAzure, s, r > 0.72 ? 1 : 0, 13);
  }
  if (r > 0.2) {
    if (spoke(12, 0.5) < 0.05) return {};
    const int s = sector(12, 0.5);
    return pane((s & 1) != 0 ? kCobalt : r > 0.36 ? kRuby : kAmber, s, r > 0.36 ? 1 : 0, 14);
  }
  if (r > 0.08) return pane((sector(6, 0.0) & 1) != 0 ? kGreen : kRuby, sector(6, 0.0), 0, 15);
  return pane(kAmber, 0, 0, 16);
}

}  // namespace

double Lancet::half_at(double y_m) const {
  if (y_m <= spring_m) return half_width_m;
  if (y_m >= top_m) return 0.0;
  // The arch consists of two arcs whose centres are at the height where it begins.
  const double rise = top_m - spring_m;
  const double centre = (rise * rise - half_width_m * half_width_m) / (2.0 * half_width_m);
  const double radius = half_width_m + centre;
  const double y = y_m - spring_m;
  return std::max(std::sqrt(std::max(radius * radius - y * y, 0.0)) - centre, 0.0);
}

MeshTexture lancet_glass(const Lancet& window, std::uint32_t design) {
  return paint(2.0 * window.half_width_m, window.top_m, kTexel_m, [&](double x, double y) {
    return leaded([&](double a, double b) { return lancet_pane(window, design % 4U, a, b); }, x - window.half_width_m,
                  window.top_m - y);
  });
}

MeshTexture rose_glass(double radius_m) {
  return paint(2.0 * radius_m, 2.0 * radius_m, kTexel_m, [&](double x, double y) {
    return leaded([&](double a, double b) { return rose_pane(radius_m, a, b); }, x - radius_m, radius_m - y);
  });
}

MeshTexture ashlar() {
  return paint(4.0, 4.0, 0.01, [](double x, double y) {
    const int course = static_cast<int>(std::floor(y / 0.5));
    const double shifted = x + ((course & 1) != 0 ? 0.5 : 0.0);
    const int block = static_cast<int>(std::floor(shifted)) % 4;
    const double joint = std::min(
        {y - 0.5 * course, 0.5 * (course + 1) - y, shifted - std::floor(shifted), std::floor(shifted) + 1.0 - shifted});
    const double tone = 0.86 + 0.14 * unit(hash(course, block, 7));
    const double grain = 0.96 + 0.08 * unit(hash(static_cast<int>(x * 50.0), static_cast<int>(y * 50.0), 8));
    const double light = 0.46 * tone * grain * (joint < 0.012 ? 0.72 : 1.0);
    return glm::vec3(light, 0.93 * light, 0.82 * light);
  });
}

MeshTexture floor_tiles() {
  return paint(2.0, 2.0, 0.01, [](double x, double y) {
    const int a = static_cast<int>(std::floor(x / 0.5));
    const int b = static_cast<int>(std::floor(y / 0.5));
    const double joint = std::min({x - 0.5 * a, 0.5 * (a + 1) - x, y - 0.5 * b, 0.5 * (b + 1) - y});
    const double tone = (((a ^ b) & 1) != 0 ? 0.50 : 0.30) * (0.88 + 0.12 * unit(hash(a, b, 9)));
    const double light = joint < 0.008 ? 0.2 : tone;
    return glm::vec3(light, 0.96 * light, 0.9 * light);
  });
}

}  // namespace tyndall::scene
