// The keys of a camera path's keyframes that are read and written like parameters.
#pragma once

#include <optional>
#include <string_view>

#include "scene/description/camera_path.hpp"

namespace tyndall::config {

// The keys of a [[path]] frame that are parameters, and the members that store them.
struct FrameKey {
  std::string_view name, parameter;
  std::optional<float> scene::PathFrame::*target;
};
constexpr FrameKey kFrameKeys[] = {
    {"altitude_m", "camera.altitude_m", &scene::PathFrame::altitude_m},
    {"yaw_deg", "camera.yaw_deg", &scene::PathFrame::yaw_deg},
    {"pitch_deg", "camera.pitch_deg", &scene::PathFrame::pitch_deg},
    {"fov_deg", "camera.fov_deg", &scene::PathFrame::fov_deg},
    {"sun_elevation_deg", "sun.elevation_deg", &scene::PathFrame::sun_elevation_deg},
    {"sun_azimuth_deg", "sun.azimuth_deg", &scene::PathFrame::sun_azimuth_deg},
};

}  // namespace tyndall::config
