// The effect through the C interface on a device: pictures, tables and reports are those of C++, byte for byte.
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "c_structures.hpp"
#include "effect_frame.hpp"
#include "tyndall/atmosphere.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

// Small tables, so that pictures need record_precompute().
Params cpp_params() {
  Params params;
  params.tables.size = {8, 16, 16, 4};
  params.tables.orders = 2;
  params.scattering.multiple = MultipleScattering::occluded;
  params.scattering.extinction = Extinction::per_pixel;
  params.epipolar.slices = 64;
  params.epipolar.samples = 64;
  params.epipolar.correct_depth_breaks = true;
  params.atmosphere.rayleigh_scattering = {5.0e-6F, 12.0e-6F, 30.0e-6F};
  params.atmosphere.custom_coefficients = true;
  return params;
}

// Returns the same parameters, set by name through the C interface.
OwnedParams c_params() {
  TyndallParams* p = nullptr;
  EXPECT_SUCCESS(tyndall_params_create(&p));
  const double size[4] = {8, 16, 16, 4};
  const double rayleigh[3] = {5.0e-6, 12.0e-6, 30.0e-6};
  EXPECT_SUCCESS(tyndall_params_set_numbers(p, "tables.size", size, 4));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "tables.orders", 2));
  EXPECT_SUCCESS(tyndall_params_set_choice(p, "scattering.multiple", "occluded"));
  EXPECT_SUCCESS(tyndall_params_set_choice(p, "scattering.extinction", "per-pixel"));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "epipolar.slices", 64));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "epipolar.samples", 64));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "epipolar.correct_depth_breaks", 1));
  EXPECT_SUCCESS(tyndall_params_set_numbers(p, "atmosphere.rayleigh_scattering", rayleigh, 3));
  EXPECT_SUCCESS(tyndall_params_set_number(p, "atmosphere.custom_coefficients", 1));
  return OwnedParams(p);
}

// A frame with stained glass and clouds, in rectangles of larger images.
TestFrame glass_frame() {
  TestFrame frame = small_frame();
  frame.image_extent = {24, 15};
  frame.offsets = {{1, 2}, {3, 4}, {5, 6}};
  frame.background = Vec3(0.5F);
  frame.lowest_ground_m = -100.0;
  frame.shadow_color = [](std::uint32_t, double u, double v) { return glm::dvec3(u, v, 0.5); };
  frame.glass_depth = [](std::uint32_t, double, double) { return 0.25F; };
  frame.clouds.texel = [](double u, double v) { return glm::dvec4(v, u, 0.5, 0.5); };
  frame.clouds.map_from_world = sun_cascade(frame.to_sun, frame.view.position, 30000.0, 0.0, 1.0).shadow_from_world;
  return frame;
}

EffectDesc desc_of_tests() {
  EffectDesc desc = desc_for(glass_frame());
  desc.views = 2;
  desc.frames_in_flight = 3;
  desc.timings = true;
  desc.counters = true;
  desc.max_shadow_resolution = 64;
  desc.max_cascades = 2;
  return desc;
}

class CEffect : public GpuTest {
 protected:
  // All cases share the effects, because creating pipelines takes longer than the cases.
  void SetUp() override {
    GpuTest::SetUp();
    cpp_texts_.clear();
    c_texts_.clear();
    if (!cpp_) make_effects();
  }
  static void TearDownTestSuite() {
    cpp_.reset();
    c_.reset();
  }
  // Creates the effect in both languages and builds the tables.
  static void make_effects() {
    DeviceInfo device = info();
    device.message = [](void* user, Severity, std::string_view text) {
      static_cast<std::vector<std::string>*>(user)->emplace_back(text);
    };
    device.message_user = &cpp_texts_;
    Result<Effect> made = Effect::create(device, desc_of_tests(), cpp_params());
    ASSERT_OK(made);
    cpp_.emplace(std::move(made).value());
    TyndallDeviceInfo c_info = c_device(info());
    c_info.message = [](void* user, TyndallSeverity severity, const char* text) {
      EXPECT_EQ(severity, TyndallSeverity_warning);
      static_cast<std::vector<std::string>*>(user)->emplace_back(text);
    };
    c_info.message_user = &c_texts_;
    c_info.replace_shader = [](void* user, const char* name, size_t*) -> const std::uint32_t* {
      static_cast<std::vector<std::string>*>(user)->emplace_back(name);
      return nullptr;
    };
    c_info.replace_shader_user = &shaders_;
    const TyndallEffectDesc desc = c_desc(desc_of_tests());
    TyndallEffect* c = nullptr;
    ASSERT_SUCCESS(tyndall_effect_create(&c_info, &desc, c_params().get(), &c));
    c_.reset(c);
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      EXPECT_TRUE(cpp_->record_precompute(cmd).ok());
      TyndallProgress progress = {};
      EXPECT_SUCCESS(tyndall_effect_record_precompute(c_.get(), cmd, UINT32_MAX, &progress));
      EXPECT_EQ(progress.done, progress.total);
      EXPECT_GT(progress.total, 0U);
      return {};
    }));
  }
  // Draws the frame in both languages and compares the pictures.
  void expect_same_picture(const TestFrame& frame, const std::function<void(FrameInputs&)>& change) {
    std::vector<std::byte> pictures[2];
    for (int language = 0; language < 2; ++language) {
      Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
      ASSERT_OK(images);
      FrameInputs inputs = images.value().inputs(frame);
      change(inputs);
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
        if (language == 0) return cpp_->record(cmd, inputs);
        const CFrame c = c_frame(inputs);
        EXPECT_SUCCESS(tyndall_effect_record(c_.get(), cmd, &c.inputs));
        return {};
      }));
      Result<std::vector<std::byte>> bytes = images.value().output_bytes(host());
      ASSERT_OK(bytes);
      pictures[language] = std::move(bytes).value();
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    const std::vector<std::byte> unwritten(pictures[0].size(), std::byte{0xFF});
    EXPECT_NE(pictures[0], unwritten);
  }
  static inline std::vector<std::string> cpp_texts_, c_texts_, shaders_;
  static inline std::optional<Effect> cpp_;
  static inline OwnedEffect c_;
};

TEST_F(CEffect, AtmosphereConstantsAreThoseOfCpp) {
  TyndallAtmosphereInputs inputs = {};
  ASSERT_SUCCESS(tyndall_atmosphere_inputs_defaults(&inputs, sizeof inputs));
  AtmosphereInputs cpp;
  EXPECT_EQ(inputs.origin_from_centre_m[1], cpp.origin_from_centre_m.y);
  cpp.origin_from_centre_m = {1.0, -6.5e6, 3.0};
  cpp.sun = {{0.6F, 0.0F, 0.8F}, {1.0F, 2.0F, 3.0F}, 0.01F};
  inputs.origin_from_centre_m[0] = 1.0;
  inputs.origin_from_centre_m[1] = -6.5e6;
  inputs.origin_from_centre_m[2] = 3.0;
  inputs.sun = {{0.6F, 0.0F, 0.8F}, {1.0F, 2.0F, 3.0F}, 0.01F};
  for (int i = 0; i < 16; ++i) inputs.clouds_from_position[i] = cpp.clouds_from_position.m[i] = 0.5F + 0.25F * i;
  std::array<std::byte, TYNDALL_ATMOSPHERE_CONSTANTS_SIZE> bytes = {};
  ASSERT_SUCCESS(tyndall_atmosphere_constants(c_params().get(), &inputs, bytes.data(), bytes.size()));
  const Result<AtmosphereConstants> expected = atmosphere_constants(cpp_params(), cpp);
  ASSERT_OK(expected);
  EXPECT_TRUE(bytes == expected.value().bytes);
  EXPECT_EQ(tyndall_atmosphere_constants(nullptr, &inputs, bytes.data(), 4), TyndallStatus_invalid_argument);
  EXPECT_NE(std::string(tyndall_last_error()).find("'size' is 4; expected"), std::string::npos) << tyndall_last_error();
  inputs.sun.direction_to_sun[0] = NAN;
  EXPECT_EQ(tyndall_atmosphere_constants(nullptr, &inputs, bytes.data(), bytes.size()), TyndallStatus_invalid_argument);
}

TEST_F(CEffect, PicturesAreThoseOfCpp) {
  expect_same_picture(small_frame(), [](FrameInputs&) {});
  expect_same_picture(glass_frame(), [](FrameInputs& inputs) {
    inputs.frame_index = 5;
    inputs.view = 1;
  });
  const Counters cpp = cpp_->counters(5, 1);
  auto c = sized<TyndallCounters>();
  ASSERT_SUCCESS(tyndall_effect_counters(c_.get(), 5, 1, &c));
  EXPECT_GT(c.samples_marched, 0U);
  EXPECT_EQ(c.samples_marched, cpp.samples_marched);
  EXPECT_EQ(c.march_steps, cpp.march_steps);
  EXPECT_EQ(c.tree_nodes_visited, cpp.tree_nodes_visited);
  EXPECT_EQ(c.shadow_map_fetches, cpp.shadow_map_fetches);
  EXPECT_EQ(c.pixels_corrected, cpp.pixels_corrected);
  EXPECT_EQ(c_texts_, cpp_texts_);
  EXPECT_GT(shaders_.size(), 10U);
  // Both languages change parameters.
  OwnedParams params = c_params();
  ASSERT_SUCCESS(tyndall_params_set_choice(params.get(), "scattering.technique", "brute-force"));
  ASSERT_SUCCESS(tyndall_effect_set_params(c_.get(), params.get(), nullptr));
  Params changed = cpp_params();
  changed.scattering.technique = Technique::brute_force;
  ASSERT_OK(cpp_->set_params(changed));
  expect_same_picture(glass_frame(), [](FrameInputs& inputs) { inputs.frame_index = 6; });
  ASSERT_SUCCESS(tyndall_effect_set_params(c_.get(), c_params().get(), nullptr));
  ASSERT_OK(cpp_->set_params(cpp_params()));
}

// A program that drops a frame has lost its images, and perhaps its cascades.
TEST_F(CEffect, DroppedFramesReadNoCascades) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  FrameInputs inputs = images.value().inputs(frame);
  inputs.frame_index = 20;
  CFrame c = c_frame(inputs);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    EXPECT_SUCCESS(tyndall_effect_record_part(c_.get(), cmd, &c.inputs, TyndallFramePart_first));
    c.inputs.cascades = nullptr;
    c.inputs.cascade_count = 1000;
    EXPECT_SUCCESS(tyndall_effect_record_part(c_.get(), cmd, &c.inputs, TyndallFramePart_drop));
    return {};
  }));
}

TEST_F(CEffect, RemarksAreThoseOfCpp) {
  expect_same_picture(small_frame(), [](FrameInputs& inputs) {
    inputs.sun.direction_to_sun = {0.0F, 0.5F, -0.5F};
    inputs.first_marched_cascade = 1;
  });
  EXPECT_FALSE(c_texts_.empty());
  EXPECT_EQ(c_texts_, cpp_texts_);
}

TEST_F(CEffect, ReportsAreThoseOfCpp) {
  auto memory = sized<TyndallMemoryUsage>(), queried = memory;
  const TyndallDeviceInfo device = c_device(info());
  const TyndallEffectDesc desc = c_desc(desc_of_tests());
  const OwnedParams params = c_params();
  ASSERT_SUCCESS(tyndall_effect_memory(c_.get(), &memory));
  ASSERT_SUCCESS(tyndall_query_memory(&device, &desc, params.get(), &queried));
  EXPECT_EQ(memory.persistent, cpp_->memory().persistent);
  EXPECT_EQ(memory.host, cpp_->memory().host);
  EXPECT_EQ(queried.persistent, memory.persistent);
  EXPECT_EQ(queried.host, memory.host);

  std::uint32_t count = 0;
  ASSERT_SUCCESS(tyndall_effect_resources(c_.get(), &count, nullptr));
  const std::span<const ResourceMemory> resources = cpp_->resources();
  ASSERT_EQ(count, resources.size());
  std::vector<TyndallResourceMemory> listed(count, {nullptr, 0});
  count = 2;  // room for two only
  ASSERT_SUCCESS(tyndall_effect_resources(c_.get(), &count, listed.data()));
  ASSERT_EQ(count, listed.size());
  EXPECT_NE(listed[1].name, nullptr);
  EXPECT_EQ(listed[2].name, nullptr);
  ASSERT_SUCCESS(tyndall_effect_resources(c_.get(), &count, listed.data()));
  for (std::size_t i = 0; i < listed.size(); ++i) {
    EXPECT_STREQ(listed[i].name, resources[i].name);
    EXPECT_EQ(listed[i].bytes, resources[i].bytes);
  }

  expect_same_picture(small_frame(), [](FrameInputs&) {});
  std::vector<TyndallPassTiming> timings(64);
  count = 64;
  ASSERT_SUCCESS(tyndall_effect_timings(c_.get(), 0, 0, &count, timings.data()));
  const std::span<const PassTiming> cpp_timings = cpp_->timings(0);
  ASSERT_EQ(count, cpp_timings.size());
  EXPECT_GT(count, 3U);
  for (std::size_t i = 0; i < count; ++i) EXPECT_STREQ(timings[i].name, cpp_timings[i].name);
  count = 64;
  ASSERT_SUCCESS(tyndall_effect_precompute_timings(c_.get(), &count, timings.data()));
  EXPECT_EQ(count, cpp_->precompute_timings().size());
  EXPECT_GT(timings[0].gpu_ms, 0.0);
}

TEST_F(CEffect, TablesAreThoseOfCpp) {
  std::size_t size = 0;
  ASSERT_SUCCESS(tyndall_effect_table_key(c_.get(), &size, nullptr));
  std::string key(size, 'x');
  size -= 1;  // too small by one
  ASSERT_SUCCESS(tyndall_effect_table_key(c_.get(), &size, key.data()));
  ASSERT_EQ(size, key.size());
  EXPECT_EQ(key, std::string(size, 'x'));
  ASSERT_SUCCESS(tyndall_effect_table_key(c_.get(), &size, key.data()));
  EXPECT_STREQ(key.c_str(), cpp_->table_key().c_str());
  VkDeviceSize bytes = 0;
  ASSERT_SUCCESS(tyndall_effect_table_bytes(c_.get(), &bytes));
  EXPECT_EQ(bytes, cpp_->table_bytes());

  auto light = sized<TyndallLightTables>();
  ASSERT_SUCCESS(tyndall_effect_light_tables(c_.get(), &light));
  EXPECT_TRUE(light.sun_transmittance != VK_NULL_HANDLE && light.sky_irradiance != VK_NULL_HANDLE);
  EXPECT_NE(light.sun_transmittance, light.sky_irradiance);
  auto scattering = sized<TyndallScatteringTables>();
  ASSERT_SUCCESS(tyndall_effect_scattering_tables(c_.get(), &scattering));
  EXPECT_EQ(scattering.high_orders.extent.width, cpp_->scattering_tables().high_orders.extent.width);
  EXPECT_EQ(scattering.single_mie.extent.depth, cpp_->scattering_tables().single_mie.extent.depth);
  EXPECT_TRUE(scattering.single_rayleigh.image != VK_NULL_HANDLE && scattering.single_rayleigh.view != VK_NULL_HANDLE);

  VkDescriptorImageInfo images[8] = {};
  std::uint32_t image_count = 0;
  ASSERT_SUCCESS(tyndall_effect_atmosphere_images(c_.get(), 0, &image_count, nullptr));
  EXPECT_EQ(image_count, atmosphere_images(*cpp_).count);
  ASSERT_SUCCESS(tyndall_effect_atmosphere_images(c_.get(), 0, &image_count, images));
  EXPECT_EQ(images[0].imageView, light.sky_irradiance);
  EXPECT_EQ(images[3].imageView, scattering.high_orders.view);
  EXPECT_EQ(images[image_count].imageView, VK_NULL_HANDLE);

  // Saved in both languages, the tables are the same; and they can be loaded.
  const gpu::Device& device = host().device();
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  Result<gpu::Buffer> a = gpu::create_buffer(device, "a", bytes, kUsage, gpu::MemoryKind::readback);
  Result<gpu::Buffer> b = gpu::create_buffer(device, "b", bytes + 8, kUsage, gpu::MemoryKind::readback);
  ASSERT_OK(a);
  ASSERT_OK(b);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    EXPECT_TRUE(cpp_->record_save_tables(cmd, a.value().buffer.get()).ok());
    EXPECT_SUCCESS(tyndall_effect_record_save_tables(c_.get(), cmd, b.value().buffer.get(), 8));
    return {};
  }));
  const auto* saved_a = static_cast<const char*>(a.value().mapped);
  const auto* saved_b = static_cast<const char*>(b.value().mapped) + 8;
  EXPECT_TRUE(std::equal(saved_a, saved_a + bytes, saved_b));
  TyndallEffect* made = nullptr;
  const TyndallDeviceInfo c_info = c_device(info());
  const TyndallEffectDesc desc = c_desc(desc_of_tests());
  ASSERT_SUCCESS(tyndall_effect_create(&c_info, &desc, c_params().get(), &made));
  const OwnedEffect loaded(made);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    EXPECT_SUCCESS(tyndall_effect_record_load_tables(made, cmd, b.value().buffer.get(), 8));
    return {};
  }));
  TyndallProgress progress = {};
  ASSERT_SUCCESS(tyndall_effect_precompute_progress(made, &progress));
  EXPECT_EQ(progress.done, progress.total);
}

TEST_F(CEffect, SkyProbesAreThoseOfCpp) {
  TyndallSkyProbeInputs inputs = {};
  ASSERT_SUCCESS(tyndall_sky_probe_inputs_defaults(&inputs, sizeof inputs));
  EXPECT_EQ(inputs.up[1], 1.0F);
  inputs.altitude_m = 250.0F;
  inputs.sun = {{0.6F, 0.0F, 0.8F}, {1.0F, 2.0F, 3.0F}, 0.01F};
  std::swap(inputs.up[1], inputs.up[2]);
  SkyProbeInputs cpp_inputs;
  cpp_inputs.up = {0.0F, 0.0F, 1.0F};
  cpp_inputs.altitude_m = 250.0F;
  cpp_inputs.sun = {{0.6F, 0.0F, 0.8F}, {1.0F, 2.0F, 3.0F}, 0.01F};
  TyndallSkyProbe* made = nullptr;
  ASSERT_SUCCESS(tyndall_sky_probe_create(c_.get(), 2, &made));
  const std::unique_ptr<TyndallSkyProbe, void (*)(TyndallSkyProbe*)> c(made, tyndall_sky_probe_destroy);
  Result<SkyProbe> cpp = SkyProbe::create(*cpp_, 2);
  ASSERT_OK(cpp);
  auto from = sized<TyndallSkyCoefficients>();
  ASSERT_SUCCESS(tyndall_sky_probe_coefficients(c.get(), &from));
  Result<gpu::Buffer> read = gpu::create_buffer(host().device(), "read", 2 * from.size,
                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback);
  ASSERT_OK(read);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    TyndallProgress progress = {};
    EXPECT_SUCCESS(tyndall_sky_probe_record(c.get(), cmd, &inputs, UINT32_MAX, &progress));
    EXPECT_EQ(progress.done, progress.total);
    EXPECT_TRUE(cpp.value().record(cmd, cpp_inputs).ok());
    gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy regions[2] = {{from.offset, 0, from.size}, {0, from.size, from.size}};
    host().device().vk.CmdCopyBuffer(cmd, from.buffer, read.value().buffer.get(), 1, &regions[0]);
    host().device().vk.CmdCopyBuffer(cmd, cpp.value().coefficients().buffer, read.value().buffer.get(), 1, &regions[1]);
    return {};
  }));
  const auto* values = static_cast<const float*>(read.value().mapped);
  EXPECT_EQ(std::memcmp(values, values + 36, 144), 0);
  EXPECT_GT(values[0], 0.0F);
  auto memory = sized<TyndallMemoryUsage>(), queried = memory;
  const TyndallDeviceInfo device = c_device(info());
  ASSERT_SUCCESS(tyndall_sky_probe_memory(c.get(), &memory));
  ASSERT_SUCCESS(tyndall_sky_probe_query_memory(&device, 2, &queried));
  EXPECT_EQ(memory.persistent, queried.persistent);
  EXPECT_EQ(memory.host, queried.host);
  auto cube = sized<TyndallSkyCube>();
  ASSERT_SUCCESS(tyndall_sky_probe_cube(c.get(), &cube));
  EXPECT_EQ(cube.view, VK_NULL_HANDLE);
  inputs.altitude_m = -1.0e7F;
  EXPECT_EQ(tyndall_sky_probe_record(c.get(), reinterpret_cast<VkCommandBuffer>(1), &inputs, 1, nullptr),
            TyndallStatus_invalid_argument);
  EXPECT_EQ(tyndall_sky_probe_record(nullptr, nullptr, &inputs, 1, nullptr), TyndallStatus_invalid_argument);
  EXPECT_EQ(tyndall_sky_probe_create(c_.get(), 0, &made), TyndallStatus_invalid_argument);
  tyndall_sky_probe_destroy(nullptr);
}

TEST_F(CEffect, SkyProbesHaveCubeMaps) {
  TyndallSkyProbeDesc desc = {};
  ASSERT_SUCCESS(tyndall_sky_probe_desc_defaults(&desc, sizeof desc));
  EXPECT_EQ(desc.frames_in_flight, SkyProbeDesc().frames_in_flight);
  EXPECT_EQ(desc.cube_size, 0U);
  desc.cube_size = 32;
  TyndallSkyProbe* made = nullptr;
  ASSERT_SUCCESS(tyndall_sky_probe_create_with(c_.get(), &desc, &made));
  const std::unique_ptr<TyndallSkyProbe, void (*)(TyndallSkyProbe*)> probe(made, tyndall_sky_probe_destroy);
  auto cube = sized<TyndallSkyCube>();
  ASSERT_SUCCESS(tyndall_sky_probe_cube(probe.get(), &cube));
  EXPECT_NE(cube.image, VK_NULL_HANDLE);
  EXPECT_NE(cube.view, VK_NULL_HANDLE);
  EXPECT_NE(cube.sampler, VK_NULL_HANDLE);
  EXPECT_EQ(cube.size, 32U);
  EXPECT_EQ(cube.levels, 6U);
  auto memory = sized<TyndallMemoryUsage>(), queried = memory;
  const TyndallDeviceInfo device = c_device(info());
  ASSERT_SUCCESS(tyndall_sky_probe_memory(probe.get(), &memory));
  ASSERT_SUCCESS(tyndall_sky_probe_query_memory_with(&device, &desc, &queried));
  EXPECT_EQ(memory.persistent, queried.persistent);
  desc.cube_size = 33;
  EXPECT_EQ(tyndall_sky_probe_create_with(c_.get(), &desc, &made), TyndallStatus_invalid_argument);
  EXPECT_EQ(tyndall_sky_probe_query_memory_with(&device, &desc, &queried), TyndallStatus_invalid_argument);
}

}  // namespace
}  // namespace tyndall
