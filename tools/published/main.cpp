// published_tables: builds the scattering tables with the published method and with ours, on the same device, and
// compares cost and accuracy with the same rays and the same path tracer. Prints Markdown
// (docs/generated/published.md). The method is that of Yusov (2013, section 2), written from its description in
// shaders/published. It has no ozone, so ozone is off.
// published_tables [RAYS_PER_GROUP] [PATHS_PER_RAY]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <random>

#include "effect/medium.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/try.hpp"
#include "models/precomputed.hpp"
#include "published_shaders.hpp"
#include "validate/study.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kOrders = 4;
constexpr std::uint32_t kDirections = 128;
constexpr VkExtent3D kTexels = {32, 128, 64 * 16};
constexpr std::uint32_t kSlice = 64;  // texels along the third axis that one submission computes

// Wall-clock time and processor time. On a CPU device, processor time is less sensitive to other load.
struct Time {
  double wall_s = 0.0, processor_s = 0.0;
  Time& operator+=(const Time& t) {
    wall_s += t.wall_s;
    processor_s += t.processor_s;
    return *this;
  }
};
Time now() {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}
Time since(const Time& start) {
  const Time end = now();
  return {end.wall_s - start.wall_s, end.processor_s - start.processor_s};
}

class Published {
 public:
  struct Times {
    Time density, single, scatter, gather;
    [[nodiscard]] Time all() const { return (((Time() += density) += single) += scatter) += gather; }
  };

  explicit Published(gpu::Host& host) : host_(host) {}

  Result<void> build(const shared::Medium& medium) {
    const gpu::Device& device = host_.device();
    TYNDALL_ASSIGN(linear_, gpu::create_sampler(device, {}));
    TYNDALL_TRY(fill(medium_, "medium", &medium, sizeof medium));
    // The published method uses an unseeded generator; any set of directions will do.
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<float> directions;
    for (std::uint32_t i = 0; i < kDirections; ++i) {
      const float z = 2.0F * uniform(random) - 1.0F;
      const float azimuth = 6.2831853F * uniform(random);
      const float spread = std::sqrt(1.0F - z * z);
      directions.insert(directions.end(), {spread * std::cos(azimuth), z, spread * std::sin(azimuth), 0.0F});
    }
    TYNDALL_TRY(fill(directions_, "directions", directions.data(), directions.size() * sizeof(float)));
    TYNDALL_TRY(image(density_, VK_FORMAT_R32G32_SFLOAT, {1024, 1024, 1}));
    TYNDALL_TRY(image(single_, VK_FORMAT_R16G16B16A16_SFLOAT, kTexels));
    TYNDALL_TRY(image(sum_, VK_FORMAT_R16G16B16A16_SFLOAT, kTexels));
    TYNDALL_TRY(image(scattered_, VK_FORMAT_R32G32B32A32_SFLOAT, kTexels));
    TYNDALL_TRY(image(order_, VK_FORMAT_R32G32B32A32_SFLOAT, kTexels));

    TYNDALL_TRY(pass(shaders::published_density_comp, {1024, 1024, 1}, single_, 0, times_.density));
    TYNDALL_TRY(pass(shaders::published_single_comp, kTexels, single_, 0, times_.single));
    for (std::uint32_t n = 2; n <= kOrders; ++n) {
      TYNDALL_TRY(pass(shaders::published_scatter_comp, kTexels, n == 2 ? single_ : order_, 0, times_.scatter));
      TYNDALL_TRY(pass(shaders::published_gather_comp, kTexels, order_, n - 2, times_.gather));
    }
    return {};
  }

  Result<std::vector<validate::Rgb>> answer(const shared::Medium& medium, std::span<const RayQuery> queries) {
    std::vector<shared::ProbeRay> rays;
    for (const RayQuery& q : queries) {
      rays.push_back(models::prepare_probe_ray(medium, models::ray_from_query(q)));
    }
    TYNDALL_TRY(fill(rays_, "rays", rays.data(), rays.size() * sizeof rays[0]));
    TYNDALL_ASSIGN(results_, gpu::create_buffer(host_.device(), "results", rays.size() * sizeof(shared::ProbeResult),
                                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::readback));
    Time unused;
    const VkExtent3D extent = {static_cast<std::uint32_t>(rays.size()), 1, 1};
    TYNDALL_TRY(pass(shaders::published_answer_comp, extent, order_, 0, unused));
    const auto* results = static_cast<const shared::ProbeResult*>(results_.mapped);
    std::vector<validate::Rgb> out;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vec3& radiance = results[i].radiance;
      out.push_back({radiance.x, radiance.y, radiance.z});
    }
    return out;
  }

  [[nodiscard]] const Times& times() const { return times_; }

 private:
  Result<void> fill(gpu::Buffer& buffer, const char* name, const void* data, std::size_t size) {
    TYNDALL_ASSIGN(buffer, gpu::create_buffer(host_.device(), name, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                              gpu::MemoryKind::upload));
    std::memcpy(buffer.mapped, data, size);
    return {};
  }

  Result<void> image(gpu::Image& out, VkFormat format, VkExtent3D extent) {
    TYNDALL_ASSIGN(out, gpu::create_image(host_.device(), {"published", format, extent,
                                                           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}));
    return host_.run([&](VkCommandBuffer cmd) -> Result<void> {
      gpu::transition(host_.device(), cmd, out, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
      return {};
    });
  }

  // Runs one invocation per texel of `extent`, and adds its duration to `time`.
  Result<void> pass(const gpu::Shader& shader, VkExtent3D extent, const gpu::Image& before, std::uint32_t adds,
                    Time& time) {
    const gpu::Device& device = host_.device();
    TYNDALL_ASSIGN(const gpu::Pipeline pipeline, gpu::create_compute_pipeline(device, shader));
    const auto named = [&](const char* name, const gpu::Image& i) {
      return gpu::named_image(name, i.view.get(), VK_IMAGE_LAYOUT_GENERAL, linear_.get());
    };
    const gpu::NamedResource resources[] = {
        gpu::named_buffer("medium_block", medium_.buffer.get()),
        gpu::named_buffer("direction_block", directions_.buffer.get()),
        gpu::named_buffer("ray_block", rays_.buffer.get()),
        gpu::named_buffer("result_block", results_.buffer.get()),
        named("density", density_),
        named("single", single_),
        named("order_before", before),
        named("scattered", scattered_),
        named("order_now", order_),
        named("sum_of_orders", sum_),
    };
    const Time start = now();
    for (std::uint32_t first = 0; first < extent.depth; first += kSlice) {
      const std::uint32_t push[] = {first, adds};
      TYNDALL_TRY(host_.run([&](VkCommandBuffer cmd) -> Result<void> {
        if (Result<void> bound = gpu::bind(host_.sets(), cmd, pipeline, resources, push); !bound) return bound;
        gpu::dispatch(device, cmd, pipeline, extent.width, extent.height, std::min(kSlice, extent.depth - first));
        gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                     VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        gpu::compute_barrier(device, cmd);
        return {};
      }));
    }
    time += since(start);
    return {};
  }

  gpu::Host& host_;
  gpu::Handle<VkSampler> linear_;
  gpu::Buffer medium_, directions_, rays_, results_;
  gpu::Image density_, single_, sum_, scattered_, order_;
  Times times_;
};

void print_errors(const char* sun, const char* method, const std::vector<validate::Rgb>& answers,
                  const std::vector<reference::Estimate>& truths) {
  std::vector<validate::Comparison> comparisons;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const validate::Truth truth = validate::truth(truths[i], 0);
    if (validate::is_comparable(truth)) comparisons.push_back(validate::compare(answers[i], truth));
  }
  const validate::ErrorSummary e = validate::summarise(comparisons);
  std::printf("| %s | %s | %zu | %.2f | %.2f | %.2f | %.2f | %.2f |\n", sun, method, e.channels[0].count,
              100.0 * e.all.mean, 100.0 * e.all.median, 100.0 * e.all.p95, 100.0 * e.all.worst, 100.0 * e.noise);
}

Result<void> run(std::uint32_t rays, std::uint32_t samples) {
  Params params;
  params.atmosphere.ozone_absorption = {0.0F, 0.0F, 0.0F};
  const shared::Medium medium = medium_from_params(params);
  TYNDALL_ASSIGN(const std::unique_ptr<gpu::Host> host, gpu::Host::create({}));

  const Time start = now();
  TYNDALL_ASSIGN(models::PrecomputedModel ours, models::PrecomputedModel::create(*host, params));
  const Time own = since(start);
  Published published(*host);
  TYNDALL_TRY(published.build(medium));

  std::printf("`published_tables %u %u` made these tables on %s. Errors are in per cent.\n\n", rays, samples,
              host->device_name().c_str());
  std::printf("| stage | time, s | processor time, s | processor time relative to all of ours |\n|---|--:|--:|--:|\n");
  const Published::Times& t = published.times();
  for (const auto& [name, time] :
       {std::pair("published: densities", t.density), std::pair("published: order 1", t.single),
        std::pair("published: orders 2 to 4, scattering at points", t.scatter),
        std::pair("published: orders 2 to 4, integration along rays", t.gather), std::pair("published: all", t.all()),
        std::pair("ours: all", own)}) {
    std::printf("| %s | %.1f | %.1f | %.2f |\n", name, time.wall_s, time.processor_s,
                time.processor_s / own.processor_s);
  }
  std::printf("\n| sun | tables | rays | mean | median | 95 %% | worst | noise "
              "|\n|---|---|--:|--:|--:|--:|--:|--:|\n");
  for (const validate::SunBand band : {validate::SunBand::up, validate::SunBand::twilight}) {
    std::vector<RayQuery> queries;
    for (const validate::Region region : {validate::Region::ground, validate::Region::air, validate::Region::space}) {
      for (const validate::TestRay& ray :
           validate::make_rays(region, band, rays, 1, params.planet.radius_m, params.atmosphere.height_m)) {
        queries.push_back(ray.query);
      }
    }
    reference::Options options;
    options.samples = samples;
    const char* sun = band == validate::SunBand::up ? "up" : "0 to -6 deg";
    TYNDALL_ASSIGN(const std::vector<reference::Estimate> truths, reference::trace(params, queries, options));
    TYNDALL_ASSIGN(const std::vector<validate::Rgb> theirs, published.answer(medium, queries));
    TYNDALL_ASSIGN(const std::vector<models::Answer> answers, ours.answer(queries));
    std::vector<validate::Rgb> mine;
    for (const models::Answer& answer : answers) mine.push_back(answer.radiance);
    print_errors(sun, "published", theirs, truths);
    print_errors(sun, "ours", mine, truths);
  }
  return {};
}

}  // namespace
}  // namespace tyndall

int main(int argc, char** argv) {
  const auto number = [&](int i, std::uint32_t otherwise) {
    return argc > i ? static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)) : otherwise;
  };
  const tyndall::Result<void> done = tyndall::run(std::max(number(1, 60), 1U), std::max(number(2, 8000), 2U));
  if (done) return 0;
  std::fprintf(stderr, "published_tables: error: %s\n", done.error().message.c_str());
  return 1;
}
