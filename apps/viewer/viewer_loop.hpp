// The loop of the viewer: waits for input, receives the results of the scenes, draws the GUI and presents it. It only
// connects the parts of the viewer, which are in their own files.
#pragma once

#include <memory>
#include <string>

#include "tables/pipeline_store.hpp"
#include "viewer/flight.hpp"
#include "viewer/gui/gui.hpp"
#include "viewer/notices.hpp"
#include "viewer/platform/devices.hpp"
#include "viewer/platform/swapchain.hpp"
#include "viewer/platform/window.hpp"
#include "viewer/present_log.hpp"
#include "viewer/redraw.hpp"
#include "viewer/scene_pair.hpp"
#include "viewer/screenshot.hpp"
#include "viewer/script.hpp"
#include "viewer/shader_reload.hpp"
#include "viewer/step_times.hpp"
#include "viewer/view_settings.hpp"
#include "viewer/viewer.hpp"

namespace tyndall::viewer {

class Viewer {
 public:
  explicit Viewer(const ViewerDesc& desc)
      : desc_(desc),
        cache_place_(desc.make_tables.cache.place),
        settings_{desc.settings, desc.settings, desc.state_file} {}
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer() = default;

  Result<void> start();
  Result<void> loop();
  [[nodiscard]] const Devices& devices() const { return devices_; }
  // Saves the settings when the device or the surface is lost, and returns the error for the user.
  Error after_loss(const Error& error);

 private:
  [[nodiscard]] double now() const { return notices_.now(); }
  [[nodiscard]] VkExtent2D picture_extent() const;
  [[nodiscard]] PairRequest pair_request() const;
  [[nodiscard]] LoopState loop_state() const;
  Result<void> step();
  Result<void> take_results();
  void handle_events();
  void run_script();
  void draw_gui();
  [[nodiscard]] GuiFacts gui_facts() const;
  void log_changes(const config::Settings& before, const config::Settings& after, const char* what);
  void update_scenes();
  Result<void> present();

  void handle_key(int key);
  void handle_requests(const GuiRequests& requests);
  void save_state();
  void load_file(const std::string& path, bool over_defaults);
  void finish_screenshot();
  void start_reload();
  Result<void> finish_reload();

  ViewerDesc desc_;
  const std::string cache_place_;  // place of the table cache while the shaders are those of the program
  Gui gui_;
  Redraw redraw_;
  Notices notices_{gui_, redraw_};
  Window window_;
  Devices devices_;
  std::unique_ptr<tables::PipelineStore> pipelines_;  // pipelines of the scenes
  ShaderReload shaders_;                              // outlives the scenes
  Swapchain swapchain_;
  ViewSettings settings_;
  ScenePair pair_{notices_, redraw_};
  Flight flight_{window_, notices_, redraw_};
  Screenshot screenshot_;
  Script script_;
  PresentLog present_log_;
  StepTimes steps_;
  double seconds_ = 0.0;  // time of the scene
  double last_step_ = 0.0;
  double last_memory_log_ = -100.0;
  bool minimised_ = false;
  std::string shader_message_;
};

}  // namespace tyndall::viewer
