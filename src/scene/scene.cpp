#include "scene/scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "gpu/guard.hpp"
#include "gpu/try.hpp"
#include "scene/description/camera_exposure.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/description/placed_sun.hpp"
#include "scene/description/unused_params.hpp"
#include "scene/formats.hpp"
#include "scene/photometry.hpp"
#include "scene/sky/background_constants.hpp"
#include "scene_shaders.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint32_t kMaxTimedPasses = 24;
constexpr double kMinHeight_m = 2.0;  // lowest height of the camera above the ground

// Refuses pictures and shadow maps that do not fit the device's memory, before anything is created.
Result<void> check_memory(const gpu::Device& device, VkExtent2D extent, std::uint32_t resolution,
                          std::uint32_t cascades, double bytes_per_texel, double more_bytes_per_pixel) {
  VkDeviceSize largest = 0;
  for (std::uint32_t i = 0; i < device.memory.memoryHeapCount; ++i) {
    largest = std::max(largest, device.memory.memoryHeaps[i].size);
  }
  // The heap of a CPU device is the memory of the machine, although drivers report less (lavapipe: at most 2 GiB).
  if (device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long page_bytes = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page_bytes > 0) {
      largest = std::max(largest, static_cast<VkDeviceSize>(pages) * static_cast<VkDeviceSize>(page_bytes));
    }
  }
  const std::uint32_t side = device.properties.limits.maxImageDimension2D;
  if (extent.width > side || extent.height > side || resolution > side) {
    return Error{
        ErrorCode::invalid_argument,
        "--size or shadows.resolution: a picture or shadow map is larger than this device supports; expected up to " +
            std::to_string(side) + " on a side"};
  }
  // Three colour images and depth, and two colour images on the host for reading back.
  constexpr double kBytesPerPixel = 3 * 16 + 4 + 2 * 16;
  const double needed = (kBytesPerPixel + more_bytes_per_pixel) * extent.width * extent.height +
                        bytes_per_texel * resolution * resolution * cascades;
  const double allowed = 0.8 * static_cast<double>(largest);
  if (needed <= allowed) return {};
  const auto gib = [](double bytes) { return std::to_string(static_cast<int>(std::ceil(bytes / 1073741824.0))); };
  return Error{ErrorCode::out_of_memory, "--size: a picture of " + std::to_string(extent.width) + "x" +
                                             std::to_string(extent.height) + " with these shadow maps needs " +
                                             gib(needed) + " GiB; expected at most " + gib(allowed) +
                                             " GiB on this device"};
}

// Returns the radical inverse of i (Halton, 1960), which is evenly distributed over [0; 1).
double halton(std::uint32_t i, std::uint32_t base) {
  double out = 0.0;
  double digit = 1.0;
  for (; i > 0; i /= base) {
    digit /= base;
    out += digit * (i % base);
  }
  return out;
}

// Returns notes on what cannot be drawn well from the view. `height_m`: height of the camera above the ground.
std::vector<std::string> limits_of_view(const View& view, double height_m, double radius_m) {
  std::vector<std::string> out;
  constexpr double kGrainy_m = 2.0e8;
  if (height_m > kGrainy_m)
    out.emplace_back("the camera is farther than 200000 km from the ground; single precision makes the planet grainy");
  const glm::dvec3 up = up_of(view.position, radius_m);
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec3 ray =
          view.forward + x * view.tan_half_width * view.right + y * view.tan_half_height * view.up;  // depth 1
      if (-glm::dot(ray, up) * kNearPlane_m <= height_m) continue;
      static_assert(kNearPlane_m == 0.5);
      out.emplace_back("the field of view contains ground within the near plane at 0.5 m, which is not drawn");
      return out;
    }
  }
  return out;
}

}  // namespace

Result<std::unique_ptr<Scene>> Scene::create(gpu::Host& host, const SceneDesc& desc, const Params& params,
                                             const SceneParams& scene) {
  return within_memory("creating the scene", [&]() -> Result<std::unique_ptr<Scene>> {
    auto out = std::make_unique<Scene>();
    out->host_ = &host;
    out->desc_ = desc;
    out->desc_.timings = desc.timings && host.timestamps();
    out->params_ = params;
    out->scene_ = scene;
    TYNDALL_ASSIGN(out->terrain_, Terrain::create(host, scene.terrain, params.planet.radius_m, kColorFormat,
                                                  kDepthFormat, desc.terrain_coarseness));
    out->notes_ = unused_params(params, scene);
    add_notes(out->notes_, out->terrain_->notes());
    TYNDALL_TRY(check_model(scene));
    TYNDALL_ASSIGN(out->meshes_, out->make_meshes(scene, params.planet.radius_m));
    if (out->meshes_ != nullptr) add_notes(out->notes_, out->meshes_->notes());
    TYNDALL_TRY(out->create_objects());
    return out;
  });
}

Result<std::unique_ptr<Effect>> Scene::make_effect(const EffectDesc& desc) {
  const gpu::Device& device = host_->device();
  DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical_device;
  info.device = device.device;
  info.get_instance_proc_addr = host_->get_instance_proc_addr();
  info.message = [](void* user, Severity, std::string_view text) {
    auto* notes = static_cast<std::vector<std::string>*>(user);
    if (std::find(notes->begin(), notes->end(), text) != notes->end()) return;
    try {
      notes->emplace_back(text);
    } catch (const std::bad_alloc&) {  // a callback of the library must not throw, so the remark is dropped
      return;
    }
  };
  info.message_user = &notes_;
  info.pipeline_cache = device.pipeline_cache;
  info.replace_shader = device.replace_shader;
  info.replace_shader_user = device.replace_shader_user;
  TYNDALL_ASSIGN(Effect effect, Effect::create(info, desc, params_));
  return std::make_unique<Effect>(std::move(effect));
}

Result<void> Scene::replace_lost_effect() {
  if (!effect_lost_) return {};
  EffectDesc desc = effect_->desc();
  desc.max_extent = desc_.extent;
  desc.max_cascades = scene_.shadows.cascades;
  desc.max_shadow_resolution = scene_.shadows.resolution;
  TYNDALL_ASSIGN(std::unique_ptr<Effect> made, make_effect(desc));
  TYNDALL_TRY(wait_for_frames());
  const std::size_t notes = notes_.size();
  light_meter_.reset();
  effect_ = std::move(made);
  notes_.resize(notes);  // drops the remark of the old effect that its commands have not completed
  tables_ready_ = false;
  TYNDALL_TRY(make_tables_ready());
  effect_lost_ = false;
  return {};
}

Result<void> Scene::create_objects() {
  const gpu::Device& device = host_->device();
  EffectDesc effect_desc;
  effect_desc.max_extent = desc_.extent;
  effect_desc.frames_in_flight = ahead() ? gpu::kFramesInFlight : 1;
  effect_desc.output_format = OutputFormat::rgba32f;
  effect_desc.max_cascades = scene_.shadows.cascades;
  effect_desc.max_shadow_resolution = scene_.shadows.resolution;
  const bool glass = meshes_ != nullptr && meshes_->has_glass();
  effect_desc.shadow_colors = glass;
  effect_desc.timings = desc_.timings;
  effect_desc.counters = desc_.counters;
  effect_desc.pipeline_threads = desc_.pipeline_threads;
  effect_desc.table_pipelines_later = true;
  TYNDALL_ASSIGN(effect_, make_effect(effect_desc));
  TYNDALL_ASSIGN(post::Tonemap tonemap, post::Tonemap::create(device, effect_desc.frames_in_flight));
  tonemap_ = std::make_unique<post::Tonemap>(std::move(tonemap));

  TYNDALL_TRY(check_memory(device, desc_.extent, scene_.shadows.resolution, scene_.shadows.cascades, glass ? 12.0 : 4.0,
                           scene_.scattering.model != ScatteringModel::atmosphere ? 3 * 16.0 : 0.0));  // SkyModel::air
  TYNDALL_ASSIGN(Targets targets, make_targets(desc_.extent));
  swap_targets(targets);
  TYNDALL_ASSIGN(Layered maps, make_shadow_maps(scene_.shadows));
  shadow_maps_ = std::move(maps.image);
  shadow_layers_ = std::move(maps.layers);
  TYNDALL_ASSIGN(Layered colors, make_shadow_colors(scene_.shadows, glass));
  shadow_colors_ = std::move(colors.image);
  shadow_color_layers_ = std::move(colors.layers);
  TYNDALL_ASSIGN(linear_, gpu::create_sampler(device, {}));
  TYNDALL_ASSIGN(nearest_, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));
  gpu::SamplerDesc compare;
  compare.compare = true;
  compare.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  TYNDALL_ASSIGN(shadow_compare_, gpu::create_sampler(device, compare));
  gpu::GraphicsDesc background;
  background.name = "background";
  background.vertex = &shaders::background_vert;
  background.fragment = &shaders::background_frag;
  background.color_format = kColorFormat;
  background.depth_format = kDepthFormat;
  background.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
  background.depth_write = false;
  TYNDALL_ASSIGN(background_, gpu::create_graphics_pipeline(device, background));
  TYNDALL_ASSIGN(copy_baseline_, gpu::create_compute_pipeline(device, shaders::copy_baseline_comp));
  TYNDALL_ASSIGN(background_constants_,
                 gpu::UploadRing::create(device, "background_constants", sizeof(BackgroundConstants)));
  if (desc_.timings) {
    TYNDALL_ASSIGN(timer_, gpu::Timer::create(device, effect_desc.frames_in_flight, kMaxTimedPasses));
  }
  TYNDALL_ASSIGN(model_, make_model(scene_));
  return make_tables_ready();
}

void Scene::begin_pass(VkCommandBuffer cmd, const char* name) {
  if (desc_.timings) timer_.begin(cmd, name);
}

void Scene::end_pass(VkCommandBuffer cmd) {
  if (desc_.timings) timer_.end(cmd);
}

Result<void> Scene::render(double seconds, bool copy_baseline, std::optional<double> step_s) {
  const post::Exposure::Start start = tonemap_->exposure().start();
  const std::optional<double> last_seconds = last_seconds_;
  Result<void> drawn = within_memory("drawing the scene", [&] { return draw_frame(seconds, copy_baseline, step_s); });
  if (!drawn) {
    static_cast<void>(wait_for_frames());  // the next frame writes what the previous one and parts of this one read
    tonemap_->exposure().put_back(start);
    last_seconds_ = last_seconds;
  }
  return drawn;
}

Result<void> Scene::draw_frame(double seconds, bool copy_baseline, std::optional<double> step_s) {
  TYNDALL_TRY(replace_lost_effect());
  // There is no previous exposure if time has not advanced or the last picture was not measured.
  step_s_ = step_s.value_or(last_seconds_ ? seconds - *last_seconds_ : 0.0);
  if (!last_seconds_ || step_s_ <= 0.0) tonemap_->exposure().reset_history();
  last_seconds_ = seconds;
  if (!is_auto_exposed(scene_.tonemap) && !desc_.histogram) last_seconds_.reset();
  radiance_sum_ = {};
  display_sum_ = {};
  const std::uint32_t samples = scene_.camera.samples;
  for (std::uint32_t i = 0; i < samples; ++i) {
    // Centred offsets of up to half a pixel; a single picture is not shifted.
    const glm::dvec2 offset =
        samples > 1 ? glm::dvec2(halton(i + 1, 2) - 0.5, halton(i + 1, 3) - 0.5) : glm::dvec2(0.0);
    const glm::dvec2 jitter = 2.0 * offset / glm::dvec2(desc_.extent.width, desc_.extent.height);
    TYNDALL_TRY(render_sample(seconds, jitter, i == 0, copy_baseline));
    if (samples == 1) break;
    TYNDALL_TRY(accumulate(output_, radiance_sum_));
    TYNDALL_TRY(accumulate(display_, display_sum_));
  }
  // The measurement waits for the frame, so it is made later if the frame is not waited for.
  illuminance_stale_ = desc_.illuminance;
  illuminance_.reset();
  return waits() ? finish() : Result<void>();
}

// Adds an image to a sum on the host.
Result<void> Scene::accumulate(const gpu::Image& image, image::Image& sum) {
  TYNDALL_ASSIGN(image::Image sample, read_back(image));
  if (sum.rgb.empty()) {
    sum = std::move(sample);
  } else {
    for (std::size_t i = 0; i < sum.rgb.size(); ++i) sum.rgb[i] += sample.rgb[i];
  }
  return {};
}

Result<image::Image> Scene::average(const gpu::Image& image, const image::Image& sum) {
  if (scene_.camera.samples == 1) return read_back(image);
  image::Image out = sum;
  for (float& value : out.rgb) value /= static_cast<float>(scene_.camera.samples);
  return out;
}

Result<void> Scene::place_lights(double seconds) {
  TYNDALL_ASSIGN(const SunParams sun, placed_sun(scene_.sun, place()));
  to_sun_ = animated_direction_to_sun(sun, seconds);
  TYNDALL_ASSIGN(moon_, placed_moon(scene_.moon, scene_.sun, place()));
  key_light_ = {to_sun_, scene_.sun.irradiance, scene_.sun.angular_radius_deg};
  const double lowest = std::sin(scene_.moon.light_below_deg * std::numbers::pi / 180.0);
  if (!scene_.moon.light || to_sun_.y >= lowest || moon_.elevation_deg <= 0.0F) return {};
  SunParams moon;
  moon.elevation_deg = moon_.elevation_deg;
  moon.azimuth_deg = moon_.azimuth_deg;
  const glm::dvec3 to_moon = direction_to_sun(moon);
  const auto ratio = static_cast<float>(moon_irradiance_ratio(moon_, glm::dot(to_sun_, to_moon)));
  const Vec3& e = scene_.sun.irradiance;
  key_light_ = {to_moon, {e.x * ratio, e.y * ratio, e.z * ratio}, moon_.angular_radius_deg};
  return {};
}

Result<void> Scene::render_sample(double seconds, const glm::dvec2& jitter, bool first, bool copy_baseline) {
  TYNDALL_TRY(finish(slot()));
  const double radius = params_.planet.radius_m;
  const double aspect = static_cast<double>(desc_.extent.width) / desc_.extent.height;
  view_ = view_from_params(scene_.camera, aspect, radius);
  view_.jitter = jitter;
  TYNDALL_TRY(place_lights(seconds));

  const bool bare = bare_ground();
  const double ground_m = bare ? 0.0 : terrain_->height_at(up_of(view_.position, radius));
  const double altitude = altitude_of(view_.position, radius);
  // Meshes do not stop the camera, which may be inside them. On the bare ground only the near plane limits the height.
  const double min_m = bare ? kNearPlane_m : kMinHeight_m;
  if (altitude < ground_m + min_m) {
    view_.position = at_altitude(view_.position, ground_m + min_m, radius);
    if (!lifted_) {
      notes_.push_back("the camera was inside the ground and has been raised to " +
                       std::to_string(static_cast<int>(std::lround(ground_m + min_m))) + " m");
    }
    lifted_ = true;
  }
  add_notes(notes_, limits_of_view(view_, std::max(altitude - ground_m, min_m), radius));
  frame_ = local_frame(view_.position, radius);
  if (!bare) {
    TYNDALL_TRY(terrain_->set_coarseness(
        std::max(desc_.terrain_coarseness, coarseness_for_picture(desc_.extent.height, view_.tan_half_height))));
    TYNDALL_TRY(terrain_->update(view_, frame_));
  }
  // All surfaces are farther away than half the height above the ground, except for walls beside the camera.
  const double above = std::max(altitude - ground_m, min_m);
  const Ground ground = meshes_ != nullptr ? meshes_->ground(terrain_->ground(), view_.position) : terrain_->ground();
  const double nearest = std::min(20.0, 0.02 * static_cast<double>(scene_.shadows.distance_m));
  cascades_ = fit_cascades(view_, key_light_.direction, scene_.shadows, ground, std::max(0.5 * above, nearest));
  light_.direction_to_sun = key_light_.direction;
  const Vec3& sunlight = key_light_.irradiance;
  const float scale = params_.scattering.scale;
  light_.sun_irradiance = {sunlight.x * scale, sunlight.y * scale, sunlight.z * scale};
  light_.atmosphere_height_m = params_.atmosphere.height_m;
  light_.tables = tables_ready_ ? effect_->light_tables() : LightTables{};
  light_.shadow_maps = shadow_maps_.view.get();
  light_.shadow_sampler = shadow_compare_.get();
  light_.shadow_colors = shadow_colors_.view.get();
  light_.has_glass = meshes_ != nullptr && meshes_->has_glass();
  light_.linear = linear_.get();
  if (!bare) {
    TYNDALL_TRY(
        terrain_->prepare(view_, desc_.extent.height, scene_.shadows, cascades_, light_, scene_.terrain.shading));
  }
  if (meshes_ != nullptr) {
    meshes_->prepare(view_, frame_, scene_.shadows, cascades_, light_, scene_.meshes.sky_light);
  }
  if (model_ != nullptr) TYNDALL_TRY(model_->prepare({view_, frame_, light_, params_, scene_, desc_.extent}));

  TYNDALL_TRY(run_passes(first, copy_baseline));
  InFlight& frame = in_flight_.at(slot());
  frame.frame_index = frame_index_;
  frame.taken = false;
  if (waits()) {
    for (InFlight& complete : in_flight_) complete.taken = true;
    take_results(slot());
  }
  ++frame_index_;
  return {};
}

// Copies the scene's colour to the output. Used with a SkyModel, which has already drawn the atmosphere.
Result<void> Scene::copy_color(VkCommandBuffer cmd) {
  begin_pass(cmd, "copy");
  TYNDALL_TRY(copy_to(cmd, output_));
  end_pass(cmd);
  return {};
}

Result<void> Scene::tonemap(VkCommandBuffer cmd, bool first) {
  gpu::compute_barrier(host_->device(), cmd);
  const post::TonemapSettings settings = tonemap_settings(params_, scene_);
  if (first && (settings.auto_exposure || desc_.histogram)) {
    begin_pass(cmd, "exposure");
    TYNDALL_TRY(tonemap_->exposure().measure(cmd, output_.view.get(), desc_.extent, settings, step_s_, slot()));
    end_pass(cmd);
  }
  begin_pass(cmd, "tonemap");
  TYNDALL_TRY(tonemap_->record(cmd, output_.view.get(), display_.view.get(), desc_.extent, settings, slot()));
  end_pass(cmd);
  return {};
}

Result<void> Scene::run_copy_baseline(VkCommandBuffer cmd) {
  gpu::compute_barrier(host_->device(), cmd);
  begin_pass(cmd, "floor");
  TYNDALL_TRY(copy_to(cmd, display_));
  end_pass(cmd);
  return {};
}

// Records the copy baseline, which copies the scene's colour to an image.
Result<void> Scene::copy_to(VkCommandBuffer cmd, const gpu::Image& to) {
  const gpu::Device& device = host_->device();
  const gpu::NamedResource resources[] = {
      gpu::named_image("scene_color", color_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, nearest_.get()),
      gpu::named_image("scene_depth", depth_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, nearest_.get()),
      gpu::named_image("output_color", to.view.get()),
  };
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, copy_baseline_, resources));
  gpu::dispatch(device, cmd, copy_baseline_, desc_.extent.width, desc_.extent.height);
  return {};
}

Result<image::Image> Scene::read_back(const gpu::Image& image) {
  TYNDALL_ASSIGN(const std::vector<std::byte> bytes,
                 gpu::download(*host_, image, VK_IMAGE_LAYOUT_GENERAL, 0, 4 * sizeof(float)));
  image::Image out(desc_.extent.width, desc_.extent.height);
  const std::size_t pixels = out.rgb.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) std::memcpy(&out.rgb[3 * i], bytes.data() + i * 16, 12);
  return out;
}

Result<image::Image> Scene::radiance() {
  return within_memory("reading the radiance", [&] { return average(output_, radiance_sum_); });
}

Result<image::Image> Scene::display() {
  return within_memory("reading the picture", [&] { return average(display_, display_sum_); });
}

Scene::Exposure Scene::exposure() const {
  const post::TonemapSettings settings = tonemap_settings(params_, scene_);
  Exposure out = {illuminance_, settings.exposure, {}, measurement_};
  if (settings.auto_exposure) out.scale = out.measurement.exposure;
  const double white = white_luminance(params_, scene_);
  if (out.scale > 0.0F && white > 0.0) {
    out.ev100 = ev100_of_exposure(static_cast<double>(out.scale), static_cast<double>(settings.middle_gray), white);
  }
  return out;
}

Counters Scene::counters() const { return counters_; }

Scene::Memory Scene::memory() const {
  const MemoryUsage effect = effect_->memory();
  const std::span<const ResourceMemory> rows = effect_->resources();
  return {effect.persistent, effect.transient, effect.host, std::vector<ResourceMemory>(rows.begin(), rows.end()),
          color_.bytes + depth_.bytes + output_.bytes + display_.bytes + shadow_maps_.bytes + shadow_colors_.bytes +
              terrain_->bytes() + (meshes_ != nullptr ? meshes_->bytes() : 0) +
              (model_ != nullptr ? model_->bytes() : 0) + tonemap_->exposure().bytes()};
}

}  // namespace tyndall::scene
