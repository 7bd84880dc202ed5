// scattering.medium = homogeneous: compares the closed form with a quadrature of the published integral in double
// precision, and epipolar sampling with brute force.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

using HomogeneousMedium = SharedEffect;

Params homogeneous_params() {
  Params params = small_params();
  params.scattering.medium = MediumKind::homogeneous;
  return params;
}

// The tests set all coefficients, so that they do not depend on the library's derivation of them.
constexpr glm::dvec3 kRayleigh = {6e-6, 14e-6, 33e-6};
constexpr glm::dvec3 kMieScattering = {3e-5, 2e-5, 1e-5};
constexpr glm::dvec3 kMieAbsorption = {1e-6, 2e-6, 4e-6};
constexpr double kG = 0.7;

Params with_coefficients(double density) {
  Params params = homogeneous_params();
  const auto vec = [](const glm::dvec3& v) {
    return Vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
  };
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.rayleigh_scattering = vec(kRayleigh);
  params.atmosphere.mie_scattering = vec(kMieScattering);
  params.atmosphere.mie_absorption = vec(kMieAbsorption);
  params.atmosphere.mie_g = static_cast<float>(kG);
  params.atmosphere.mie_phase = MiePhase::henyey_greenstein;
  params.scattering.scale = 1.0F;
  params.scattering.technique = Technique::brute_force;
  params.homogeneous_medium.density = static_cast<float>(density);
  params.homogeneous_medium.extent_m = 12000.0F;
  return params;
}

// The in-scattering integral of Yusov 2012, with the assumptions of section 2, computed by Simpson's rule. `lit` is the
// visibility of the sun at a distance.
struct Seen {
  glm::dvec3 light, through;
};
Seen quadrature(double density, double cos_view_sun, double start, double end, int steps,
                const std::function<glm::dvec3(double)>& lit) {
  const double rayleigh = 3.0 / (16.0 * std::numbers::pi) * (1.0 + cos_view_sun * cos_view_sun);
  const double mie =
      (1.0 - kG * kG) / (4.0 * std::numbers::pi * std::pow(1.0 + kG * kG - 2.0 * kG * cos_view_sun, 1.5));
  const glm::dvec3 sigma = density * (kRayleigh + kMieScattering + kMieAbsorption);
  glm::dvec3 sum(0.0);
  const double step = (end - start) / steps;
  for (int i = 0; i <= steps; ++i) {
    const double t = step * i;
    const double weight = (i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / 3.0;
    sum += weight * step * lit(start + t) * glm::exp(-sigma * t);
  }
  return {density * (kRayleigh * rayleigh + kMieScattering * mie) * sum, glm::exp(-sigma * (end - start))};
}

TestFrame open_frame() {
  TestFrame frame;
  frame.extent = {24, 16};
  frame.view = TestView::at(900.0, 0.3, 0.05, 0.6);
  frame.view.tan_half_width = 0.9;
  frame.to_sun = glm::normalize(glm::dvec3(0.35, 0.25, -0.9));
  frame.background = {0.3, 0.2, 0.1};
  // Surfaces at many distances, and sky above them.
  frame.distance_m = [](std::uint32_t x, std::uint32_t y) { return y < 6 ? 0.0 : 40.0 * (x + 1) * (16 - y); };
  return frame;
}

double worst_error(const Picture& picture, const std::function<glm::dvec3(std::uint32_t, std::uint32_t)>& truth,
                   VkExtent2D extent) {
  double worst = 0.0;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      worst = std::max(worst, relative_error(picture[y * extent.width + x], truth(x, y)));
    }
  }
  return worst;
}

TEST_F(HomogeneousMedium, WithoutShadowsIsTheIntegral) {
  const TestFrame frame = open_frame();
  show(frame);
  for (const double density : {1e-4, 1.0, 30.0}) {
    for (const double height_m : {1.0e7, 1000.0, 700.0}) {  // above everything, above the camera, below it
      Params params = with_coefficients(density);
      params.homogeneous_medium.height_m = static_cast<float>(height_m);
      params.homogeneous_medium.sunlight = {0.5F, 0.75F, 1.0F};
      const auto truth = [&](std::uint32_t x, std::uint32_t y) {
        const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
        const double seen = frame.distance_m(x, y);
        double start = 0.0;
        double end = seen > 0.0 ? seen : params.homogeneous_medium.extent_m;
        const double crossing = (height_m - ray.altitude_m) / ray.cos_view;
        if (ray.altitude_m > height_m) start = ray.cos_view < 0.0 ? crossing : end;
        if (ray.altitude_m <= height_m && ray.cos_view > 0.0) end = std::min(end, crossing);
        end = std::max(start, end);
        const Seen s = quadrature(density, ray.cos_view_sun, start, end, 2000, [](double) { return glm::dvec3(1.0); });
        return s.light * glm::dvec3(0.5, 0.75, 1.0) +
               s.through * glm::dvec3(frame.background.x, frame.background.y, frame.background.z);
      };
      const std::string name = "density " + std::to_string(density) + ", top " + std::to_string(height_m);
      params.scattering.technique = Technique::brute_force;
      const double brute = worst_error(draw(params, name), truth, frame.extent);
      EXPECT_LE(brute, 1e-5) << name;
      // Every ray is completely lit, so all mean source functions are 1 and interpolation has no error.
      params.scattering.technique = Technique::epipolar;
      const double epipolar = worst_error(draw(params, name), truth, frame.extent);
      EXPECT_LE(epipolar, 1e-3) << name;
      RecordProperty("worst: " + name, std::to_string(brute) + " " + std::to_string(epipolar));
    }
  }
}

// The map contains lit bars and bars in shadow, and glass in front of them. The expected value uses the same map and
// filter.
TEST_F(HomogeneousMedium, WithShadowsIsTheIntegralOverLitSections) {
  TestFrame frame = open_frame();
  frame.shadow_resolution = 64;
  Cascade cascade;
  cascade.far_m = 9000.0F;  // beyond it, everything is lit
  cascade.shadow_from_world = Mat4{{}};
  cascade.shadow_from_world.m[0] = 1.0F / 20000.0F;   // u from x
  cascade.shadow_from_world.m[9] = 1.0F / 20000.0F;   // v from z
  cascade.shadow_from_world.m[6] = -1.0F / 40000.0F;  // depth from y, downwards
  cascade.shadow_from_world.m[12] = cascade.shadow_from_world.m[13] = 0.5F;
  cascade.shadow_from_world.m[14] = 0.7F;
  cascade.shadow_from_world.m[15] = 1.0F;
  frame.cascades = {cascade};
  const auto bar = [](double u, double v) { return static_cast<int>(std::floor(16.0 * u) + std::floor(16.0 * v)); };
  frame.shadow_depth = [bar](std::uint32_t, double u, double v) { return bar(u, v) % 2 == 0 ? 1.0F : 0.0F; };
  const auto glass = [bar](std::uint32_t, double u, double v) {
    return bar(u, v) % 4 == 0 ? glm::dvec3(1.0, 0.25, 0.5) : glm::dvec3(0.5, 1.0, 0.75);
  };
  // Without glass, with glass of unknown height, and with glass at 850 m, which colours the medium below it.
  constexpr double kGlass_m = 850.0;
  enum class Glass { none, anywhere, level };
  for (const Glass kind : {Glass::none, Glass::anywhere, Glass::level}) {
    const bool colored = kind != Glass::none;
    with_colors_ = colored;
    make(own_effect_, desc());
    with_colors_ = false;
    if (colored) frame.shadow_color = glass;
    if (kind == Glass::level)
      frame.glass_depth = [](std::uint32_t, double, double) { return static_cast<float>(0.7 - kGlass_m / 40000.0); };
    show(frame);
    Params params = with_coefficients(8.0);
    const auto truth = [&](std::uint32_t x, std::uint32_t y) {
      const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
      const double seen = frame.distance_m(x, y);
      const double end = seen > 0.0 ? seen : params.homogeneous_medium.extent_m;
      const glm::dvec3 direction = frame.view.ray(x, y, frame.extent);
      const double depth_per_m = glm::dot(direction, frame.view.forward);
      const auto lit = [&](double t) {
        if (t * depth_per_m > cascade.far_m) return glm::dvec3(1.0);
        const glm::dvec3 p = frame.view.position + t * direction;
        const double u = (0.5 + p.x / 20000.0) * 64.0 - 0.5;
        const double v = (0.5 + p.z / 20000.0) * 64.0 - 0.5;
        const double column = std::floor(u);
        const double row = std::floor(v);
        double share = 0.0;
        glm::dvec3 color(0.0);
        for (int k = 0; k < 4; ++k) {
          const double i = column + (k & 1);
          const double j = row + (k >> 1);
          const double weight = (1.0 - std::abs(u - i)) * (1.0 - std::abs(v - j));
          const bool inside = i >= 0.0 && j >= 0.0 && i < 64.0 && j < 64.0;
          const double tu = (i + 0.5) / 64.0;
          const double tv = (j + 0.5) / 64.0;
          share += weight * (inside ? static_cast<double>(frame.shadow_depth(0, tu, tv)) : 1.0);
          color += weight * (inside && colored ? glass(0, tu, tv) : glm::dvec3(1.0));
        }
        return kind == Glass::level && p.y > kGlass_m ? glm::dvec3(share) : share * color;
      };
      const Seen s = quadrature(8.0, ray.cos_view_sun, 0.0, end, 20000, lit);
      return s.light + s.through * glm::dvec3(frame.background.x, frame.background.y, frame.background.z);
    };
    const std::string name = kind == Glass::none       ? "bars"
                             : kind == Glass::anywhere ? "coloured bars"
                                                       : "coloured bars below glass";
    // The map is read once per texel, and a texel is 300 m wide.
    params.scattering.integration_steps = 1000;
    const double brute = worst_error(draw(params, name), truth, frame.extent);
    EXPECT_LE(brute, 2e-3) << name;
    RecordProperty("worst: " + name, std::to_string(brute));
  }
}

TEST_F(HomogeneousMedium, EpipolarIsLikeBruteForce) {
  const std::vector<std::pair<std::string, std::function<void(BoxScene&, Params&)>>> cases = {
      {"towards the sun", [](BoxScene&, Params&) {}},
      {"sun in view",
       [](BoxScene& s, Params&) {
         s.sun.in_view = true;
         s.sun.x = 0.2;
         s.sun.y = -0.4;
         s.pitch_deg = 8.0;
       }},
      {"sun behind",
       [](BoxScene& s, Params&) {
         s.sun.in_view = true;
         s.sun.behind = true;
         s.pitch_deg = -6.0;
       }},
      {"dense", [](BoxScene&, Params& p) { p.homogeneous_medium.density = 8.0F; }},
      {"thin", [](BoxScene&, Params& p) { p.homogeneous_medium.density = 0.05F; }},
      {"below a top", [](BoxScene&, Params& p) { p.homogeneous_medium.height_m = 2500.0F; }},
      {"above the top",
       [](BoxScene& s, Params& p) {
         s.altitude_m = 6000.0;
         s.pitch_deg = -12.0;
         p.homogeneous_medium.height_m = 2500.0F;
       }},
      {"one cascade",
       [](BoxScene& s, Params&) {
         s.cascades = 1;
         s.shadow_resolution = 512;
       }},
      {"no shafts", [](BoxScene&, Params& p) { p.scattering.light_shafts = false; }},
      {"no light", [](BoxScene&, Params& p) { p.scattering.single = SingleScattering::none; }},
      {"depth breaks corrected", [](BoxScene&, Params& p) { p.epipolar.correct_depth_breaks = true; }},
      {"extinction per pixel", [](BoxScene&, Params& p) { p.scattering.extinction = Extinction::per_pixel; }},
  };
  for (const auto& [name, change] : cases) {
    BoxScene scene;
    Params params = homogeneous_params();
    change(scene, params);
    show(scene);
    expect_alike(name, params, 40.0);
  }
}

TEST_F(HomogeneousMedium, TreesAndOrderOfCascadesChangeNothing) {
  BoxScene scene;
  scene.shadow_resolution = 512;
  show(scene);
  Params params = homogeneous_params();
  const Picture picture = draw(params, "tree");
  const Counters with_tree = counters();
  EXPECT_GT(with_tree.samples_marched, 0U);
  const auto same = [&](const char* name, const std::function<void(Params&)>& change) {
    Params other = params;
    change(other);
    const Likeness likeness = compare(draw(other, name), picture, frame().extent);
    EXPECT_EQ(likeness.worst_relative_error, 0.0) << name;
    RecordProperty(std::string("worst: ") + name, std::to_string(likeness.worst_relative_error));
  };
  same("no tree", [](Params& p) { p.epipolar.min_max_tree = false; });
  EXPECT_EQ(counters().samples_marched, with_tree.samples_marched);
  EXPECT_GT(counters().shadow_map_fetches, 4 * with_tree.shadow_map_fetches);
  same("multi-pass", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass; });
  same("instanced", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced; });
  // The tables are not used.
  same("multiple none", [](Params& p) { p.scattering.multiple = MultipleScattering::none; });
  same("single integration", [](Params& p) { p.scattering.single = SingleScattering::integration; });
}

TEST_F(HomogeneousMedium, ZeroCoefficientsScatterNothing) {
  BoxScene scene;
  show(scene);
  Params params = homogeneous_params();
  params.homogeneous_medium.density = 0.0F;
  for (const Technique technique : {Technique::epipolar, Technique::brute_force}) {
    params.scattering.technique = technique;
    const Picture picture = draw(params, "density 0");
    const TestFrame& f = frame();
    for (const glm::dvec3& p : picture) {
      EXPECT_NEAR(p.x, f.background.x, 1e-6);
      EXPECT_NEAR(p.z, f.background.z, 1e-6);
    }
  }
}

}  // namespace
}  // namespace tyndall
