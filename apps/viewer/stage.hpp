// One scene that follows its settings while the program goes on: what takes long (creation, terrain files, keeping
// tables) runs on a thread of its own, tables are built in slices, everything else at once.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "config/settings.hpp"
#include "scene/scene.hpp"

namespace tyndall::viewer {

[[nodiscard]] bool same_value(const config::Row& row, const config::Settings& a, const config::Settings& b);
[[nodiscard]] bool same_settings(const config::Settings& a, const config::Settings& b);
// Makes what ranges alone cannot say hold: shadows.first_marched below shadows.cascades.
void make_consistent(config::Settings& settings);

class Stage {
 public:
  // Begins to create the scene; poll() says when it is there.
  void start(gpu::Host& host, const scene::SceneDesc& desc, const config::Settings& settings);
  Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  ~Stage();

  // Takes what threads have finished. An error is one for the user; the stage goes on with what it had.
  Result<void> poll();
  // Follows new settings. An error is one for the user, and the settings stay what settings() says.
  Result<void> follow(const config::Settings& wanted);
  // The settings that have been taken over, or are being taken over.
  [[nodiscard]] const config::Settings& settings() const { return wanted_; }
  Result<void> set_extent(VkExtent2D extent);
  Result<void> set_coarseness(int coarseness);

  // Builds tables for about so long [ms]; whether anything was done.
  Result<bool> advance_tables(double milliseconds);
  // Keeps finished tables in the cache; whether anything was done.
  Result<bool> keep_tables();
  // The frame at `seconds` of the scene's time, `step_s` after the last one.
  Result<void> render(double seconds, double step_s);
  // Only exposure and tone mapping.
  Result<void> tone(double step_s);

  [[nodiscard]] bool ready() const { return scene_ != nullptr && scene_->can_render(); }
  [[nodiscard]] bool creating() const { return creating_.valid(); }
  [[nodiscard]] bool working() const { return creating_.valid() || loading_.valid() || keeping_.valid(); }
  [[nodiscard]] bool building() const;
  // Whether a frame would show something new.
  [[nodiscard]] bool stale() const { return stale_; }
  void make_stale() { stale_ = true; }
  // Whether the picture wants other exposure or tone mapping, because of settings or because the eye still adapts.
  [[nodiscard]] bool tone_stale() const;
  [[nodiscard]] scene::Scene* scene() const { return scene_.get(); }
  // Remarks that have not been taken yet.
  [[nodiscard]] std::vector<std::string> take_notes();

 private:
  [[nodiscard]] config::Settings loaded(config::Settings settings) const;
  void load_terrain();

  gpu::Host* host_ = nullptr;
  scene::SceneDesc desc_;
  config::Settings wanted_, applied_;
  std::unique_ptr<scene::Scene> scene_;
  std::future<Result<std::unique_ptr<scene::Scene>>> creating_;
  std::future<Result<scene::ElevationSource>> loading_;
  scene::TerrainParams loading_for_;
  double loading_radius_m_ = 0.0;
  std::future<std::string> keeping_;
  bool unkept_ = false;      // tables that were built and are not in the cache
  bool stale_ = true;
  bool tone_stale_ = false;
  std::uint32_t budget_ = 1;  // slices that took less than the time allowed
  std::size_t notes_taken_ = 0;
};

}  // namespace tyndall::viewer
