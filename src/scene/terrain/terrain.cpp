#include "scene/terrain/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "gpu/try.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/terrain/terrain_constants.hpp"
#include "scene_shaders.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint32_t kMaxBlocks = 32768;
constexpr std::size_t kMaxTiles = kMaxLevels * (kLevelSamples / kTileSamples) * (kLevelSamples / kTileSamples);

struct DrawPush {
  Mat4 clip_from_local;
  std::uint32_t first_block;
};

std::uint32_t indices_per_block(int coarseness) {
  const auto cells = static_cast<std::uint32_t>(kBlockCells / coarseness);
  return cells * cells * 6;
}

std::vector<std::uint32_t> block_indices(int coarseness) {
  std::vector<std::uint32_t> out;
  out.reserve(indices_per_block(coarseness));
  const auto cells = static_cast<std::uint32_t>(kBlockCells / coarseness);
  const std::uint32_t side = cells + 1;
  for (std::uint32_t z = 0; z < cells; ++z) {
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = z * side + x;
      // The direction of the diagonal alternates, so that ridges in both directions look alike. The pattern repeats
      // every two cells, so it is the same around all even vertices, to which the odd ones morph.
      if (((x ^ z) & 1U) == 0) {
        out.insert(out.end(), {a, a + side, a + side + 1, a, a + side + 1, a + 1});
      } else {
        out.insert(out.end(), {a, a + side, a + 1, a + 1, a + side, a + side + 1});
      }
    }
  }
  return out;
}

// Returns whether a sphere is outside of the four side planes of the view.
bool outside(const View& view, const glm::dvec3& centre, double radius) {
  const glm::dvec3 d = centre - view.position;
  const double z = glm::dot(d, view.forward);
  if (z < -radius) return true;
  const double x = std::abs(glm::dot(d, view.right));
  const double y = std::abs(glm::dot(d, view.up));
  const auto beyond = [&](double side, double tangent) {
    // The margin is larger than half a pixel of jitter at any size.
    return (side - z * tangent * 1.02) / std::sqrt(1.0 + tangent * tangent) > radius + 1.0;
  };
  return beyond(x, view.tan_half_width) || beyond(y, view.tan_half_height);
}

bool outside(const CascadeFit& cascade, const glm::dvec3& centre, double radius) {
  const glm::dvec3 p = glm::transpose(cascade.world_from_light) * centre - cascade.centre;
  return std::abs(p.x) > cascade.half_extent.x + radius || std::abs(p.y) > cascade.half_extent.y + radius ||
         std::abs(p.z) > cascade.half_extent.z + radius;
}

// Computes a sphere around the ground over a square of a map projection.
void bounding_sphere(int projection, const glm::dvec2& low, const glm::dvec2& high, const Ground& ground,
                     glm::dvec3& centre, double& radius) {
  const glm::dvec2 middle = 0.5 * (low + high);
  centre = world_from_projection(projection, middle.x, middle.y, 0.5 * (ground.min_m + ground.max_m), ground.radius_m);
  radius = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = (corner & 1) != 0 ? high.x : low.x;
    const double z = (corner & 2) != 0 ? high.y : low.y;
    for (const double h : {ground.min_m, ground.max_m}) {
      radius = std::max(radius, glm::distance(centre, world_from_projection(projection, x, z, h, ground.radius_m)));
    }
  }
}

}  // namespace

Result<std::unique_ptr<Terrain>> Terrain::create(gpu::Host& host, const TerrainParams& params, double radius_m,
                                                 VkFormat color_format, VkFormat depth_format, int coarseness) {
  auto out = std::make_unique<Terrain>();
  out->host_ = &host;
  out->coarseness_ = coarseness;
  TYNDALL_ASSIGN(ElevationSource source, load_source(host.device(), params, radius_m));
  TYNDALL_TRY(out->create_objects(color_format, depth_format));
  TYNDALL_ASSIGN(Planned planned, out->plan_source(params, radius_m, std::move(source)));
  out->swap_source(planned);
  return out;
}

Result<ElevationSource> Terrain::load_source(const gpu::Device& device, const TerrainParams& params, double radius_m) {
  ElevationDesc elevation;
  elevation.source = params.source == "none" ? "procedural" : params.source;
  elevation.seed = params.seed;
  elevation.exaggeration = params.exaggeration;
  elevation.units = params.units;
  elevation.planet_radius_m = radius_m;
  const std::uint32_t side = device.properties.limits.maxImageDimension2D;
  elevation.max_samples = static_cast<int>(std::min<std::uint64_t>(std::uint64_t{side} * 2 / 3, kMaxElevationSamples));
  return ElevationSource::create(elevation);
}

Result<Terrain::Planned> Terrain::plan_source(const TerrainParams& params, double radius_m,
                                              ElevationSource source) const {
  Planned out = {params, radius_m, version_ + 1, nullptr, {}, {}, {}};
  const ElevationAtlas& atlas = source.atlas();
  const VkExtent3D extent = {static_cast<std::uint32_t>(atlas.width), static_cast<std::uint32_t>(atlas.height), 1};
  TYNDALL_ASSIGN(out.atlas,
                 gpu::create_image(host_->device(), {"elevation_atlas", VK_FORMAT_R32_SFLOAT, extent,
                                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  TYNDALL_TRY(gpu::upload(*host_, out.atlas, atlas.texels.data(), atlas.texels.size() * sizeof(float),
                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
  out.source = std::make_shared<const ElevationSource>(std::move(source));
  out.notes = out.source->notes();
  return out;
}

void Terrain::swap_source(Planned& planned) noexcept {
  std::swap(params_, planned.params);
  std::swap(radius_m_, planned.radius_m);
  std::swap(version_, planned.version);
  std::swap(source_, planned.source);
  std::swap(notes_, planned.notes);
  std::swap(tiles_, planned.tiles);
  std::swap(atlas_, planned.atlas);
}

Result<void> Terrain::create_objects(VkFormat color_format, VkFormat depth_format) {
  const gpu::Device& device = host_->device();
  TYNDALL_ASSIGN(fill_, gpu::create_compute_pipeline(device, shaders::terrain_heights_comp));
  gpu::GraphicsDesc view;
  view.name = "terrain";
  view.vertex = &shaders::terrain_vert;
  view.fragment = &shaders::terrain_frag;
  view.color_format = color_format;
  view.depth_format = depth_format;
  view.depth_compare = VK_COMPARE_OP_GREATER;
  TYNDALL_ASSIGN(view_pipeline_, gpu::create_graphics_pipeline(device, view));
  TYNDALL_ASSIGN(light_, gpu::create_compute_pipeline(device, shaders::terrain_light_comp));
  gpu::GraphicsDesc shadow;
  shadow.name = "terrain_shadow";
  shadow.vertex = &shaders::terrain_shadow_vert;
  shadow.depth_format = depth_format;
  shadow.depth_compare = VK_COMPARE_OP_LESS;
  TYNDALL_ASSIGN(shadow_pipeline_, gpu::create_graphics_pipeline(device, shadow));
  TYNDALL_ASSIGN(nearest_, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));

  TYNDALL_ASSIGN(indices_, create_indices(coarseness_));
  TYNDALL_ASSIGN(map_projections_,
                 gpu::UploadRing::create(device, "terrain_projections", sizeof(shared::MapProjections)));
  TYNDALL_ASSIGN(constants_, gpu::UploadRing::create(device, "terrain_constants", sizeof(shared::TerrainConstants)));
  TYNDALL_ASSIGN(blocks_, gpu::UploadRing::create(device, "terrain_blocks", kMaxBlocks * sizeof(TerrainBlock)));
  TYNDALL_ASSIGN(fill_constants_, gpu::create_buffer(device, "terrain_fill_constants", sizeof(fill::TerrainFill),
                                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::upload));
  TYNDALL_ASSIGN(fill_tiles_, gpu::create_buffer(device, "terrain_fill_tiles", kMaxTiles * sizeof(TerrainTile),
                                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::upload));
  return {};
}

Result<gpu::Buffer> Terrain::create_indices(int coarseness) const {
  const std::vector<std::uint32_t> indices = block_indices(coarseness);
  const VkDeviceSize index_bytes = indices.size() * sizeof(std::uint32_t);
  TYNDALL_ASSIGN(
      gpu::Buffer out,
      gpu::create_buffer(host_->device(), "terrain_indices", index_bytes,
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::device));
  TYNDALL_TRY(gpu::upload(*host_, out, indices.data(), index_bytes));
  return out;
}

Result<void> Terrain::set_coarseness(int coarseness) {
  if (coarseness == coarseness_) return {};
  TYNDALL_ASSIGN(indices_, create_indices(coarseness));
  coarseness_ = coarseness;
  heights_ = {};
  tiles_.clear();
  ++version_;
  return {};
}

Ground Terrain::ground() const {
  if (none()) return {0.0, 0.0, radius_m_, {}};
  return {source_->min_height_m(), source_->max_height_m(), radius_m_, {}};
}

// Uses the formula of terrain_heights.comp.
double ground_height(const ElevationSource& source, const glm::dvec3& up, double radius_m) {
  const std::array<double, kMapProjectionCount> weights = projection_weights(up);
  const glm::dvec2 map = projection_from_up(0, up, radius_m);
  const double file = source.from_file() ? source.file_share(map.x, map.y) : 0.0;
  double height_m = 0.0;
  for (int projection = 0; projection < kMapProjectionCount; ++projection) {
    const double weight = (1.0 - file) * weights[static_cast<std::size_t>(projection)] + (projection == 0 ? file : 0.0);
    if (weight <= 0.0) continue;
    const glm::dvec2 at = projection == 0 ? map : projection_from_up(projection, up, radius_m);
    height_m += weight * static_cast<double>(source.height_m(projection, at.x, at.y, kFinestCell_m));
  }
  return height_m;
}

double Terrain::height_at(const glm::dvec3& up) const { return none() ? 0.0 : ground_height(*source_, up, radius_m_); }

VkDeviceSize Terrain::bytes() const {
  return heights_.bytes + atlas_.bytes + fill_constants_.bytes + fill_tiles_.bytes + map_projections_.bytes() +
         constants_.bytes() + blocks_.bytes() + indices_.bytes;
}

Result<void> Terrain::update(const View& view, const LocalFrame& frame) {
  if (none()) return {};
  frame_ = frame;
  map_projections_.write(map_projections_of(frame, radius_m_));
  lod_ = plan_terrain(projection_from_up(frame.projection, up_of(view.position, radius_m_), radius_m_),
                      altitude_of(view.position, radius_m_), source_->max_height_m(), radius_m_, coarseness_,
                      source_->min_height_m());
  if (frame.projection != filled_projection_) tiles_.clear();
  filled_projection_ = frame.projection;
  const gpu::Device& device = host_->device();
  const auto layers = static_cast<std::uint32_t>(lod_.levels.size());
  const auto samples = static_cast<std::uint32_t>(lod_.level_samples());
  if (heights_.desc.layers < layers || !heights_.image) {
    TYNDALL_ASSIGN(gpu::Image heights,
                   gpu::create_image(device, {"terrain_heights",
                                              VK_FORMAT_R32_SFLOAT,
                                              {samples, samples, 1},
                                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                              layers,
                                              1,
                                              true}));
    TYNDALL_TRY(host_->run([&](VkCommandBuffer cmd) -> Result<void> {
      gpu::transition(device, cmd, heights, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
      return {};
    }));
    tiles_.clear();
    heights_ = std::move(heights);
  }
  if (tiles_.start(lod_)) ++version_;
  return {};
}

Result<void> Terrain::fill_missing() {
  const std::vector<TerrainTile> tiles = tiles_.missing();
  if (tiles.empty()) return {};
  fill::TerrainFill constants = {};
  constants.source = source_->constants();
  for (std::size_t i = 0; i < lod_.levels.size(); ++i) {
    const ClipLevel& level = lod_.levels[i];
    const glm::dvec2 first = glm::dvec2(level.origin) * level.cell_m - frame_.map_m;
    constants.levels[i] = {{level.origin.x, level.origin.y},
                           {static_cast<float>(first.x), static_cast<float>(first.y)},
                           static_cast<float>(level.cell_m),
                           0};
  }
  std::memcpy(fill_constants_.mapped, &constants, sizeof constants);
  std::memcpy(fill_tiles_.mapped, tiles.data(), tiles.size() * sizeof(TerrainTile));
  const gpu::Device& device = host_->device();
  Result<void> filled = host_->run([&](VkCommandBuffer cmd) -> Result<void> {
    const gpu::Label label(device, cmd, fill_.name);
    const gpu::NamedResource resources[] = {
        gpu::named_buffer("terrain_fill_block", fill_constants_.buffer.get()),
        gpu::named_buffer("tiles_block", fill_tiles_.buffer.get()),
        gpu::named_buffer("map_projections_block", map_projections_.buffer()),
        gpu::named_image("elevation_atlas", atlas_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         nearest_.get()),
        gpu::named_image("elevation_levels", heights_.view.get()),
    };
    TYNDALL_TRY(gpu::bind(host_->sets(), cmd, fill_, resources));
    gpu::dispatch(device, cmd, fill_, kTileSamples, kTileSamples, static_cast<std::uint32_t>(tiles.size()));
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                 VK_ACCESS_SHADER_READ_BIT);
    return {};
  });
  if (filled.ok()) tiles_.mark_filled();
  return filled;
}

Result<void> Terrain::prepare(const View& view, std::uint32_t height_px, const ShadowParams& shadows,
                              const std::vector<CascadeFit>& cascades, const TerrainLight& light,
                              TerrainShading shading) {
  if (none()) return {};
  const Ground whole = ground();
  shared::TerrainConstants out = {};
  const glm::dvec2 camera = lod_.camera_map - frame_.map_m;
  out.camera_map = {static_cast<float>(camera.x), static_cast<float>(camera.y)};
  out.vertical_m = static_cast<float>(lod_.vertical_m);
  out.planet_radius_m = static_cast<float>(radius_m_);
  out.direction_to_sun = to_vec3(frame_.direction(light.direction_to_sun));
  out.atmosphere_height_m = static_cast<float>(light.atmosphere_height_m);
  out.sun_irradiance = light.sun_irradiance;
  out.pixel_angle_rad = static_cast<float>(2.0 * view.tan_half_height / height_px);
  out.block_cells = static_cast<std::uint32_t>(lod_.block_cells());
  out.camera_position = to_vec3(frame_.place(view.position));
  out.camera_forward = to_vec3(frame_.direction(view.forward));
  out.layers = static_cast<std::uint32_t>(lod_.levels.size());
  out.shading = static_cast<std::uint32_t>(shading);
  out.seed = params_.seed;
  out.cascade_count = static_cast<std::uint32_t>(cascades.size());
  out.shadow_resolution = static_cast<float>(shadows.resolution);
  out.smooth_shadows = shadows.smooth.value;
  out.best_cascade = shadows.best_cascade.value;
  out.show_cascades = shadows.show_cascades.value;
  out.has_glass = light.has_glass ? 1U : 0U;
  for (std::size_t i = 0; i < lod_.levels.size(); ++i) {
    const ClipLevel& level = lod_.levels[i];
    const glm::dvec2 first = glm::dvec2(level.origin) * level.cell_m - frame_.map_m;
    out.levels[i] = {{level.origin.x, level.origin.y},
                     {static_cast<float>(first.x), static_cast<float>(first.y)},
                     static_cast<float>(level.cell_m),
                     static_cast<float>(lod_.range_m(level))};
  }
  for (std::size_t i = 0; i < cascades.size(); ++i) {
    const CascadeFit& c = cascades[i];
    out.shadow_from_local[i] = to_mat4(c.shadow_from_world() * frame_.world_from_local);
    out.cascade[i] = {static_cast<float>(c.far_m), static_cast<float>(2.0 * c.half_extent.x / shadows.resolution),
                      static_cast<float>(2.0 * c.half_extent.y / shadows.resolution),
                      static_cast<float>(2.0 * c.half_extent.z)};
  }
  constants_.write(out);

  // First the blocks of the view, from near to far, so that hidden ground is not shaded. Then the blocks of each
  // cascade, which are not finer than its texels.
  auto* blocks = static_cast<TerrainBlock*>(blocks_.next());
  std::uint32_t used = 0;
  ranges_.clear();
  const auto take = [&]() -> Result<void> {
    if (used + scratch_.size() > kMaxBlocks) {
      return Error{ErrorCode::out_of_memory, "the view needs more blocks of terrain than there is room for"};
    }
    std::copy(scratch_.begin(), scratch_.end(), blocks + used);
    ranges_.push_back({used, static_cast<std::uint32_t>(scratch_.size())});
    used += static_cast<std::uint32_t>(scratch_.size());
    return {};
  };
  const auto sphere_test = [&](const auto& volume) {
    return [&](const glm::dvec2& low, const glm::dvec2& high) {
      glm::dvec3 centre;
      double radius = 0.0;
      bounding_sphere(frame_.projection, low, high, whole, centre, radius);
      return !outside(volume, centre, radius);
    };
  };
  select_blocks(lod_, 0, sphere_test(view), scratch_);
  const auto distance = [&](const TerrainBlock& b) {
    const double cell = lod_.levels[static_cast<std::size_t>(b.layer)].cell_m;
    return glm::distance(glm::dvec2(b.x + lod_.block_cells() / 2, b.z + lod_.block_cells() / 2) * cell,
                         lod_.camera_map);
  };
  std::sort(scratch_.begin(), scratch_.end(),
            [&](const TerrainBlock& a, const TerrainBlock& b) { return distance(a) < distance(b); });
  TYNDALL_TRY(take());
  for (const TerrainBlock& block : scratch_) tiles_.add_shaded(lod_, block);
  for (const CascadeFit& cascade : cascades) {
    int finest = 0;
    while (finest + 1 < static_cast<int>(lod_.levels.size()) &&
           lod_.levels[static_cast<std::size_t>(finest)].cell_m < 0.5 * cascade.texel_m) {
      ++finest;
    }
    select_blocks(lod_, finest, sphere_test(cascade), scratch_);
    TYNDALL_TRY(take());
    for (const TerrainBlock& block : scratch_) tiles_.add_drawn(lod_, block);
  }
  return fill_missing();
}

Result<void> Terrain::draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline,
                           std::span<const gpu::NamedResource> resources, const glm::dmat4& clip_from_world,
                           std::uint32_t range) {
  const gpu::Device& device = host_->device();
  const gpu::Label label(device, cmd, pipeline.name);
  const DrawPush push = {to_mat4(clip_from_world * frame_.world_from_local), ranges_[range].first};
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, pipeline, resources, &push));
  device.vk.CmdBindIndexBuffer(cmd, indices_.buffer.get(), 0, VK_INDEX_TYPE_UINT32);
  if (ranges_[range].count > 0)
    device.vk.CmdDrawIndexed(cmd, indices_per_block(coarseness_), ranges_[range].count, 0, 0, 0);
  return {};
}

Result<void> Terrain::draw_view(VkCommandBuffer cmd, const View& view) {
  return draw_view(cmd, view, view_pipeline_, {});
}

Result<void> Terrain::draw_view(VkCommandBuffer cmd, const View& view, const gpu::Pipeline& pipeline,
                                std::span<const gpu::NamedResource> more) {
  if (none()) return {};
  std::vector<gpu::NamedResource> resources = geometry();
  resources.insert(resources.end(), more.begin(), more.end());
  return draw(cmd, pipeline, resources, clip_from_world(view), 0);
}

Result<void> Terrain::light_view(VkCommandBuffer cmd, const TerrainLight& light, VkImageView color, VkExtent2D extent) {
  return light_view(cmd, light, color, extent, light_, {});
}

Result<void> Terrain::light_view(VkCommandBuffer cmd, const TerrainLight& light, VkImageView color, VkExtent2D extent,
                                 const gpu::Pipeline& pipeline, std::span<const gpu::NamedResource> more) {
  if (none()) return {};
  const gpu::Device& device = host_->device();
  const gpu::Label label(device, cmd, pipeline.name);
  std::vector<gpu::NamedResource> resources = lit(light);
  resources.push_back(gpu::named_image("scene_color", color));
  resources.insert(resources.end(), more.begin(), more.end());
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, pipeline, resources));
  gpu::dispatch(device, cmd, pipeline, extent.width, extent.height);
  return {};
}

std::vector<gpu::NamedResource> Terrain::geometry() const {
  return {gpu::named_buffer("terrain_block", constants_.buffer()),
          gpu::named_buffer("map_projections_block", map_projections_.buffer()),
          gpu::named_buffer("blocks_block", blocks_.buffer()),
          gpu::named_image("terrain_heights", heights_.view.get(), VK_IMAGE_LAYOUT_GENERAL, nearest_.get())};
}

std::vector<gpu::NamedResource> Terrain::lit(const TerrainLight& light) const {
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  std::vector<gpu::NamedResource> out = geometry();
  out.insert(
      out.end(),
      {gpu::named_image("shadow_maps", light.shadow_maps, kRead, light.shadow_sampler),
       gpu::named_image("shadow_colors", light.shadow_colors, kRead, light.linear),
       gpu::named_image("sun_transmittance", light.tables.sun_transmittance, VK_IMAGE_LAYOUT_GENERAL, light.linear),
       gpu::named_image("sky_irradiance", light.tables.sky_irradiance, VK_IMAGE_LAYOUT_GENERAL, light.linear)});
  return out;
}

Result<void> Terrain::draw_cascade(VkCommandBuffer cmd, const CascadeFit& cascade, std::uint32_t index) {
  if (none()) return {};
  return draw(cmd, shadow_pipeline_, geometry(), clip_from_shadow() * cascade.shadow_from_world(), index + 1);
}

}  // namespace tyndall::scene
