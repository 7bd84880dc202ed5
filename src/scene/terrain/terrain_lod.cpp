#include "scene/terrain/terrain_lod.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tyndall::scene {
namespace {

double distance_to_square(const glm::dvec2& p, const glm::dvec2& low, const glm::dvec2& high, double vertical) {
  const glm::dvec2 nearest = glm::clamp(p, low, high);
  return std::sqrt(glm::dot(p - nearest, p - nearest) + vertical * vertical);
}

// Returns the largest distance, measured on an azimuthal equidistant map projection, between a position on the planet
// and the points that are reach_m away from it.
double reach_on_projection(const glm::dvec2& place, double reach_m, double radius_m) {
  constexpr int kDirections = 64;
  const double distance_m = glm::length(place);
  const double arc = distance_m / radius_m;
  const double reach = std::min(reach_m / radius_m, std::numbers::pi);
  double out = reach_m;
  // Seen from the centre of the projection, the position is at azimuth 0, and both sides are symmetric.
  for (int i = 0; distance_m > 0.0 && i <= kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    const double up = std::cos(arc) * std::cos(reach) - std::sin(arc) * std::sin(reach) * std::cos(angle);
    const double along = std::sin(arc) * std::cos(reach) + std::cos(arc) * std::sin(reach) * std::cos(angle);
    const double across = std::sin(reach) * std::sin(angle);
    const double horizontal = std::hypot(along, across);
    const double away_m = std::atan2(horizontal, up) * radius_m;
    const double scale = horizontal > 0.0 ? away_m / horizontal : 0.0;
    out = std::max(out, std::hypot(along * scale - distance_m, across * scale));
  }
  return out;
}

struct Selection {
  const TerrainLod& lod;
  int finest_layer;
  const std::function<bool(const glm::dvec2&, const glm::dvec2&)>& visible;
  std::vector<TerrainBlock>& out;

  // Selects the block at block coordinates (bx, bz) of a layer, or the finer blocks that it consists of.
  void visit(int layer, int bx, int bz) const {
    const ClipLevel& level = lod.levels[static_cast<std::size_t>(layer)];
    const double size = lod.block_cells() * level.cell_m;
    const glm::dvec2 low(bx * size, bz * size);
    const glm::dvec2 high = low + glm::dvec2(size);
    if (!visible(low, high)) return;
    if (layer > finest_layer) {
      const double finer = lod.range_m(lod.levels[static_cast<std::size_t>(layer) - 1]);
      if (distance_to_square(lod.camera_map, low, high, lod.vertical_m) < finer) {
        for (int i = 0; i < 4; ++i) visit(layer - 1, 2 * bx + (i & 1), 2 * bz + (i >> 1));
        return;
      }
    }
    out.push_back({bx * lod.block_cells(), bz * lod.block_cells(), layer, 0});
  }
};

}  // namespace

int coarseness_for_picture(std::uint32_t height_px, double tan_half_height) {
  const double pixel = 2.0 * tan_half_height / std::max(height_px, 1U);
  const double cells = 2.0 * pixel * kRangeCells;
  return cells >= 4.0 ? 4 : cells >= 2.0 ? 2 : 1;
}

TerrainLod plan_terrain(const glm::dvec2& camera_map, double altitude_m, double max_ground_m, double radius_m,
                        int coarseness, double min_ground_m) {
  TerrainLod out;
  out.coarseness = coarseness;
  out.camera_map = camera_map;
  out.vertical_m = std::max(altitude_m - max_ground_m, 0.0);
  // The arc from the camera to its horizon, plus the arc from there to the farthest summit that rises above it.
  const double lowest = std::min(min_ground_m, 0.0);
  const double base = radius_m + lowest;
  const auto horizon_arc = [&](double h) { return radius_m * std::acos(base / (base + std::max(h - lowest, 1.0))); };
  out.reach_m =
      reach_on_projection(camera_map, 1.01 * (horizon_arc(altitude_m) + horizon_arc(max_ground_m)) + 1000.0, radius_m);
  for (int k = 0; k < 30; ++k) {
    ClipLevel level;
    level.level = k;
    level.cell_m = kFinestCell_m * std::exp2(k);
    const double range = out.range_m(level);
    if (range <= out.vertical_m) continue;  // the camera is too high to see anything this fine
    const glm::dvec2 cell = glm::floor(camera_map / (2.0 * level.cell_m));
    level.origin = 2 * glm::ivec2(cell) - out.level_samples() / 2;
    out.levels.push_back(level);
    const double slant = std::hypot(out.reach_m, out.vertical_m);
    if (range >= slant || out.levels.size() == kMaxLevels) break;
  }
  return out;
}

void select_blocks(const TerrainLod& lod, int finest_layer,
                   const std::function<bool(const glm::dvec2&, const glm::dvec2&)>& visible,
                   std::vector<TerrainBlock>& out) {
  out.clear();
  if (lod.levels.empty()) return;
  const int top = static_cast<int>(lod.levels.size()) - 1;
  const ClipLevel& coarsest = lod.levels.back();
  const double size = lod.block_cells() * coarsest.cell_m;
  const double reach = std::min(lod.reach_m, lod.range_m(coarsest));
  const glm::ivec2 first(glm::floor((lod.camera_map - reach) / size));
  const glm::ivec2 last(glm::floor((lod.camera_map + reach) / size));
  const Selection selection{lod, std::min(finest_layer, top), visible, out};
  for (int bz = first.y; bz <= last.y; ++bz) {
    for (int bx = first.x; bx <= last.x; ++bx) {
      const glm::dvec2 low(bx * size, bz * size);
      if (distance_to_square(lod.camera_map, low, low + size, 0.0) > reach) continue;
      selection.visit(top, bx, bz);
    }
  }
}

}  // namespace tyndall::scene
