// A correct frame, which frame_checks_test.cpp changes, and the errors and remarks about the result.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "effect/frame_constants.hpp"
#include "effect/remarks.hpp"

namespace tyndall {

inline VkImageView view_number(std::uintptr_t number) {
  return reinterpret_cast<VkImageView>(number);  // NOLINT(performance-no-int-to-ptr): never used as one
}

// The inputs of a frame. In right(), a camera at 1200 m looks slightly down and to the north-east, the sun is in the
// south-east, and each of three square cascades covers the view up to its far distance.
struct Case {
  EffectDesc desc;
  Params params;
  std::vector<Cascade> cascades;
  FrameInputs inputs;
  bool tables_ready = true;

  FrameInputs frame() const {
    FrameInputs out = inputs;
    out.cascades = cascades;
    return out;
  }
};

inline void set_row(Mat4& m, int row, double x, double y, double z, double w) {
  const double values[4] = {x, y, z, w};
  for (int column = 0; column < 4; ++column) m.m[4 * column + row] = static_cast<float>(values[column]);
}

inline Mat4 projection(double near_m, bool reversed, double far_m = 0.0) {
  Mat4 p = {{}};
  p.m[0] = 1.0F;
  p.m[5] = -1.6F;
  p.m[11] = -1.0F;
  // depth = (a distance + b) / distance
  const double n = reversed ? far_m : near_m;
  const double f = reversed ? near_m : far_m;
  p.m[10] = static_cast<float>(far_m > 0.0 ? f / (n - f) : reversed ? 0.0 : -1.0);
  p.m[14] = static_cast<float>(far_m > 0.0 ? n * f / (n - f) : reversed ? near_m : -near_m);
  return p;
}

inline Mat4 camera_at(double x, double y, double z, double yaw, double pitch) {
  Mat4 m;
  const double sy = std::sin(yaw), cy = std::cos(yaw), sp = std::sin(pitch), cp = std::cos(pitch);
  const double columns[4][3] = {{cy, 0.0, sy}, {-sy * sp, cp, cy * sp}, {-sy * cp, -sp, cy * cp}, {x, y, z}};
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) m.m[4 * c + r] = static_cast<float>(columns[c][r]);
  }
  return m;
}

// Rotates a camera about its axis.
inline Mat4 rolled(const Mat4& m, double roll) {
  Mat4 out = m;
  const double c = std::cos(roll), s = std::sin(roll);
  for (int r = 0; r < 3; ++r) {
    const double x = static_cast<double>(m.m[r]), y = static_cast<double>(m.m[4 + r]);
    out.m[r] = static_cast<float>(c * x + s * y);
    out.m[4 + r] = static_cast<float>(c * y - s * x);
  }
  return out;
}

inline Mat4 inverse_of(const Mat4& m) {
  Mat4 out;
  for (int r = 0; r < 3; ++r) {
    double offset = 0.0;
    for (int c = 0; c < 3; ++c) {
      out.m[4 * c + r] = m.m[4 * r + c];
      offset -= static_cast<double>(m.m[4 * r + c]) * static_cast<double>(m.m[12 + c]);
    }
    out.m[12 + r] = static_cast<float>(offset);
  }
  return out;
}

inline void place_cascades(Case& s) {
  const double to_sun[3] = {0.48, 0.6, 0.64};
  const double right[3] = {0.8, 0.0, -0.6};
  const double up[3] = {-0.36, 0.8, -0.48};
  s.inputs.sun.direction_to_sun = {0.48F, 0.6F, 0.64F};
  s.cascades.clear();
  const float* m = s.inputs.camera.world_from_view.m;
  for (const double end : {2000.0, 8000.0, 30000.0}) {
    Cascade c;
    c.near_m = s.cascades.empty() ? 0.0F : s.cascades.back().far_m;
    c.far_m = static_cast<float>(end);
    double middle[3];
    for (int i = 0; i < 3; ++i) middle[i] = static_cast<double>(m[12 + i]) - 0.5 * end * static_cast<double>(m[8 + i]);
    const auto row = [&](int index, const double* axis, double scale) {
      const double offset = 0.5 - scale * (axis[0] * middle[0] + axis[1] * middle[1] + axis[2] * middle[2]);
      set_row(c.shadow_from_world, index, scale * axis[0], scale * axis[1], scale * axis[2], offset);
    };
    row(0, right, 0.4 / end);
    row(1, up, 0.4 / end);
    row(2, to_sun, (s.desc.shadow_depth_reversed ? 0.5 : -0.5) / (end + 20000.0));
    s.cascades.push_back(c);
  }
}

inline Case right() {
  Case s;
  s.inputs.extent = {160, 100};
  s.inputs.color.view = view_number(1);
  s.inputs.depth.view = view_number(2);
  s.inputs.output.view = view_number(3);
  s.inputs.shadow_maps.view = view_number(4);
  s.inputs.shadow_resolution = 512;
  s.inputs.camera = {camera_at(300.0, 1200.0, -500.0, 0.4, -0.1), projection(0.1, true)};
  place_cascades(s);
  return s;
}

inline std::string error_of(const std::function<void(Case&)>& change) {
  Case s = right();
  change(s);
  const Result<void> result = check_frame(s.frame(), s.desc, s.params);
  return result.ok() ? "" : result.error().message;
}

// Returns the remarks of a checker that may have seen other frames.
inline std::vector<std::string> remarks_of(Remarks& remarks, const Case& s) {
  const FrameInputs inputs = s.frame();
  const Result<void> result = check_frame(inputs, s.desc, s.params);
  EXPECT_TRUE(result.ok()) << result.error().message;
  std::vector<std::string> texts;
  DeviceInfo device;
  device.message = [](void* user, Severity severity, std::string_view text) {
    EXPECT_EQ(severity, Severity::warning);
    static_cast<std::vector<std::string>*>(user)->emplace_back(text);
  };
  device.message_user = &texts;
  const shared::FrameConstants frame = frame_constants(inputs, s.desc, s.params);
  remarks.on_frame(inputs, {s.desc, s.params, frame, s.tables_ready}, device);
  return texts;
}

// Returns the remarks about a frame, one per line.
inline std::string remark_of(const std::function<void(Case&)>& change) {
  Case s = right();
  change(s);
  Remarks remarks;
  std::string all;
  for (const std::string& text : remarks_of(remarks, s)) all += text + "\n";
  return all;
}

inline void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

}  // namespace tyndall
