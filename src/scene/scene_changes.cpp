// What of a scene can change between frames: parameters, terrain, the size of the picture, the tables.
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "gpu/try.hpp"
#include "scene/formats.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {
namespace {

bool same_source(const TerrainParams& a, const TerrainParams& b) {
  return a.source == b.source && a.seed == b.seed && a.exaggeration == b.exaggeration && a.units == b.units;
}

bool same_meshes(const MeshParams& a, const MeshParams& b) {
  const auto all = [](const MeshParams& m) {
    return std::tie(m.source, m.position_m.x, m.position_m.y, m.position_m.z, m.scale, m.yaw_deg);
  };
  return all(a) == all(b);
}

// Models other than the effect draw the terrain and the sky, and nothing else.
Result<void> check_model(const SceneParams& scene) {
  if (scene.scattering.model == ScatteringModel::atmosphere) return {};
  if (scene.meshes.source == "none" && scene.terrain.source != "none") return {};
  return Error{ErrorCode::invalid_argument, "only the effect draws meshes and bare ground, scattering.model, allowed is "
               "atmosphere with meshes.source or with terrain.source = none"};
}

bool same(const CascadeFit& a, const CascadeFit& b) {
  return a.world_from_light == b.world_from_light && a.centre == b.centre && a.half_extent == b.half_extent;
}

}  // namespace

Result<void> Scene::create_images(VkExtent2D size) {
  const gpu::Device& device = host_->device();
  const VkExtent3D extent = {size.width, size.height, 1};
  const VkImageUsageFlags written = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  TYNDALL_ASSIGN(gpu::Image color,
                 gpu::create_image(device, {"scene_color", kColorFormat, extent,
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                VK_IMAGE_USAGE_STORAGE_BIT}));
  TYNDALL_ASSIGN(gpu::Image depth,
                 gpu::create_image(device, {"scene_depth", kDepthFormat, extent,
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
  TYNDALL_ASSIGN(gpu::Image output, gpu::create_image(device, {"output", kColorFormat, extent, written}));
  TYNDALL_ASSIGN(display_, gpu::create_image(device, {"display", kColorFormat, extent, written}));
  color_ = std::move(color);
  depth_ = std::move(depth);
  output_ = std::move(output);
  images_ready_ = false;
  return {};
}

Result<void> Scene::create_shadow_maps(const ShadowParams& shadows) {
  const gpu::Device& device = host_->device();
  TYNDALL_ASSIGN(gpu::Image maps,
                 gpu::create_image(device, {"shadow_maps", kDepthFormat, {shadows.resolution, shadows.resolution, 1},
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                            shadows.cascades, 1, true}));
  std::vector<gpu::Handle<VkImageView>> layers;
  for (std::uint32_t i = 0; i < shadows.cascades; ++i) {
    TYNDALL_ASSIGN(gpu::Handle<VkImageView> layer, gpu::create_layer_view(device, maps, i));
    layers.push_back(std::move(layer));
  }
  shadow_layers_ = std::move(layers);
  shadow_maps_ = std::move(maps);
  drawn_cascades_.clear();
  return {};
}

// Maps of what glass leaves of the light; one clear texel where there is no glass.
Result<void> Scene::create_shadow_colors(const ShadowParams& shadows) {
  const gpu::Device& device = host_->device();
  shadow_color_layers_.clear();
  if (meshes_ == nullptr || !meshes_->has_glass()) {
    const std::uint16_t clear[] = {0x3C00, 0x3C00, 0x3C00, 0x3C00};  // ones in half precision
    TYNDALL_ASSIGN(shadow_colors_, gpu::create_image(device, {"no_shadow_colors", kShadowColorFormat, {1, 1, 1},
                                                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                              1, 1, true}));
    return gpu::upload(*host_, shadow_colors_, clear, sizeof clear, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
  TYNDALL_ASSIGN(shadow_colors_,
                 gpu::create_image(device, {"shadow_colors", kShadowColorFormat, {shadows.resolution, shadows.resolution, 1},
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                            shadows.cascades, 1, true}));
  for (std::uint32_t i = 0; i < shadows.cascades; ++i) {
    TYNDALL_ASSIGN(gpu::Handle<VkImageView> layer, gpu::create_layer_view(device, shadow_colors_, i));
    shadow_color_layers_.push_back(std::move(layer));
  }
  return {};
}

// The meshes that `scene` asks for, on the terrain that is there.
Result<void> Scene::make_meshes(const SceneParams& scene) {
  TYNDALL_TRY(check_model(scene));
  std::unique_ptr<Meshes> made;
  if (scene.meshes.source != "none" || terrain_->none()) {
    TYNDALL_ASSIGN(made, Meshes::create(*host_, scene.meshes, *terrain_, params_.planet.radius_m, kColorFormat, kDepthFormat,
                                        kShadowColorFormat));
    for (const std::string& note : made->notes()) {
      if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
    }
  }
  if (effect_ != nullptr && !colored_air_ && made != nullptr && made->has_glass()) {
    TYNDALL_TRY(effect_->set_shadow_colors(true));
    colored_air_ = true;
  }
  meshes_ = std::move(made);
  drawn_cascades_.clear();
  return {};
}

// The tables, or the model that draws without them.
Result<void> Scene::make_model_ready() {
  if (scene_.scattering.model == ScatteringModel::atmosphere) {
    model_.reset();
    if (desc_.tables_later || effect_->precompute_progress().complete()) return {};
    TYNDALL_ASSIGN(const tables::Outcome made, tables::make_ready(*host_, *effect_, desc_.make_tables));
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    tables_ready_ = true;
    return {};
  }
  TYNDALL_ASSIGN(model_, create_sky_model(*host_, scene_, kColorFormat, kDepthFormat));
  return {};
}

Result<Progress> Scene::advance_tables(std::uint32_t budget) {
  if (!effect_->precompute_progress().complete()) {
    TYNDALL_TRY(tables::advance(*host_, *effect_, desc_.make_tables, budget, notes_));
  }
  const Progress progress = effect_->precompute_progress();
  tables_ready_ = tables_ready_ || progress.complete();
  return progress;
}

Result<void> Scene::set_terrain(const TerrainParams& params, double radius_m, ElevationSource source) {
  SceneParams wanted = scene_;
  wanted.terrain = params;
  return replace_ground(wanted, radius_m, std::move(source));
}

// Terrain and meshes of `wanted` in the place of those that are there.
Result<void> Scene::replace_ground(const SceneParams& wanted, double radius_m, ElevationSource source) {
  TYNDALL_TRY(check_model(wanted));
  TYNDALL_TRY(terrain_->set_source(wanted.terrain, radius_m, std::move(source)));
  for (const std::string& note : terrain_->notes()) {
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  }
  const TerrainShading shading = scene_.terrain.shading;
  scene_.terrain = wanted.terrain;
  scene_.terrain.shading = shading;
  params_.planet.radius_m = static_cast<float>(radius_m);
  TYNDALL_TRY(make_meshes(wanted));
  scene_.meshes = wanted.meshes;
  return create_shadow_colors(scene_.shadows);
}

Result<void> Scene::set_scene(const SceneParams& scene) {
  TYNDALL_TRY(check_model(scene));
  const bool other_maps = scene.shadows.resolution != scene_.shadows.resolution ||
                          scene.shadows.cascades != scene_.shadows.cascades;
  const bool other_model = scene.scattering.model != scene_.scattering.model ||
                           scene.scattering.evaluate != scene_.scattering.evaluate;
  if (!same_source(scene.terrain, scene_.terrain)) {
    TYNDALL_ASSIGN(ElevationSource source,
                   Terrain::load_source(host_->device(), scene.terrain, params_.planet.radius_m));
    TYNDALL_TRY(replace_ground(scene, params_.planet.radius_m, std::move(source)));
  }
  if (!same_meshes(scene.meshes, scene_.meshes)) {
    TYNDALL_TRY(make_meshes(scene));
    scene_.meshes = scene.meshes;
    TYNDALL_TRY(create_shadow_colors(scene_.shadows));
  }
  if (other_maps) {
    TYNDALL_TRY(effect_->set_limits(desc_.extent, scene.shadows.cascades, scene.shadows.resolution));
    TYNDALL_TRY(create_shadow_maps(scene.shadows));
    TYNDALL_TRY(create_shadow_colors(scene.shadows));
  }
  const SceneParams before = std::exchange(scene_, scene);
  if (!other_model) return {};
  Result<void> ready = make_model_ready();
  if (!ready) {
    scene_.scattering.model = before.scattering.model;
    scene_.scattering.evaluate = before.scattering.evaluate;
  }
  return ready;
}

Result<void> Scene::set_params(const Params& params) {
  const double radius_m = params.planet.radius_m;
  if (params.planet.radius_m != params_.planet.radius_m) {
    TYNDALL_ASSIGN(ElevationSource source, Terrain::load_source(host_->device(), scene_.terrain, radius_m));
    TYNDALL_TRY(set_terrain(scene_.terrain, radius_m, std::move(source)));
  }
  TYNDALL_TRY(effect_->set_params(params));
  params_ = params;
  return model_ != nullptr ? Result<void>() : make_model_ready();
}

Result<void> Scene::set_extent(VkExtent2D extent) {
  TYNDALL_TRY(effect_->set_limits(extent, scene_.shadows.cascades, scene_.shadows.resolution));
  TYNDALL_TRY(create_images(extent));
  desc_.extent = extent;
  return {};
}

Result<void> Scene::tone(double step_s) {
  step_s_ = step_s;
  return host_->run([&](VkCommandBuffer cmd) -> Result<void> {
    if (desc_.timings) timer_.begin_frame(cmd, 0);
    return tonemap(cmd, true);
  });
}

bool Scene::shadows_are_drawn() const {
  return drawn_terrain_ == terrain_->version() && drawn_cascades_.size() == cascades_.size() &&
         std::equal(cascades_.begin(), cascades_.end(), drawn_cascades_.begin(), same);
}

}  // namespace tyndall::scene
