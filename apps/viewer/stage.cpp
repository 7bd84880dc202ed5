#include "stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"
#include "window.hpp"

namespace tyndall::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kMostSlices = 64;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <typename T>
bool is_done(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

const std::byte* at(const config::Row& row, const config::Settings& settings) {
  const auto* base = row.owner == config::Owner::effect ? reinterpret_cast<const std::byte*>(&settings.effect)
                                                        : reinterpret_cast<const std::byte*>(&settings.scene);
  return base + row.info.offset;
}

bool same_terrain(const scene::TerrainParams& a, const scene::TerrainParams& b) {
  return a.source == b.source && a.seed == b.seed && a.exaggeration == b.exaggeration;
}

}  // namespace

bool same_value(const config::Row& row, const config::Settings& a, const config::Settings& b) {
  if (row.info.type == ParamType::string) {
    return *reinterpret_cast<const std::string*>(at(row, a)) == *reinterpret_cast<const std::string*>(at(row, b));
  }
  const std::size_t count = row.info.type == ParamType::vec3 ? 3 : row.info.type == ParamType::uvec4 ? 4 : 1;
  return std::memcmp(at(row, a), at(row, b), 4 * count) == 0;
}

bool same_settings(const config::Settings& a, const config::Settings& b) {
  return std::all_of(config::rows().begin(), config::rows().end(),
                     [&](const config::Row& row) { return same_value(row, a, b); });
}

void make_consistent(config::Settings& settings) {
  scene::ShadowParams& shadows = settings.scene.shadows;
  shadows.first_marched = std::min(shadows.first_marched, shadows.cascades - 1);
}

Stage::~Stage() {
  if (creating_.valid()) creating_.wait();
  if (loading_.valid()) loading_.wait();
  if (keeping_.valid()) keeping_.wait();
}

void Stage::start(gpu::Host& host, const scene::SceneDesc& desc, const config::Settings& settings) {
  host_ = &host;
  desc_ = desc;
  desc_.tables_later = true;
  wanted_ = applied_ = settings;
  applied_.scene.camera.samples = 1;
  creating_ = std::async(std::launch::async, [&host, made_from = desc_, settings = applied_] {
    Result<std::unique_ptr<scene::Scene>> made = scene::Scene::create(host, made_from, settings.effect, settings.scene);
    // The first step looks into the cache: with tables there, the scene comes ready to draw.
    if (made && !made.value()->tables_progress().complete()) {
      if (Result<Progress> step = made.value()->advance_tables(1); !step) made = step.error();
    }
    // The first frame takes longest: the device's driver makes its own of the shaders, the ground is filled.
    if (made && made.value()->can_render()) {
      if (Result<void> drawn = made.value()->render(0.0); !drawn) made = drawn.error();
    }
    Window::wake();
    return made;
  });
}

std::vector<std::string> Stage::take_notes() {
  if (scene_ == nullptr) return {};
  const std::vector<std::string>& all = scene_->notes();
  std::vector<std::string> out(all.begin() + static_cast<std::ptrdiff_t>(std::min(notes_taken_, all.size())), all.end());
  notes_taken_ = all.size();
  return out;
}

Result<void> Stage::poll() {
  if (is_done(keeping_)) {
    if (const std::string note = keeping_.get(); !note.empty()) return Error{ErrorCode::io, note};
  }
  if (is_done(creating_)) {
    Result<std::unique_ptr<scene::Scene>> made = creating_.get();
    if (!made) return made.error();
    scene_ = std::move(made).value();
    notes_taken_ = 0;
    unkept_ = building();
    stale_ = !ready();  // it comes with its first frame
    // What changed meanwhile.
    if (scene_->extent().width != desc_.extent.width || scene_->extent().height != desc_.extent.height) {
      TYNDALL_TRY(scene_->set_extent(desc_.extent));
      stale_ = true;
    }
    const config::Settings wanted = wanted_;
    wanted_ = applied_;
    TYNDALL_TRY(follow(wanted));
  }
  if (is_done(loading_)) {
    Result<scene::ElevationSource> source = loading_.get();
    if (!source) {
      // As before the change.
      wanted_.scene.terrain.source = applied_.scene.terrain.source;
      wanted_.scene.terrain.seed = applied_.scene.terrain.seed;
      wanted_.scene.terrain.exaggeration = applied_.scene.terrain.exaggeration;
      wanted_.effect.planet.radius_m = applied_.effect.planet.radius_m;
      return source.error();
    }
    TYNDALL_TRY(scene_->set_terrain(loading_for_, loading_radius_m_, std::move(source).value()));
    const scene::TerrainShading shading = applied_.scene.terrain.shading;
    applied_.scene.terrain = loading_for_;
    applied_.scene.terrain.shading = shading;
    stale_ = true;
    // The radius of the air follows that of the ground.
    Params params = applied_.effect;
    params.planet.radius_m = static_cast<float>(loading_radius_m_);
    TYNDALL_TRY(scene_->set_params(params));
    applied_.effect = params;
    const config::Settings wanted = wanted_;
    wanted_ = applied_;
    TYNDALL_TRY(follow(wanted));
  }
  return {};
}

// `settings` with the ground that has been loaded.
config::Settings Stage::loaded(config::Settings settings) const {
  settings.scene.terrain.source = applied_.scene.terrain.source;
  settings.scene.terrain.seed = applied_.scene.terrain.seed;
  settings.scene.terrain.exaggeration = applied_.scene.terrain.exaggeration;
  settings.effect.planet.radius_m = applied_.effect.planet.radius_m;
  settings.scene.camera.samples = 1;  // there is one picture on the device
  return settings;
}

void Stage::load_terrain() {
  if (loading_.valid()) return;  // poll() comes back here
  const bool other = !same_terrain(wanted_.scene.terrain, applied_.scene.terrain) ||
                     wanted_.effect.planet.radius_m != applied_.effect.planet.radius_m;
  if (!other) return;
  loading_for_ = wanted_.scene.terrain;
  loading_radius_m_ = wanted_.effect.planet.radius_m;
  loading_ = std::async(std::launch::async, [device = &host_->device(), params = loading_for_, radius = loading_radius_m_] {
    Result<scene::ElevationSource> source = scene::Terrain::load_source(*device, params, radius);
    Window::wake();
    return source;
  });
}

Result<void> Stage::follow(const config::Settings& wanted) {
  if (same_settings(wanted, wanted_)) return {};
  if (scene_ == nullptr) {
    wanted_ = wanted;
    return {};
  }
  if (Result<void> valid = config::check(wanted); !valid) return valid;
  const config::Settings before = wanted_;
  const config::Settings next = loaded(wanted);
  if (affected(applied_.effect, next.effect) != 0) {
    TYNDALL_TRY(scene_->set_params(next.effect));
    applied_.effect = next.effect;
    unkept_ = unkept_ || building();
  }
  wanted_.effect = wanted.effect;
  if (Result<void> set = scene_->set_scene(next.scene); !set) {
    stale_ = true;
    return set;
  }
  const bool only_tone = std::all_of(config::rows().begin(), config::rows().end(), [&](const config::Row& row) {
    return row.info.group == "tonemap" || same_value(row, wanted, before);
  });
  applied_.scene = next.scene;
  wanted_ = wanted;
  (only_tone ? tone_stale_ : stale_) = true;
  load_terrain();
  return {};
}

Result<void> Stage::set_extent(VkExtent2D extent) {
  if (extent.width == desc_.extent.width && extent.height == desc_.extent.height) return {};
  desc_.extent = extent;
  if (scene_ == nullptr) return {};
  stale_ = true;
  return scene_->set_extent(extent);
}

Result<void> Stage::set_coarseness(int coarseness) {
  if (coarseness == desc_.terrain_coarseness) return {};
  desc_.terrain_coarseness = coarseness;
  if (scene_ == nullptr) return {};
  stale_ = true;
  return scene_->set_terrain_coarseness(coarseness);
}

bool Stage::building() const {
  return scene_ != nullptr && wanted_.scene.scattering.model == scene::ScatteringModel::atmosphere &&
         !scene_->tables_progress().complete();
}

Result<bool> Stage::advance_tables(double milliseconds) {
  if (!building()) return false;
  const Clock::time_point start = Clock::now();
  TYNDALL_ASSIGN(const Progress progress, scene_->advance_tables(budget_));
  const double took = ms_since(start);
  if (took > milliseconds) budget_ = std::max(budget_ / 2, 1U);
  if (took < 0.4 * milliseconds) budget_ = std::min(budget_ * 2, kMostSlices);
  if (progress.complete()) stale_ = true;
  return true;
}

Result<bool> Stage::keep_tables() {
  if (!unkept_ || keeping_.valid() || scene_ == nullptr || building()) return false;
  unkept_ = false;
  if (desc_.make_tables.cache.place == "off") return false;
  TYNDALL_ASSIGN(tables::Keeper keeper, tables::Keeper::fetch(*host_, scene_->effect(), desc_.make_tables.cache));
  keeping_ = std::async(std::launch::async, [kept = std::move(keeper)]() mutable {
    std::string note = kept.write();
    Window::wake();
    return note;
  });
  return true;
}

Result<void> Stage::render(double seconds, double step_s) {
  stale_ = tone_stale_ = false;
  return scene_->render(seconds, false, step_s);
}

Result<void> Stage::tone(double step_s) {
  tone_stale_ = false;
  return scene_->tone(step_s);
}

bool Stage::tone_stale() const {
  if (tone_stale_) return true;
  const scene::TonemapParams& params = applied_.scene.tonemap;
  if (!params.auto_exposure || !params.light_adaptation || !ready() || stale_) return false;
  constexpr float kAdapted = 0.005F;  // relative difference that nobody sees
  const post::Measurement m = scene_->measurement();
  return m.measured > 0.0F && std::abs(m.luminance - std::max(m.measured, params.least_luminance)) > kAdapted * m.luminance;
}

}  // namespace tyndall::viewer
