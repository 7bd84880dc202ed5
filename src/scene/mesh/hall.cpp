#include "scene/mesh/hall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "math/angles.hpp"
#include "scene/mesh/hall_glass.hpp"

namespace tyndall::scene {
namespace {

using Vec = glm::dvec3;

constexpr double kHalfWidth_m = 6.0;  // interior half width of the nave
constexpr double kHalfLength_m = 18.0;
constexpr double kFloor_m = 0.15;
constexpr double kWall_m = 0.8;    // thickness of walls
constexpr double kSpring_m = 8.5;  // height at which the vault begins
constexpr double kRise_m = 7.0;    // height of the vault
constexpr double kBay_m = 6.0;
constexpr int kBays = 6;
constexpr double kGlass_m = 0.5;    // distance of panes behind the inner face of the wall
constexpr double kBehind_m = 0.05;  // width of panes that stone hides on each side
constexpr double kSill_m = 2.6;
constexpr Lancet kWindow = {1.1, 3.4, 5.3};  // heights are above the sill
constexpr Vec kRose = {0.0, 9.8, kHalfLength_m};
constexpr double kRoseRadius_m = 2.6;
constexpr int kSlices = 32;  // vertical slices into which an opening is divided

enum Material : std::uint32_t { kStone, kTiles, kWood, kRoof, kFirstGlass, kRoseGlass = kFirstGlass + 4, kMaterials };

// Returns the height of the vault's inner surface, or of the surface that is `out_m` outside of it. Both consist of two
// arcs that meet in a ridge.
double vault_at(double x, double out_m = 0.0) {
  const double centre = (kRise_m * kRise_m - kHalfWidth_m * kHalfWidth_m) / (2.0 * kHalfWidth_m);
  const double radius = kHalfWidth_m + centre + out_m;
  const double d = std::abs(x) + centre;
  return kSpring_m + std::sqrt(std::max(radius * radius - d * d, 0.0));
}

// Collects triangles by material.
class Builder {
 public:
  // Adds a quad whose corners are counter-clockwise seen from the front. The texture of stone repeats every 4 m of the
  // world.
  void quad(Material material, const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
    const Vec n = glm::cross(c - a, d - b);
    if (glm::length(n) < 1e-9) return;
    const Vec normal = glm::normalize(n);
    quad(material, {a, b, c, d}, {normal, normal, normal, normal}, laid(material, {a, b, c, d}, normal));
  }

  void quad(Material material, const std::array<Vec, 4>& p, const std::array<Vec, 4>& n,
            const std::array<glm::dvec2, 4>& uv) {
    const auto base = static_cast<std::uint32_t>(out_.vertices.size());
    for (std::size_t i = 0; i < 4; ++i) {
      MeshVertex v;
      v.position = glm::vec3(p[i]);
      v.normal = glm::vec3(glm::normalize(n[i]));
      v.uv = glm::vec2(uv[i]);
      out_.vertices.push_back(v);
      out_.bounds.add(p[i]);
    }
    for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) indices_[material].push_back(base + i);
  }

  void box(Material material, const Vec& low, const Vec& high) {
    const auto p = [&](int i) {
      return Vec((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
    };
    for (const auto& f :
         {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
      quad(material, p(f[0]), p(f[1]), p(f[2]), p(f[3]));
    }
  }

  void cylinder(Material material, double x, double z, double radius, double low,
                const std::function<double(double)>& top) {
    constexpr int kSides = 24;
    for (int i = 0; i < kSides; ++i) {
      const auto n = [&](int k) {
        return Vec(std::cos(2.0 * kPi * k / kSides), 0.0, -std::sin(2.0 * kPi * k / kSides));
      };
      const auto p = [&](int k, bool high) {
        Vec out = Vec(x, low, z) + n(k) * radius;
        if (high) out.y = top(out.x);
        return out;
      };
      const auto uv = [&](int k, const Vec& q) { return glm::dvec2(radius * 2.0 * kPi * k / kSides, -q.y) / 4.0; };
      const std::array<Vec, 4> q = {p(i, false), p(i + 1, false), p(i + 1, true), p(i, true)};
      quad(material, q, {n(i), n(i + 1), n(i + 1), n(i)}, {uv(i, q[0]), uv(i + 1, q[1]), uv(i + 1, q[2]), uv(i, q[3])});
      quad(material, q[3], q[2], Vec(x, top(x), z), Vec(x, top(x), z));  // the lid
      if (low > kFloor_m) quad(material, q[1], q[0], Vec(x, low, z), Vec(x, low, z));
    }
  }

  MeshData take() {
    for (std::uint32_t m = 0; m < kMaterials; ++m) {
      if (indices_[m].empty()) continue;
      MeshPart part;
      part.first_index = static_cast<std::uint32_t>(out_.indices.size());
      part.index_count = static_cast<std::uint32_t>(indices_[m].size());
      part.material = m;
      out_.indices.insert(out_.indices.end(), indices_[m].begin(), indices_[m].end());
      out_.parts.push_back(part);
    }
    out_.meshes.push_back({0, static_cast<std::uint32_t>(out_.parts.size()), 0, 1});
    out_.instances.emplace_back(1.0F);
    return std::move(out_);
  }

  MeshData& data() { return out_; }

 private:
  static std::array<glm::dvec2, 4> laid(Material material, const std::array<Vec, 4>& p, const Vec& n) {
    const double size = material == kTiles ? 2.0 : 4.0;
    std::array<glm::dvec2, 4> out;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec& q = p[i];
      out[i] = (std::abs(n.y) > 0.7             ? glm::dvec2(q.x, q.z)
                : std::abs(n.x) > std::abs(n.z) ? glm::dvec2(q.z, -q.y)
                                                : glm::dvec2(q.x, -q.y)) /
               size;
    }
    return out;
  }

  MeshData out_;
  std::array<std::vector<std::uint32_t>, kMaterials> indices_;
};

// A wall: its inner face starts at `origin` and extends along `along`, and `out` points away from the room. Looking
// out, +along is to the right.
struct Frame {
  Vec origin, along, out;
  [[nodiscard]] Vec at(double u, double y, double n) const { return origin + along * u + Vec(0, y, 0) + out * n; }
};

// An opening of a wall over [middle - half, middle + half], between two curves.
struct Opening {
  double middle, half;
  std::function<double(double)> low, high;  // heights as functions of the distance from the middle
  Material glass;
  glm::dvec2 picture_low, picture_high;  // corners of the picture: distance from the middle, and height
};

void wall(Builder& b, const Frame& f, double from, double to, const std::function<double(double)>& top,
          const std::vector<Opening>& openings, int smoothness) {
  // Adds a part without an opening, from the ground up.
  const auto face = [&](double u0, double u1, double low0, double low1, double high0, double high1) {
    b.quad(kStone, f.at(u0, low0, 0), f.at(u1, low1, 0), f.at(u1, high1, 0), f.at(u0, high0, 0));
    b.quad(kStone, f.at(u1, low1, kWall_m), f.at(u0, low0, kWall_m), f.at(u0, high0, kWall_m),
           f.at(u1, high1, kWall_m));
  };
  // The heights at which openings begin and end divide the wall into rows.
  std::vector<double> rows;
  if (!openings.empty())
    rows = {openings.front().low(openings.front().half), openings.front().high(openings.front().half)};
  const auto solid = [&](double u0, double u1) {
    for (int i = 0; i < smoothness; ++i) {
      const double a = u0 + (u1 - u0) * i / smoothness;
      const double c = u0 + (u1 - u0) * (i + 1) / smoothness;
      // The wall between openings is divided into the same rows, because T-junctions would let light through.
      double low = 0.0;
      for (const double row : rows) {
        if (row <= low) continue;
        face(a, c, std::min(low, top(a)), std::min(low, top(c)), std::min(row, top(a)), std::min(row, top(c)));
        low = row;
      }
      face(a, c, std::min(low, top(a)), std::min(low, top(c)), top(a), top(c));
      b.quad(kStone, f.at(a, top(a), 0), f.at(c, top(c), 0), f.at(c, top(c), kWall_m), f.at(a, top(a), kWall_m));
    }
  };
  double at = from;
  for (const Opening& o : openings) {
    solid(at, o.middle - o.half);
    for (int i = 0; i < kSlices; ++i) {
      // The slices are narrower towards the sides, where the edge of a round window is steep.
      const auto place = [&](int k) { return -o.half * std::cos(kPi * k / kSlices); };
      const double x0 = place(i), x1 = place(i + 1);
      const double u0 = o.middle + x0, u1 = o.middle + x1;
      const double l0 = o.low(x0), l1 = o.low(x1), h0 = o.high(x0), h1 = o.high(x1);
      face(u0, u1, 0, 0, l0, l1);
      face(u0, u1, h0, h1, top(u0), top(u1));
      b.quad(kStone, f.at(u0, top(u0), 0), f.at(u1, top(u1), 0), f.at(u1, top(u1), kWall_m),
             f.at(u0, top(u0), kWall_m));
      b.quad(kStone, f.at(u0, l0, 0), f.at(u1, l1, 0), f.at(u1, l1, kWall_m), f.at(u0, l0, kWall_m));  // the sill
      b.quad(kStone, f.at(u0, h0, kWall_m), f.at(u1, h1, kWall_m), f.at(u1, h1, 0), f.at(u0, h0, 0));  // the arch
      const auto uv = [&](double x, double y) {
        return glm::dvec2((x - o.picture_low.x) / (o.picture_high.x - o.picture_low.x),
                          (o.picture_high.y - y) / (o.picture_high.y - o.picture_low.y));
      };
      // The panes extend behind the stone, so that no texel of the shadow colours next to them is lit without colour.
      const double wider = 1.0 + kBehind_m / o.half;
      const auto pane = [&](double x, double y) { return f.at(o.middle + x * wider, y, kGlass_m); };
      b.quad(o.glass,
             {pane(x1, l1 - kBehind_m), pane(x0, l0 - kBehind_m), pane(x0, h0 + kBehind_m), pane(x1, h1 + kBehind_m)},
             {f.out, f.out, f.out, f.out},
             {uv(x1 * wider, l1 - kBehind_m), uv(x0 * wider, l0 - kBehind_m), uv(x0 * wider, h0 + kBehind_m),
              uv(x1 * wider, h1 + kBehind_m)});
    }
    // Jambs, if the height of the opening is not zero at its sides.
    const double left = o.middle - o.half, right = o.middle + o.half;
    const double l = o.low(o.half), h = o.high(o.half);
    b.quad(kStone, f.at(left, l, 0), f.at(left, l, kWall_m), f.at(left, h, kWall_m), f.at(left, h, 0));
    b.quad(kStone, f.at(right, l, kWall_m), f.at(right, l, 0), f.at(right, h, 0), f.at(right, h, kWall_m));
    at = right;
  }
  solid(at, to);
  for (const auto& [u, flip] : {std::pair{from, false}, {to, true}}) {  // the ends of the wall
    const Vec p[] = {f.at(u, 0, 0), f.at(u, 0, kWall_m), f.at(u, top(u), kWall_m), f.at(u, top(u), 0)};
    if (flip) {
      b.quad(kStone, p[0], p[1], p[2], p[3]);
    } else {
      b.quad(kStone, p[3], p[2], p[1], p[0]);
    }
  }
}

void side_walls(Builder& b) {
  constexpr double kIntoGable_m = 0.4;
  constexpr double kBehindVault_m = 0.2;
  for (const double side : {-1.0, 1.0}) {
    const Frame f = {Vec(side * kHalfWidth_m, 0, 0), Vec(0, 0, side), Vec(side, 0, 0)};
    std::vector<Opening> openings;
    for (int bay = 0; bay < kBays; ++bay) {
      Opening o;
      o.middle = kBay_m * (bay + 0.5) - kHalfLength_m;
      o.half = kWindow.half_width_m;
      o.low = [](double) { return kSill_m; };
      o.high = [](double x) {
        // Returns the height at which the half width of the arch is |x|: the inverse of half_at().
        const double rise = kWindow.top_m - kWindow.spring_m;
        const double centre =
            (rise * rise - kWindow.half_width_m * kWindow.half_width_m) / (2.0 * kWindow.half_width_m);
        const double radius = kWindow.half_width_m + centre;
        const double d = std::min(std::abs(x) + centre, radius);
        return kSill_m + kWindow.spring_m + std::sqrt(radius * radius - d * d);
      };
      o.glass = static_cast<Material>(kFirstGlass + static_cast<std::uint32_t>(bay + (side > 0.0 ? 1 : 0)) % 4U);
      o.picture_low = {-kWindow.half_width_m, kSill_m};
      o.picture_high = {kWindow.half_width_m, kSill_m + kWindow.top_m};
      openings.push_back(o);
    }
    // The wall extends up behind the vault: their edges have different vertices, and would leave gaps.
    wall(
        b, f, -kHalfLength_m - kIntoGable_m, kHalfLength_m + kIntoGable_m,
        [](double) { return kSpring_m + kBehindVault_m; }, openings, 1);
  }
}

void gables(Builder& b) {
  const double half = kHalfWidth_m + kWall_m;
  const auto top = [](double x) { return vault_at(std::abs(x), kWall_m); };
  Opening rose;
  rose.middle = kRose.x;
  rose.half = kRoseRadius_m;
  rose.low = [](double x) { return kRose.y - std::sqrt(std::max(kRoseRadius_m * kRoseRadius_m - x * x, 0.0)); };
  rose.high = [](double x) { return kRose.y + std::sqrt(std::max(kRoseRadius_m * kRoseRadius_m - x * x, 0.0)); };
  rose.glass = kRoseGlass;
  rose.picture_low = {-kRoseRadius_m, kRose.y - kRoseRadius_m};
  rose.picture_high = {kRoseRadius_m, kRose.y + kRoseRadius_m};
  wall(b, {Vec(0, 0, kHalfLength_m), Vec(-1, 0, 0), Vec(0, 0, 1)}, -half, half, top, {rose}, 24);
  wall(b, {Vec(0, 0, -kHalfLength_m), Vec(1, 0, 0), Vec(0, 0, -1)}, -half, half, top, {}, 48);
}

// Adds the smooth inner surface of the vault and the roof above it.
void vault(Builder& b) {
  constexpr int kSteps = 48;
  const double reach = kHalfLength_m + 0.4;
  const auto place = [](int i, double half) { return -half * std::cos(kPi * i / kSteps); };
  const auto inner = [&](int i, double z) {
    const double x = place(i, kHalfWidth_m);
    return Vec(x, vault_at(x), z);
  };
  const auto outer = [&](int i, double z) {
    const double x = place(i, kHalfWidth_m + kWall_m);
    return Vec(x, vault_at(x, kWall_m), z);
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int bay = 0; bay < kBays; ++bay) {
      const double z0 = -kHalfLength_m + kBay_m * bay, z1 = z0 + kBay_m;
      b.quad(kStone, inner(i, z0), inner(i + 1, z0), inner(i + 1, z1), inner(i, z1));
    }
    b.quad(kRoof, outer(i, reach), outer(i + 1, reach), outer(i + 1, -reach), outer(i, -reach));
    // Ribs between the bays.
    for (int bay = 0; bay <= kBays; ++bay) {
      const double z = -kHalfLength_m + kBay_m * bay;
      const auto low = [&](int k, double dz) {
        Vec p = inner(k, z + dz);
        const Vec to_axis = glm::normalize(Vec(-p.x, kSpring_m - p.y, 0.0));
        return p + to_axis * 0.35;
      };
      b.quad(kStone, low(i, -0.22), low(i + 1, -0.22), low(i + 1, 0.22), low(i, 0.22));
      b.quad(kStone, inner(i, z - 0.22), inner(i + 1, z - 0.22), low(i + 1, -0.22), low(i, -0.22));
      b.quad(kStone, low(i, 0.22), low(i + 1, 0.22), inner(i + 1, z + 0.22), inner(i, z + 0.22));
    }
  }
}

void furniture(Builder& b) {
  b.box(kTiles, Vec(-kHalfWidth_m - 0.4, 0.0, -kHalfLength_m - 0.4),
        Vec(kHalfWidth_m + 0.4, kFloor_m, kHalfLength_m + 0.4));
  for (int bay = 0; bay <= kBays; ++bay) {
    const double z = -kHalfLength_m + kBay_m * bay;
    for (const double side : {-1.0, 1.0}) {
      // Pilasters at the wall, and columns in the room.
      const double x = side * (kHalfWidth_m - 0.15);
      b.box(kStone, Vec(x - 0.2, 0.0, z - 0.3), Vec(x + 0.2, kSpring_m + 0.3, z + 0.3));
      if (bay == 0 || bay == kBays) continue;
      const double column = side * 3.5;
      const auto flat = [](double y) { return [y](double) { return y; }; };
      b.cylinder(kStone, column, z, 0.36, kFloor_m, [](double at) { return vault_at(at); });
      b.cylinder(kStone, column, z, 0.55, kFloor_m, flat(0.45));
      b.cylinder(kStone, column, z, 0.46, 0.45, flat(0.75));
      b.cylinder(kStone, column, z, 0.48, 7.3, flat(7.8));
      b.cylinder(kStone, column, z, 0.58, 7.8, flat(8.0));
    }
  }
  for (int row = 0; row < 14; ++row) {
    const double z = -6.5 + 1.55 * row;
    for (const double side : {-1.0, 1.0}) {
      const double low = side > 0.0 ? 0.9 : -2.9;
      const double high = low + 2.0;
      b.box(kWood, Vec(low, kFloor_m + 0.40, z), Vec(high, kFloor_m + 0.45, z + 0.42));
      b.box(kWood, Vec(low, kFloor_m + 0.50, z - 0.05), Vec(high, kFloor_m + 0.92, z));
      b.box(kWood, Vec(low, kFloor_m, z - 0.05), Vec(low + 0.06, kFloor_m + 0.92, z + 0.42));
      b.box(kWood, Vec(high - 0.06, kFloor_m, z - 0.05), Vec(high, kFloor_m + 0.92, z + 0.42));
    }
  }
}

MeshMaterial plain(const char* name, const glm::vec4& color, int texture) {
  MeshMaterial out;
  out.name = name;
  out.color = color;
  out.texture = texture;
  return out;
}

}  // namespace

MeshData make_hall() {
  Builder b;
  MeshData& d = b.data();
  d.textures = {ashlar(), floor_tiles()};
  d.materials = {plain("stone", glm::vec4(1.0F), 0), plain("tiles", glm::vec4(1.0F), 1),
                 plain("wood", {0.10F, 0.055F, 0.03F, 1.0F}, -1), plain("roof", {0.10F, 0.10F, 0.12F, 1.0F}, -1)};
  for (std::uint32_t i = 0; i <= 4; ++i) {
    MeshMaterial glass = plain(i < 4 ? "lancet" : "rose", glm::vec4(1.0F), static_cast<int>(d.textures.size()));
    d.textures.push_back(i < 4 ? lancet_glass(kWindow, i) : rose_glass(kRoseRadius_m));
    glass.kind = SurfaceKind::glass;
    glass.transmission = 1.0F;
    glass.double_sided = true;
    d.materials.push_back(glass);
  }
  side_walls(b);
  gables(b);
  vault(b);
  furniture(b);
  return b.take();
}

}  // namespace tyndall::scene
