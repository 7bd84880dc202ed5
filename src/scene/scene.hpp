// The demo engine: renders terrain, meshes, sun and shadow cascades into colour and depth, and applies tyndall::Effect.
// Like any engine, it uses only the public interface of the library.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "gpu/timer.hpp"
#include "gpu/upload_ring.hpp"
#include "image/image.hpp"
#include "post/tonemap.hpp"
#include "scene/mesh/meshes.hpp"
#include "scene/sky/light_meter.hpp"
#include "scene/sky/sky_model.hpp"
#include "scene/terrain/terrain.hpp"
#include "tables/make_ready.hpp"

namespace tyndall::scene {

struct SceneDesc {
  VkExtent2D extent = {1280, 720};
  bool timings = false;  // if the queue has timestamps
  bool counters = false;
  bool histogram = false;              // measure every picture, not only those that auto exposure needs
  tables::MakeReady make_tables = {};  // how the tables are built and cached
  bool tables_later = false;           // build the tables with advance_tables() instead of in create()
  bool illuminance = false;            // measure the illuminance at the camera with every picture
  int terrain_coarseness = 1;          // minimum of TerrainLod::coarseness; small pictures use a larger value
  bool reuse_shadows = true;           // reuse shadow maps that would not change
  std::uint32_t pipeline_threads = 1;  // see EffectDesc
  bool in_parts = false;               // submit a frame in parts, so that other users of the queue get their turn
  // If above 0, a frame is recorded while the previous one executes. render() then returns before the frame is
  // complete, and timings(), exposure() and counters() are those of the last frame that is known to be complete. While
  // frames take longer than this, render() waits for each, because other users of the queue would have to wait for two
  // frames.
  double ahead_up_to_ms = 0.0;
};

struct PassTime {
  std::string name;
  double ms = 0.0;
  bool in_effect = false;
};

class Scene {
 public:
  // Loads the terrain and builds the tables unless they are cached. Takes seconds.
  static Result<std::unique_ptr<Scene>> create(gpu::Host& host, const SceneDesc& desc, const Params& params,
                                               const SceneParams& scene);

  // Set new parameters. An error changes nothing, including the next frame. A different terrain is loaded, which takes
  // long for large files, unless set_terrain() has provided it. A change back to scattering.model = atmosphere, or of
  // parameters of the atmosphere, rebuilds the tables, unless SceneDesc::tables_later is set. Running out of memory is
  // an error; no function throws std::bad_alloc.
  Result<void> set_scene(const SceneParams& scene);
  Result<void> set_params(const Params& params);
  // Sets a terrain that Terrain::load_source() has loaded for these parameters and this radius of the planet.
  Result<void> set_terrain(const TerrainParams& params, double radius_m, ElevationSource source);
  // `terrain_coarseness`: see SceneDesc.
  Result<void> set_extent(VkExtent2D extent, std::optional<int> terrain_coarseness = {});

  // Reads the tables of the parameters from the cache, or builds `budget` slices of them (see
  // Effect::precompute_progress()). Until they are complete, frames use the previous tables. If there are none,
  // render() fails.
  Result<Progress> advance_tables(std::uint32_t budget);
  [[nodiscard]] bool can_render() const { return model_ != nullptr || tables_ready_; }
  Effect& effect() { return *effect_; }

  // Renders the frame at `seconds` of the sequence. After an error, the next call draws the frame that this call should
  // have drawn. `copy_baseline`: also measure a pass that only copies the picture. `step_s`: the time in which the
  // exposure adapts to this frame; by default the time since the previous frame. The first frame, and a frame at the
  // same time as the previous one, is exposed independently.
  Result<void> render(double seconds, bool copy_baseline = false, std::optional<double> step_s = {});

  // Waits until all frames are complete, takes their results, and measures the illuminance.
  Result<void> finish();

  // Exposes and tone maps the last rendered frame again, `step_s` later. Used while the exposure adapts, and if only
  // tonemap.* has changed.
  Result<void> tone(double step_s);

  // Return the last rendered frame: its radiance, or display values from 0 to 1 after tone mapping. Both are linear.
  Result<image::Image> radiance();
  Result<image::Image> display();
  struct Exposure {
    // The illuminance by sun and sky at the camera, with SceneDesc::illuminance, without moonlight. Empty if the light
    // has no unit (scattering.color = rgb), if the medium or the model is not the atmosphere, or with a camera in
    // space.
    std::optional<Illuminance> illuminance;
    float scale = 1.0F;             // factor of the radiance
    std::optional<double> ev100;    // exposure value of `scale`; empty if that is 0, or if the sun has no light
    post::Measurement measurement;  // with auto exposure or SceneDesc::histogram
  };
  [[nodiscard]] Exposure exposure() const;
  [[nodiscard]] const std::vector<PassTime>& timings() const { return times_; }

  // The images of the last rendered frame, on the device. `display` and `output` (radiance) are in GENERAL layout,
  // the others in SHADER_READ_ONLY_OPTIMAL; shadow_maps is an array with one layer per cascade.
  struct Images {
    const gpu::Image &display, &output, &color, &depth, &shadow_maps;
    const View& view;  // the view that they were drawn from
  };
  [[nodiscard]] Images images() const { return {display_, output_, color_, depth_, shadow_maps_, view_}; }
  // Returns the ground that is drawn, which any thread may read; nullptr for the bare sphere at sea level.
  [[nodiscard]] std::shared_ptr<const ElevationSource> elevations() const {
    return bare_ground() ? nullptr : terrain_->source();
  }

  // Returns remarks for the user, one line each: assumptions about a file, parameters without effect, and whether the
  // camera was raised above the ground.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  // Returns where the origin of the world is on the Earth, if an elevation file says so.
  [[nodiscard]] const std::optional<Place>& place() const { return terrain_->place(); }
  struct Memory {
    VkDeviceSize effect_persistent = 0, effect_transient = 0, effect_host = 0;
    std::vector<ResourceMemory> effect_resources;  // the parts of effect_persistent
    VkDeviceSize scene = 0;
  };
  // Returns the counters of the last rendered frame; needs SceneDesc::counters.
  [[nodiscard]] Counters counters() const;
  [[nodiscard]] Memory memory() const;

 private:
  Result<void> create_objects();
  [[nodiscard]] Result<std::unique_ptr<Effect>> make_effect(const EffectDesc& desc);
  // Creates the effect again after recorded commands were not submitted, because the effect counts them as done.
  Result<void> replace_lost_effect();
  // The images whose size is that of the picture.
  struct Targets {
    gpu::Image color, depth, output, display;
  };
  // An image with a view of each layer.
  struct Layered {
    gpu::Image image;
    std::vector<gpu::Handle<VkImageView>> layers;
  };
  struct Pending;  // prepared changes
  [[nodiscard]] Result<Targets> make_targets(VkExtent2D extent) const;
  [[nodiscard]] Result<Layered> make_layered(const gpu::ImageDesc& desc) const;
  [[nodiscard]] Result<Layered> make_shadow_maps(const ShadowParams& shadows) const;
  [[nodiscard]] Result<Layered> make_shadow_colors(const ShadowParams& shadows, bool glass) const;
  [[nodiscard]] Result<std::unique_ptr<Meshes>> make_meshes(const SceneParams& scene, double radius_m) const;
  [[nodiscard]] Result<std::unique_ptr<SkyModel>> make_model(const SceneParams& scene) const;
  Result<void> make_tables_ready();
  [[nodiscard]] Result<Pending> plan(const SceneParams& scene, const Params& params,
                                     std::optional<ElevationSource> source);
  void swap(Pending& pending) noexcept;
  // Plans and applies a change. An error changes nothing. `source`: elevations of the terrain, if they have been
  // loaded.
  Result<void> change(const SceneParams& scene, const Params& params, std::optional<ElevationSource> source);
  void swap_targets(Targets& targets) noexcept;
  // Waits until all frames are complete, and takes their results.
  Result<void> wait_for_frames();
  // Waits until the frame that was recorded with a slot is complete, and takes its results.
  Result<void> finish(std::uint32_t slot);
  void take_results(std::uint32_t slot);
  [[nodiscard]] bool ahead() const { return desc_.ahead_up_to_ms > 0.0; }
  // Returns whether the frame that is being drawn is waited for.
  [[nodiscard]] bool waits() const { return !ahead() || slow_; }
  // Returns the slot of the frame that is being drawn, or of the next one.
  [[nodiscard]] std::uint32_t slot() const {
    return ahead() ? static_cast<std::uint32_t>(frame_index_ % gpu::kFramesInFlight) : 0;
  }
  Result<void> execute(const gpu::Host::Record& record);
  [[nodiscard]] bool shadows_are_drawn() const;
  // Returns whether no terrain is drawn, because of terrain.source or because the model draws its own sphere.
  [[nodiscard]] bool bare_ground() const;
  Result<void> draw_shadows(VkCommandBuffer cmd);
  Result<void> draw_shadow_colors(VkCommandBuffer cmd);
  Result<void> draw_view(VkCommandBuffer cmd);
  Result<void> run_effect(VkCommandBuffer cmd);
  Result<void> copy_color(VkCommandBuffer cmd);
  Result<void> tonemap(VkCommandBuffer cmd, bool first);
  Result<void> run_copy_baseline(VkCommandBuffer cmd);
  Result<void> copy_to(VkCommandBuffer cmd, const gpu::Image& to);
  [[nodiscard]] Result<std::optional<Illuminance>> measure_illuminance();
  Result<void> draw_frame(double seconds, bool copy_baseline, std::optional<double> step_s);
  // Places the sun, the moon, and the one of them that lights the scene (moon.light_below_deg).
  Result<void> place_lights(double seconds);
  Result<void> render_sample(double seconds, const glm::dvec2& jitter, bool first, bool copy_baseline);
  // Records and submits one sample of a frame.
  Result<void> run_passes(bool first, bool copy_baseline);
  Result<void> accumulate(const gpu::Image& image, image::Image& sum);
  Result<image::Image> average(const gpu::Image& image, const image::Image& sum);
  Result<image::Image> read_back(const gpu::Image& image);
  void begin_pass(VkCommandBuffer cmd, const char* name);
  void end_pass(VkCommandBuffer cmd);

  gpu::Host* host_ = nullptr;
  SceneDesc desc_;
  Params params_;
  SceneParams scene_;
  std::unique_ptr<Terrain> terrain_;
  std::unique_ptr<Meshes> meshes_;  // nullptr if there is only terrain
  std::vector<std::string> notes_;  // outlives the effect, which writes to it
  std::unique_ptr<Effect> effect_;
  std::optional<Illuminance> illuminance_;
  bool illuminance_stale_ = false;
  std::unique_ptr<LightMeter> light_meter_;  // reads the effect's tables; nullptr until it is needed
  std::unique_ptr<SkyModel> model_;          // nullptr if the effect draws the atmosphere
  bool tables_ready_ = false;
  std::unique_ptr<post::Tonemap> tonemap_;
  gpu::Image color_, depth_, shadow_maps_, shadow_colors_, output_, display_;
  std::vector<gpu::Handle<VkImageView>> shadow_layers_, shadow_color_layers_;  // a view of each layer
  gpu::Handle<VkSampler> linear_, nearest_, shadow_compare_;
  gpu::Pipeline background_, copy_baseline_;
  gpu::UploadRing background_constants_;
  gpu::Timer timer_;

  View view_;
  LocalFrame frame_;  // the frame in which everything is drawn
  glm::dvec3 to_sun_ = {};
  MoonParams moon_;  // the moon with the angles at which it stands
  // The light that falls on the scene: the sun, or the moon with moon.light.
  struct KeyLight {
    glm::dvec3 direction = {};
    Vec3 irradiance;
    float angular_radius_deg = 0.0F;
  } key_light_;
  std::vector<CascadeFit> cascades_;
  TerrainLight light_;
  std::uint64_t frame_index_ = 0;
  // The frames that may be executing, by slot. They are waited for before the members above, which they use, are
  // destroyed.
  struct InFlight {
    InFlight() = default;
    InFlight(const InFlight&) = delete;
    InFlight& operator=(const InFlight&) = delete;
    ~InFlight();
    gpu::Host* host = nullptr;     // set with `submission`
    std::uint64_t submission = 0;  // the last one of the frame; see gpu::Host::wait()
    std::uint64_t frame_index = 0;
    bool taken = true;  // the results of the frame have been taken
  };
  std::array<InFlight, gpu::kFramesInFlight> in_flight_;
  // The results of the newest frame that is known to be complete. The times of its passes are in `times_`.
  post::Measurement measurement_;
  Counters counters_;
  bool slow_ = false;                   // that frame took longer than SceneDesc::ahead_up_to_ms
  std::optional<double> last_seconds_;  // time of the previous frame, if its exposure was measured
  double step_s_ = 0.0;
  bool images_ready_ = false;
  bool effect_lost_ = false;                // see replace_lost_effect()
  bool lifted_ = false;                     // the camera has been raised above the ground, and a note says so
  std::vector<CascadeFit> drawn_cascades_;  // the cascades that the shadow maps now contain
  std::uint64_t drawn_terrain_ = 0;
  image::Image radiance_sum_, display_sum_;  // with camera.samples > 1
  std::vector<PassTime> times_;
};

// Returns an error if scattering.model cannot draw the contents of `scene`.
[[nodiscard]] Result<void> check_model(const SceneParams& scene);
// Appends the notes that are not in the list yet.
void add_notes(std::vector<std::string>& notes, const std::vector<std::string>& more);

}  // namespace tyndall::scene
