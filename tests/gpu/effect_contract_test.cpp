// The promises of include/tyndall/effect.hpp apart from the picture: memory is predicted, errors change nothing,
// effects are independent of each other, and results are reproducible byte for byte.
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "effect_frame.hpp"
#include "gpu/descriptors.hpp"
#include "gpu_test_shaders.hpp"

namespace tyndall {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr Technique kTechniques[] = {Technique::epipolar, Technique::brute_force};

class EffectContract : public GpuTest {
 protected:
  // Returns the sun transmittance and sky irradiance look-up tables as floats, read in the same way as by an engine.
  std::vector<float> light_tables(const Effect& effect) {
    std::vector<float> out;
    const gpu::Device& device = host().device();
    Result<gpu::Pipeline> pipeline = gpu::create_compute_pipeline(device, shaders::read_table_comp);
    Result<gpu::Handle<VkSampler>> sampler = gpu::create_sampler(device, {});
    constexpr std::uint32_t kWidth = 32;
    constexpr std::uint32_t kHeight = 256;
    constexpr VkDeviceSize kBytes = kWidth * kHeight * 16;
    Result<gpu::Buffer> buffer =
        gpu::create_buffer(device, "texels", kBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::readback);
    EXPECT_OK(pipeline);
    EXPECT_OK(sampler);
    EXPECT_OK(buffer);
    if (!pipeline.ok() || !sampler.ok() || !buffer.ok()) return out;
    const LightTables tables = effect.light_tables();
    for (VkImageView view : {tables.sun_transmittance, tables.sky_irradiance}) {
      EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
        gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
        const gpu::NamedResource resources[] = {
            gpu::named_image("table", view, VK_IMAGE_LAYOUT_GENERAL, sampler.value().get()),
            gpu::named_buffer("texel_block", buffer.value().buffer.get())};
        EXPECT_TRUE(gpu::bind(host().sets(), cmd, pipeline.value(), resources).ok());
        gpu::dispatch(device, cmd, pipeline.value(), kWidth, kHeight);
        gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                     VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        return {};
      }));
      const auto* texels = static_cast<const float*>(buffer.value().mapped);
      out.insert(out.end(), texels, texels + kBytes / sizeof(float));
    }
    return out;
  }
};

TEST_F(EffectContract, QueriedMemoryIsAllocatedMemory) {
  // The three differ in everything that memory depends on.
  EffectDesc descs[3];
  Params params[3];
  for (Params& p : params) p.tables.size = {8, 16, 16, 4};
  descs[0].max_extent = {333, 77};
  descs[0].frames_in_flight = 1;
  params[0].epipolar.correct_depth_breaks = true;
  params[0].shadows.cascade_processing = CascadeProcessing::multi_pass;
  descs[1] = descs[0];
  descs[1].frames_in_flight = 3;
  descs[1].output_format = OutputFormat::rgba32f;
  descs[1].counters = true;
  params[1].scattering.technique = Technique::brute_force;
  descs[2] = descs[1];
  descs[2].frames_in_flight = 8;
  descs[2].max_cascades = 7;
  descs[2].max_shadow_resolution = 700;
  descs[2].views = 2;
  params[2].froxels.enabled = true;
  params[2].froxels.columns = 33;
  params[2].epipolar.slices = 77;
  params[2].epipolar.samples = 33;
  params[2].epipolar.min_max_format = MinMaxFormat::float32;
  params[2].shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
  for (std::size_t i = 0; i < std::size(descs); ++i) {
    const Result<MemoryUsage> planned = query_memory(info(), descs[i], params[i]);
    ASSERT_OK(planned);
    Result<Effect> effect = Effect::create(info(), descs[i], params[i]);
    ASSERT_OK(effect);
    const MemoryUsage taken = effect.value().memory();
    EXPECT_GT(taken.persistent, 0U);
    EXPECT_GT(taken.host, 0U);
    EXPECT_EQ(planned.value().persistent, taken.persistent) << i;
    EXPECT_EQ(planned.value().transient, taken.transient) << i;
    EXPECT_EQ(planned.value().host, taken.host) << i;
    VkDeviceSize sum = 0;
    std::set<std::string> names;
    for (const ResourceMemory& resource : effect.value().resources()) {
      EXPECT_TRUE(names.insert(resource.name).second) << resource.name;
      EXPECT_GT(resource.bytes, 0U) << resource.name;
      sum += resource.bytes;
    }
    EXPECT_EQ(sum, taken.persistent) << i;
    EXPECT_EQ(names.contains("min_max_tree"), params[i].scattering.technique == Technique::epipolar);
    EXPECT_TRUE(names.contains("single_rayleigh"));
    // The memory after set_params() is predicted, too.
    for (const Params& other : params) {
      const Result<MemoryUsage> expected = query_memory(info(), descs[i], other);
      ASSERT_OK(expected);
      ASSERT_OK(effect.value().set_params(other));
      EXPECT_EQ(effect.value().memory().persistent, expected.value().persistent) << i;
      EXPECT_EQ(effect.value().memory().host, expected.value().host) << i;
    }
  }
}

TEST_F(EffectContract, DescriptionsOutOfRangeAreRefused) {
  const auto refused = [&](const auto& change) {
    EffectDesc desc;
    DeviceInfo device = info();
    change(desc, device);
    const Result<Effect> effect = Effect::create(device, desc, {});
    EXPECT_EQ(query_memory(device, desc).ok(), effect.ok());
    return !effect.ok() && effect.error().code == ErrorCode::invalid_argument;
  };
  EXPECT_FALSE(refused([](EffectDesc&, DeviceInfo&) {}));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_extent = {0, 720}; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_extent = {16385, 1}; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.frames_in_flight = 0; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.frames_in_flight = 9; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_cascades = 0; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_cascades = kMaxCascades + 1; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_shadow_resolution = 0; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.max_shadow_resolution = 16385; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.sky_depth = 0.5F; }));
  EXPECT_TRUE(refused([](EffectDesc& d, DeviceInfo&) { d.sky_depth = kNaN; }));
  EXPECT_TRUE(refused([](EffectDesc&, DeviceInfo& i) { i.device = VK_NULL_HANDLE; }));
  EXPECT_TRUE(refused([](EffectDesc&, DeviceInfo& i) { i.get_instance_proc_addr = nullptr; }));
  Params params;
  params.atmosphere.mie_g = 2.0F;
  EXPECT_FALSE(Effect::create(info(), {}, params).ok());
}

TEST_F(EffectContract, ParametersOutOfRangeAreRefusedAndTheOldOnesStay) {
  Result<Effect> effect = Effect::create(info(), {}, {});
  ASSERT_OK(effect);
  Params good;
  good.scattering.scale = 2.0F;
  ASSERT_OK(effect.value().set_params(good));
  for (const ParamInfo& row : param_table()) {
    const auto with = [&](auto value) {
      Params bad = good;
      std::memcpy(reinterpret_cast<char*>(&bad) + row.offset, &value, sizeof value);
      return effect.value().set_params(bad);
    };
    std::vector<Result<void>> results;
    switch (row.type) {
      case ParamType::float32:
      case ParamType::vec3:
        for (const float value :
             {kNaN, kInfinity, -kInfinity, std::nextafter(static_cast<float>(row.max), kInfinity) * 1.001F,
              static_cast<float>(row.min) - 1.0F}) {
          results.push_back(with(value));
        }
        break;
      case ParamType::uint32:
        results.push_back(with(static_cast<std::uint32_t>(row.max) + 1U));
        if (row.min > 0.0) results.push_back(with(static_cast<std::uint32_t>(row.min) - 1U));
        break;
      case ParamType::enumeration: results.push_back(with(1000U)); break;
      default: break;
    }
    for (const Result<void>& result : results) {
      ASSERT_FALSE(result.ok()) << row.group << "." << row.name;
      EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
      EXPECT_NE(result.error().message.find(std::string(row.group) + "." + std::string(row.name)), std::string::npos);
    }
    EXPECT_EQ(affected(effect.value().params(), good), 0U) << row.name;
  }
}

TEST_F(EffectContract, FramesThatCannotBeDrawnAreErrors) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  Result<Effect> effect = Effect::create(info(), desc_for(frame), {});
  ASSERT_OK(effect);
  std::array<Cascade, kMaxCascades + 1> many;
  many.fill(frame.cascades[0]);
  const auto refused = [&](const auto& change) {
    FrameInputs inputs = images.value().inputs(frame);
    std::array<Cascade, 2> cascades = {frame.cascades[0], frame.cascades[1]};
    inputs.cascades = cascades;
    change(inputs, cascades);
    Result<void> result;
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      result = effect.value().record(cmd, inputs);
      return {};
    }));
    EXPECT_TRUE(result.ok() || result.error().code == ErrorCode::invalid_argument);
    return !result.ok();
  };
  using Two = std::array<Cascade, 2>;
  EXPECT_FALSE(refused([](FrameInputs&, Two&) {}));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.extent = {0, 9}; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.extent = {17, 9}; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.color.view = VK_NULL_HANDLE; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.depth.view = VK_NULL_HANDLE; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.output.view = VK_NULL_HANDLE; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.output.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.shadow_maps.view = VK_NULL_HANDLE; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.shadow_colors = f.shadow_maps; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.shadow_colors = f.color; }));  // without EffectDesc::shadow_colors
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.shadow_colors = {f.color.view, VK_IMAGE_LAYOUT_UNDEFINED}; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.shadow_resolution = 0; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.lowest_ground_m = 1.0F; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.lowest_ground_m = static_cast<float>(kNaN); }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.first_marched_cascade = 2; }));
  EXPECT_TRUE(refused([&](FrameInputs& f, Two&) { f.cascades = many; }));
  EXPECT_TRUE(refused([](FrameInputs&, Two& c) { c[1].shadow_from_world.m[5] = kNaN; }));
  EXPECT_TRUE(refused([](FrameInputs&, Two& c) { c[0].far_m = -1.0F; }));
  EXPECT_TRUE(refused([](FrameInputs&, Two& c) { c[0].near_m = kNaN; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.camera.world_from_view.m[12] = kInfinity; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.camera.clip_from_view.m[0] = 0.0F; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.camera.clip_from_view.m[0] = kNaN; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.sun.direction_to_sun = Vec3(0.0F); }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.sun.direction_to_sun.x = kNaN; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.sun.irradiance.y = kNaN; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.sun.irradiance.y = -1.0F; }));
  EXPECT_TRUE(refused([](FrameInputs& f, Two&) { f.sun.angular_radius_rad = kNaN; }));
}

TEST_F(EffectContract, CascadesBeyondMaxCascadesAreNotMarched) {
  const TestFrame frame = small_frame();  // has two cascades
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  EffectDesc desc = desc_for(frame);
  desc.max_cascades = 1;
  Result<Effect> effect = Effect::create(info(), desc, {});
  ASSERT_OK(effect);
  const auto drawn = [&](const Params& params, std::uint32_t first_marched) {
    EXPECT_OK(effect.value().set_params(params));
    FrameInputs inputs = images.value().inputs(frame);
    inputs.first_marched_cascade = first_marched;
    Result<void> result;
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      result = effect.value().record(cmd, inputs);
      return {};
    }));
    return result.ok();
  };
  EXPECT_FALSE(drawn({}, 0));
  EXPECT_TRUE(drawn({}, 1));
  EXPECT_TRUE(drawn(with_technique(Technique::brute_force), 0));
  Params open;
  open.scattering.light_shafts = false;
  EXPECT_TRUE(drawn(open, 0));
}

TEST_F(EffectContract, RecordingTwiceGivesTheSameBytes) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  EffectDesc desc = desc_for(frame);
  desc.timings = true;
  Result<Effect> effect = Effect::create(info(), desc, {});
  ASSERT_OK(effect);
  for (const Technique technique : kTechniques) {
    ASSERT_OK(effect.value().set_params(with_technique(technique)));
    std::vector<std::byte> first;
    for (std::uint64_t i = 0; i < 5; ++i) {
      FrameInputs inputs = images.value().inputs(frame);
      inputs.frame_index = i;
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return effect.value().record(cmd, inputs); }));
      Result<std::vector<std::byte>> bytes = images.value().output_bytes(host());
      ASSERT_OK(bytes);
      if (i == 0) first = bytes.value();
      EXPECT_EQ(bytes.value(), first) << i;
      const std::span<const PassTiming> timings = effect.value().timings(i);
      ASSERT_EQ(timings.size() > 1, technique == Technique::epipolar);
      ASSERT_FALSE(timings.empty());
      for (const PassTiming& pass : timings) {
        EXPECT_GT(pass.gpu_ms, 0.0) << pass.name;
        EXPECT_LT(pass.gpu_ms, 60000.0) << pass.name;
      }
    }
  }
}

TEST_F(EffectContract, TwoEffectsOnOneDeviceAreIndependent) {
  const TestFrame frame = small_frame();
  Params thin = precise_params();
  thin.scattering.technique = Technique::epipolar;
  Params thick = thin;
  thick.atmosphere.aerosol_density = 20.0F;
  const Result<std::vector<glm::dvec3>> clear_alone = render(host(), thin, frame);
  const Result<std::vector<glm::dvec3>> thick_alone = render(host(), thick, frame);
  ASSERT_OK(clear_alone);
  ASSERT_OK(thick_alone);
  ASSERT_NE(clear_alone.value(), thick_alone.value());
  Result<Effect> a = Effect::create(info(), desc_for(frame), thin);
  Result<Effect> b = Effect::create(info(), desc_for(frame), thick);
  ASSERT_OK(a);
  ASSERT_OK(b);
  Result<FrameImages> images_a = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  Result<FrameImages> images_b = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images_a);
  ASSERT_OK(images_b);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    Result<void> recorded = a.value().record(cmd, images_a.value().inputs(frame));
    if (recorded.ok()) recorded = b.value().record(cmd, images_b.value().inputs(frame));
    return recorded;
  }));
  // An effect can be moved and destroyed while another is in use.
  { const Effect gone = std::move(a).value(); }
  const Result<std::vector<glm::dvec3>> clear = images_a.value().output(host());
  const Result<std::vector<glm::dvec3>> hazy = images_b.value().output(host());
  ASSERT_OK(clear);
  ASSERT_OK(hazy);
  EXPECT_EQ(clear.value(), clear_alone.value());
  EXPECT_EQ(hazy.value(), thick_alone.value());
}

TEST_F(EffectContract, TablesBuiltInStepsMatchTablesBuiltAtOnce) {
  Params params;
  params.tables.size = {8, 16, 16, 4};
  params.tables.orders = 2;
  Result<Effect> at_once = Effect::create(info(), {}, params);
  Result<Effect> sliced = Effect::create(info(), {}, params);
  ASSERT_OK(at_once);
  ASSERT_OK(sliced);
  EXPECT_FALSE(at_once.value().precompute_progress().complete());
  const auto build = [&](Effect& effect, std::uint32_t budget) {
    std::uint32_t calls = 0;
    while (!effect.precompute_progress().complete() && calls < 10000) {
      const std::uint32_t before = effect.precompute_progress().done;
      EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
        const Result<Progress> progress = effect.record_precompute(cmd, budget);
        if (!progress.ok()) return progress.error();
        EXPECT_EQ(progress.value().done, effect.precompute_progress().done);
        return {};
      }));
      EXPECT_GT(effect.precompute_progress().done, before);
      if (effect.precompute_progress().done <= before) break;
      ++calls;
    }
    return calls;
  };
  EXPECT_EQ(build(at_once.value(), UINT32_MAX), 1U);
  EXPECT_EQ(build(sliced.value(), 1), sliced.value().precompute_progress().total);
  const std::vector<float> expected = light_tables(at_once.value());
  EXPECT_EQ(light_tables(sliced.value()), expected);
  float brightest = 0.0F;
  for (const float value : expected) {
    ASSERT_TRUE(std::isfinite(value));
    brightest = std::max(brightest, value);
  }
  EXPECT_GT(brightest, 0.5F);
  // Only parameters of the atmosphere make the tables stale. Rebuilt tables are the same.
  params.scattering.integration_steps = 77;
  ASSERT_OK(sliced.value().set_params(params));
  EXPECT_TRUE(sliced.value().precompute_progress().complete());
  params.atmosphere.aerosol_density = 3.0F;
  ASSERT_OK(sliced.value().set_params(params));
  EXPECT_FALSE(sliced.value().precompute_progress().complete());
  build(sliced.value(), 5);
  EXPECT_NE(light_tables(sliced.value()), expected);
  params.atmosphere.aerosol_density = 1.0F;
  ASSERT_OK(sliced.value().set_params(params));
  build(sliced.value(), UINT32_MAX);
  EXPECT_EQ(light_tables(sliced.value()), expected);
}

}  // namespace
}  // namespace tyndall
