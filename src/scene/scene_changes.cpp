// Changes of a scene between frames: parameters, terrain, the size of the picture, the tables.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "gpu/guard.hpp"
#include "gpu/try.hpp"
#include "scene/description/terrain_key.hpp"
#include "scene/formats.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {
namespace {

bool same(const CascadeFit& a, const CascadeFit& b) {
  return a.world_from_light == b.world_from_light && a.centre == b.centre && a.half_extent == b.half_extent;
}

bool same_effect_limits(const EffectDesc& a, const EffectDesc& b) {
  return a.max_cascades == b.max_cascades && a.max_shadow_resolution == b.max_shadow_resolution &&
         a.shadow_colors == b.shadow_colors;
}

}  // namespace

// The objects that new parameters need. They are all created before any of them is used.
struct Scene::Pending {
  SceneParams scene;
  Params params;
  EffectDesc effect;
  bool other_effect = false;
  std::optional<Terrain::Planned> terrain;
  bool other_meshes = false, other_model = false;
  std::unique_ptr<Meshes> meshes;
  std::unique_ptr<SkyModel> model;
  std::optional<Layered> shadow_maps, shadow_colors;
  std::vector<std::string> notes;

  // Returns whether Scene::swap() replaces something that frames in flight use.
  [[nodiscard]] bool replaces() const {
    return other_effect || terrain || other_meshes || other_model || shadow_maps || shadow_colors;
  }
};

// Returns an error if a model other than the effect would have to draw more than terrain and sky.
Result<void> check_model(const SceneParams& scene) {
  if (scene.scattering.model == ScatteringModel::atmosphere) return {};
  if (scene.meshes.source == "none" && scene.terrain.source != "none") return {};
  return Error{ErrorCode::invalid_argument, "scattering.model: only the effect draws meshes and bare ground; expected "
                                            "atmosphere with meshes.source or with terrain.source = none"};
}

void add_notes(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  for (const std::string& note : more) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }
}

Result<Scene::Targets> Scene::make_targets(VkExtent2D size) const {
  const gpu::Device& device = host_->device();
  const VkExtent3D extent = {size.width, size.height, 1};
  const VkImageUsageFlags written =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  Targets out;
  TYNDALL_ASSIGN(out.color, gpu::create_image(device, {"scene_color", kColorFormat, extent,
                                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT}));
  TYNDALL_ASSIGN(out.depth,
                 gpu::create_image(device, {"scene_depth", kDepthFormat, extent,
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
  TYNDALL_ASSIGN(out.output, gpu::create_image(device, {"output", kColorFormat, extent, written}));
  TYNDALL_ASSIGN(out.display, gpu::create_image(device, {"display", kColorFormat, extent, written}));
  return out;
}

void Scene::swap_targets(Targets& targets) noexcept {
  std::swap(color_, targets.color);
  std::swap(depth_, targets.depth);
  std::swap(output_, targets.output);
  std::swap(display_, targets.display);
  images_ready_ = false;
}

Result<Scene::Layered> Scene::make_layered(const gpu::ImageDesc& desc) const {
  Layered out;
  TYNDALL_ASSIGN(out.image, gpu::create_image(host_->device(), desc));
  for (std::uint32_t i = 0; i < desc.layers; ++i) {
    TYNDALL_ASSIGN(gpu::Handle<VkImageView> layer, gpu::create_layer_view(host_->device(), out.image, i));
    out.layers.push_back(std::move(layer));
  }
  return out;
}

Result<Scene::Layered> Scene::make_shadow_maps(const ShadowParams& shadows) const {
  return make_layered({"shadow_maps",
                       kDepthFormat,
                       {shadows.resolution, shadows.resolution, 1},
                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                       shadows.cascades,
                       1,
                       true});
}

// Creates the maps of shadow colours, or a single clear texel if there is no glass.
Result<Scene::Layered> Scene::make_shadow_colors(const ShadowParams& shadows, bool glass) const {
  if (glass) {
    return make_layered({"shadow_colors",
                         kShadowColorFormat,
                         {shadows.resolution, shadows.resolution, 1},
                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                         shadows.cascades,
                         1,
                         true});
  }
  const std::uint16_t clear[] = {0x3C00, 0x3C00, 0x3C00, 0x3C00};  // ones in half precision
  Layered out;
  TYNDALL_ASSIGN(out.image,
                 gpu::create_image(host_->device(), {"no_shadow_colors",
                                                     kShadowColorFormat,
                                                     {1, 1, 1},
                                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                     1,
                                                     1,
                                                     true}));
  TYNDALL_TRY(gpu::upload(*host_, out.image, clear, sizeof clear, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
  return out;
}

// Creates the meshes of `scene` on the current terrain; nullptr if there is only terrain.
Result<std::unique_ptr<Meshes>> Scene::make_meshes(const SceneParams& scene, double radius_m) const {
  if (scene.meshes.source == "none" && !terrain_->none()) return std::unique_ptr<Meshes>();
  return Meshes::create(*host_, scene.meshes, *terrain_, radius_m, kColorFormat, kDepthFormat, kShadowColorFormat);
}

// Creates the model that draws instead of the effect; nullptr with scattering.model = atmosphere.
Result<std::unique_ptr<SkyModel>> Scene::make_model(const SceneParams& scene) const {
  if (scene.scattering.model == ScatteringModel::atmosphere) return std::unique_ptr<SkyModel>();
  return create_sky_model(*host_, scene, kColorFormat, kDepthFormat);
}

Result<void> Scene::make_tables_ready() {
  if (model_ != nullptr || desc_.tables_later || effect_->precompute_progress().complete()) return {};
  TYNDALL_ASSIGN(const auto made, tables::make_ready(*host_, *effect_, desc_.make_tables));
  tables_ready_ = true;
  // From here on nothing may fail, because the old tables no longer exist. Notes are dropped if there is no memory.
  static_cast<void>(within_memory("notes", [&]() -> Result<void> {
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    return {};
  }));
  return {};
}

Result<Progress> Scene::advance_tables(std::uint32_t budget) {
  return within_memory("making the scattering tables", [&]() -> Result<Progress> {
    TYNDALL_TRY(wait_for_frames());
    TYNDALL_TRY(replace_lost_effect());
    const Progress before = effect_->precompute_progress();
    if (!before.complete()) {
      Result<void> advanced = tables::advance(*host_, *effect_, desc_.make_tables, budget, notes_);
      effect_lost_ = !advanced.ok() && effect_->precompute_progress().done != before.done;
      TYNDALL_TRY(std::move(advanced));
    }
    const Progress progress = effect_->precompute_progress();
    tables_ready_ = tables_ready_ || progress.complete();
    return progress;
  });
}

Result<Scene::Pending> Scene::plan(const SceneParams& scene, const Params& params,
                                   std::optional<ElevationSource> source) {
  TYNDALL_TRY(check_model(scene));
  Pending out;
  out.scene = scene;
  out.params = params;
  out.notes = notes_;
  const double radius_m = params.planet.radius_m;
  const bool other_ground =
      source.has_value() || terrain_key(scene.terrain, params.planet) != terrain_key(scene_.terrain, params_.planet);
  if (other_ground) {
    if (!source) {
      TYNDALL_ASSIGN(source, Terrain::load_source(host_->device(), scene.terrain, radius_m));
    }
    TYNDALL_ASSIGN(out.terrain, terrain_->plan_source(scene.terrain, radius_m, std::move(*source)));
    add_notes(out.notes, out.terrain->notes);
  }
  out.other_meshes = other_ground || differs(scene, scene_, "meshes", Affects::Resources);
  if (out.other_meshes) {
    // Meshes are placed on the ground, so the planned terrain is installed while they are created.
    struct InPlace {
      Terrain& terrain;
      std::optional<Terrain::Planned>& planned;
      InPlace(Terrain& t, std::optional<Terrain::Planned>& p) : terrain(t), planned(p) { exchange(); }
      ~InPlace() { exchange(); }
      InPlace(const InPlace&) = delete;
      InPlace& operator=(const InPlace&) = delete;
      void exchange() {
        if (planned) terrain.swap_source(*planned);
      }
    } const in_place(*terrain_, out.terrain);
    TYNDALL_ASSIGN(out.meshes, make_meshes(scene, radius_m));
    if (out.meshes != nullptr) add_notes(out.notes, out.meshes->notes());
  }
  const std::unique_ptr<Meshes>& meshes = out.other_meshes ? out.meshes : meshes_;
  const bool glass = meshes != nullptr && meshes->has_glass();
  const bool other_maps = differs(scene, scene_, "shadows", Affects::Resources);
  if (other_maps) {
    TYNDALL_ASSIGN(out.shadow_maps, make_shadow_maps(scene.shadows));
  }
  if (other_maps || out.other_meshes) {
    TYNDALL_ASSIGN(out.shadow_colors, make_shadow_colors(scene.shadows, glass));
  }
  out.other_model = differs(scene, scene_, "scattering", Affects::Pipeline);
  if (out.other_model) {
    TYNDALL_ASSIGN(out.model, make_model(scene));
  }
  out.effect = effect_->desc();
  out.effect.max_cascades = scene.shadows.cascades;
  out.effect.max_shadow_resolution = scene.shadows.resolution;
  out.effect.shadow_colors = out.effect.shadow_colors || glass;
  out.other_effect = affected(effect_->params(), params) != 0 || !same_effect_limits(out.effect, effect_->desc());
  return out;
}

// Exchanges the current and the planned state. A second call undoes the first.
void Scene::swap(Pending& pending) noexcept {
  std::swap(scene_, pending.scene);
  std::swap(params_, pending.params);
  std::swap(notes_, pending.notes);
  const auto exchange = [](gpu::Image& image, std::vector<gpu::Handle<VkImageView>>& layers,
                           std::optional<Layered>& other) {
    if (!other) return;
    std::swap(image, other->image);
    std::swap(layers, other->layers);
  };
  exchange(shadow_maps_, shadow_layers_, pending.shadow_maps);
  exchange(shadow_colors_, shadow_color_layers_, pending.shadow_colors);
  if (pending.terrain) terrain_->swap_source(*pending.terrain);
  if (pending.other_meshes) std::swap(meshes_, pending.meshes);
  if (pending.other_model) std::swap(model_, pending.model);
  if (pending.terrain || pending.other_meshes || pending.shadow_maps) drawn_cascades_.clear();
}

Result<void> Scene::change(const SceneParams& scene, const Params& params, std::optional<ElevationSource> source) {
  TYNDALL_TRY(replace_lost_effect());
  TYNDALL_ASSIGN(Pending pending, plan(scene, params, std::move(source)));
  if (pending.replaces()) TYNDALL_TRY(wait_for_frames());
  const EffectDesc effect_before = effect_->desc();
  const Params params_before = effect_->params();
  if (pending.other_effect) TYNDALL_TRY(effect_->set_params(pending.params, pending.effect));
  // Building the tables needs the effect with the new parameters, and may also fail.
  struct Exchanged {
    Scene& scene;
    Pending& pending;
    const EffectDesc& effect_before;
    const Params& params_before;
    bool taken_back = true;
    ~Exchanged() {
      if (!taken_back) return;
      scene.swap(pending);
      const Result<void> set = scene.effect_->set_params(params_before, effect_before);
      // If the last commands of new tables are not submitted, neither the new nor the old tables are valid.
      const bool stale =
          scene.model_ == nullptr && !scene.desc_.tables_later && !scene.effect_->precompute_progress().complete();
      if (!set || stale) scene.effect_lost_ = true;
    }
  } exchanged{*this, pending, effect_before, params_before};
  swap(pending);
  TYNDALL_TRY(make_tables_ready());
  exchanged.taken_back = false;
  return {};
}

Result<void> Scene::set_terrain(const TerrainParams& terrain, double radius_m, ElevationSource source) {
  return within_memory("changing the terrain", [&] {
    SceneParams scene = scene_;
    scene.terrain = terrain;
    scene.terrain.shading = scene_.terrain.shading;
    Params params = params_;
    params.planet.radius_m = static_cast<float>(radius_m);
    return change(scene, params, std::move(source));
  });
}

Result<void> Scene::set_scene(const SceneParams& scene) {
  return within_memory("changing the scene", [&] { return change(scene, params_, {}); });
}

Result<void> Scene::set_params(const Params& params) {
  return within_memory("changing the scene", [&] { return change(scene_, params, {}); });
}

Result<void> Scene::set_extent(VkExtent2D extent, std::optional<int> terrain_coarseness) {
  return within_memory("changing the size of the picture", [&]() -> Result<void> {
    if (extent.width != desc_.extent.width || extent.height != desc_.extent.height || effect_lost_) {
      TYNDALL_TRY(wait_for_frames());
      TYNDALL_TRY(replace_lost_effect());
      TYNDALL_ASSIGN(Targets targets, make_targets(extent));
      TYNDALL_TRY(effect_->set_limits(extent, scene_.shadows.cascades, scene_.shadows.resolution));
      swap_targets(targets);
      desc_.extent = extent;
    }
    desc_.terrain_coarseness = terrain_coarseness.value_or(desc_.terrain_coarseness);
    return {};
  });
}

Result<void> Scene::tone(double step_s) {
  const post::Exposure::Start start = tonemap_->exposure().start();
  Result<void> toned = within_memory("tone mapping", [&]() -> Result<void> {
    TYNDALL_TRY(wait_for_frames());
    step_s_ = step_s;
    TYNDALL_TRY(host_->run([&](VkCommandBuffer cmd) -> Result<void> {
      if (desc_.timings) timer_.begin_frame(cmd, slot());
      return tonemap(cmd, true);
    }));
    measurement_ = tonemap_->exposure().read(slot());
    return {};
  });
  if (!toned) tonemap_->exposure().put_back(start);
  return toned;
}

bool Scene::bare_ground() const { return terrain_->none() || (model_ != nullptr && !model_->draws_terrain(scene_)); }

bool Scene::shadows_are_drawn() const {
  return drawn_terrain_ == terrain_->version() && drawn_cascades_.size() == cascades_.size() &&
         std::equal(cascades_.begin(), cascades_.end(), drawn_cascades_.begin(), same);
}

}  // namespace tyndall::scene
