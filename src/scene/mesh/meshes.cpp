#include "scene/mesh/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"
#include "math/angles.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/mesh/gltf_file.hpp"
#include "scene/mesh/hall.hpp"
#include "scene/mesh/mesh_constants.hpp"
#include "scene/mesh/mesh_textures.hpp"
#include "scene/view/constant_ids.hpp"
#include "scene_shaders.hpp"

namespace tyndall::scene {
namespace {

constexpr float kGroundAlbedo = 0.3F;  // for the ground without terrain and under meshes; plain terrain has the same

// The layout of shaders/scene/mesh_push.glsl.
struct MeshPush {
  Mat4 clip_from_local;
  float color[4];
  float alpha_cutoff;
  float transmission;
  std::uint32_t kind;
  std::uint32_t double_sided;
};

struct GroundPush {
  Mat4 local_from_ndc;
  float near_m;
};

// Returns the frame of the meshes: east, up and south at a position of the map, rotated by meshes.yaw_deg.
glm::dmat4 site_of(const MeshParams& params, const Terrain& terrain, double radius_m) {
  const glm::dvec3 p = to_glm(params.position_m);
  const glm::dvec3 up = up_of(world_from_map(p.x, p.z, 0.0, radius_m), radius_m);
  const glm::dvec3 origin = world_from_map(p.x, p.z, terrain.height_at(up) + p.y, radius_m);
  const glm::dvec3 east = east_of(up);
  const glm::dvec3 south = glm::cross(east, up);
  const double yaw = params.yaw_deg * kRadPerDeg;
  glm::dmat4 out(1.0);
  out[0] = glm::dvec4(east * std::cos(yaw) + south * std::sin(yaw), 0.0);
  out[1] = glm::dvec4(up, 0.0);
  out[2] = glm::dvec4(south * std::cos(yaw) - east * std::sin(yaw), 0.0);
  out[3] = glm::dvec4(origin, 1.0);
  return out;
}

shared::MeshInstance placed(const glm::dmat4& site_from_mesh) {
  shared::MeshInstance out = {};
  out.site_from_mesh = to_mat4(site_from_mesh);
  const glm::dmat3 m(site_from_mesh);
  // The cofactor matrix is the inverse transpose up to a factor. It also exists for instances that flatten a mesh.
  const glm::dmat3 c(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const double handed = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
  const double size = std::max({glm::length(c[0]), glm::length(c[1]), glm::length(c[2]), 1e-300});
  const auto column = [&](int i) {
    const glm::dvec3 v = c[i] * (handed / size);
    return shared::vec4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
                        static_cast<float>(handed)};
  };
  out.normal_x = column(0);
  out.normal_y = column(1);
  out.normal_z = column(2);
  return out;
}

}  // namespace

Result<std::unique_ptr<Meshes>> Meshes::create(gpu::Host& host, const MeshParams& params, const Terrain& terrain,
                                               double radius_m, VkFormat color_format, VkFormat depth_format,
                                               VkFormat shadow_color_format) {
  auto out = std::make_unique<Meshes>();
  out->host_ = &host;
  out->radius_m_ = radius_m;
  out->bare_ground_ = terrain.none();
  TYNDALL_TRY(out->load(params, terrain));
  TYNDALL_TRY(out->create_pipelines(color_format, depth_format, shadow_color_format));
  TYNDALL_TRY(out->create_buffers());
  return out;
}

Result<void> Meshes::load(const MeshParams& params, const Terrain& terrain) {
  if (params.source == "none") return {};
  if (params.source == "hall") {
    data_ = make_hall();
  } else {
    TYNDALL_ASSIGN(data_, load_gltf(params.source));
  }
  world_from_site_ = site_of(params, terrain, radius_m_);
  site_from_model_ = glm::dmat4(glm::dmat3(static_cast<double>(params.scale)));
  lowest_m_ = std::numeric_limits<double>::max();
  highest_m_ = std::numeric_limits<double>::lowest();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const glm::dvec3 p((i & 1U) != 0 ? data_.bounds.max.x : data_.bounds.min.x,
                       (i & 2U) != 0 ? data_.bounds.max.y : data_.bounds.min.y,
                       (i & 4U) != 0 ? data_.bounds.max.z : data_.bounds.min.z);
    corners_[i] = glm::dvec3(world_from_site_ * site_from_model_ * glm::dvec4(p, 1.0));
    const double altitude = altitude_of(corners_[i], radius_m_);
    if (!(std::abs(altitude) < 1.0e8)) {
      return Error{ErrorCode::invalid_argument,
                   "meshes.scale: the meshes reach farther than a planet; expected a size of up to 10000 km"};
    }
    lowest_m_ = std::min(lowest_m_, altitude);
    highest_m_ = std::max(highest_m_, altitude);
  }
  // The ground is a sphere, so it is higher under the middle of a flat mesh than under its corners.
  const double side = glm::distance(corners_[0], corners_[7]);
  lowest_m_ -= side * side / (8.0 * radius_m_);
  find_boxes();
  for (const MeshPart& part : data_.parts) has_glass_ = has_glass_ || data_.materials[part.material].transmits();
  return {};
}

void Meshes::find_boxes() {
  boxes_.clear();
  for (const Mesh& mesh : data_.meshes) {
    Box whole;
    for (std::uint32_t i = 0; i < mesh.part_count; ++i) {
      const MeshPart& part = data_.parts[mesh.first_part + i];
      Box box;
      for (std::uint32_t k = 0; k < part.index_count; ++k)
        box.add(data_.vertices[data_.indices[part.first_index + k]].position);
      if (mesh.instance_count == 1) {
        boxes_.push_back(placed_box(site_from_model_ * glm::dmat4(data_.instances[mesh.first_instance]), box));
      } else if (!box.empty()) {
        whole.add(box.min);
        whole.add(box.max);
      }
    }
    if (mesh.instance_count == 1) continue;
    for (std::uint32_t i = 0; i < mesh.instance_count; ++i) {
      boxes_.push_back(placed_box(site_from_model_ * glm::dmat4(data_.instances[mesh.first_instance + i]), whole));
    }
  }
}

Result<void> Meshes::create_pipelines(VkFormat color_format, VkFormat depth_format, VkFormat shadow_color_format) {
  const gpu::Device& device = host_->device();
  gpu::GraphicsDesc view;
  view.name = "meshes";
  view.vertex = &shaders::mesh_vert;
  view.fragment = &shaders::mesh_frag;
  view.color_format = color_format;
  view.depth_format = depth_format;
  view.depth_compare = VK_COMPARE_OP_GREATER;
  const auto layer = [](std::uint32_t value) { return std::array<gpu::Constant, 1>{{{shared::kLayerId, value}}}; };
  if (any()) {
    TYNDALL_ASSIGN(surfaces_, gpu::create_graphics_pipeline(device, view, layer(shared::kOpaqueLayer)));
    gpu::GraphicsDesc shadow;
    shadow.name = "mesh_shadow";
    shadow.vertex = &shaders::mesh_shadow_vert;
    shadow.depth_format = depth_format;
    shadow.depth_compare = VK_COMPARE_OP_LESS;
    TYNDALL_ASSIGN(shadow_, gpu::create_graphics_pipeline(device, shadow));
    shadow.name = "mesh_shadow_mask";
    shadow.fragment = &shaders::mesh_shadow_frag;
    TYNDALL_ASSIGN(shadow_mask_, gpu::create_graphics_pipeline(device, shadow));
  }
  if (has_glass_) {
    gpu::GraphicsDesc clear = view;
    clear.depth_write = false;
    clear.name = "clear_glass";
    clear.blend = gpu::Blend::multiply;
    TYNDALL_ASSIGN(multiply_, gpu::create_graphics_pipeline(device, clear, layer(shared::kClearLayer)));
    clear.name = "clear_glass_reflection";
    clear.blend = gpu::Blend::add;
    TYNDALL_ASSIGN(add_, gpu::create_graphics_pipeline(device, clear, layer(shared::kReflectionLayer)));
    gpu::GraphicsDesc colors;
    colors.name = "shadow_colors";
    colors.vertex = &shaders::mesh_shadow_vert;
    colors.fragment = &shaders::mesh_colors_frag;
    colors.color_format = shadow_color_format;
    colors.blend = gpu::Blend::multiply_min;
    TYNDALL_ASSIGN(colors_, gpu::create_graphics_pipeline(device, colors));
  }
  if (bare_ground_) {
    gpu::GraphicsDesc ground = view;
    ground.name = "bare_ground";
    ground.vertex = &shaders::background_vert;
    ground.fragment = &shaders::ground_frag;
    TYNDALL_ASSIGN(ground_, gpu::create_graphics_pipeline(device, ground));
  }
  return {};
}

Result<void> Meshes::create_buffers() {
  const gpu::Device& device = host_->device();
  TYNDALL_ASSIGN(constants_, gpu::UploadRing::create(device, "mesh_constants", sizeof(shared::MeshConstants)));
  if (!any()) return {};
  std::vector<shared::MeshInstance> instances;
  instances.reserve(data_.instances.size());
  for (const glm::mat4& m : data_.instances) instances.push_back(placed(site_from_model_ * glm::dmat4(m)));
  const VkDeviceSize vertex_bytes = data_.vertices.size() * sizeof(MeshVertex);
  const VkDeviceSize instance_bytes = instances.size() * sizeof(shared::MeshInstance);
  const VkDeviceSize most = device.properties.limits.maxStorageBufferRange;
  if (vertex_bytes > most || instance_bytes > most) {
    return Error{ErrorCode::out_of_memory,
                 "meshes.source: the meshes are larger than this device supports; expected up to " +
                     std::to_string(most / sizeof(MeshVertex)) + " vertices and " +
                     std::to_string(most / sizeof(shared::MeshInstance)) + " placed meshes"};
  }
  const auto fill = [&](gpu::Buffer& buffer, const char* name, const void* bytes, VkDeviceSize size,
                        VkBufferUsageFlags usage) -> Result<void> {
    TYNDALL_ASSIGN(buffer, gpu::create_buffer(device, name, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryKind::device));
    return gpu::upload(*host_, buffer, bytes, size);
  };
  TYNDALL_TRY(
      fill(vertices_, "mesh_vertices", data_.vertices.data(), vertex_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  TYNDALL_TRY(fill(indices_, "mesh_indices", data_.indices.data(), data_.indices.size() * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  TYNDALL_TRY(fill(instances_, "mesh_instances", instances.data(), instance_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  MeshTexture white;
  white.width = white.height = 1;
  white.rgba.assign(4, 255);
  data_.textures.push_back(std::move(white));
  const std::uint32_t side = device.properties.limits.maxImageDimension2D;
  for (MeshTexture& texture : data_.textures) {
    if (texture.width > side || texture.height > side) {
      return Error{ErrorCode::invalid_argument,
                   "meshes.source: a texture of the meshes is larger than this device supports; expected up to " +
                       std::to_string(side) + " texels on a side"};
    }
    TYNDALL_ASSIGN(gpu::Image image, upload_texture(*host_, texture));
    textures_.push_back(std::move(image));
    texture.rgba = {};
  }
  for (const MeshMaterial& material : data_.materials) {
    if (samplers_.contains(material.sampler)) continue;
    TYNDALL_ASSIGN(samplers_[material.sampler], create_texture_sampler(device, material.sampler));
  }
  data_.vertices = {};
  data_.indices = {};
  return {};
}

Ground Meshes::ground(Ground ground, const glm::dvec3& camera) const {
  if (!any()) return ground;
  ground.min_m = std::min(ground.min_m, lowest_m_);
  ground.max_m = std::max(ground.max_m, highest_m_);
  if (bare_ground_) ground.casters = corners_;
  // From less than a diameter away, the inside is visible through windows and doors.
  if (glm::distance(camera, 0.5 * (corners_[0] + corners_[7])) < glm::distance(corners_[0], corners_[7]))
    ground.room = corners_;
  return ground;
}

VkDeviceSize Meshes::bytes() const {
  VkDeviceSize out = constants_.bytes() + vertices_.bytes + indices_.bytes + instances_.bytes;
  for (const gpu::Image& texture : textures_) out += texture.bytes;
  return out;
}

void Meshes::prepare(const View& view, const LocalFrame& frame, const ShadowParams& shadows,
                     const std::vector<CascadeFit>& cascades, const TerrainLight& light, float sky_light) {
  shared::MeshConstants out = {};
  frame_ = frame;
  out.camera_position = to_vec3(frame.place(view.position));
  out.camera_forward = to_vec3(frame.direction(view.forward));
  out.direction_to_sun = to_vec3(frame.direction(light.direction_to_sun));
  out.local_from_site = to_mat4(frame.local_from_world * world_from_site_);
  out.planet_radius_m = static_cast<float>(radius_m_);
  out.sun_irradiance = light.sun_irradiance;
  out.atmosphere_height_m = static_cast<float>(light.atmosphere_height_m);
  out.ground_albedo = Vec3(kGroundAlbedo);
  out.sky_light = sky_light;
  out.shadow_resolution = static_cast<float>(shadows.resolution);
  out.cascade_count = static_cast<std::uint32_t>(cascades.size());
  out.smooth_shadows = shadows.smooth.value;
  out.best_cascade = shadows.best_cascade.value;
  out.show_cascades = shadows.show_cascades.value;
  out.has_glass = light.has_glass ? 1U : 0U;
  for (std::size_t i = 0; i < cascades.size(); ++i) {
    const CascadeFit& c = cascades[i];
    out.shadow_from_local[i] = to_mat4(c.shadow_from_world() * frame.world_from_local);
    out.cascade[i] = {static_cast<float>(c.far_m), static_cast<float>(2.0 * c.half_extent.x / shadows.resolution),
                      static_cast<float>(2.0 * c.half_extent.y / shadows.resolution),
                      static_cast<float>(2.0 * c.half_extent.z)};
  }
  constants_.write(out);
}

std::vector<gpu::NamedResource> Meshes::resources(const TerrainLight* light) const {
  std::vector<gpu::NamedResource> out = {gpu::named_buffer("mesh_block", constants_.buffer())};
  if (any()) {
    out.push_back(gpu::named_buffer("vertices_block", vertices_.buffer.get()));
    out.push_back(gpu::named_buffer("instances_block", instances_.buffer.get()));
  }
  if (light == nullptr) return out;
  const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  out.push_back(gpu::named_image("shadow_maps", light->shadow_maps, read, light->shadow_sampler));
  out.push_back(gpu::named_image("shadow_colors", light->shadow_colors, read, light->linear));
  out.push_back(
      gpu::named_image("sun_transmittance", light->tables.sun_transmittance, VK_IMAGE_LAYOUT_GENERAL, light->linear));
  out.push_back(
      gpu::named_image("sky_irradiance", light->tables.sky_irradiance, VK_IMAGE_LAYOUT_GENERAL, light->linear));
  return out;
}

// Draws the parts with a chosen material that can be visible. Consecutive instances share a draw. The resources of a
// material are bound before its draws.
template <typename Choose>
Result<void> Meshes::draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, const glm::dmat4& clip_from_world,
                          const TerrainLight* light, const Choose& choose) {
  const gpu::Device& device = host_->device();
  const gpu::Label label(device, cmd, pipeline.name);
  std::vector<gpu::NamedResource> bound = resources(light);
  bound.push_back({});
  device.vk.CmdBindIndexBuffer(cmd, indices_.buffer.get(), 0, VK_INDEX_TYPE_UINT32);
  MeshPush push = {};
  push.clip_from_local = to_mat4(clip_from_world * frame_.world_from_local);
  const Sides sides = sides_of(clip_from_world * world_from_site_);
  const Box* box = boxes_.data();
  for (const Mesh& mesh : data_.meshes) {
    const Box* const boxes = box;
    box += mesh.instance_count == 1 ? mesh.part_count : mesh.instance_count;
    const auto in_sight = [&](std::uint32_t part, std::uint32_t instance) {
      return !is_outside(sides, boxes[mesh.instance_count == 1 ? part : instance]);
    };
    for (std::uint32_t i = 0; i < mesh.part_count; ++i) {
      const MeshPart& part = data_.parts[mesh.first_part + i];
      const MeshMaterial& material = data_.materials[part.material];
      if (!choose(material)) continue;
      std::uint32_t first = 0;
      while (first < mesh.instance_count && !in_sight(i, first)) ++first;
      if (first == mesh.instance_count) continue;
      std::memcpy(push.color, &material.color, sizeof push.color);
      push.alpha_cutoff = material.alpha_cutoff;
      push.transmission = material.transmission;
      push.kind = static_cast<std::uint32_t>(material.kind);
      push.double_sided = material.double_sided ? 1U : 0U;
      const gpu::Image& texture =
          material.texture < 0 ? textures_.back() : textures_[static_cast<std::size_t>(material.texture)];
      bound.back() = gpu::named_image("base_color", texture.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                      samplers_.at(material.sampler).get());
      TYNDALL_TRY(gpu::bind(host_->sets(), cmd, pipeline, bound, &push));
      while (first < mesh.instance_count) {
        std::uint32_t end = first + 1;
        while (end < mesh.instance_count && in_sight(i, end)) ++end;
        device.vk.CmdDrawIndexed(cmd, part.index_count, end - first, part.first_index, 0, mesh.first_instance + first);
        first = end;
        while (first < mesh.instance_count && !in_sight(i, first)) ++first;
      }
    }
  }
  return {};
}

Result<void> Meshes::draw_view(VkCommandBuffer cmd, const View& view, const TerrainLight& light) {
  if (any()) {
    TYNDALL_TRY(draw(cmd, surfaces_, clip_from_world(view), &light,
                     [](const MeshMaterial& m) { return !m.transmits() || m.diffuses(); }));
  }
  if (!bare_ground_) return {};
  const gpu::Device& device = host_->device();
  const gpu::Label label(device, cmd, ground_.name);
  GroundPush push = {};
  glm::dmat4 local_from_ndc(1.0);
  local_from_ndc[0] = glm::dvec4(frame_.direction(view.right) * view.tan_half_width, 0.0);
  local_from_ndc[1] = glm::dvec4(frame_.direction(view.up) * -view.tan_half_height, 0.0);
  local_from_ndc[2] = glm::dvec4(frame_.direction(view.forward - view.right * (view.tan_half_width * view.jitter.x) +
                                                  view.up * (view.tan_half_height * view.jitter.y)),
                                 0.0);
  push.local_from_ndc = to_mat4(local_from_ndc);
  push.near_m = static_cast<float>(kNearPlane_m);
  const std::vector<gpu::NamedResource> bound = resources(&light);
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, ground_, bound, &push));
  device.vk.CmdDraw(cmd, 3, 1, 0, 0);
  return {};
}

Result<void> Meshes::draw_clear_glass(VkCommandBuffer cmd, const View& view, const TerrainLight& light) {
  if (!has_glass_) return {};
  const auto clear = [](const MeshMaterial& m) { return m.transmits() && !m.diffuses(); };
  TYNDALL_TRY(draw(cmd, multiply_, clip_from_world(view), &light, clear));
  return draw(cmd, add_, clip_from_world(view), &light, clear);
}

Result<void> Meshes::draw_cascade(VkCommandBuffer cmd, const CascadeFit& cascade) {
  if (!any()) return {};
  const glm::dmat4 clip = clip_from_shadow() * cascade.shadow_from_world();
  TYNDALL_TRY(draw(cmd, shadow_, clip, nullptr, [](const MeshMaterial& m) { return m.kind == SurfaceKind::opaque; }));
  return draw(cmd, shadow_mask_, clip, nullptr, [](const MeshMaterial& m) { return m.kind == SurfaceKind::mask; });
}

Result<void> Meshes::draw_colors(VkCommandBuffer cmd, const CascadeFit& cascade) {
  if (!has_glass_) return {};
  return draw(cmd, colors_, clip_from_shadow() * cascade.shadow_from_world(), nullptr,
              [](const MeshMaterial& m) { return m.transmits(); });
}

}  // namespace tyndall::scene
