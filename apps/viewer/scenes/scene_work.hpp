// The work on one scene: applies requests, builds tables in slices, draws frames and their canvas. It contains
// everything that takes time; scene_thread.hpp runs it beside the GUI's thread.
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

// The requested contents and view of a scene.
struct SceneRequest {
  config::Settings settings;
  VkExtent2D extent = {};  // size of the picture
  int coarseness = 1;      // see TerrainLod
  View view;
  double seconds = 0.0;  // time of the scene
  bool again = false;    // the time has advanced: draw another frame
  bool rest = false;     // the user is idle
  bool capture = false;  // return the picture as images
};

// The state of a scene, as a copy for the GUI while the scene is being worked on.
struct SceneFacts {
  bool can_render = false, building = false;
  bool working = false;     // a file is being read or written
  bool tone_stale = false;  // auto exposure has not settled
  Progress tables = {}, pipelines = {};
  double store_tables_in_s = -1.0;  // negative: nothing to store
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

// The result of a piece of work.
struct SceneResult {
  std::optional<Error> error;        // for the user
  bool over = false;                 // the scene has ended; otherwise it continues with its previous settings
  config::Settings settings;         // settings that are applied or being applied
  config::Settings requested;        // settings of the request that was worked on
  bool frame = false, tone = false;  // a frame was drawn; the last frame was tone mapped again
  double frame_ms = 0.0;             // wall time, including the time spent waiting for the processor
  bool tables = false;               // slices were built
  bool tables_done = false, tables_stored = false, pipelines_done = false;
  std::optional<Picture> picture;
  std::optional<Capture> capture;
  std::vector<std::string> notes;  // remarks that have not been reported yet
};

class SceneWork {
 public:
  SceneWork() = default;
  SceneWork(const SceneWork&) = delete;
  SceneWork& operator=(const SceneWork&) = delete;
  ~SceneWork();

  // Creates the scene, and draws it if its tables are in the cache. `to_host`: see Canvas.
  SceneResult create(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request, bool to_host);
  // Returns whether there is something to do for the request now.
  [[nodiscard]] bool wants(const SceneRequest& request) const;
  // Returns whether the last frame shows the request, apart from tables that are being built and from adaptation.
  [[nodiscard]] bool shows(const SceneRequest& request) const;
  // Does the next piece of work.
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
  Result<void> store_tables();
  [[nodiscard]] bool follows(const SceneRequest& request) const;
  [[nodiscard]] bool building() const;
  [[nodiscard]] bool ready() const { return scene_ != nullptr && scene_->can_render(); }
  [[nodiscard]] bool tone_stale() const;
  [[nodiscard]] double store_in_s() const;
  [[nodiscard]] double step_s();

  gpu::Host* host_ = nullptr;
  scene::SceneDesc desc_;
  config::Settings wanted_, applied_, drawn_settings_;
  std::unique_ptr<scene::Scene> scene_;
  Canvas canvas_;
  View drawn_view_;
  std::future<Result<scene::ElevationSource>> loading_;
  config::Settings loading_for_;
  std::future<std::string> storing_;
  bool unstored_ = false;  // tables were built that are not in the cache
  bool first_tables_ = true;
  Clock::time_point tables_since_;  // when the tables were finished
  bool stale_ = true;
  bool tone_wanted_ = false;
  bool drawn_ = false;       // a frame has been drawn
  bool unmeasured_ = false;  // the results of the frame are not known yet, because it may be executing
  Clock::time_point drawn_at_;
  Progress pipelines_ = {};
  std::uint32_t budget_ = 1;  // slices of tables for one piece of work
  std::size_t notes_reported_ = 0;
};

}  // namespace tyndall::viewer
