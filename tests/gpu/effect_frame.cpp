#include "effect_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "effect/medium.hpp"
#include "gpu/try.hpp"
#include "models/glsl_double.hpp"

namespace tyndall {
namespace {

constexpr double kNear_m = 1.0;
constexpr double kFar_m = 1.0e6;  // far plane with standard depth

float device_depth(const TestFrame& frame, double view_depth_m) {
  if (frame.convention == DepthConvention::reversed_infinite) {
    return view_depth_m <= 0.0 ? 0.0F : static_cast<float>(kNear_m / view_depth_m);
  }
  if (view_depth_m <= 0.0) return 1.0F;
  return static_cast<float>(kFar_m / (kFar_m - kNear_m) * (1.0 - kNear_m / view_depth_m));
}

Camera camera_of(const TestFrame& frame) {
  const TestView& v = frame.view;
  Camera out;
  const glm::dvec3 columns[4] = {v.right, v.up, -v.forward, v.position};
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) out.world_from_view.m[4 * c + r] = static_cast<float>(columns[c][r]);
  }
  Mat4& clip = out.clip_from_view;
  clip = Mat4{{}};
  clip.m[0] = static_cast<float>(1.0 / v.tan_half_width);
  clip.m[5] = static_cast<float>(-1.0 / v.tan_half_height);
  clip.m[8] = static_cast<float>(2.0 * v.jitter_px.x / frame.extent.width);
  clip.m[9] = static_cast<float>(2.0 * v.jitter_px.y / frame.extent.height);
  clip.m[11] = -1.0F;
  if (frame.convention == DepthConvention::reversed_infinite) {
    clip.m[14] = static_cast<float>(kNear_m);
  } else {
    clip.m[10] = static_cast<float>(kFar_m / (kNear_m - kFar_m));
    clip.m[14] = static_cast<float>(kNear_m * kFar_m / (kNear_m - kFar_m));
  }
  return out;
}

glsl64::Medium wide_medium(const Params& params) { return glsl64::widen(medium_from_params(params)); }

}  // namespace

TestView TestView::at(double altitude_m, double yaw_rad, double pitch_rad, double tan_half) {
  TestView out;
  out.position = {0.0, altitude_m, 0.0};
  const glm::dvec3 heading(std::sin(yaw_rad), 0.0, -std::cos(yaw_rad));
  out.forward = heading * std::cos(pitch_rad) + glm::dvec3(0, 1, 0) * std::sin(pitch_rad);
  out.right = {std::cos(yaw_rad), 0.0, std::sin(yaw_rad)};
  out.up = glm::cross(out.right, out.forward);
  out.tan_half_width = out.tan_half_height = tan_half;
  return out;
}

glm::dvec3 TestView::ray(std::uint32_t x, std::uint32_t y, VkExtent2D extent) const {
  const double ndc_x = 2.0 * (x + 0.5 + jitter_px.x) / extent.width - 1.0;
  const double ndc_y = 2.0 * (y + 0.5 + jitter_px.y) / extent.height - 1.0;
  return glm::normalize(forward + right * (ndc_x * tan_half_width) - up * (ndc_y * tan_half_height));
}

RayAngles TestFrame::ray(std::uint32_t x, std::uint32_t y, double planet_radius_m) const {
  // The effect receives the camera in single precision.
  const glm::dvec3 p = glm::vec3(view.position);
  const glm::dvec3 from_centre = p + glm::dvec3(0.0, planet_radius_m, 0.0);
  const double distance = glm::length(from_centre);
  const double altitude = (p.x * p.x + p.z * p.z + p.y * (2.0 * planet_radius_m + p.y)) / (distance + planet_radius_m);
  const glm::dvec3 direction = view.ray(x, y, extent);
  const glm::dvec3 vertical = from_centre / distance;
  const glm::dvec3 sun = glm::normalize(to_sun);
  return {altitude, glm::dot(direction, vertical), glm::dot(sun, vertical), glm::dot(direction, sun)};
}

Result<FrameImages> FrameImages::create(gpu::Host& host, const TestFrame& frame, OutputFormat format) {
  FrameImages out;
  out.format_ = format;
  const gpu::Device& device = host.device();
  const VkExtent2D whole = frame.image_extent.width > 0 ? frame.image_extent : frame.extent;
  const VkExtent3D extent = {whole.width, whole.height, 1};
  constexpr VkImageUsageFlags kInput = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const std::size_t pixels = static_cast<std::size_t>(extent.width) * extent.height;

  std::vector<float> color;
  std::vector<float> depth;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const auto inside = [&](const VkOffset2D& offset) {
        const std::uint32_t px = x - static_cast<std::uint32_t>(offset.x);
        const std::uint32_t py = y - static_cast<std::uint32_t>(offset.y);
        return px < frame.extent.width && py < frame.extent.height;
      };
      const Vec3 shown = inside(frame.offsets.color) ? frame.background : Vec3(std::numeric_limits<float>::quiet_NaN());
      color.insert(color.end(), {shown.x, shown.y, shown.z, 1.0F});
      if (!inside(frame.offsets.depth)) {
        depth.push_back((x + y) % 2 == 0 ? 0.875F : 1.0F / 65536.0F);
        continue;
      }
      const std::uint32_t px = x - static_cast<std::uint32_t>(frame.offsets.depth.x);
      const std::uint32_t py = y - static_cast<std::uint32_t>(frame.offsets.depth.y);
      const double distance = frame.distance_m ? frame.distance_m(px, py) : 0.0;
      depth.push_back(
          device_depth(frame, distance * glm::dot(frame.view.ray(px, py, frame.extent), frame.view.forward)));
    }
  }
  TYNDALL_ASSIGN(out.color_, gpu::create_image(device, {"color", VK_FORMAT_R32G32B32A32_SFLOAT, extent, kInput}));
  TYNDALL_TRY(gpu::upload(host, out.color_, color.data(), pixels * 16, kRead));
  TYNDALL_ASSIGN(out.depth_, gpu::create_image(device, {"depth", VK_FORMAT_D32_SFLOAT, extent, kInput}));
  TYNDALL_TRY(gpu::upload(host, out.depth_, depth.data(), pixels * 4, kRead));

  if (!frame.cascades.empty()) {
    const std::uint32_t n = frame.shadow_resolution;
    TYNDALL_ASSIGN(out.shadows_, gpu::create_image(device, {"shadows",
                                                            VK_FORMAT_D32_SFLOAT,
                                                            {n, n, 1},
                                                            kInput,
                                                            static_cast<std::uint32_t>(frame.cascades.size()),
                                                            1,
                                                            true}));
    TYNDALL_TRY(out.draw_shadows(host, frame));
    if (frame.shadow_color) {
      std::vector<float> glass;
      for (std::uint32_t c = 0; c < frame.cascades.size(); ++c) {
        for (std::uint32_t y = 0; y < n; ++y) {
          for (std::uint32_t x = 0; x < n; ++x) {
            const glm::vec3 pane = frame.shadow_color(c, (x + 0.5) / n, (y + 0.5) / n);
            glass.insert(glass.end(), {pane.x, pane.y, pane.z,
                                       frame.glass_depth ? frame.glass_depth(c, (x + 0.5) / n, (y + 0.5) / n) : 1.0F});
          }
        }
      }
      TYNDALL_ASSIGN(out.glass_, gpu::create_image(device, {"glass",
                                                            VK_FORMAT_R32G32B32A32_SFLOAT,
                                                            {n, n, 1},
                                                            kInput,
                                                            static_cast<std::uint32_t>(frame.cascades.size()),
                                                            1,
                                                            true}));
      TYNDALL_TRY(gpu::upload(host, out.glass_, glass.data(), glass.size() * 4, kRead));
    }
  }

  if (frame.clouds.texel) TYNDALL_TRY(out.draw_clouds(host, frame));

  const VkFormat output_format =
      format == OutputFormat::rgba16f ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
  TYNDALL_ASSIGN(out.output_, gpu::create_image(device, {"output", output_format, extent,
                                                         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  // Filled with a value that no frame writes, so that missing pixels are detected.
  const std::vector<std::byte> unwritten(pixels * (format == OutputFormat::rgba16f ? 8 : 16), std::byte{0xFF});
  TYNDALL_TRY(gpu::upload(host, out.output_, unwritten.data(), unwritten.size(), VK_IMAGE_LAYOUT_GENERAL));
  return out;
}

FrameInputs FrameImages::inputs(const TestFrame& frame) const {
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  FrameInputs out;
  out.extent = frame.extent;
  out.color = {color_.view.get(), kRead, frame.offsets.color};
  out.depth = {depth_.view.get(), kRead, frame.offsets.depth};
  out.shadow_maps = {shadows_.view.get(), kRead};
  out.shadow_colors = {glass_.view.get(), kRead};
  out.shadow_color_depths = static_cast<bool>(frame.glass_depth);
  out.shadow_resolution = frame.shadow_resolution;
  out.cascades = frame.cascades;
  out.first_marched_cascade = frame.first_marched;
  out.camera = camera_of(frame);
  out.sun.direction_to_sun = {static_cast<float>(frame.to_sun.x), static_cast<float>(frame.to_sun.y),
                              static_cast<float>(frame.to_sun.z)};
  out.sun.irradiance = frame.irradiance;
  out.output = {output_.view.get(), VK_IMAGE_LAYOUT_GENERAL, frame.offsets.output};
  out.lowest_ground_m = static_cast<float>(frame.lowest_ground_m);
  out.clouds = {{clouds_.view.get(), kRead}, frame.clouds.map_from_world};
  return out;
}

Result<void> FrameImages::draw_clouds(gpu::Host& host, const TestFrame& frame) {
  const std::uint32_t n = frame.clouds.resolution;
  std::vector<float> texels;
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const glm::vec4 texel = frame.clouds.texel((x + 0.5) / n, (y + 0.5) / n);
      texels.insert(texels.end(), {texel.x, texel.y, texel.z, texel.w});
    }
  }
  TYNDALL_ASSIGN(clouds_,
                 gpu::create_image(host.device(), {"clouds",
                                                   VK_FORMAT_R32G32B32A32_SFLOAT,
                                                   {n, n, 1},
                                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
  return gpu::upload(host, clouds_, texels.data(), texels.size() * 4, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Result<void> FrameImages::draw_shadows(gpu::Host& host, const TestFrame& frame) {
  const std::uint32_t n = frame.shadow_resolution;
  std::vector<float> shadows;
  for (std::uint32_t c = 0; c < frame.cascades.size(); ++c) {
    for (std::uint32_t y = 0; y < n; ++y) {
      for (std::uint32_t x = 0; x < n; ++x) {
        const float nothing = frame.shadow_depth_reversed ? 0.0F : 1.0F;
        shadows.push_back(frame.shadow_depth ? frame.shadow_depth(c, (x + 0.5) / n, (y + 0.5) / n) : nothing);
      }
    }
  }
  return gpu::upload(host, shadows_, shadows.data(), shadows.size() * 4, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Result<std::vector<std::byte>> FrameImages::output_bytes(gpu::Host& host) {
  return gpu::download(host, output_, VK_IMAGE_LAYOUT_GENERAL, 0, format_ == OutputFormat::rgba16f ? 8 : 16);
}

Result<std::vector<glm::dvec3>> FrameImages::output(gpu::Host& host) {
  TYNDALL_ASSIGN(const std::vector<std::byte> bytes, output_bytes(host));
  std::vector<glm::dvec3> out(static_cast<std::size_t>(output_.desc.extent.width) * output_.desc.extent.height);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (format_ == OutputFormat::rgba16f) {
        std::uint16_t half = 0;
        std::memcpy(&half, bytes.data() + i * 8 + c * 2, sizeof half);
        out[i][static_cast<int>(c)] = glm::unpackHalf1x16(half);
      } else {
        float value = 0.0F;
        std::memcpy(&value, bytes.data() + i * 16 + c * 4, sizeof value);
        out[i][static_cast<int>(c)] = value;
      }
    }
  }
  return out;
}

EffectDesc desc_for(const TestFrame& frame, OutputFormat format) {
  EffectDesc desc;
  desc.max_extent = frame.extent;
  desc.output_format = format;
  desc.sky_depth = frame.convention == DepthConvention::standard ? 1.0F : 0.0F;
  desc.shadow_depth_reversed = frame.shadow_depth_reversed;
  desc.shadow_colors = static_cast<bool>(frame.shadow_color);
  desc.clouds = static_cast<bool>(frame.clouds.texel);
  return desc;
}

Result<std::vector<glm::dvec3>> render(gpu::Host& host, Effect& effect, const TestFrame& frame, OutputFormat format) {
  TYNDALL_ASSIGN(FrameImages images, FrameImages::create(host, frame, format));
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) { return effect.record(cmd, images.inputs(frame)); }));
  return images.output(host);
}

namespace {
DeviceInfo info_of(const gpu::Host& host) {
  const gpu::Device& device = host.device();
  DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical_device;
  info.device = device.device;
  info.get_instance_proc_addr = host.get_instance_proc_addr();
  return info;
}
}  // namespace

Result<std::vector<glm::dvec3>> render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                       OutputFormat format) {
  TYNDALL_ASSIGN(Effect effect, Effect::create(info_of(host), desc_for(frame, format), params));
  return render(host, effect, frame, format);
}

Result<std::vector<glm::dvec3>> EffectCache::render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                                    OutputFormat format) {
  EffectDesc wanted = desc_for(frame, format);
  wanted.max_extent = {128, 128};
  wanted.max_cascades = kMaxCascades;
  auto cached = std::find_if(cached_.begin(), cached_.end(), [&](const Cached& k) {
    return k.desc.output_format == wanted.output_format && k.desc.sky_depth == wanted.sky_depth &&
           k.desc.shadow_depth_reversed == wanted.shadow_depth_reversed &&
           k.desc.shadow_colors == wanted.shadow_colors && k.desc.clouds == wanted.clouds;
  });
  if (cached == cached_.end()) {
    TYNDALL_ASSIGN(Effect effect, Effect::create(info_of(host), wanted, params));
    cached_.push_back({wanted, std::move(effect)});
    cached = cached_.end() - 1;
  } else {
    TYNDALL_TRY(cached->effect.set_params(params));
  }
  return tyndall::render(host, cached->effect, frame, format);
}

Cascade sun_cascade(const glm::dvec3& to_sun, const glm::dvec3& middle, double half_m, double near_m, double far_m) {
  const glm::dvec3 sun = glm::normalize(to_sun);
  const glm::dvec3 right =
      glm::normalize(glm::cross(std::abs(sun.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), sun));
  const glm::dvec3 rows[3] = {right * (0.5 / half_m), glm::cross(sun, right) * (0.5 / half_m),
                              sun * (-0.5 / (4.0 * half_m))};
  Cascade out;
  out.near_m = static_cast<float>(near_m);
  out.far_m = static_cast<float>(far_m);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.shadow_from_world.m[4 * c + r] = static_cast<float>(rows[r][c]);
    out.shadow_from_world.m[12 + r] = static_cast<float>(0.5 - glm::dot(rows[r], middle));
  }
  return out;
}

TestFrame small_frame() {
  TestFrame frame;
  frame.view = TestView::at(2000.0, 0.2, 0.05, 0.8);
  frame.to_sun = {0.3, 0.4, -0.866};
  frame.distance_m = [](std::uint32_t x, std::uint32_t) { return x < 5 ? 8000.0 : 0.0; };
  frame.cascades = {sun_cascade(frame.to_sun, frame.view.position, 50000.0, 0.0, 10000.0),
                    sun_cascade(frame.to_sun, frame.view.position, 50000.0, 10000.0, 20000.0)};
  frame.shadow_depth = [](std::uint32_t, double u, double v) {
    return std::fmod(8.0 * u + v, 1.0) < 0.5 ? 0.0F : 1.0F;
  };
  return frame;
}

Params with_technique(Technique technique) {
  Params params;
  params.scattering.technique = technique;
  return params;
}

Params precise_params() {
  Params params;
  params.scattering.scale = 1.0F;
  params.scattering.integration_steps = 48;
  // These tests compute the rays of pixels, as brute force does. epipolar_modes_test.cpp compares the techniques.
  params.scattering.technique = Technique::brute_force;
  // Needs no tables, which tables_test.cpp tests.
  params.scattering.single = SingleScattering::integration;
  params.scattering.multiple = MultipleScattering::none;
  params.tables.size = {8, 16, 16, 4};
  return params;
}

glm::dvec3 true_inscattering(const Params& params, const RayAngles& ray, double start, double end) {
  constexpr int kSteps = 48;  // four times the steps for 0.1 %
  if (end <= start) return glm::dvec3(0.0);
  return glsl64::single_scattering(wide_medium(params), ray.altitude_m, ray.cos_view, ray.cos_sun, ray.cos_view_sun,
                                   start, end, kSteps);
}

glm::dvec3 true_transmittance(const Params& params, const RayAngles& ray, double end) {
  const glsl64::Medium medium = wide_medium(params);
  return glsl64::transmittance(medium, glsl64::density_integral_along(medium, ray.altitude_m, ray.cos_view, end));
}

std::optional<AirSegment> segment_below_top(const Params& params, const RayAngles& ray) {
  const glsl64::Medium medium = wide_medium(params);
  AirSegment out = {};
  if (!glsl64::atmosphere_segment(ray.altitude_m, ray.cos_view, medium.atmosphere_height_m, medium.planet_radius_m,
                                  out.start, out.end, out.on_ground)) {
    return std::nullopt;
  }
  return out;
}

double relative_error(const glm::dvec3& value, const glm::dvec3& truth) {
  const glm::dvec3 difference = glm::abs(value - truth);
  return std::max({difference.x, difference.y, difference.z}) / std::max({truth.x, truth.y, truth.z, 1e-30});
}

}  // namespace tyndall
