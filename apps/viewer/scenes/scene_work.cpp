#include "viewer/scenes/scene_work.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/phase_file.hpp"
#include "gpu/try.hpp"
#include "scene/description/camera_exposure.hpp"
#include "scene/description/terrain_key.hpp"
#include "viewer/platform/window.hpp"
#include "viewer/scenes/settings_compare.hpp"

namespace tyndall::viewer {
namespace {

constexpr std::uint32_t kMaxSlices = 64;
constexpr double kTables_ms = 60.0;  // how long one piece of work should build tables
constexpr double kTonePeriod_s = 1.0 / 60.0;
// Tables are stored only once the parameters have been stable for this long, so that dragging a slider does not fill
// the cache.
constexpr double kStoreFirstAfter_s = 1.0;
constexpr double kStoreAfter_s = 20.0;

template <typename T>
bool is_done(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

scene::TerrainKey key_of(const config::Settings& settings) {
  return scene::terrain_key(settings.scene.terrain, settings.effect.planet);
}

void set_terrain_key(const scene::TerrainKey& key, config::Settings& settings) {
  scene::set_terrain_key(key, settings.scene.terrain, settings.effect.planet);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

SceneWork::~SceneWork() {
  if (loading_.valid()) loading_.wait();
  if (storing_.valid()) storing_.wait();
}

SceneResult SceneWork::create(gpu::Host& host, const scene::SceneDesc& desc, const SceneRequest& request,
                              bool to_host) {
  host_ = &host;
  desc_ = desc;
  desc_.extent = request.extent;
  desc_.terrain_coarseness = request.coarseness;
  desc_.tables_later = true;
  wanted_ = applied_ = request.settings;
  applied_.scene.camera.samples = 1;  // several samples are averaged on the host, but the canvas reads device images
  SceneResult out;
  out.settings = wanted_;
  const Result<void> done = [&]() -> Result<void> {
    TYNDALL_TRY(config::load_files(applied_));
    TYNDALL_TRY(canvas_.create(host, to_host, desc.ahead_up_to_ms > 0.0));
    TYNDALL_ASSIGN(scene_, scene::Scene::create(host, desc_, applied_.effect, applied_.scene));
    // The first step searches the cache: if the tables are there, the first frame is drawn at once.
    if (building()) {
      TYNDALL_TRY(scene_->advance_tables(1));
      unstored_ = building();
    }
    if (ready()) TYNDALL_TRY(draw(request, out));
    return {};
  }();
  if (!done) {
    out.error = done.error();
    out.over = true;
    scene_.reset();
    return out;
  }
  out.notes = scene_->notes();
  notes_reported_ = out.notes.size();
  return out;
}

bool SceneWork::building() const {
  return scene_ != nullptr && applied_.scene.scattering.model == scene::ScatteringModel::atmosphere &&
         !scene_->effect().precompute_progress().complete();
}

bool SceneWork::tone_stale() const {
  if (tone_wanted_ || (unmeasured_ && drawn_ && !stale_)) return true;
  const scene::TonemapParams& params = applied_.scene.tonemap;
  if (!scene::is_auto_exposed(params) || !params.light_adaptation || !drawn_ || stale_) return false;
  constexpr float kAdapted = 0.005F;  // relative difference that is not visible
  const post::Measurement m = scene_->exposure().measurement;
  return m.measured > 0.0F &&
         std::abs(m.luminance - std::max(m.measured, params.least_luminance)) > kAdapted * m.luminance;
}

double SceneWork::store_in_s() const {
  if (!unstored_ || storing_.valid() || building() || desc_.make_tables.cache.place == "off") return -1.0;
  return std::max((first_tables_ ? kStoreFirstAfter_s : kStoreAfter_s) - seconds_since(tables_since_), 0.0);
}

bool SceneWork::follows(const SceneRequest& request) const {
  return request.extent.width == desc_.extent.width && request.extent.height == desc_.extent.height &&
         request.coarseness == desc_.terrain_coarseness && same_settings(request.settings, wanted_);
}

bool SceneWork::shows(const SceneRequest& request) const { return drawn_ && !stale_ && follows(request); }

bool SceneWork::wants(const SceneRequest& request) const {
  if (scene_ == nullptr) return false;
  if (is_done(loading_) || is_done(storing_)) return true;
  if (!follows(request) || building()) return true;
  if (!ready()) return false;
  if (stale_ || request.again || request.capture || !same_view(request.view, drawn_view_)) return true;
  if (tone_stale() && seconds_since(drawn_at_) >= kTonePeriod_s) return true;
  return request.rest && (store_in_s() == 0.0 || !pipelines_.complete() || pipelines_.total == 0);
}

SceneResult SceneWork::run(const SceneRequest& request) {
  SceneResult out;
  out.requested = request.settings;
  // Capture the frame that is shown before drawing the next one, because during a flight a next one is always due.
  if (request.capture && drawn_) {
    if (Result<void> captured = capture(out); !captured) {
      out.error = captured.error();
      out.over = true;
    }
    out.settings = wanted_;
    return out;
  }
  Result<void> done = take_terrain();
  if (done) done = follow_settings(request.settings);
  if (!done) out.error = done.error();
  done = resize(request);
  if (done) done = next(request, out);
  if (!done) {
    out.error = done.error();
    out.over = true;
  }
  out.settings = wanted_;
  const std::vector<std::string>& notes = scene_->notes();
  out.notes.insert(out.notes.end(),
                   notes.begin() + static_cast<std::ptrdiff_t>(std::min(notes_reported_, notes.size())), notes.end());
  notes_reported_ = notes.size();
  return out;
}

Result<void> SceneWork::next(const SceneRequest& request, SceneResult& out) {
  if (is_done(storing_)) {
    const std::string note = storing_.get();
    out.tables_stored = note.empty();
    if (!out.tables_stored) out.notes.push_back(note);
  }
  if (building()) TYNDALL_TRY(advance_tables(out));
  if (!ready()) return {};
  if (stale_ || request.again || !same_view(request.view, drawn_view_)) return draw(request, out);
  TYNDALL_TRY(scene_->finish());
  unmeasured_ = false;
  if (tone_stale()) return draw(request, out);
  if (!request.rest || out.tables) return {};
  if (store_in_s() == 0.0) return store_tables();
  if (!pipelines_.complete() || pipelines_.total == 0) {
    TYNDALL_ASSIGN(pipelines_, scene_->effect().prepare_pipelines(1));
    out.pipelines_done = pipelines_.complete();
  }
  return {};
}

// Builds tables for about kTables_ms.
Result<void> SceneWork::advance_tables(SceneResult& out) {
  const Clock::time_point start = Clock::now();
  const std::uint32_t budget = budget_;
  const bool fresh = scene_->effect().precompute_progress().done == 0;
  TYNDALL_ASSIGN(const Progress progress, scene_->advance_tables(budget));
  const double took_ms = 1000.0 * seconds_since(start);
  if (took_ms > kTables_ms) budget_ = std::max(budget_ / 2, 1U);
  if (took_ms < 0.4 * kTables_ms) budget_ = std::min(budget_ * 2, kMaxSlices);
  out.tables = true;
  if (!progress.complete()) return {};
  // If the first call completed more slices than its budget, the tables came from the cache.
  if (fresh && progress.total > budget) unstored_ = false;
  out.tables_done = stale_ = true;
  tables_since_ = Clock::now();
  return {};
}

// Returns the time since this scene was last drawn.
double SceneWork::step_s() {
  const Clock::time_point before = std::exchange(drawn_at_, Clock::now());
  return std::clamp(std::chrono::duration<double>(drawn_at_ - before).count(), 1.0e-3, 1.0);
}

// Returns the last drawn frame as images.
Result<void> SceneWork::capture(SceneResult& out) {
  TYNDALL_ASSIGN(image::Image display, scene_->display());
  TYNDALL_ASSIGN(image::Image radiance, scene_->radiance());
  out.capture = Capture{std::move(display), std::move(radiance), drawn_settings_};
  return {};
}

Result<void> SceneWork::draw(const SceneRequest& request, SceneResult& out) {
  if (stale_ || request.again) {
    const Clock::time_point start = Clock::now();
    stale_ = tone_wanted_ = false;
    TYNDALL_TRY(scene_->render(request.seconds, false, step_s()));
    out.frame = drawn_ = true;
    unmeasured_ = desc_.ahead_up_to_ms > 0.0;
    drawn_settings_ = loaded(wanted_);
    out.frame_ms = 1000.0 * seconds_since(start);
  } else if (tone_stale()) {
    tone_wanted_ = false;
    TYNDALL_TRY(scene_->tone(step_s()));
    out.tone = true;
    drawn_settings_.scene.tonemap = wanted_.scene.tonemap;
  }
  TYNDALL_ASSIGN(out.picture, canvas_.draw(*scene_, request.view));
  drawn_view_ = request.view;
  return {};
}

// Stores the tables on another thread; next() notices when it is done.
Result<void> SceneWork::store_tables() {
  unstored_ = first_tables_ = false;
  TYNDALL_ASSIGN(tables::CacheWriter writer,
                 tables::CacheWriter::fetch(*host_, scene_->effect(), desc_.make_tables.cache));
  storing_ = std::async(std::launch::async, [store = std::move(writer)]() mutable {
    std::string note = store.write();
    Window::wake();
    return note;
  });
  return {};
}

// Installs a terrain that has been loaded.
Result<void> SceneWork::take_terrain() {
  if (!is_done(loading_)) return {};
  Result<scene::ElevationSource> source = loading_.get();
  if (!source) {
    set_terrain_key(key_of(applied_), wanted_);
    return source.error();
  }
  const double radius_m = loading_for_.effect.planet.radius_m;
  TYNDALL_TRY(scene_->set_terrain(loading_for_.scene.terrain, radius_m, std::move(source).value()));
  set_terrain_key(key_of(loading_for_), applied_);
  stale_ = true;
  // The radius of the atmosphere follows that of the ground.
  TYNDALL_TRY(scene_->set_params(applied_.effect));
  const config::Settings wanted = std::exchange(wanted_, applied_);
  return follow_settings(wanted);
}

// Returns `settings` with the terrain that is loaded.
config::Settings SceneWork::loaded(config::Settings settings) const {
  set_terrain_key(key_of(applied_), settings);
  // Without terrain, only the effect can draw, so it replaces another model until there is terrain again.
  if (settings.scene.terrain.source == "none") settings.scene.scattering.model = scene::ScatteringModel::atmosphere;
  settings.scene.camera.samples = 1;
  return settings;
}

void SceneWork::load_terrain() {
  if (loading_.valid()) return;  // take_terrain() calls this again
  if (key_of(wanted_) == key_of(applied_)) return;
  loading_for_ = wanted_;
  loading_ = std::async(std::launch::async, [device = &host_->device(), params = wanted_.scene.terrain,
                                             radius = wanted_.effect.planet.radius_m] {
    Result<scene::ElevationSource> source = scene::Terrain::load_source(*device, params, radius);
    Window::wake();
    return source;
  });
}

Result<void> SceneWork::resize(const SceneRequest& request) {
  const bool other_extent = request.extent.width != desc_.extent.width || request.extent.height != desc_.extent.height;
  if (!other_extent && request.coarseness == desc_.terrain_coarseness) return {};
  TYNDALL_TRY(scene_->set_extent(request.extent, request.coarseness));
  desc_.extent = request.extent;
  desc_.terrain_coarseness = request.coarseness;
  stale_ = true;
  return {};
}

Result<void> SceneWork::follow_settings(const config::Settings& wanted) {
  if (same_settings(wanted, wanted_)) return {};
  config::Settings next = wanted;
  TYNDALL_TRY(config::load_files(next));
  // The aperture and the exposure time are set one after the other. One of them alone has no effect.
  scene::TonemapParams& tonemap = next.scene.tonemap;
  if ((tonemap.aperture > 0.0F) != (tonemap.shutter_s > 0.0F)) tonemap.aperture = tonemap.shutter_s = 0.0F;
  TYNDALL_TRY(config::check(next));
  next = loaded(std::move(next));
  const bool only_tone = same_but_for_tone(wanted, wanted_);
  if (affected(applied_.effect, next.effect) != 0) {
    TYNDALL_TRY(scene_->set_params(next.effect));
    applied_.effect = next.effect;
    if (building()) {
      unstored_ = true;
      first_tables_ = false;
    }
  }
  wanted_.effect = wanted.effect;
  if (Result<void> set = scene_->set_scene(next.scene); !set) {
    stale_ = true;
    return set;
  }
  (only_tone ? tone_wanted_ : stale_) = true;
  applied_.scene = next.scene;
  wanted_ = wanted;
  load_terrain();
  return {};
}

SceneFacts SceneWork::facts() const {
  SceneFacts f;
  if (scene_ == nullptr) return f;
  f.can_render = ready();
  f.building = building();
  f.working = loading_.valid() || storing_.valid();
  f.tables = scene_->effect().precompute_progress();
  f.pipelines = pipelines_;
  f.store_tables_in_s = store_in_s();
  f.extent = desc_.extent;
  f.shadow_layers = static_cast<int>(scene_->images().shadow_maps.desc.layers);
  f.elevations = scene_->elevations();
  f.radius_m = applied_.effect.planet.radius_m;
  f.memory = scene_->memory();
  if (!drawn_) return f;
  f.tone_stale = tone_stale();
  f.timings = scene_->timings();
  f.exposure = scene_->exposure();
  return f;
}

}  // namespace tyndall::viewer
