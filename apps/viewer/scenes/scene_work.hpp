// The work on one scene: follows what is wished for, builds tables in slices, draws frames and their canvas. Everything
// that a scene takes time for is here; scene_thread.hpp runs it on a thread beside the GUI's.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"
#include "viewer/scenes/canvas.hpp"

namespace tyndall::viewer {

// What a scene is to be and to show.
struct SceneRequest {
  config::Settings settings;
  VkExtent2D extent = {};  // of the picture
  int coarseness = 1;      // of the ground
  View view;
  double seconds = 0.0;  // of the scene's own time
  bool again = false;    // which has gone on
  bool rest = false;     // the hands do
  bool capture = false;  // the picture is wanted as an image
};

// What a scene says of itself: a copy, for the GUI while the scene is worked on.
struct SceneFacts {
  bool can_render = false, building = false;
  bool working = false;     // a file is read or written beside
  bool tone_stale = false;  // the eye still adapts
  Progress tables = {}, pipelines = {};
  double keep_tables_in_s = -1.0;  // negative: nothing to keep
  std::vector<scene::PassTime> timings;
  scene::Scene::Exposure exposure;
  scene::Scene::Memory memory;
  VkExtent2D extent = {};
  int shadow_layers = 1;
  std::shared_ptr<const scene::ElevationSource> elevations;
  double radius_m = 0.0;
};

struct Capture {
  image::Image display, radiance;
  config::Settings settings;
};

// What came of a piece of work.
struct SceneResult {
  std::optional<Error> error;        // for the user
  bool over = false;                 // after that the scene does not go on; otherwise with what it had
  config::Settings settings;         // taken over, or being taken over
  config::Settings asked;            // of the wish
  bool frame = false, tone = false;  // was drawn
  double frame_ms = 0.0;             // until it was there, waiting for the machine included
  bool tables = false;               // slices were built
  bool tables_done = false, tables_kept = false, pipelines_done = false;
  std::optional<Picture> picture;
  std::optional<Capture> capture;
  std::vector<std::string> notes;  // remarks that have not been told yet
};

class SceneWork {
 public:
  SceneWork() = default;
  SceneWork(const SceneWork&) = delete;
  SceneWork& operator=(const SceneWork&) = delete;
  ~SceneWork();

  // Creates the scene, and draws it when its tables are in the cache. `to_host`: see Canvas.
  SceneResult create(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request, bool to_host);
  // Whether there is something to do for the wish now.
  [[nodiscard]] bool wants(const SceneRequest& request) const;
  // Whether the last frame is that of the wish, but for the tables that are still being built and the eye that adapts.
  [[nodiscard]] bool shows(const SceneRequest& request) const;
  // The next piece.
  SceneResult run(const SceneRequest& request);

  [[nodiscard]] bool exists() const { return scene_ != nullptr; }
  [[nodiscard]] SceneFacts facts() const;

 private:
  using Clock = std::chrono::steady_clock;

  Result<void> take_terrain();
  Result<void> resize(const SceneRequest& request);
  Result<void> follow_settings(const config::Settings& wanted);
  void load_terrain();
  [[nodiscard]] config::Settings loaded(config::Settings settings) const;
  Result<void> next(const SceneRequest& request, SceneResult& out);
  Result<void> advance_tables(SceneResult& out);
  Result<void> draw(const SceneRequest& request, SceneResult& out);
  Result<void> capture(SceneResult& out);
  Result<void> keep_tables();
  [[nodiscard]] bool follows(const SceneRequest& request) const;
  [[nodiscard]] bool building() const;
  [[nodiscard]] bool ready() const { return scene_ != nullptr && scene_->can_render(); }
  [[nodiscard]] bool tone_stale() const;
  [[nodiscard]] double keep_in_s() const;
  [[nodiscard]] double step_s();

  gpu::Host* host_ = nullptr;
  scene::SceneDesc desc_;
  config::Settings wanted_, applied_, drawn_settings_;
  std::unique_ptr<scene::Scene> scene_;
  Canvas canvas_;
  View drawn_view_;
  std::future<Result<scene::ElevationSource>> loading_;
  config::Settings loading_for_;
  std::future<std::string> keeping_;
  bool unkept_ = false;  // tables that were built and are not in the cache
  bool first_tables_ = true;
  Clock::time_point tables_since_;  // when they were finished
  bool stale_ = true;
  bool tone_wanted_ = false;
  bool drawn_ = false;  // there is a frame
  Clock::time_point drawn_at_;
  Progress pipelines_ = {};
  std::uint32_t budget_ = 1;  // slices that took less than the time allowed
  std::size_t notes_told_ = 0;
};

}  // namespace tyndall::viewer
