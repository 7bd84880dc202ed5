#include "window_tools.hpp"

#include <sstream>

namespace tyndall::desk {

Frame frame_of(const std::string& line) {
  Frame f;
  std::istringstream text(line);
  std::string word;
  double time = 0.0;
  double ms = 0.0;
  text >> time >> word >> word >> f.number >> f.width >> f.height >> word >> ms >> word >> f.x >> f.y >> f.z >> f.yaw >>
      f.pitch >> f.fov >> word >> f.azimuth >> f.elevation;
  return f;
}

std::vector<Frame> frames(const Desk& desk) {
  std::vector<Frame> out;
  std::istringstream text(log_text(desk));
  for (std::string line; std::getline(text, line);) {
    if (line.find(" frame left ") != std::string::npos) out.push_back(frame_of(line));
  }
  return out;
}

Frame last_frame(const Desk& desk) {
  const std::vector<Frame> all = frames(desk);
  return all.empty() ? Frame() : all.back();
}

bool pull(Desk& desk, const std::string& key, const std::vector<double>& ways) {
  if (!desk.point_at(key, 0.25)) return false;
  std::size_t at = desk.lines();
  desk.input("mousedown 1");
  if (!desk.wait_for({"press left"}, at)) return false;
  for (const double part : ways) {
    if (!desk.point_at(key, part)) return false;
  }
  at = desk.lines();
  desk.input("mouseup 1");
  return desk.wait_for({"release left"}, at).has_value();
}

std::string key_of(const std::string& panel) {
  if (panel == "Basic") return "epipolar.slices";
  if (panel == "Additional") return "shadows.cascades";
  if (panel == "Tone mapping") return "tonemap.white_point";
  if (panel == "Atmosphere") return "planet.radius_m";
  return "group.camera";
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool compare_two(Desk& desk) {
  if (!desk.click("menu.Windows") || !desk.click("item.Views and comparison") || !desk.wait_for_place("compare"))
    return false;
  const std::size_t from = desk.lines();
  return desk.click("compare", 0.1) && desk.wait_for({"shown two"}, from).has_value();
}

}  // namespace tyndall::desk
