// soak [--frames N] [--seed S] [--from M] [--device NAME] [--validation on|off]
// Drives the library with random parameters, limits, inputs and recordings, on small pictures, with the validation
// layer and its synchronisation checks. Fails when the layer says anything, when a pixel is negative, not finite or
// brighter than a bound that no scattering exceeds, when a refusal is not one line, when a refused call changes the
// effect, or, with --validation off, when memory grows. The same seed does the same.
// --from M repeats a finding quickly: it draws only the frames from M on, with complete tables in the first of them.
// --validation off measures memory alone: the layer holds more with every effect.
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "effect/wavelengths.hpp"
#include "gpu/try.hpp"
#include "random_inputs.hpp"

namespace tyndall {
namespace {

[[noreturn]] void find(const std::string& what) { throw std::runtime_error(what); }

// Returns by how much a channel of a grey background may grow behind a medium. With four wavelengths, it grows when a
// wavelength is attenuated that has a negative weight in it, because Rec. 709 has no saturated colours. This is the
// case if a medium attenuates little else, or by the rounding of transmittances in the froxel volume.
double greatest_gain(const Params& params, int channel) {
  if (params.scattering.color == ColorMode::rgb) return 1.0;
  const shared::vec4 rows[] = {shared::kColorRed, shared::kColorGreen, shared::kColorBlue};
  double gain = 1.0;
  for (int i = 0; i < 4; ++i) {
    const float spectrum = (&shared::kLiftRed.x)[i] + (&shared::kLiftGreen.x)[i] + (&shared::kLiftBlue.x)[i];
    gain += std::max(0.0, -static_cast<double>((&rows[channel].x)[i] * spectrum));
  }
  return gain;
}

// Returns the greatest radiance that a channel of a frame may have. Single scattering along a ray is at most the
// irradiance times the greatest value of the phase function, and further orders and the ground add at most what a
// diffuse reflector of albedo 1 under the whole sunlight and sky sends back. Both are rounded up generously: this finds
// light that explodes.
double brightest(const Params& params, const TestFrame& frame, int channel) {
  const double g = std::abs(static_cast<double>(params.atmosphere.mie_g));
  const double forward = (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(1.0 - g, 3.0));
  const double sun = static_cast<double>(frame.irradiance.x) * static_cast<double>(params.scattering.scale);
  return greatest_gain(params, channel) * static_cast<double>(frame.background.x) + 4.0 * sun * (1.0 + 1.5 * forward);
}

void require_one_line(const Error& error) {
  if (error.message.empty()) find("an error without a message");
  for (const char c : error.message) {
    if (static_cast<unsigned char>(c) < 0x20) find("an error of several lines: " + error.message);
  }
}

// Lists the parameters that differ from the defaults.
std::string described(const Params& params) {
  static const Params defaults;
  std::string out;
  for (const ParamInfo& row : param_table()) {
    const std::size_t words = row.type == ParamType::vec3 ? 3 : row.type == ParamType::uvec4 ? 4 : 1;
    const char* const at = reinterpret_cast<const char*>(&params) + row.offset;
    if (std::memcmp(at, reinterpret_cast<const char*>(&defaults) + row.offset, 4 * words) == 0) continue;
    out.append(" ").append(row.group).append(".").append(row.name).append("=");
    for (std::size_t i = 0; i < words; ++i) {
      float real = 0.0F;
      std::uint32_t whole = 0;
      std::memcpy(&real, at + 4 * i, 4);
      std::memcpy(&whole, at + 4 * i, 4);
      const bool is_real = row.type == ParamType::float32 || row.type == ParamType::vec3;
      out += (i > 0 ? "," : "") + (is_real ? std::to_string(real) : std::to_string(whole));
    }
  }
  return out;
}

std::string described(const TestFrame& frame) {
  const TestView& view = frame.view;
  const auto vector = [](const glm::dvec3& v) {
    return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
  };
  std::string out = " " + std::to_string(frame.extent.width) + "x" + std::to_string(frame.extent.height) + " at " +
                    vector(view.position) + " towards " + vector(view.forward) + ", tangent " +
                    std::to_string(view.tan_half_width) + ", sun " + vector(frame.to_sun) + " " +
                    std::to_string(frame.irradiance.x) + ", background " + std::to_string(frame.background.x) +
                    ", distances " + std::to_string(frame.distance_m(0, 1)) + " " +
                    std::to_string(frame.distance_m(0, 2));
  for (const Cascade& cascade : frame.cascades) out += ", cascade to " + std::to_string(cascade.far_m);
  return out;
}

// Returns the resident memory, without what malloc holds for later.
std::size_t resident_bytes() {
  ::malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// Returns the median of a quarter (0 to 3) of some numbers.
std::size_t median_of_quarter(const std::vector<std::size_t>& all, std::size_t quarter) {
  std::vector<std::size_t> some(all.begin() + static_cast<std::ptrdiff_t>(all.size() * quarter / 4),
                                all.begin() + static_cast<std::ptrdiff_t>(all.size() * (quarter + 1) / 4));
  std::sort(some.begin(), some.end());
  return some[some.size() / 2];
}

struct Counts {
  std::uint64_t drawn = 0, refused = 0, parameters = 0, limits = 0, effects = 0, builds = 0;
};

class Soak {
 public:
  Soak(gpu::Host& host, const DeviceInfo& info, std::uint64_t seed) : host_(host), info_(info), random_(seed) {}

  // Without `draws`, only changes the parameters and the limits, as before a frame that is drawn.
  void frame(bool draws) {
    const bool first = draws && !draws_;
    draws_ = draws;
    if (!effect_ || random_.one_in(200)) make();
    if (random_.one_in(2)) set_params();
    if (random_.one_in(20)) set_limits();
    if (first) build(UINT32_MAX);
    if (random_.one_in(16)) build(random_.one_in(2) ? UINT32_MAX : 1 + random_.below(20));
    draw();
    if (random_.one_in(10)) refuse();
  }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  // Returns the resident memory before the creation of each effect [MiB], when there is none.
  [[nodiscard]] const std::vector<std::size_t>& memory() const { return memory_; }

 private:
  void make() {
    effect_.reset();
    settle();
    memory_.push_back(resident_bytes() >> 20U);
    EffectDesc desc;
    desc.max_extent = kLargest;
    desc.output_format = random_.one_in(2) ? OutputFormat::rgba16f : OutputFormat::rgba32f;
    desc.max_shadow_resolution = kLargestShadows;
    desc.frames_in_flight = 1 + random_.below(3);
    desc.counters = random_.one_in(2);
    desc.timings = random_.one_in(2);
    desc.table_pipelines_later = random_.one_in(2);
    Params params;
    params.tables.orders = 2;
    shorten(params);
    Result<Effect> made = Effect::create(info_, desc, params);
    if (!made.ok()) find("Effect::create: " + made.error().message);
    effect_.emplace(std::move(made).value());
    ++counts_.effects;
    if (random_.one_in(2)) build(UINT32_MAX);  // frames before the first build read black tables
  }

  // Waits until the driver has freed what is destroyed. Mesa's CPU driver frees pipelines at the end of the next
  // submission, after its fence: the second submission waits for that of the first.
  void settle() {
    for (int i = 0; i < 2; ++i) {
      const Result<void> done = host_.run([](VkCommandBuffer) -> Result<void> { return {}; });
      if (!done.ok()) find("an empty command buffer: " + done.error().message);
    }
  }

  void set_params() {
    const Params before = effect_->params();
    const Params params = changed(before, random_);
    const bool allowed = check_params(params).ok();
    const Result<void> set = effect_->set_params(params);
    if (set.ok() != allowed) find("check_params and set_params disagree: " + (set.ok() ? "" : set.error().message));
    if (!set.ok()) {
      require_one_line(set.error());
      if (affected(effect_->params(), before) != 0) find("a refused set_params has changed the parameters");
      ++counts_.refused;
    }
    ++counts_.parameters;
  }

  void set_limits() {
    const VkExtent2D extent = {1 + random_.below(kLargest.width), 1 + random_.below(kLargest.height)};
    const Result<void> set =
        effect_->set_limits(extent, 1 + random_.below(kMaxCascades), 1 + random_.below(kLargestShadows));
    if (!set.ok()) find("set_limits: " + set.error().message);
    ++counts_.limits;
  }

  // Records some or all slices of tables that are not up to date.
  void build(std::uint32_t budget) {
    if (!draws_) return;
    const Result<void> done = host_.run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> recorded = effect_->record_precompute(cmd, budget);
      if (!recorded.ok()) return recorded.error();
      return {};
    });
    if (!done.ok()) find("record_precompute: " + done.error().message);
    ++counts_.builds;
  }

  void draw() {
    const TestFrame shape = random_frame(effect_->params(), effect_->desc().max_extent, random_);
    if (!draws_) return;
    const OutputFormat format = effect_->desc().output_format;
    Result<FrameImages> images = FrameImages::create(host_, shape, format);
    if (!images.ok()) find("images: " + images.error().message);
    const Result<void> recorded = host_.run([&](VkCommandBuffer cmd) {
      FrameInputs inputs = images.value().inputs(shape);
      inputs.frame_index = ++index_;
      return effect_->record(cmd, inputs);
    });
    if (!recorded.ok()) {
      // A random camera may be impossible, for example below the lowest ground that the parameters allow.
      require_one_line(recorded.error());
      ++counts_.refused;
      return;
    }
    const Result<std::vector<glm::dvec3>> picture = images.value().output(host_);
    if (!picture.ok()) find("output: " + picture.error().message);
    double bounds[3] = {};
    for (int c = 0; c < 3; ++c) {
      double& bound = bounds[c];
      bound = brightest(effect_->params(), shape, c);
      // Until tables for changed parameters are complete, pictures combine the coefficients with the previous tables,
      // and may be too bright (docs/integration.md).
      if (affected(effect_->params(), table_params(*effect_)) != 0) bound = std::numeric_limits<double>::max();
      // Half precision rounds up by at most one part in 2048, or by half of its smallest number.
      if (format == OutputFormat::rgba16f) bound = bound * 1.0005 + 0x1p-25;
    }
    for (const glm::dvec3& pixel : picture.value()) {
      for (int c = 0; c < 3; ++c) {
        if (std::isfinite(pixel[c]) && pixel[c] >= 0.0 && pixel[c] <= bounds[c]) continue;
        find("a pixel is " + std::to_string(pixel[c]) + "; expected 0 to " + std::to_string(bounds[c]) + ";" +
             described(effect_->params()) + ";" + described(shape));
      }
    }
    ++counts_.drawn;
  }

  // Records a frame that must be refused, and checks that nothing was recorded.
  void refuse() {
    TestFrame shape = random_frame(effect_->params(), effect_->desc().max_extent, random_);
    const std::uint32_t kind = random_.below(8);
    const std::uint32_t entry = kind == 2 ? random_.below(15) : 0;
    if (!draws_) return;
    Result<FrameImages> images = FrameImages::create(host_, shape, effect_->desc().output_format);
    if (!images.ok()) find("images: " + images.error().message);
    FrameInputs inputs = images.value().inputs(shape);
    const float nan = std::nanf("");
    switch (kind) {
      case 0: inputs.extent.width = effect_->desc().max_extent.width + 1; break;
      case 1: inputs.extent = {0, 1}; break;
      case 2: inputs.camera.world_from_view.m[entry] = nan; break;
      case 3: inputs.camera.clip_from_view.m[0] = nan; break;
      case 4: inputs.sun.direction_to_sun = {0.0F, 0.0F, 0.0F}; break;
      case 5: inputs.sun.irradiance = Vec3(-1.0F); break;
      case 6: inputs.color.view = VK_NULL_HANDLE; break;
      default: inputs.output.offset = {-1, 0}; break;
    }
    Result<void> recorded;
    const Result<void> ran = host_.run([&](VkCommandBuffer cmd) -> Result<void> {
      recorded = effect_->record(cmd, inputs);
      return {};
    });
    if (!ran.ok()) find("run: " + ran.error().message);
    if (recorded.ok()) find("an impossible frame was recorded");
    require_one_line(recorded.error());
    ++counts_.refused;
  }

  gpu::Host& host_;
  DeviceInfo info_;
  Random random_;
  std::optional<Effect> effect_;
  bool draws_ = true;
  std::uint64_t index_ = 0;
  Counts counts_;
  std::vector<std::size_t> memory_;
};

struct Options {
  std::uint64_t frames = 100, seed = 1, from = 0;
  std::string device;
  bool validation = true;
};

int run(const Options& options) {
  std::vector<std::string> messages;  // outlives the host
  std::vector<std::size_t> memory;    // Soak::memory()
  Counts counts;
  {
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, options.validation, &messages});
    if (!host.ok()) find("device: " + host.error().message);
    const gpu::Device& device = host.value()->device();
    Soak soak(*host.value(),
              {device.instance, device.physical_device, device.device, host.value()->get_instance_proc_addr()},
              options.seed);
    for (std::uint64_t i = 0; i < options.frames; ++i) {
      try {
        soak.frame(i >= options.from);
        if (!messages.empty()) find(messages.front());
      } catch (const std::runtime_error& finding) {
        std::fprintf(stderr, "soak: frame %llu of seed %llu: %s\n", static_cast<unsigned long long>(i),
                     static_cast<unsigned long long>(options.seed), finding.what());
        return 1;
      }
      if ((i + 1) % 1000 == 0) std::fprintf(stderr, "soak: %llu frames\n", static_cast<unsigned long long>(i) + 1);
    }
    counts = soak.counts();
    memory = soak.memory();
  }
  if (!messages.empty()) find("at the end: " + messages.front());
  std::printf(
      "%llu frames drawn, %llu calls refused, %llu changes of parameters, %llu of limits, %llu effects, %llu builds\n",
      static_cast<unsigned long long>(counts.drawn), static_cast<unsigned long long>(counts.refused),
      static_cast<unsigned long long>(counts.parameters), static_cast<unsigned long long>(counts.limits),
      static_cast<unsigned long long>(counts.effects), static_cast<unsigned long long>(counts.builds));
  std::printf("resident memory without an effect [MiB]:");
  for (const std::size_t mib : memory) std::printf(" %zu", mib);
  std::printf("\nresident memory without a device [MiB]: %zu\n", resident_bytes() >> 20U);
  // Without the layer, memory without an effect is that of the device. Compares the second and the last quarter of a
  // long run by their medians.
  constexpr std::size_t kLongRun = 20, kGrowth_mib = 8;
  if (options.validation || memory.size() < kLongRun) return 0;
  const std::size_t before = median_of_quarter(memory, 1), after = median_of_quarter(memory, 3);
  if (after > before + kGrowth_mib) {
    std::fprintf(stderr, "soak: memory grows from %zu to %zu MiB\n", before, after);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace tyndall

int main(int count, char** arguments) {
  tyndall::Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = arguments[i];
    if (name == "--frames") options.frames = std::strtoull(arguments[i + 1], nullptr, 10);
    if (name == "--seed") options.seed = std::strtoull(arguments[i + 1], nullptr, 10);
    if (name == "--from") options.from = std::strtoull(arguments[i + 1], nullptr, 10);
    if (name == "--validation") options.validation = std::strcmp(arguments[i + 1], "off") != 0;
    if (name == "--device") options.device = arguments[i + 1];
  }
  try {
    return tyndall::run(options);
  } catch (const std::exception& thrown) {
    std::fprintf(stderr, "soak: %s\n", thrown.what());
    return 1;
  }
}
