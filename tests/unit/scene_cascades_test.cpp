// The fit of shadow cascades, for suns from below the horizon to the zenith and cameras from the ground to space: a
// cascade contains the part of the view that terrain can shadow, its depth range contains the casters towards the sun,
// and its texels do not move with the camera.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "effect/frame_constants.hpp"
#include "effect/remarks.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/view/cascades.hpp"

namespace tyndall::scene {
namespace {

constexpr Ground kGround = {-50.0, 4500.0, 6.36e6};
constexpr double kElevations_deg[] = {-5.0, 0.0, 0.3, 4.0, 20.0, 60.0, 89.9, 90.0};
constexpr double kAltitudes_m[] = {2.0, 300.0, 5000.0, 30.0e3, 400.0e3};

View view_at(double altitude_m, double yaw_deg, double pitch_deg) {
  CameraParams camera;
  camera.position_m = {1200.0F, 0.0F, -700.0F};
  camera.altitude_m = static_cast<float>(altitude_m);
  camera.yaw_deg = static_cast<float>(yaw_deg);
  camera.pitch_deg = static_cast<float>(pitch_deg);
  return view_from_params(camera, 16.0 / 9.0, kGround.radius_m);
}

glm::dvec3 sun_at(double elevation_deg, double azimuth_deg = 35.0) {
  SunParams sun;
  sun.elevation_deg = static_cast<float>(elevation_deg);
  sun.azimuth_deg = static_cast<float>(azimuth_deg);
  return direction_to_sun(sun);
}

double first_near(double altitude_m) { return std::max(0.5 * altitude_m, 20.0); }

template <typename Check>
void for_every_setting(const Check& check) {
  for (const double elevation : kElevations_deg) {
    for (const double altitude : kAltitudes_m) {
      for (const double pitch : {-70.0, -10.0, 12.0}) {
        for (const std::uint32_t count : {1U, 4U, 8U}) {
          ShadowParams shadows;
          shadows.cascades = count;
          shadows.first_marched = count / 2;
          const View view = view_at(altitude, 40.0 * elevation, pitch);
          const glm::dvec3 sun = sun_at(elevation);
          check(view, sun, shadows, fit_cascades(view, sun, shadows, kGround, first_near(altitude)));
          if (testing::Test::HasFailure()) {
            FAIL() << "sun at " << elevation << ", camera at " << altitude << ", pitch " << pitch << ", cascades "
                   << count;
          }
        }
      }
    }
  }
}

TEST(SceneCascades, SplitsEndInOrderAtTheFarDistance) {
  for (const double partitioning : {0.0, 0.5, 0.95, 1.0}) {
    for (const std::uint32_t count : {1U, 2U, 8U}) {
      const std::vector<double> ends = split_distances(10.0, 1e5, count, partitioning);
      ASSERT_EQ(ends.size(), count);
      EXPECT_EQ(ends.back(), 1e5);
      double before = 10.0;
      for (const double end : ends) {
        EXPECT_GT(end, before);
        before = end;
      }
    }
  }
  EXPECT_NEAR(split_distances(10.0, 1e5, 2, 0.0)[0], 0.5 * (10.0 + 1e5), 1e-6);
  EXPECT_NEAR(split_distances(10.0, 1e5, 2, 1.0)[0], 1000.0, 1e-6);  // geometric mean
}

TEST(SceneCascades, AreFiniteOrderedAndMarchedFromTheCamera) {
  for_every_setting(
      [](const View&, const glm::dvec3&, const ShadowParams& shadows, const std::vector<CascadeFit>& fits) {
        ASSERT_EQ(fits.size(), shadows.cascades);
        double end = 0.0;
        for (const CascadeFit& fit : fits) {
          const glm::dmat4 matrix = fit.shadow_from_world();
          for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r) ASSERT_TRUE(std::isfinite(matrix[c][r]));
          }
          EXPECT_GT(std::abs(glm::determinant(glm::dmat3(matrix))), 0.0);
          EXPECT_GT(fit.texel_m, 0.0);
          EXPECT_GT(fit.far_m, end);
          EXPECT_LE(fit.near_m, end);  // no gap
          end = fit.far_m;
        }
        EXPECT_EQ(fits[0].near_m, 0.0);
        EXPECT_EQ(fits[shadows.first_marched].near_m, 0.0);
        EXPECT_GE(end, shadows.distance_m);
      });
}

TEST(SceneCascades, ContainTheGroundOfTheirSliceAndItsCasters) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::size_t receivers = 0;
  std::size_t casters = 0;
  for_every_setting(
      [&](const View& view, const glm::dvec3& sun, const ShadowParams&, const std::vector<CascadeFit>& fits) {
        for (const CascadeFit& fit : fits) {
          const glm::dmat4 shadow_from_world = fit.shadow_from_world();
          for (int i = 0; i < 400; ++i) {
            // A point of the cascade's slice of the view, at depths spread evenly over the logarithm of the distance.
            const double low = std::max(fit.near_m, 1.0);
            const double depth = low * std::pow(fit.far_m / low, uniform(engine));
            const double x = (2.0 * uniform(engine) - 1.0) * view.tan_half_width * depth;
            const double y = (2.0 * uniform(engine) - 1.0) * view.tan_half_height * depth;
            const glm::dvec3 p = view.position + view.forward * depth + view.right * x + view.up * y;
            const double altitude = altitude_of(p, kGround.radius_m);
            if (altitude < kGround.min_m || altitude > kGround.max_m) continue;
            ++receivers;
            const glm::dvec3 uvz(shadow_from_world * glm::dvec4(p, 1.0));
            for (int k = 0; k < 3; ++k) {
              ASSERT_GE(uvz[k], 0.0) << "axis " << k << " at altitude " << altitude << ", depth " << depth;
              ASSERT_LE(uvz[k], 1.0) << "axis " << k << " at altitude " << altitude << ", depth " << depth;
            }
            // Terrain between the point and the sun, as far as the rays are below the summits.
            for (const double distance : {1e3, 1e4, 1e5, 3e5}) {
              const glm::dvec3 caster = p + sun * distance;
              const double above = altitude_of(caster, kGround.radius_m);
              if (above < kGround.min_m || above > kGround.max_m) break;
              ++casters;
              ASSERT_GE((shadow_from_world * glm::dvec4(caster, 1.0)).z, 0.0) << "caster at " << distance;
            }
          }
        }
      });
  // The random draws include visible ground and casters.
  EXPECT_GT(receivers, 10000U);
  EXPECT_GT(casters, 1000U);
}

// For every view, one cascade contains a room around the camera well inside its map, and finer cascades come before it.
TEST(SceneCascades, OneContainsARoomAroundTheCamera) {
  std::size_t rooms = 0;
  for (const bool bare : {false, true}) {
    for (const float distance_m : {10.0F, 60.0F, 3.0e5F}) {
      for (const std::uint32_t count : {1U, 2U, 4U, 8U}) {
        for (const double elevation : kElevations_deg) {
          std::vector<glm::dvec3> corners;
          for (int i = 0; i < 8; ++i) {
            corners.push_back(world_from_map(1193.0 + 13.0 * (i & 1), -706.0 + 11.0 * (i >> 2),
                                             500.0 + 8.0 * (i >> 1 & 1), kGround.radius_m));
          }
          Ground ground = kGround;
          ground.room = corners;
          if (bare) ground.casters = corners;
          ShadowParams shadows;
          shadows.cascades = count;
          shadows.first_marched = count - 1;
          shadows.distance_m = distance_m;
          const View view = view_at(502.0, 40.0 * elevation, 5.0);
          const glm::dvec3 sun = sun_at(elevation);
          const std::vector<CascadeFit> fits = fit_cascades(view, sun, shadows, ground, 1.0);
          ASSERT_EQ(fits.size(), count);
          double end = 0.0;
          const CascadeFit* room = nullptr;
          for (const CascadeFit& fit : fits) {
            EXPECT_GT(fit.far_m, end);
            EXPECT_LE(fit.near_m, end);
            end = fit.far_m;
            if (fit.holds_room) room = &fit;
          }
          ASSERT_NE(room, nullptr) << count << " cascades to " << distance_m;
          ++rooms;
          const auto at = static_cast<std::uint32_t>(room - fits.data());
          EXPECT_EQ(first_marched(shadows, fits), std::min(at, shadows.first_marched));
          for (std::size_t i = 0; i < at; ++i) EXPECT_LT(fits[i].texel_m, room->texel_m);
          EXPECT_LT(room->texel_m, 0.035);  // a diagonal of 18.8 m in 1024 texels
          for (const glm::dvec3& p : corners) {
            EXPECT_LE(glm::distance(p, view.position), room->far_m + 1e-9);
            const glm::dvec3 uvz(room->shadow_from_world() * glm::dvec4(p, 1.0));
            for (int k = 0; k < 2; ++k) EXPECT_LE(std::abs(uvz[k] - 0.5), 0.45 - 3.0 / shadows.resolution);
            EXPECT_GT(uvz.z, 0.0);
            EXPECT_LT(uvz.z, 1.0);
          }
        }
      }
    }
  }
  EXPECT_EQ(rooms, 2U * 3U * 4U * std::size(kElevations_deg));
}

TEST(SceneCascades, TexelsAreFixedWhenTheCameraMovesAndTurns) {
  ShadowParams shadows;
  for (const double elevation : {4.0, 45.0, 90.0}) {
    for (const double altitude : {500.0, 8000.0}) {
      const glm::dvec3 sun = sun_at(elevation);
      std::vector<CascadeFit> before;
      std::vector<std::set<double>> sizes(shadows.cascades);
      for (int step = 0; step < 500; ++step) {
        View view = view_at(altitude, 0.05 * step, -8.0);
        view.position += glm::dvec3(0.37 * step, 0.0, -0.83 * step);
        const std::vector<CascadeFit> fits = fit_cascades(view, sun, shadows, kGround, 250.0);
        for (std::size_t i = 0; i < fits.size(); ++i) {
          sizes[i].insert(fits[i].half_extent.x);
          if (before.empty() || fits[i].half_extent.x != before[i].half_extent.x ||
              fits[i].half_extent.y != before[i].half_extent.y) {
            continue;
          }
          EXPECT_EQ(fits[i].world_from_light, before[i].world_from_light);
          for (int axis = 0; axis < 2; ++axis) {
            const double texel = 2.0 * fits[i].half_extent[axis] / shadows.resolution;
            const double moved = (fits[i].centre[axis] - before[i].centre[axis]) / texel;
            // Moves are whole texels, apart from the rounding of planet-sized coordinates.
            ASSERT_NEAR(moved, std::round(moved), 1e-6) << "cascade " << i << " step " << step;
          }
        }
        before = fits;
      }
      // Sizes change in steps, a few times during a walk of 450 m and a turn of 25 degrees.
      for (const std::set<double>& seen : sizes)
        EXPECT_LE(seen.size(), 4U) << "sun " << elevation << " at " << altitude;
    }
  }
}

// Remarks on inputs (src/effect/remarks.hpp) are for mistakes; these cascades and cameras are correct.
void expect_no_remark(const View& view, const glm::dvec3& sun, const ShadowParams& shadows,
                      const std::vector<CascadeFit>& fits) {
  std::vector<Cascade> cascades;
  for (const CascadeFit& fit : fits) {
    cascades.push_back(
        {to_mat4(fit.shadow_from_world()), static_cast<float>(fit.near_m), static_cast<float>(fit.far_m)});
  }
  const auto view_number = [](std::uintptr_t number) { return reinterpret_cast<VkImageView>(number); };  // NOLINT
  FrameInputs inputs;
  inputs.extent = {1280, 720};
  inputs.color.view = view_number(1);
  inputs.depth.view = view_number(2);
  inputs.output.view = view_number(3);
  inputs.shadow_maps.view = view_number(4);
  inputs.shadow_resolution = shadows.resolution;
  inputs.cascades = cascades;
  inputs.first_marched_cascade = shadows.first_marched;
  inputs.camera = camera_from_view(view);
  inputs.sun.direction_to_sun = to_vec3(sun);
  EffectDesc desc;
  desc.max_cascades = kMaxCascades;
  const Params params;
  const Result<void> checked = check_frame(inputs, desc, params);
  EXPECT_TRUE(checked.ok()) << checked.error().message;
  DeviceInfo device;
  device.message = [](void*, Severity, std::string_view text) { ADD_FAILURE() << text; };
  const shared::FrameConstants frame = frame_constants(inputs, desc, params);
  Remarks().on_frame(inputs, {desc, params, frame, true}, device);
}

TEST(SceneCascades, TheEffectHasNothingToRemarkAboutThem) {
  for_every_setting(expect_no_remark);
  // Maps that end at a few casters: around the camera, in front of it, and behind it.
  for (const double distance_m : {0.0, 300.0, -300.0}) {
    for (const double elevation : kElevations_deg) {
      for (const double altitude : {2.0, 60.0, 2000.0}) {
        const View view = view_at(altitude, 70.0, -5.0);
        const glm::dvec3 place = view.position + distance_m * view.forward;
        const glm::dvec3 casters[] = {place - glm::dvec3(20.0, 10.0, 30.0), place + glm::dvec3(20.0, 10.0, 30.0)};
        Ground ground = kGround;
        ground.casters = casters;
        ShadowParams shadows;
        const glm::dvec3 sun = sun_at(elevation);
        expect_no_remark(view, sun, shadows, fit_cascades(view, sun, shadows, ground, first_near(altitude)));
        ASSERT_FALSE(testing::Test::HasFailure())
            << "sun at " << elevation << ", camera at " << altitude << ", casters at " << distance_m;
      }
    }
  }
}

}  // namespace
}  // namespace tyndall::scene
