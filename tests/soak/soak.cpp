// soak [--frames N] [--seed S] [--device NAME]
// Drives the library with random parameters, limits, inputs and recordings, on small pictures, with the validation
// layer and its synchronisation checks. Fails when the layer says anything, when a pixel is negative, not finite or
// brighter than a bound that no scattering exceeds, when a refusal is not one line, when a refused call changes the
// effect, or when memory grows. The same seed does the same.
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "../gpu/effect_frame.hpp"
#include "effect/wavelengths.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr VkExtent2D kLargest = {48, 32};
constexpr std::uint32_t kLargestShadows = 64;

[[noreturn]] void find(const std::string& what) { throw std::runtime_error(what); }

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1.0p-53);
  }
  // Returns an end of the range, a number inside of it, or one of any magnitude.
  double number(double low, double high, double usual) {
    switch (below(6)) {
      case 0: return low;
      case 1: return high;
      case 2: return uniform(low, high);
      case 3:
        return low > 0.0 ? low * std::pow(high / low, uniform(0.0, 1.0)) : high * std::pow(10.0, uniform(-9.0, 0.0));
      default: return usual;
    }
  }

 private:
  std::mt19937_64 engine_;
};

std::uint32_t choices_of(const ParamInfo& row) {
  return 1 + static_cast<std::uint32_t>(std::count(row.choices.begin(), row.choices.end(), '|'));
}

// Changes one parameter, within the range of its row.
void change(Params& params, const ParamInfo& row, Random& random) {
  static const Params defaults;
  char* const at = reinterpret_cast<char*>(&params) + row.offset;
  const char* const usual = reinterpret_cast<const char*>(&defaults) + row.offset;
  const std::size_t floats = row.type == ParamType::vec3 ? 3 : row.type == ParamType::float32 ? 1 : 0;
  for (std::size_t i = 0; i < floats; ++i) {
    float value = 0.0F;
    std::memcpy(&value, usual + 4 * i, sizeof value);
    value = std::clamp(static_cast<float>(random.number(row.min, row.max, static_cast<double>(value))),
                       static_cast<float>(row.min), static_cast<float>(row.max));
    std::memcpy(at + 4 * i, &value, sizeof value);
  }
  if (floats > 0) return;
  if (row.type == ParamType::uvec4) {
    // tables.size, small: larger tables take long and do nothing else.
    const std::array<std::uint32_t, 4> size = {2 + random.below(5), 4 + 2 * random.below(7), 2 + random.below(9),
                                               2 + random.below(5)};
    std::memcpy(at, size.data(), sizeof size);
    return;
  }
  std::uint32_t value = 0;
  std::memcpy(&value, usual, sizeof value);
  if (row.type == ParamType::flag) value = random.below(2);
  if (row.type == ParamType::enumeration) value = random.below(choices_of(row));
  if (row.type == ParamType::uint32)
    value = static_cast<std::uint32_t>(random.number(row.min, row.max, static_cast<double>(value)));
  std::memcpy(at, &value, sizeof value);
}

// Limits what only takes time: large tables and volumes, samples, steps and orders.
void shorten(Params& params) {
  if (params.tables.size == Params().tables.size) params.tables.size = {4, 8, 8, 4};
  params.epipolar.slices = std::min(params.epipolar.slices, 64U);
  params.epipolar.samples = std::min(params.epipolar.samples, 64U);
  params.froxels.columns = std::min(params.froxels.columns, 16U);
  params.froxels.rows = std::min(params.froxels.rows, 16U);
  params.froxels.slices = std::min(params.froxels.slices, 16U);
  params.scattering.integration_steps = std::min(params.scattering.integration_steps, 64U);
  params.tables.orders = std::min(params.tables.orders, 3U);
}

// Returns whether a change of this row compiles pipelines, which takes most of the time on a CPU device.
bool is_slow(const ParamInfo& row) { return row.affects == Affects::Pipeline || row.affects == Affects::Everything; }

Params changed(const Params& from, Random& random) {
  Params params = from;
  const std::span<const ParamInfo> rows = param_table();
  for (std::uint32_t count = 1 + random.below(4); count > 0; --count) {
    const ParamInfo& row = rows[random.below(static_cast<std::uint32_t>(rows.size()))];
    if (!is_slow(row) || random.one_in(3)) change(params, row, random);
  }
  if (random.one_in(10)) params = Params();
  shorten(params);
  return params;
}

TestFrame random_frame(const Params& params, VkExtent2D limit, Random& random) {
  TestFrame frame;
  frame.extent = {1 + random.below(limit.width), 1 + random.below(limit.height)};
  frame.shadow_resolution = 1 + random.below(kLargestShadows);
  const double top = static_cast<double>(params.atmosphere.height_m);
  const double deepest = std::max(-11000.0, -0.25 * static_cast<double>(params.planet.radius_m));
  const std::array<double, 9> altitudes = {0.0,        0.5,        1000.0, random.uniform(0.0, top),    top,
                                           1.01 * top, 10.0 * top, -0.5,   random.uniform(deepest, 0.0)};
  frame.view = TestView::at(altitudes[random.below(9)], random.uniform(-4.0, 4.0), random.uniform(-1.5707, 1.5707),
                            std::pow(10.0, random.uniform(-2.0, 0.7)));
  const double elevation = random.uniform(-1.5707, 1.5707);
  const double azimuth = random.uniform(-3.2, 3.2);
  frame.to_sun = {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                  -std::cos(elevation) * std::cos(azimuth)};
  frame.irradiance = Vec3(static_cast<float>(random.number(0.0, 1e5, 10.0)));
  frame.background = Vec3(static_cast<float>(random.number(0.0, 1e4, 0.0)));
  const std::array<double, 2> distances = {random.number(0.0, 1e7, 3000.0), random.number(0.0, 1e5, 20.0)};
  const std::uint32_t stripe = 1 + random.below(8);
  frame.distance_m = [=](std::uint32_t x, std::uint32_t y) {
    return (x + y) % stripe == 0 ? 0.0 : distances[x / stripe % 2];
  };
  const std::uint32_t count = random.below(5);
  double near_m = 0.0;
  for (std::uint32_t c = 0; c < count; ++c) {
    const double far_m = near_m + random.number(1.0, 1e6, 5000.0);
    frame.cascades.push_back(
        sun_cascade(frame.to_sun, frame.view.position, random.number(1.0, 1e6, 20000.0), near_m, far_m));
    near_m = far_m;
  }
  frame.first_marched = count > 0 ? random.below(count) : 0;
  const double waves = random.uniform(0.0, 20.0);
  frame.shadow_depth = [=](std::uint32_t c, double u, double v) {
    return static_cast<float>(0.5 + 0.5 * std::sin(waves * (u + 0.3 * v + c)));
  };
  return frame;
}

// Returns by how much a grey background may become brighter behind a medium. With four wavelengths, a channel of its
// colour grows when a wavelength is attenuated that has a negative weight in it: Rec. 709 has no saturated colours. An
// atmosphere attenuates the other wavelengths more, but the froxel volume rounds each transmittance to half precision.
double greatest_gain(const Params& params) {
  if (params.scattering.color == ColorMode::rgb) return 1.0;
  double out = 1.0;
  for (const shared::vec4& row : {shared::kColorRed, shared::kColorGreen, shared::kColorBlue}) {
    double gain = 1.0;
    for (int i = 0; i < 4; ++i) {
      const float spectrum = (&shared::kLiftRed.x)[i] + (&shared::kLiftGreen.x)[i] + (&shared::kLiftBlue.x)[i];
      gain += std::max(0.0, -static_cast<double>((&row.x)[i] * spectrum));
    }
    out = std::max(out, gain);
  }
  return out;
}

// Returns the greatest radiance that a frame may have. Single scattering along a ray is at most the irradiance times
// the greatest value of the phase function, and further orders and the ground add at most what a diffuse reflector of
// albedo 1 under the whole sunlight and sky sends back. Both are rounded up generously: this finds light that explodes.
double brightest(const Params& params, const TestFrame& frame) {
  const double g = std::abs(static_cast<double>(params.atmosphere.mie_g));
  const double forward = (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(1.0 - g, 3.0));
  const double sun = static_cast<double>(frame.irradiance.x) * static_cast<double>(params.scattering.scale);
  return greatest_gain(params) * static_cast<double>(frame.background.x) + 4.0 * sun * (1.0 + 1.5 * forward);
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

  void frame() {
    if (!effect_ || random_.one_in(200)) make();
    if (random_.one_in(2)) set_params();
    if (random_.one_in(20)) set_limits();
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
    // Mesa's CPU driver frees pipelines when it executes a command buffer after their destruction.
    const Result<void> emptied = host_.run([](VkCommandBuffer) -> Result<void> { return {}; });
    if (!emptied.ok()) find("an empty command buffer: " + emptied.error().message);
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
    double bound = brightest(effect_->params(), shape);
    // Until tables for changed parameters are complete, pictures combine the coefficients with the previous tables, and
    // may be too bright (docs/integration.md).
    if (affected(effect_->params(), table_params(*effect_)) != 0) bound = std::numeric_limits<double>::max();
    // Half precision rounds up by at most one part in 2048, or by half of its smallest number.
    if (format == OutputFormat::rgba16f) bound = bound * 1.0005 + 0x1p-25;
    for (const glm::dvec3& pixel : picture.value()) {
      for (int c = 0; c < 3; ++c) {
        if (std::isfinite(pixel[c]) && pixel[c] >= 0.0 && pixel[c] <= bound) continue;
        find("a pixel is " + std::to_string(pixel[c]) + "; expected 0 to " + std::to_string(bound) + ";" +
             described(effect_->params()) + ";" + described(shape));
      }
    }
    ++counts_.drawn;
  }

  // Records a frame that must be refused, and checks that nothing was recorded.
  void refuse() {
    TestFrame shape = random_frame(effect_->params(), effect_->desc().max_extent, random_);
    Result<FrameImages> images = FrameImages::create(host_, shape, effect_->desc().output_format);
    if (!images.ok()) find("images: " + images.error().message);
    FrameInputs inputs = images.value().inputs(shape);
    const float nan = std::nanf("");
    switch (random_.below(8)) {
      case 0: inputs.extent.width = effect_->desc().max_extent.width + 1; break;
      case 1: inputs.extent = {0, 1}; break;
      case 2: inputs.camera.world_from_view.m[random_.below(15)] = nan; break;
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
  std::uint64_t index_ = 0;
  Counts counts_;
  std::vector<std::size_t> memory_;
};

struct Options {
  std::uint64_t frames = 100, seed = 1;
  std::string device;
};

int run(const Options& options) {
  std::vector<std::string> messages;  // outlives the host
  std::vector<std::size_t> memory;    // Soak::memory()
  Counts counts;
  {
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, true, &messages});
    if (!host.ok()) find("device: " + host.error().message);
    const gpu::Device& device = host.value()->device();
    Soak soak(*host.value(),
              {device.instance, device.physical_device, device.device, host.value()->get_instance_proc_addr()},
              options.seed);
    for (std::uint64_t i = 0; i < options.frames; ++i) {
      try {
        soak.frame();
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
  // Without an effect, memory is that of the device and of the validation layer, which holds objects of earlier effects
  // until their command buffers are recorded again. Compares the second and the last quarter of a long run by their
  // medians.
  constexpr std::size_t kLongRun = 20;
  if (memory.size() < kLongRun) return 0;
  const std::size_t before = median_of_quarter(memory, 1), after = median_of_quarter(memory, 3);
  if (after > before + before / 5 + 32) {
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
    if (name == "--device") options.device = arguments[i + 1];
  }
  try {
    return tyndall::run(options);
  } catch (const std::exception& thrown) {
    std::fprintf(stderr, "soak: %s\n", thrown.what());
    return 1;
  }
}
