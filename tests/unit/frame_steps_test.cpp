// The steps of a frame and of a build of the tables, without a device: their order, what they read and write, the
// barriers between them, and the pipelines that they need.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <unordered_set>

#include "effect/frame_steps.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"

namespace tyndall {
namespace {

constexpr FrameShape kUsual = {{1280, 720}, 4, 0, false};

std::vector<std::string> names_of(const Params& params, const FrameShape& shape = kUsual) {
  std::vector<std::string> out;
  for (const Step& step : frame_steps({}, params, shape))
    if (step.dispatches()) out.emplace_back(step.name);
  return out;
}

struct KeyHash {
  std::size_t operator()(const PipelineKey& key) const {
    std::size_t out = reinterpret_cast<std::size_t>(key.shader);
    for (const std::uint8_t value : key.constants.values) out = out * 131 + value;
    return out;
  }
};
using KeySet = std::unordered_set<PipelineKey, KeyHash>;

// Calls body(params) for all combinations of the parameters that select steps and pipelines.
template <typename Body>
void for_each_mode(Body&& body) {
  Params p;
  for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
    for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
      for (std::uint32_t single = 0; single < 3; ++single) {
        for (std::uint32_t multiple = 0; multiple < 3; ++multiple) {
          for (std::uint32_t bits = 0; bits < 64; ++bits) {
            p.scattering.technique = technique;
            p.scattering.medium = medium;
            p.scattering.single = static_cast<SingleScattering>(single);
            p.scattering.multiple = static_cast<MultipleScattering>(multiple);
            p.scattering.sections = static_cast<LitSections>(bits & 1U);
            p.scattering.extinction = static_cast<Extinction>(bits >> 1U & 1U);
            p.epipolar.min_max_tree = (bits >> 2U & 1U) != 0;
            p.epipolar.min_max_format = static_cast<MinMaxFormat>(bits >> 3U & 1U);
            p.epipolar.refinement = static_cast<Refinement>(bits >> 4U & 1U);
            p.froxels.enabled = p.scattering.light_shafts = (bits >> 5U & 1U) != 0;
            for (const std::uint32_t downscale : {1U, 2U, 4U}) {
              p.scattering.downscale = downscale;
              for (const std::uint32_t slices : {100U, 300U, 1024U}) {
                p.epipolar.slices = slices;
                body(p);
              }
            }
          }
        }
      }
    }
  }
}

constexpr FrameShape kShapes[] = {{{64, 48}, 0, 0, false},
                                  {{64, 48}, 4, 1, false},
                                  {{1920, 1080}, 4, 0, true},
                                  {{1920, 1080}, 2, 1, false},
                                  {{1920, 1080}, 3, 3, true}};

EffectDesc full_desc() {
  EffectDesc desc;
  desc.shadow_colors = true;
  desc.counters = true;
  return desc;
}

TEST(FrameSteps, FollowTheMethod) {
  Params params;
  const std::vector<std::string> usual = {
      "slice_end_points",    "slice_samples", "refine_samples", "slice_directions", "min_max_tree",  "march_samples",
      "interpolate_samples", "unwarp",        "unwarp_pixels",  "march_samples",    "correct_pixels"};
  EXPECT_EQ(names_of(params), usual);

  // Without cascades there are no shadows.
  std::vector<std::string> unshadowed = usual;
  std::erase(unshadowed, "slice_directions");
  std::erase(unshadowed, "min_max_tree");
  EXPECT_EQ(names_of(params, {{1280, 720}, 0, 0, false}), unshadowed);
  EXPECT_EQ(names_of(params, {{1280, 720}, 2, 2, false}), unshadowed);
  params.scattering.light_shafts = false;
  EXPECT_EQ(names_of(params), unshadowed);
  params = {};
  params.scattering.single = SingleScattering::none;
  params.scattering.multiple = MultipleScattering::unoccluded;
  EXPECT_EQ(names_of(params), unshadowed);

  params = {};
  params.epipolar.min_max_tree = false;
  std::vector<std::string> without_tree = usual;
  std::erase(without_tree, "min_max_tree");
  EXPECT_EQ(names_of(params), without_tree);

  params = {};
  params.scattering.downscale = 2;
  const std::vector<std::string> downscaled = {"slice_end_points",    "slice_samples",      "refine_samples",
                                               "slice_directions",    "min_max_tree",       "march_samples",
                                               "interpolate_samples", "unwarp_downscaled",  "unwarp_downscaled_pixels",
                                               "march_samples",       "correct_downscaled", "upscale",
                                               "upscale_pixels",      "march_samples",      "correct_pixels"};
  EXPECT_EQ(names_of(params), downscaled);

  params = {};
  params.epipolar.show_sampling = true;
  std::vector<std::string> shown = usual;
  shown.insert(shown.end(), 2, "show_sampling");
  EXPECT_EQ(names_of(params), shown);

  params.scattering.technique = Technique::brute_force;
  EXPECT_EQ(names_of(params, {{64, 64}, 4, 0, false}), std::vector<std::string>{"march_per_pixel"});
  params.scattering.enabled = false;
  EXPECT_EQ(names_of(params), std::vector<std::string>{"no_air"});
}

TEST(FrameSteps, CascadesAreMarchedTogetherOrApart) {
  const auto marches = [](CascadeProcessing processing, const FrameShape& shape) {
    Params params;
    params.shadows.cascade_processing = processing;
    std::vector<std::array<std::uint32_t, 2>> out;
    for (const Step& step : frame_steps({}, params, shape)) {
      if (step.dispatches() && step.chosen == Resource::march_list) out.push_back(step.push);
    }
    return out;
  };
  using Push = std::array<std::uint32_t, 2>;
  const FrameShape three = {{64, 64}, 4, 1, false};
  EXPECT_EQ(marches(CascadeProcessing::single_pass, three), (std::vector<Push>{{shared::kAllCascades, 0}}));
  EXPECT_EQ(marches(CascadeProcessing::multi_pass, three),
            (std::vector<Push>{
                {shared::kOneCascade, 0}, {shared::kOneCascade, 1}, {shared::kOneCascade, 2}, {shared::kFinish, 1}}));
  EXPECT_EQ(marches(CascadeProcessing::multi_pass_instanced, three),
            (std::vector<Push>{{shared::kCascadesAside, 0}, {shared::kFinish, 3}}));
  // Without cascades, every kind of processing has a single pass.
  for (const CascadeProcessing processing : {CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
    EXPECT_EQ(marches(processing, {{64, 64}, 0, 0, false}), (std::vector<Push>{{shared::kAllCascades, 0}}));
  }
}

// Specialisation constants follow from the parameters. A parameter that has no effect does not change them, so that the
// pipelines are equal.
TEST(FrameSteps, ConstantsFollowTheModes) {
  for_each_mode([&](const Params& params) {
    const ScatteringParams& s = params.scattering;
    const bool homogeneous = s.medium == MediumKind::homogeneous;
    const bool occluded = s.multiple == MultipleScattering::occluded && !homogeneous;
    for (const Step& step : frame_steps(full_desc(), params, kShapes[2])) {
      if (!step.dispatches()) continue;
      const Specialisation& constants = step.pipeline.constants;
      const std::string name = step.name;
      if (name == "march_per_pixel" || name == "march_samples") {
        EXPECT_EQ(constants[shared::kSingleId] != 0, s.single != SingleScattering::none);
        if (!homogeneous) {
          EXPECT_EQ(constants[shared::kSingleId], static_cast<std::uint32_t>(s.single));
        }
        EXPECT_EQ(constants[shared::kOccludedId], occluded ? 1 : 0);
        const bool each =
            s.sections == LitSections::each && !homogeneous && (s.single == SingleScattering::table || occluded);
        EXPECT_EQ(constants[shared::kSectionsId], each ? 1 : 0);
        EXPECT_EQ(constants[shared::kHomogeneousId], homogeneous ? 1 : 0);
        EXPECT_EQ(constants[shared::kCountId], 1);
        const bool shadowed = s.light_shafts && (s.single != SingleScattering::none || occluded);
        EXPECT_EQ(constants[shared::kColorsId], shadowed ? 1 : 0);
        const bool tree = shadowed && params.epipolar.min_max_tree && name == "march_samples";
        EXPECT_EQ(constants[shared::kTreeId], tree ? 1 : 0);
      }
      if (name == "unwarp" || name == "upscale") {
        EXPECT_EQ(constants[shared::kExtinctionId], homogeneous ? 0U : static_cast<std::uint32_t>(s.extinction));
        EXPECT_EQ(constants[shared::kDownscaleId], s.downscale);
      }
      if (name == "refine_samples") {
        EXPECT_EQ(constants[shared::kRefinementId], static_cast<std::uint32_t>(params.epipolar.refinement));
      }
      if (name == "min_max_tree") {
        EXPECT_EQ(constants[shared::kFormatId], static_cast<std::uint32_t>(params.epipolar.min_max_format));
      }
      // Constants that the shader does not have are 0.
      for (std::uint32_t id = 0; id < shared::kSpecialisationIds; ++id) {
        const auto& ids = step.pipeline.shader->constants;
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) {
          EXPECT_EQ(constants[id], 0) << name << ' ' << id;
        }
      }
    }
  });
}

// Returns the name of a buffer that a frame reads before writing it, or an empty string. Ignores buffers that shaders
// bind without using them in a mode.
std::string unwritten_read(const FrameSteps& steps, bool tree, bool cascades, bool downscaled) {
  std::set<Resource> written;
  for (const Step& step : steps) {
    const Uses uses = uses_of(step);
    for (const Use& use : uses) {
      if (info_of(use.resource).lifetime == Lifetime::build) return std::string(name_of(use.resource)) + " is used";
      if (info_of(use.resource).lifetime != Lifetime::frame) continue;
      const bool unused = (use.resource == Resource::min_max_tree && !tree) ||
                          (use.resource == Resource::slice_lines && !cascades) ||
                          (use.resource == Resource::downscaled_inscattering && !downscaled) ||
                          use.resource == Resource::march_states || use.resource == Resource::counters;
      if (!unused && (use.access & ~kWriteAccess) != 0 && (use.access & kWriteAccess) == 0 &&
          !written.contains(use.resource)) {
        return std::string(step.name) + " reads " + name_of(use.resource);
      }
    }
    for (const Use& use : uses) {
      if ((use.access & kWriteAccess) != 0) written.insert(use.resource);
    }
  }
  return written.contains(Resource::output_color) ? "" : "the output is not written";
}

TEST(FrameSteps, ReadOnlyWrittenResources) {
  for_each_mode([&](Params params) {
    for (const CascadeProcessing processing :
         {CascadeProcessing::single_pass, CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
      params.shadows.cascade_processing = processing;
      for (const FrameShape& shape : kShapes) {
        const FrameSteps steps = frame_steps(full_desc(), params, shape);
        const auto runs = [&](std::string_view name) {
          return std::any_of(steps.begin(), steps.end(), [&](const Step& s) { return name == s.name; });
        };
        ASSERT_EQ(
            unwritten_read(steps, runs("min_max_tree"), runs("slice_directions"), params.scattering.downscale > 1), "");
      }
    }
  });
}

// Every pair of steps that use a resource, one of them writing it, has a barrier between them that covers both uses.
void expect_ordered(const std::vector<Step>& steps) {
  HazardTracker tracker;
  std::vector<HazardTracker::Barrier> barriers;
  for (const Step& step : steps) barriers.push_back(tracker.before(uses_of(step)));
  const auto stage_of = [](VkAccessFlags access) -> VkPipelineStageFlags {
    switch (access) {
      case VK_ACCESS_SHADER_READ_BIT:
      case VK_ACCESS_SHADER_WRITE_BIT: return VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
      case VK_ACCESS_INDIRECT_COMMAND_READ_BIT: return VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
      case VK_ACCESS_HOST_READ_BIT: return VK_PIPELINE_STAGE_HOST_BIT;
      default: return VK_PIPELINE_STAGE_TRANSFER_BIT;
    }
  };
  const auto ordered = [&](std::size_t first, VkAccessFlags a, std::size_t second, VkAccessFlags b) {
    for (std::size_t k = first + 1; k <= second; ++k) {
      const HazardTracker::Barrier& barrier = barriers[k];
      const bool from =
          (barrier.from & stage_of(a)) != 0 && ((a & kWriteAccess) == 0 || (barrier.from_access & a) != 0);
      const bool to = (barrier.to & stage_of(b)) != 0 && ((a & kWriteAccess) == 0 || (barrier.to_access & b) != 0);
      if (from && to) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const Use& a : uses_of(steps[i])) {
      // Up to the next step that writes the resource: later ones are ordered behind that one.
      bool overwritten = false;
      for (std::size_t j = i + 1; j < steps.size() && !overwritten; ++j) {
        for (const Use& b : uses_of(steps[j])) {
          if (a.resource != b.resource || ((a.access | b.access) & kWriteAccess) == 0) continue;
          for (VkAccessFlags x = 1; x <= VK_ACCESS_HOST_READ_BIT; x <<= 1U) {
            for (VkAccessFlags y = 1; y <= VK_ACCESS_HOST_READ_BIT; y <<= 1U) {
              if ((a.access & x) == 0 || (b.access & y) == 0 || ((x | y) & kWriteAccess) == 0) continue;
              ASSERT_TRUE(ordered(i, x, j, y))
                  << steps[i].name << " and " << steps[j].name << " are not ordered in " << name_of(a.resource);
            }
          }
          overwritten = overwritten || (b.access & kWriteAccess) != 0;
        }
      }
    }
  }
}

TEST(FrameSteps, BarriersOrderEveryHazard) {
  for (const CascadeProcessing processing :
       {CascadeProcessing::single_pass, CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
    for (const std::uint32_t downscale : {1U, 2U}) {
      for (const FrameShape& shape : kShapes) {
        Params params;
        params.shadows.cascade_processing = processing;
        params.scattering.downscale = downscale;
        params.epipolar.show_sampling = true;
        const FrameSteps steps = frame_steps(full_desc(), params, shape);
        expect_ordered({steps.begin(), steps.end()});
      }
    }
  }
  for (std::uint32_t stale = 1; stale <= kAllTables; ++stale) {
    Params params;
    params.tables.size = {4, 4, 4, 4};
    expect_ordered(table_steps(params, stale));
  }
}

TEST(FrameSteps, BarriersAreOnlyWhereTheyAreNeeded) {
  HazardTracker tracker;
  Uses write_samples;
  write_samples.add(Resource::samples, VK_ACCESS_SHADER_WRITE_BIT);
  Uses read_samples;
  read_samples.add(Resource::samples, VK_ACCESS_SHADER_READ_BIT);
  Uses write_slices;
  write_slices.add(Resource::slices, VK_ACCESS_SHADER_WRITE_BIT);
  Uses list;
  list.add(Resource::samples, VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
  EXPECT_EQ(tracker.before(write_samples).from, 0U);
  EXPECT_EQ(tracker.before(write_slices).from, 0U);
  const HazardTracker::Barrier read = tracker.before(read_samples);
  EXPECT_EQ(read.from, static_cast<VkPipelineStageFlags>(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT));
  EXPECT_EQ(read.from_access, static_cast<VkAccessFlags>(VK_ACCESS_SHADER_WRITE_BIT));
  EXPECT_EQ(tracker.before(read_samples).from, 0U);  // already visible
  EXPECT_EQ(tracker.before(list).to, static_cast<VkPipelineStageFlags>(VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT));
  // Both kinds of reads have to be complete before the next write.
  EXPECT_EQ(tracker.before(write_samples).from, static_cast<VkPipelineStageFlags>(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                                                                  VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT));
}

// prepare_pipelines() creates the pipelines that frames need and no others; record() creates none.
TEST(FrameSteps, AllPipelinesAreFound) {
  for (const auto& [colors, target, color] :
       {std::tuple(false, Target::cpu, ColorMode::rgb), std::tuple(true, Target::gpu, ColorMode::rgb),
        std::tuple(true, Target::cpu, ColorMode::spectral)}) {
    const EffectDesc desc = {.shadow_colors = colors};
    Params similar;
    similar.scattering.color = color;
    if (colors) similar.atmosphere.mie_phase = MiePhase::draine;
    const std::vector<PipelineKey> list = all_frame_pipelines(desc, target, similar);
    const KeySet all(list.begin(), list.end());
    KeySet reached;
    for_each_mode([&, with_glass = colors, device = target](Params params) {
      params.epipolar.show_sampling = true;
      params.scattering.color = similar.scattering.color;
      params.atmosphere.mie_phase = similar.atmosphere.mie_phase;
      for (const bool enabled : {false, true}) {
        params.scattering.enabled = enabled;
        for (FrameShape shape : kShapes) {
          shape.shadow_colors = shape.shadow_colors && with_glass;
          shape.target = device;
          for (const Step& step : frame_steps(desc, params, shape))
            if (step.dispatches()) reached.insert(step.pipeline);
        }
      }
    });
    EXPECT_EQ(reached.size(), list.size());  // none of them twice
    for (const PipelineKey& key : reached) EXPECT_TRUE(all.contains(key)) << key.shader->name;
  }
}

// The variants of a pass differ only in how they compute. Memory and barriers are planned for one of them.
TEST(FrameSteps, VariantsUseTheSameResources) {
  for_each_mode([&](const Params& params) {
    for (const Step& step : frame_steps(full_desc(), params, kShapes[2])) {
      if (!step.dispatches()) continue;
      const gpu::Shader& cpu = *step.pipeline.shader;
      const gpu::Shader& gpu = variant_for(cpu, Target::gpu);
      ASSERT_EQ(std::string(gpu.name), std::string(cpu.name) + "_gpu");
      const auto resources = bound_resources(cpu);
      const auto others = bound_resources(gpu);
      ASSERT_TRUE(std::is_permutation(resources.begin(), resources.end(), others.begin(), others.end())) << cpu.name;
      ASSERT_TRUE(std::equal(cpu.constants.begin(), cpu.constants.end(), gpu.constants.begin(), gpu.constants.end()));
    }
  });
}

TEST(FrameSteps, SetParamsCreatesThePipelinesOfItsFrames) {
  std::uint32_t turn = 0;
  for_each_mode([&](const Params& params) {
    if (++turn % 37 != 0) return;  // a prime number, so that all parameters vary
    const std::vector<PipelineKey> list = pipelines_of_frames(full_desc(), params);
    const KeySet made(list.begin(), list.end());
    for (const FrameShape& shape : kShapes) {
      for (const Step& step : frame_steps(full_desc(), params, shape)) {
        if (step.dispatches()) {
          EXPECT_TRUE(made.contains(step.pipeline)) << step.name;
        }
      }
    }
  });
}

TEST(Resources, HaveUniqueNames) {
  std::set<std::string> names;
  for (const ResourceInfo& info : kResourceInfo) EXPECT_TRUE(names.insert(info.name).second) << info.name;
}

// With tables.orders >= 3, the steps of the late orders follow those of the full orders. With fewer, one more pass of
// `scatter` completes the sums instead.
TEST(TableSteps, LateOrdersFollowFromThreeOrdersOn) {
  for (std::uint32_t orders = 1; orders <= 5; ++orders) {
    Params params;
    params.tables.orders = orders;
    std::vector<std::uint32_t> gathered, scattered;
    std::uint32_t last_full = 0;
    for (const Step& step : table_steps(params, kAllTables)) {
      const std::string name = step.name;
      if (name == "gather_late") gathered.push_back(step.push[1]);
      if (name == "scatter_late") scattered.push_back(step.push[1]);
      if (name == "scatter") last_full = step.push[1];
    }
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 1; orders > 2 && i <= shared::kLateOrders; ++i) expected.push_back(orders + i);
    EXPECT_EQ(gathered, expected) << orders;
    EXPECT_EQ(scattered, expected) << orders;
    EXPECT_EQ(last_full, orders > 2 ? orders : orders + 1);
  }
}

TEST(TableSteps, WriteStaleTablesAndReadOnlyWrittenResources) {
  Params params;
  params.tables.size = {5, 6, 7, 8};
  params.tables.orders = 3;
  const std::span<const char* const> names = table_step_names();
  for (std::uint32_t stale = 1; stale <= kAllTables; ++stale) {
    std::set<Resource> written;
    for (const Step& step : table_steps(params, stale)) {
      EXPECT_TRUE(std::find(names.begin(), names.end(), step.name) != names.end()) << step.name;
      for (const Use& use : uses_of(step)) {
        // The first pass of `scatter` writes the sums that later passes add to.
        const bool reads = (use.access & kWriteAccess) == 0 && info_of(use.resource).lifetime == Lifetime::build;
        EXPECT_TRUE(!reads || written.contains(use.resource)) << step.name << ' ' << name_of(use.resource);
      }
      for (const Use& use : uses_of(step)) {
        if ((use.access & kWriteAccess) != 0) written.insert(use.resource);
      }
    }
    const bool single = (stale & kSingleTables) != 0;
    const bool high = (stale & kHighTables) != 0;
    EXPECT_EQ(written.contains(Resource::single_rayleigh), single);
    EXPECT_EQ(written.contains(Resource::single_mie), single);
    EXPECT_EQ(written.contains(Resource::high_orders), high);
    EXPECT_EQ(written.contains(Resource::sky_irradiance_table), high);
    EXPECT_EQ(written.contains(Resource::sun_transmittance), (stale & bit(TableId::sun_transmittance)) != 0);
  }
}

}  // namespace
}  // namespace tyndall
