// The effect's checks of its inputs: errors for inputs that cannot be drawn, remarks for those that are probably
// mistakes, each reported once, and nothing for correct inputs of any convention.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "frame_checks_case.hpp"

namespace tyndall {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(FrameChecks, CorrectFramesCauseNoRemarks) {
  EXPECT_EQ(error_of([](Case&) {}), "");
  EXPECT_EQ(remark_of([](Case&) {}), "");
  const auto silent = [](const char* name, const std::function<void(Case&)>& change) {
    EXPECT_EQ(error_of(change), "") << name;
    EXPECT_EQ(remark_of(change), "") << name;
  };
  const auto with_projection = [](const Mat4& p, float sky_depth) {
    return [=](Case& s) {
      s.inputs.camera.clip_from_view = p;
      s.desc.sky_depth = sky_depth;
    };
  };
  for (const double near_m : {0.01, 0.1, 1.0, 100.0}) {
    silent("reversed and infinite", with_projection(projection(near_m, true), 0.0F));
    silent("infinite", with_projection(projection(near_m, false), 1.0F));
    for (const double far_m : {1000.0, 50000.0, 1e6}) {
      silent("reversed", with_projection(projection(near_m, true, far_m), 0.0F));
      silent("standard", with_projection(projection(near_m, false, far_m), 1.0F));
    }
  }
  silent("jittered and off the axis", [](Case& s) {
    s.inputs.camera.clip_from_view.m[8] = 0.37F;
    s.inputs.camera.clip_from_view.m[9] = -0.004F;
  });
  silent("scaled as a whole", [](Case& s) {
    for (float& entry : s.inputs.camera.clip_from_view.m) entry *= 100.0F;
  });
  // On phones, the projection may turn the picture to fit a swapchain that stays as it is.
  silent("turned by a quarter", [](Case& s) {
    Mat4& p = s.inputs.camera.clip_from_view;
    p.m[0] = p.m[5] = 0.0F;
    p.m[1] = p.m[4] = 1.3F;
  });
  silent("turned by a half", [](Case& s) {
    Mat4& p = s.inputs.camera.clip_from_view;
    p.m[0] = -p.m[0];
    p.m[5] = -p.m[5];
  });
  silent("an oblique near plane", [](Case& s) { s.inputs.camera.clip_from_view.m[2] = 0.3F; });
  silent("reversed shadow maps", [](Case& s) {
    s.desc.shadow_depth_reversed = true;
    place_cascades(s);
  });
  silent("below sea level", [](Case& s) {
    s.inputs.camera.world_from_view = camera_at(300.0, -420.0, -500.0, 0.4, -0.1);
    place_cascades(s);
  });
  silent("from space", [](Case& s) {
    s.inputs.camera.world_from_view = camera_at(0.0, 2e7, 0.0, 0.4, -1.2);
    place_cascades(s);
  });
  silent("tables that are not needed", [](Case& s) {
    s.tables_ready = false;
    s.params.scattering.single = SingleScattering::integration;
    s.params.scattering.multiple = MultipleScattering::none;
  });
  silent("a declared depth format", [](Case& s) { s.desc.depth_format = VK_FORMAT_D32_SFLOAT; });
  silent("16 bits for a short range", [](Case& s) {
    s.desc.depth_format = VK_FORMAT_D16_UNORM;
    s.desc.sky_depth = 1.0F;
    s.inputs.camera.clip_from_view = projection(1.0, false, 10000.0);
  });
}

// Replaces the near plane of a reflection by the mirror (Lengyel, "Oblique view frustum depth projection and clipping",
// 2005). Rays do not depend on the near plane, also where the mirror lies behind the camera.
TEST(FrameChecks, AnObliqueNearPlaneChangesNoRay) {
  const auto expect_near = [](const Vec3& a, const Vec3& b) {
    for (const auto& [x, y] : {std::pair{a.x, b.x}, {a.y, b.y}, {a.z, b.z}}) EXPECT_NEAR(x, y, 1e-5F);
  };
  for (const double pitch : {-0.6, -0.2, 0.2, 0.6}) {
    for (const bool reversed : {false, true}) {
      Case s = right();
      s.desc.sky_depth = reversed ? 0.0F : 1.0F;
      s.inputs.camera = {camera_at(0.0, 10.0, 0.0, 0.4, pitch), projection(0.1, reversed)};
      // The mirror is 2 m above the reflected camera, and what is above the mirror is visible.
      const double plane[4] = {0.0, std::cos(pitch), -std::sin(pitch), -2.0};
      const double corner = std::abs(plane[1]) / 1.6 - plane[2];
      const double factor = 1.0 / std::max(corner, 0.1);
      Mat4 oblique = s.inputs.camera.clip_from_view;
      for (int column = 0; column < 4; ++column) {
        const double w = static_cast<double>(oblique.m[4 * column + 3]);
        const double z = factor * plane[column];
        oblique.m[4 * column + 2] = static_cast<float>(reversed ? w - z : z);
      }
      const auto rays = [&](const Mat4& clip_from_view) {
        s.inputs.camera.clip_from_view = clip_from_view;
        const Result<void> accepted = check_frame(s.frame(), s.desc, s.params);
        EXPECT_TRUE(accepted.ok()) << accepted.error().message;
        return frame_constants(s.frame(), s.desc, s.params);
      };
      const shared::FrameConstants usual = rays(s.inputs.camera.clip_from_view);
      const shared::FrameConstants mirrored = rays(oblique);
      for (const double x : {0.0, 50.0, 160.0}) {
        for (const double y : {0.0, 70.0, 100.0}) {
          SCOPED_TRACE(testing::Message() << pitch << ' ' << reversed << ' ' << x << ' ' << y);
          const auto ray = [&](const shared::FrameConstants& frame) {
            const auto sum = [&](float origin, float across, float down) {
              return static_cast<double>(origin) + x * static_cast<double>(across) + y * static_cast<double>(down);
            };
            const double r[3] = {sum(frame.ray_origin.x, frame.ray_x.x, frame.ray_y.x),
                                 sum(frame.ray_origin.y, frame.ray_x.y, frame.ray_y.y),
                                 sum(frame.ray_origin.z, frame.ray_x.z, frame.ray_y.z)};
            const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
            return Vec3(static_cast<float>(r[0] / length), static_cast<float>(r[1] / length),
                        static_cast<float>(r[2] / length));
          };
          expect_near(ray(mirrored), ray(usual));
        }
      }
    }
  }
}

TEST(FrameChecks, CertainMistakesAreErrors) {
  const auto expect_error = [](const std::vector<std::string>& words, const std::function<void(Case&)>& change) {
    expect_words(error_of(change), words);
  };
  expect_error({"clip_from_view", "orthographic", "perspective"}, [](Case& s) {
    Mat4& p = s.inputs.camera.clip_from_view;
    p = {};
    p.m[0] = 0.01F;
    p.m[5] = -0.01F;
    p.m[10] = -1e-4F;
  });
  expect_error({"clip_from_view", "+z", "-z"}, [](Case& s) {
    for (const int entry : {10, 11}) s.inputs.camera.clip_from_view.m[entry] *= -1.0F;
  });
  expect_error({"sky_depth is 1", "reversed Z"}, [](Case& s) { s.desc.sky_depth = 1.0F; });
  expect_error({"sky_depth is 0", "expected 1"},
               [](Case& s) { s.inputs.camera.clip_from_view = projection(0.1, false, 1e5); });
  expect_error({"world_from_view", "0 0 0 1", "transposed"}, [](Case& s) {
    Mat4 turned;
    for (int i = 0; i < 16; ++i) turned.m[i] = s.inputs.camera.world_from_view.m[i % 4 * 4 + i / 4];
    s.inputs.camera.world_from_view = turned;
  });
  expect_error({"world_from_view", "scaled", "99.99"}, [](Case& s) {
    for (int i = 0; i < 12; ++i) s.inputs.camera.world_from_view.m[i] *= 100.0F;
  });
  expect_error({"cascades[1]", "0 0 0 1", "transposed"}, [](Case& s) {
    Mat4 turned;
    for (int i = 0; i < 16; ++i) turned.m[i] = s.cascades[1].shadow_from_world.m[i % 4 * 4 + i / 4];
    s.cascades[1].shadow_from_world = turned;
  });
  expect_error({"cascades[2]", "zero"}, [](Case& s) { s.cascades[2].shadow_from_world = Mat4{{}}; });
  expect_error({"cascades[0]", "zero or cannot be inverted"},
               [](Case& s) { set_row(s.cascades[0].shadow_from_world, 2, 0, 0, 0, 0.5); });
  expect_error({"cascades[0]", "not finite"}, [](Case& s) { s.cascades[0].shadow_from_world.m[3] = kNaN; });
  expect_error({"cascades[1]", "near_m <= far_m"}, [](Case& s) { s.cascades[1].far_m = 10.0F; });
  expect_error({"cascades[2]", "finite"},
               [](Case& s) { s.cascades[2].far_m = std::numeric_limits<float>::infinity(); });
  expect_error({"FrameInputs::depth", "layout", "SHADER_READ_ONLY_OPTIMAL"},
               [](Case& s) { s.inputs.depth.layout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL; });
  expect_error({"FrameInputs::color", "layout"}, [](Case& s) { s.inputs.color.layout = VK_IMAGE_LAYOUT_UNDEFINED; });
  expect_error({"FrameInputs::shadow_maps", "layout"},
               [](Case& s) { s.inputs.shadow_maps.layout = VK_IMAGE_LAYOUT_UNDEFINED; });
  expect_error({"FrameInputs::output", "color or depth"}, [](Case& s) { s.inputs.output.view = s.inputs.color.view; });
  expect_error({"FrameInputs::view is 1", "EffectDesc::views"}, [](Case& s) { s.inputs.view = 1; });
  expect_error({"FrameInputs::depth", "offset", "-1,0"}, [](Case& s) { s.inputs.depth.offset.x = -1; });
}

void expect_remark(const std::vector<std::string>& words, const std::function<void(Case&)>& change) {
  const std::string text = remark_of(change);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  expect_words(text, words);
}

TEST(FrameChecks, UnlikelyCamerasAreRemarkedOn) {
  expect_remark({"world_from_view", "mirrored", "+1"}, [](Case& s) {
    for (int i = 0; i < 3; ++i) s.inputs.camera.world_from_view.m[i] *= -1.0F;
  });
  expect_remark({"world_from_view", "inverse", "view_from_world"}, [](Case& s) {
    s.inputs.cascades = {};
    s.params.scattering.light_shafts = false;
    s.inputs.camera.world_from_view = inverse_of(camera_at(5.0, 12.0, 30.0, 0.4, 0.2));
  });
  expect_remark({"world_from_view", "below sea level", "y up"}, [](Case& s) {
    s.params.scattering.light_shafts = false;
    s.inputs.camera.world_from_view = camera_at(0.0, -900.0, 0.0, 0.0, -1.5707963);
  });
  expect_remark({"world_from_view", "1e9", "metre"}, [](Case& s) {
    s.params.scattering.light_shafts = false;
    s.inputs.camera.world_from_view.m[13] = 4e9F;
  });
  expect_remark({"clip_from_view", "y up", "OpenGL"}, [](Case& s) { s.inputs.camera.clip_from_view.m[5] *= -1.0F; });
  expect_remark({"clip_from_view", "near plane", "metre"},
                [](Case& s) { s.inputs.camera.clip_from_view.m[14] = 1e-4F; });
  // OpenGL's depth of -1 to 1, reversed: depth 0 is at twice the near plane.
  expect_remark({"clip_from_view", "far plane", "depth 0 to 1"}, [](Case& s) {
    s.inputs.camera.clip_from_view.m[10] = 1.0001F;
    s.inputs.camera.clip_from_view.m[14] = 0.2F;
  });
  expect_remark({"clip_from_view", "origin", "world_from_view"},
                [](Case& s) { s.inputs.camera.clip_from_view.m[12] = 0.032F; });
  expect_remark({"depth_format", "16 bits", "sky"}, [](Case& s) { s.desc.depth_format = VK_FORMAT_D16_UNORM; });
  expect_remark({"depth_format", "16 bits", "sky"}, [](Case& s) {
    s.desc.depth_format = VK_FORMAT_D16_UNORM;
    s.desc.sky_depth = 1.0F;
    s.inputs.camera.clip_from_view = projection(0.1, false, 1e5);
  });
}

TEST(FrameChecks, UnlikelyCascadesAreRemarkedOn) {
  const auto on_each = [](const std::function<void(Mat4&)>& change) {
    return [=](Case& s) {
      for (Cascade& c : s.cascades) change(c.shadow_from_world);
    };
  };
  expect_remark({"cascades[0]", "clip space", "0 to 1"}, on_each([](Mat4& m) {
                  for (int c = 0; c < 4; ++c) {
                    for (int r = 0; r < 2; ++r) m.m[4 * c + r] = 2.0F * m.m[4 * c + r] - (c == 3 ? 1.0F : 0.0F);
                  }
                }));
  expect_remark({"cascades[0]", "nothing will be shadowed there"}, on_each([](Mat4& m) { m.m[13] += 3.0F; }));
  expect_remark({"cascades[0]", "past the sun", "direction_to_sun"}, [](Case& s) {
    s.inputs.sun.direction_to_sun = {0.0F, 1.0F, 0.0F};
  });
  expect_remark({"cascades[0]", "shadow_depth_reversed is off", "expected 0"}, on_each([](Mat4& m) {
                  for (int c = 0; c < 4; ++c) m.m[4 * c + 2] = (c == 3 ? 1.0F : 0.0F) - m.m[4 * c + 2];
                }));
  expect_remark({"cascades[0]", "shadow_depth_reversed is on", "expected 1"},
                [](Case& s) { s.desc.shadow_depth_reversed = true; });
  expect_remark({"cascades[1]", "empty range"}, [](Case& s) { s.cascades[1].near_m = s.cascades[1].far_m; });
  expect_remark({"cascades[0]", "empty range"}, [](Case& s) {
    s.cascades.resize(1);
    s.cascades[0].far_m = 0.0F;
  });
  expect_remark({"cascades[2]", "near to far"}, [](Case& s) {
    s.cascades[2].near_m = 0.0F;
    s.cascades[2].far_m = 5000.0F;
  });
  expect_remark({"cascades[2]", "starts at 9000 m", "ends at 8000 m"}, [](Case& s) { s.cascades[2].near_m = 9000.0F; });
  // The map of one cascade lies beside the part of the view that belongs to the cascade.
  expect_remark({"cascades[1]", "its part of the view", "shadowed there"},
                [](Case& s) { s.cascades[1].shadow_from_world.m[12] += 3.0F; });
  // Near the ground, a map contains the view but not the camera.
  expect_remark({"cascades[0]", "camera outside", "this frame"}, [](Case& s) {
    s.inputs.camera.world_from_view.m[13] = 50.0F;
    place_cascades(s);
    set_row(s.cascades[0].shadow_from_world, 0, 2.4e-4, 0.0, -1.8e-4, -0.55 - 2.4e-4 * 300.0 - 1.8e-4 * 500.0);
  });
  // The ranges have another unit than the maps.
  expect_remark({"reach less far than their ranges", "far_m"}, [](Case& s) {
    s.inputs.camera.world_from_view = camera_at(300.0, 20.0, -500.0, 0.4, -0.01);
    place_cascades(s);
    for (Cascade& c : s.cascades) {
      c.near_m *= 10.0F;
      c.far_m *= 10.0F;
    }
  });
  expect_remark({"cascades[1]", "clip space"}, [](Case& s) {
    Mat4& m = s.cascades[1].shadow_from_world;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 2; ++r) m.m[4 * c + r] = 2.0F * m.m[4 * c + r] - (c == 3 ? 1.0F : 0.0F);
    }
  });
  expect_remark({"cascades", "starts 40 m"}, [](Case& s) { s.cascades[0].near_m = 40.0F; });
  expect_remark({"cascades", "metre"}, [](Case& s) {
    s.cascades.resize(1);
    s.cascades[0].far_m = 0.5F;
  });
  expect_remark({"light_shafts", "nothing will be shadowed"}, [](Case& s) { s.cascades.clear(); });
}

TEST(FrameChecks, UnlikelySunsAndMissingTablesAreRemarkedOn) {
  expect_remark({"tables are not built", "record_precompute()", "no in-scattering"},
                [](Case& s) { s.tables_ready = false; });
  expect_remark({"direction_to_sun", "unit length"}, [](Case& s) {
    s.inputs.sun.direction_to_sun = {0.96F, 1.2F, 1.28F};
  });
  expect_remark({"angular_radius_rad", "degrees"}, [](Case& s) { s.inputs.sun.angular_radius_rad = 0.27F; });
  expect_remark({"irradiance is 0", "no in-scattering"}, [](Case& s) { s.inputs.sun.irradiance = Vec3(0.0F); });
}

// Cameras have various positions, headings and pitches, with and without cascades. The first frame detects the inverse
// of every camera that has no roll and is rotated about more than one axis.
TEST(FrameChecks, InvertedViewsAreRemarkedOn) {
  int seen = 0, all = 0;
  for (const double distance : {0.0, 30.0, 5000.0, 2.0e5}) {
    for (const double height : {2.0, 150.0, 9000.0}) {
      for (const double yaw : {0.3, 1.2, 2.6, 4.0, 5.9}) {
        for (const double pitch : {-1.1, -0.2, -0.01, 0.1, 0.7}) {
          const Mat4 right = camera_at(distance, height, -0.7 * distance, yaw, pitch);
          for (const bool wrong : {false, true}) {
            const std::string text = remark_of([&](Case& s) {
              s.params.scattering.light_shafts = false;
              s.inputs.camera.world_from_view = wrong ? inverse_of(right) : right;
            });
            if (!wrong) {
              EXPECT_EQ(text, "") << distance << " " << height << " " << yaw << " " << pitch;
            } else {
              ++all;
              seen += text.find("looks like its inverse") != std::string::npos ? 1 : 0;
              EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 1) << text;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(seen, all);
  // With cascades, the inverse of a camera that is rolled or rotated about one axis is detected, too.
  for (const double roll : {0.0, 0.4}) {
    const std::string text = remark_of([&](Case& s) {
      s.inputs.camera.world_from_view =
          rolled(camera_at(20000.0, 1200.0, -9000.0, 0.9, roll == 0.0 ? 0.0 : -0.2), roll);
      place_cascades(s);
      s.inputs.camera.world_from_view = inverse_of(s.inputs.camera.world_from_view);
    });
    expect_words(text, {"looks like its inverse"});
  }
}

// A camera is rolled and turns in place, without cascades. Its inverse is detected in the second frame, because its
// position moves around the origin.
TEST(FrameChecks, AnInvertedViewThatRollsIsRemarkedOnWhenItTurns) {
  for (const bool wrong : {false, true}) {
    Remarks remarks;
    std::size_t texts = 0;
    for (int frame = 0; frame < 40; ++frame) {
      Case s = right();
      s.params.scattering.light_shafts = false;
      const Mat4 m = rolled(camera_at(40.0, 90.0, -10.0, 0.1 * frame, -0.3 + 0.01 * frame), 0.5);
      s.inputs.camera.world_from_view = wrong ? inverse_of(m) : m;
      texts += remarks_of(remarks, s).size();
    }
    EXPECT_EQ(texts > 0, wrong);
  }
}

// Cameras that roll, orbit the origin, are on their side or fly a loop are correct.
// Adds a map of clouds along the sun, as the cascades are.
void add_clouds(Case& s) {
  s.desc.clouds = true;
  s.inputs.clouds.map = {view_number(9), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, {0, 0}};
  s.inputs.clouds.map_from_world = s.cascades.back().shadow_from_world;
}

TEST(FrameChecks, CloudsAreChecked) {
  EXPECT_EQ(error_of(add_clouds), "");
  EXPECT_EQ(remark_of(add_clouds), "");
  const auto error = [](const std::function<void(Case&)>& change) {
    return error_of([&](Case& s) {
      add_clouds(s);
      change(s);
    });
  };
  expect_words(error([](Case& s) { s.desc.clouds = false; }), {"FrameInputs::clouds", "EffectDesc::clouds"});
  expect_words(error([](Case& s) { s.inputs.clouds.map.layout = VK_IMAGE_LAYOUT_UNDEFINED; }),
               {"FrameInputs::clouds.map's layout is 0", "can be sampled"});
  expect_words(error([](Case& s) { s.inputs.clouds.map.offset.x = 1; }), {"FrameInputs::clouds.map", "offset"});
  expect_words(error([](Case& s) { s.inputs.clouds.map.view = s.inputs.output.view; }),
               {"FrameInputs::clouds.map is the view of FrameInputs::output"});
  for (const int entry : {0, 2, 12, 14}) {  // in u, and in the depth
    expect_words(error([entry](Case& s) { s.inputs.clouds.map_from_world.m[entry] = kNaN; }),
                 {"FrameInputs::clouds's map_from_world is not finite", "expected a matrix"});
  }
  expect_words(error([](Case& s) { set_row(s.inputs.clouds.map_from_world, 2, 0.0, 0.0, 0.0, 0.5); }),
               {"FrameInputs::clouds's map_from_world is zero or cannot be inverted"});
  expect_words(error([](Case& s) { s.inputs.clouds.map_from_world.m[3] = 0.1F; }),
               {"FrameInputs::clouds's map_from_world", "last row", "transposed"});

  const auto remark = [](const std::function<void(Case&)>& change) {
    return remark_of([&](Case& s) {
      add_clouds(s);
      change(s);
    });
  };
  expect_words(remark([](Case& s) { set_row(s.inputs.clouds.map_from_world, 0, 1e-5, 1e-5, 0.0, 0.5); }),
               {"FrameInputs::clouds looks", "degrees past the sun"});
  expect_words(remark([](Case& s) {
                 Mat4& m = s.inputs.clouds.map_from_world;
                 for (const int entry : {2, 6, 10, 14}) m.m[entry] = -m.m[entry];
               }),
               {"the depth of FrameInputs::clouds does not grow away from the sun"});
  // The depth may be the altitude, with the opposite sign.
  EXPECT_EQ(remark([](Case& s) { set_row(s.inputs.clouds.map_from_world, 2, 0.0, -1e-4, 0.0, 0.5); }), "");
  expect_words(remark([](Case& s) {
                 s.params.scattering.single = SingleScattering::none;
                 s.params.scattering.multiple = MultipleScattering::unoccluded;
               }),
               {"FrameInputs::clouds", "nothing will be darkened"});
}

TEST(FrameChecks, UnusualCamerasAreNotRemarkedOn) {
  Remarks remarks;
  for (int frame = 0; frame < 2000; ++frame) {
    Case s = right();
    s.params.scattering.light_shafts = false;
    const double t = 0.01 * frame;
    const double roll = frame < 1000 ? 3.0 * std::sin(1.7 * t) : 1.5707963267948966;
    const double yaw = 2.0 * std::sin(t) + 0.3, pitch = 1.2 * std::cos(0.7 * t);
    Mat4 m = camera_at(100.0 * std::cos(t), 500.0 + 100.0 * std::sin(t), 30.0 * t, yaw, pitch);
    if (frame % 2 == 1) {  // in orbit around the origin
      m = camera_at(0.0, 0.0, 0.0, yaw, -0.4);
      for (int r = 0; r < 3; ++r) m.m[12 + r] = 500.0F * m.m[8 + r];
    }
    s.inputs.camera.world_from_view = rolled(m, frame % 2 == 1 ? 0.0 : roll);
    s.desc.views = 2;
    s.inputs.view = static_cast<std::uint32_t>(frame % 2);
    const std::vector<std::string> texts = remarks_of(remarks, s);
    EXPECT_EQ(texts.size(), 0U) << frame << ": " << (texts.empty() ? "" : texts[0]);
  }
}

TEST(FrameChecks, ARemarkIsRepeatedOnlyAfterACorrectFrame) {
  Remarks remarks;
  Case good = right();
  Case wrong = right();
  wrong.inputs.camera.clip_from_view.m[5] *= -1.0F;
  EXPECT_EQ(remarks_of(remarks, good).size(), 0U);
  EXPECT_EQ(remarks_of(remarks, wrong).size(), 1U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(remarks_of(remarks, wrong).size(), 0U);
  // Another mistake gives another remark. Another view has its own remarks.
  wrong.inputs.sun.irradiance = Vec3(0.0F);
  EXPECT_EQ(remarks_of(remarks, wrong).size(), 1U);
  wrong.desc.views = 2;
  wrong.inputs.view = 1;
  EXPECT_EQ(remarks_of(remarks, wrong).size(), 2U);
  wrong.inputs.view = 0;
  EXPECT_EQ(remarks_of(remarks, wrong).size(), 0U);
  EXPECT_EQ(remarks_of(remarks, good).size(), 0U);
  EXPECT_EQ(remarks_of(remarks, wrong).size(), 2U);
}

}  // namespace
}  // namespace tyndall
