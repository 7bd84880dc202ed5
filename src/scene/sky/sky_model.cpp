#include "scene/sky/sky_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "gpu/try.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/sky/homogeneous_sky.hpp"
#include "scene/sky/oneil_sky.hpp"
#include "scene/view/constant_ids.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint32_t kColumns = 128;
constexpr std::uint32_t kRowsAbove = 64;    // rows from the zenith to the edge of the sky
constexpr std::uint32_t kRowsBetween = 48;  // rows from there to the planet's horizon
constexpr std::uint32_t kRowsBelow = 48;    // rows from there to the nadir
constexpr std::uint32_t kRows = kRowsAbove + kRowsBetween + kRowsBelow;
constexpr std::uint32_t kIndices = kColumns * kRows * 6;
constexpr double kHalfTurn = std::numbers::pi;

// The constants that scene/sky_mesh.glsl reads, in std430.
struct MeshBlock {
  Mat4 clip_from_local;
  Vec3 up;
  std::uint32_t columns;
  Vec3 ahead;
  std::uint32_t rows;
  Vec3 right;
  float unused;
  float angles[kColumns + 1 + kRows + 1];
};

std::vector<std::uint32_t> mesh_indices() {
  std::vector<std::uint32_t> out;
  out.reserve(kIndices);
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::uint32_t a = row * (kColumns + 1) + column;
      const std::uint32_t below = a + kColumns + 1;
      out.insert(out.end(), {a, below, below + 1, a, below + 1, a + 1});
    }
  }
  return out;
}

// Returns a horizontal unit vector near `wanted`, or any horizontal one if that is vertical.
glm::dvec3 horizontal(const glm::dvec3& wanted, const glm::dvec3& up) {
  for (const glm::dvec3& v : {wanted, glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0)}) {
    const glm::dvec3 flat = v - up * glm::dot(v, up);
    if (glm::length(flat) > 1e-3) return glm::normalize(flat);
  }
  return {1, 0, 0};
}

}  // namespace

Result<void> SkyModel::create_objects(gpu::Host& host, const Shaders& shaders, ModelEvaluation evaluation,
                                      std::size_t constants_bytes, VkFormat color_format, VkFormat depth_format,
                                      std::span<const std::span<const gpu::Constant>> variants) {
  host_ = &host;
  evaluation_ = evaluation;
  const gpu::Device& device = host.device();
  gpu::GraphicsDesc ground;
  ground.name = "terrain";
  ground.vertex = shaders.ground_vertex;
  ground.fragment = shaders.ground_fragment;
  ground.color_format = color_format;
  ground.depth_format = depth_format;
  ground.depth_compare = VK_COMPARE_OP_GREATER;
  gpu::GraphicsDesc sky = ground;
  ground.color_count = 1 + shaders.air_images;
  sky.name = "sky";
  sky.vertex = shaders.sky_vertex;
  sky.fragment = shaders.sky_fragment;
  sky.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
  sky.depth_write = false;
  for (std::size_t i = 0; i < std::max(variants.size(), std::size_t{1}); ++i) {
    std::vector<gpu::Constant> constants = {{shared::kPerPixelId, evaluation == ModelEvaluation::pixel ? 1U : 0U}};
    if (!variants.empty()) constants.insert(constants.end(), variants[i].begin(), variants[i].end());
    if (evaluation == ModelEvaluation::vertex) {
      TYNDALL_ASSIGN(gpu::Pipeline of_ground, gpu::create_graphics_pipeline(device, ground, constants));
      ground_.push_back(std::move(of_ground));
    }
    TYNDALL_ASSIGN(gpu::Pipeline of_light, gpu::create_compute_pipeline(device, *shaders.ground_light, constants));
    TYNDALL_ASSIGN(gpu::Pipeline of_sky, gpu::create_graphics_pipeline(device, sky, constants));
    light_.push_back(std::move(of_light));
    sky_.push_back(std::move(of_sky));
  }
  air_.resize(shaders.air_images);
  air_format_ = color_format;

  const std::vector<std::uint32_t> indices = mesh_indices();
  const VkDeviceSize index_bytes = indices.size() * sizeof(std::uint32_t);
  TYNDALL_ASSIGN(indices_, gpu::create_buffer(device, "sky_mesh_indices", index_bytes,
                                              VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryKind::device));
  TYNDALL_TRY(gpu::upload(host, indices_, indices.data(), index_bytes));
  TYNDALL_ASSIGN(mesh_, gpu::UploadRing::create(device, "sky_mesh", sizeof(MeshBlock)));
  TYNDALL_ASSIGN(constants_, gpu::UploadRing::create(device, "model_constants", constants_bytes));
  return {};
}

void SkyModel::fill_mesh(const ModelFrame& frame) {
  const double radius = frame.params.planet.radius_m;
  const glm::dvec3 up = up_of(frame.view.position, radius);
  const glm::dvec3 ahead = horizontal(frame.light.direction_to_sun, up);
  MeshBlock out = {};
  out.clip_from_local = to_mat4(clip_from_world(frame.view) * frame.local.world_from_local);
  out.up = to_vec3(frame.local.direction(up));
  out.columns = kColumns;
  out.ahead = to_vec3(frame.local.direction(ahead));
  out.rows = kRows;
  out.right = to_vec3(frame.local.direction(glm::cross(ahead, up)));

  // Columns are closer together towards the sun.
  for (std::uint32_t i = 0; i <= kColumns; ++i) {
    const double x = 2.0 * i / kColumns - 1.0;
    out.angles[i] = static_cast<float>(kHalfTurn * x * (0.3 + 0.7 * x * x));
  }
  // The upper rows extend to the edge of the sky: the horizontal or, from space, the rim of the atmosphere. The next
  // rows extend to the horizon of the ground sphere, which for an eye below sea level is at twice its depth. At both
  // edges there are two rows close together, so that a discontinuity there is sharp and every vertex is clearly on one
  // side.
  const double altitude = altitude_of(frame.view.position, radius);
  const auto dip = [&](double below_m) {  // returns the angle of a sphere's rim below the horizontal
    const double r = radius + altitude;
    return below_m > 0.0 ? std::acos(std::clamp((r - below_m) / r, -1.0, 1.0)) : 0.0;
  };
  const double edge = 0.5 * kHalfTurn + dip(altitude - static_cast<double>(frame.params.atmosphere.height_m));
  const double horizon = 0.5 * kHalfTurn + dip(std::abs(altitude));
  float* const zenith = out.angles + kColumns + 1;
  for (std::uint32_t i = 0; i <= kRowsAbove; ++i) {
    const double x = 1.0 - static_cast<double>(i) / kRowsAbove;
    zenith[i] = static_cast<float>(edge * (1.0 - x * (0.1 + 0.9 * x)));
  }
  constexpr double kNarrow_rad = 1e-4;
  const double last = horizon - kNarrow_rad;
  for (std::uint32_t i = 1; i <= kRowsBetween; ++i) {
    // Rows are closer together at both ends, because radiance increases like a square root from the rim, and
    // exponentially towards the horizon.
    const double t = static_cast<double>(i - 1) / (kRowsBetween - 1);
    const double x = t * t * (3.0 - 2.0 * t);
    zenith[kRowsAbove + i] = static_cast<float>(std::min(edge + kNarrow_rad, last) * (1.0 - x) + last * x);
  }
  for (std::uint32_t i = 1; i <= kRowsBelow; ++i) {
    const double x = static_cast<double>(i - 1) / (kRowsBelow - 1);
    const double from = horizon + kNarrow_rad;
    zenith[kRowsAbove + kRowsBetween + i] = static_cast<float>(from + (kHalfTurn - from) * x * (0.1 + 0.9 * x));
  }
  mesh_.write(out);
}

Result<void> SkyModel::create_air(VkExtent2D extent) {
  if (evaluation_ == ModelEvaluation::pixel) extent = {1, 1};
  static constexpr const char* kNames[] = {"air_0", "air_1", "air_2"};
  for (std::size_t i = 0; i < air_.size(); ++i) {
    const VkExtent3D& had = air_[i].desc.extent;
    if (air_[i].image && had.width == extent.width && had.height == extent.height) continue;
    TYNDALL_ASSIGN(air_[i], gpu::create_image(host_->device(),
                                              {kNames[i],
                                               air_format_,
                                               {extent.width, extent.height, 1},
                                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT}));
  }
  return {};
}

VkDeviceSize SkyModel::bytes() const {
  VkDeviceSize out = mesh_.bytes() + constants_.bytes() + indices_.bytes;
  for (const gpu::Image& image : air_) out += image.bytes;
  return out;
}

std::vector<gpu::NamedResource> SkyModel::own_resources() const {
  std::vector<gpu::NamedResource> out = more_resources();
  out.push_back(gpu::named_buffer("model_block", constants_.buffer()));
  return out;
}

Result<void> SkyModel::prepare(const ModelFrame& frame) {
  fill_mesh(frame);
  TYNDALL_TRY(create_air(frame.extent));
  return fill(frame, constants_.next());
}

Result<void> SkyModel::draw_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame) {
  if (!draws_terrain(frame.scene)) return {};
  if (ground_.empty()) return terrain.draw_view(cmd, frame.view);
  return terrain.draw_view(cmd, frame.view, ground_[variant()], own_resources());
}

Result<void> SkyModel::light_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame, VkImageView color) {
  if (!draws_terrain(frame.scene)) return {};
  std::vector<gpu::NamedResource> more = own_resources();
  for (const gpu::Image& image : air_) more.push_back(gpu::named_image(image.desc.name, image.view.get()));
  return terrain.light_view(cmd, frame.light, color, frame.extent, light_[variant()], more);
}

Result<void> SkyModel::draw_sky(VkCommandBuffer cmd, VkBuffer background) {
  const gpu::Device& device = host_->device();
  const gpu::Pipeline& sky = sky_[variant()];
  const gpu::Label label(device, cmd, sky.name);
  std::vector<gpu::NamedResource> resources = own_resources();
  resources.push_back(gpu::named_buffer("mesh_block", mesh_.buffer()));
  resources.push_back(gpu::named_buffer("background_block", background));
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, sky, resources));
  device.vk.CmdBindIndexBuffer(cmd, indices_.buffer.get(), 0, VK_INDEX_TYPE_UINT32);
  device.vk.CmdDrawIndexed(cmd, kIndices, 1, 0, 0, 0);
  return {};
}

Result<std::unique_ptr<SkyModel>> create_sky_model(gpu::Host& host, const SceneParams& scene, VkFormat color_format,
                                                   VkFormat depth_format) {
  const ModelEvaluation evaluation = scene.scattering.evaluate;
  switch (scene.scattering.model) {
    case ScatteringModel::homogeneous: return create_homogeneous_sky(host, evaluation, color_format, depth_format);
    case ScatteringModel::oneil: return create_oneil_sky(host, evaluation, false, color_format, depth_format);
    case ScatteringModel::oneil_table: return create_oneil_sky(host, evaluation, true, color_format, depth_format);
    case ScatteringModel::atmosphere: break;
  }
  return Error{ErrorCode::invalid_argument,
               "scattering.model: 'atmosphere' is not a sky model; expected one of the others"};
}

}  // namespace tyndall::scene
