// Several effects that share one set of tables (EffectDesc::tables_of): pictures, memory, lifetimes, and parameters
// that disagree. The lifetimes are those of a fake device, on which commands complete at once.
#include <memory>
#include <optional>
#include <string>

#include "c_structures.hpp"
#include "small_effect.hpp"

namespace tyndall {
namespace {

EffectDesc desc_sharing(const Effect& other, EffectDesc desc = small_desc()) {
  desc.tables_of = &other;
  return desc;
}

Effect make_sharing(const Effect& other, const Params& params = small_params()) {
  Result<Effect> made = Effect::create(faults::fake_device(), desc_sharing(other), params);
  EXPECT_OK(made);
  return std::move(made).value();
}

Result<void> draw(Effect& effect, std::uint64_t frame) {
  FrameInputs inputs = fake_frame();
  inputs.frame_index = frame;
  return effect.record(kCommands, inputs);
}

Params other_air() {
  Params params = small_params();
  params.atmosphere.aerosol_density = 2.0F;
  return params;
}

template <typename T>
void expect_error(const Result<T>& result, const char* text) {
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find(text), std::string::npos) << result.error().message;
}

TEST(EffectSharing, MemoryIsCountedOnce) {
  std::optional<Effect> first = make(Built::completely);
  const MemoryUsage alone = first->memory();
  const Result<MemoryUsage> query = query_memory(faults::fake_device(), desc_sharing(*first), small_params());
  ASSERT_OK(query);
  Effect second = make_sharing(*first);
  EXPECT_EQ(second.memory().persistent, query.value().persistent);
  EXPECT_EQ(second.memory().transient, 0U);
  EXPECT_EQ(query.value().transient, 0U);
  EXPECT_EQ(second.memory().host, query.value().host);
  EXPECT_EQ(first->memory().persistent, alone.persistent);
  VkDeviceSize tables = 0;
  for (const ResourceMemory& row : first->resources()) tables += row.bytes;
  for (const ResourceMemory& row : second.resources()) tables -= row.bytes;
  EXPECT_EQ(tables, alone.persistent - query.value().persistent);
  EXPECT_GT(tables, 0U);
  EXPECT_EQ(second.light_tables().sun_transmittance, first->light_tables().sun_transmittance);
  EXPECT_EQ(second.desc().tables_of, nullptr);
  // The tables outlive the effect that made them, and then belong to the other.
  const auto view = reinterpret_cast<std::uint64_t>(second.scattering_tables().high_orders.view);
  const std::size_t objects = faults::live_objects();
  first.reset();
  EXPECT_LT(faults::live_objects(), objects);
  EXPECT_TRUE(faults::is_live(view));
  EXPECT_EQ(second.memory().persistent, alone.persistent);
  EXPECT_OK(draw(second, 0));
}

TEST(EffectSharing, NothingIsLeft) {
  {
    std::optional<Effect> first = make(Built::in_part);
    Effect second = make_sharing(*first);
    Effect third = make_sharing(second);
    first.reset();
    EXPECT_FALSE(third.precompute_progress().complete());
    EXPECT_OK(third.record_precompute(kCommands));
    EXPECT_TRUE(second.precompute_progress().complete());
    EXPECT_OK(draw(second, 0));
    EXPECT_OK(draw(third, 0));
  }
  EXPECT_EQ(faults::live_objects(), 0U);
}

TEST(EffectSharing, ParametersThatDisagreeAreRefused) {
  Effect first = make(Built::completely);
  expect_error(Effect::create(faults::fake_device(), desc_sharing(first), other_air()),
               "need other tables than those of EffectDesc::tables_of");
  Params params = small_params();
  params.scattering.color = ColorMode::spectral;
  expect_error(Effect::create(faults::fake_device(), desc_sharing(first), params), "scattering.color");
  params = small_params();
  params.scattering.technique = Technique::brute_force;
  params.scattering.scale = 3.0F;
  EXPECT_OK(Effect::create(faults::fake_device(), desc_sharing(first), params));
  DeviceInfo other_device = faults::fake_device();
  other_device.device = number<VkDevice>(4711);
  expect_error(Effect::create(other_device, desc_sharing(first), small_params()), "another VkDevice");
  const Effect moved = std::move(first);
  expect_error(Effect::create(faults::fake_device(), desc_sharing(first), small_params()),  // NOLINT
               "has been moved from");
}

// Either effect may begin a build, and either may record its slices.
TEST(EffectSharing, OneBuildServesAll) {
  Effect first = make(Built::completely);
  Effect second = make_sharing(first);
  const VkImageView before = second.light_tables().sun_transmittance;
  ASSERT_OK(second.set_params(other_air()));
  EXPECT_FALSE(first.precompute_progress().complete());
  std::uint64_t frame = 4;
  EXPECT_OK(draw(first, frame));  // the old tables are still in use
  EXPECT_OK(draw(second, frame++));
  ASSERT_OK(first.record_precompute(kCommands, 3));
  ASSERT_OK(second.record_precompute(kCommands, 2));
  EXPECT_EQ(first.precompute_progress().done, 5U);
  ASSERT_OK(first.set_params(other_air()));
  EXPECT_EQ(second.precompute_progress().done, 5U) << "the build goes on";
  ASSERT_OK(first.record_precompute(kCommands));
  EXPECT_TRUE(second.precompute_progress().complete());
  EXPECT_NE(second.light_tables().sun_transmittance, before);
  EXPECT_EQ(affected(table_params(second), other_air()), 0U);
  EXPECT_OK(draw(first, frame));
  EXPECT_OK(draw(second, frame));
}

TEST(EffectSharing, TablesForOtherParametersAreAnErrorOfTheFrame) {
  Effect first = make(Built::completely);
  Effect second = make_sharing(first);
  ASSERT_OK(first.set_params(other_air()));
  EXPECT_OK(draw(second, 0));
  ASSERT_OK(first.record_precompute(kCommands));
  EXPECT_OK(draw(first, 4));
  expect_error(draw(second, 1), "expected set_params() with the same of each effect");
  ASSERT_OK(second.set_params(other_air()));
  EXPECT_OK(draw(second, 1));
  // The other way round: the second effect takes the tables back, and the first is refused.
  ASSERT_OK(second.set_params(small_params()));
  ASSERT_OK(second.record_precompute(kCommands));
  expect_error(draw(first, 5), "expected set_params() with the same of each effect");
  EXPECT_OK(draw(second, 2));
}

// table_key() and table_bytes() follow from the parameters of an effect, which are not always those of the tables.
TEST(EffectSharing, TablesAreSavedAndLoadedWithTheirOwnParametersOnly) {
  Effect first = make(Built::completely);
  Effect second = make_sharing(first);
  const auto buffer = number<VkBuffer>(99);
  ASSERT_OK(second.record_save_tables(kCommands, buffer));
  ASSERT_OK(first.set_params(other_air()));
  const char* const text = "expected set_params() with the same of each effect";
  expect_error(second.record_load_tables(kCommands, buffer), text);
  EXPECT_FALSE(first.precompute_progress().complete());
  ASSERT_OK(first.record_precompute(kCommands));
  expect_error(second.record_save_tables(kCommands, buffer), text);
  EXPECT_OK(first.record_save_tables(kCommands, buffer));
  ASSERT_OK(second.set_params(other_air()));
  EXPECT_OK(second.record_save_tables(kCommands, buffer));
}

// Old tables are freed after frames of both effects. (The commands of the fake device have completed at once.)
TEST(EffectSharing, OldTablesLastUntilNoFrameOfAnyEffectReadsThem) {
  Effect first = make(Built::completely);
  Effect second = make_sharing(first);
  EXPECT_OK(draw(second, 0));
  const auto old = reinterpret_cast<std::uint64_t>(second.light_tables().sky_irradiance);
  ASSERT_OK(first.set_params(other_air()));
  ASSERT_OK(second.set_params(other_air()));
  ASSERT_OK(first.record_precompute(kCommands));
  ASSERT_NE(reinterpret_cast<std::uint64_t>(second.light_tables().sky_irradiance), old);
  int rounds = 0;
  for (std::uint64_t frame = 4; frame < 20 && faults::is_live(old); ++frame, ++rounds) {
    EXPECT_OK(draw(first, frame));
    EXPECT_OK(draw(second, frame - 3));
  }
  EXPECT_FALSE(faults::is_live(old));
  EXPECT_GE(rounds, 2);
  EXPECT_LE(rounds, 5);
  EXPECT_EQ(first.memory().transient, 0U);
}

// Each allocation of an effect that shares tables fails once. The others stay as they were.
TEST(EffectSharing, FailuresChangeNothing) {
  for (const faults::Kind kind : {faults::Kind::vulkan, faults::Kind::host}) {
    long n = 0;
    for (;; ++n) {
      ASSERT_LT(n, 1000);
      Effect first = make(Built::completely);
      const Observed before = observe(first);
      const EffectDesc desc = desc_sharing(first);
      faults::arm(kind, n);
      const Result<Effect> made = Effect::create(faults::fake_device(), desc, small_params());
      const bool failed = faults::disarm();
      ASSERT_EQ(made.ok(), !failed) << n;
      if (!failed) break;
      expect_same(before, observe(first), std::to_string(n));
    }
    EXPECT_GT(n, 5);
  }
}

// A frame in two parts reads the tables in both, so nobody may change them in between.
TEST(EffectSharing, NobodyChangesTablesBetweenThePartsOfAFrame) {
  Effect first = make(Built::completely);
  Effect second = make_sharing(first);
  FrameInputs inputs = fake_frame();
  inputs.frame_index = 4;
  ASSERT_OK(first.record(kCommands, inputs, FramePart::first));
  expect_error(second.set_params(other_air()), "expected FramePart::second or drop before this call");
  expect_error(second.record_precompute(kCommands), "expected FramePart::second or drop before this call");
  ASSERT_OK(first.record(kCommands, inputs, FramePart::second));
  EXPECT_OK(second.set_params(other_air()));
}

// In C, the callbacks of the effect that made the tables stay valid.
TEST(EffectSharing, C) {
  TyndallDeviceInfo device = c_device(faults::fake_device());
  TyndallEffectDesc desc = c_desc(small_desc());
  TyndallEffect* first = nullptr;
  ASSERT_SUCCESS(tyndall_effect_create(&device, &desc, nullptr, &first));
  EXPECT_EQ(desc.tables_of, nullptr);
  desc.tables_of = first;
  auto query = sized<TyndallMemoryUsage>(), memory = query, alone = query;
  ASSERT_SUCCESS(tyndall_query_memory(&device, &desc, nullptr, &query));
  ASSERT_SUCCESS(tyndall_effect_memory(first, &alone));
  TyndallEffect* made = nullptr;
  ASSERT_SUCCESS(tyndall_effect_create(&device, &desc, nullptr, &made));
  const OwnedEffect second(made);
  ASSERT_SUCCESS(tyndall_effect_memory(made, &memory));
  EXPECT_EQ(memory.persistent, query.persistent);
  EXPECT_LT(memory.persistent, alone.persistent);
  tyndall_effect_destroy(first);
  TyndallProgress progress = {};
  ASSERT_SUCCESS(tyndall_effect_record_precompute(made, kCommands, UINT32_MAX, &progress));
  EXPECT_EQ(progress.done, progress.total);
}

// On a device: the effect that shares the tables draws the same picture, with the validation layer.
class GpuEffectSharing : public GpuTest {};

TEST_F(GpuEffectSharing, PicturesAreTheSame) {
  const TestFrame frame = small_frame();
  Params params;
  params.tables.size = {8, 32, 16, 8};
  params.tables.orders = 2;
  EffectDesc desc = desc_for(frame);
  Result<Effect> made = Effect::create(info(), desc, params);
  ASSERT_OK(made);
  std::optional<Effect> first = std::move(made).value();
  desc.tables_of = &*first;
  Result<Effect> sharing = Effect::create(info(), desc, params);
  ASSERT_OK(sharing);
  Effect second = std::move(sharing).value();
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> built = second.record_precompute(cmd);
    return built.ok() ? Result<void>() : built.error();
  }));
  const Result<std::vector<glm::dvec3>> a = render(host(), *first, frame), b = render(host(), second, frame);
  ASSERT_OK(a);
  ASSERT_OK(b);
  EXPECT_EQ(a.value(), b.value());
  // Both in one submission, while the tables are built again, and after the first effect is gone.
  params.atmosphere.aerosol_density = 3.0F;
  ASSERT_OK(first->set_params(params));
  ASSERT_OK(second.set_params(params));
  Result<FrameImages> one = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  Result<FrameImages> other = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(one);
  ASSERT_OK(other);
  for (std::uint64_t i = 8; i < 14; ++i) {
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = (i % 2 == 0 ? *first : second).record_precompute(cmd, i < 12 ? 20 : UINT32_MAX);
      if (!built.ok()) return built.error();
      FrameInputs inputs = one.value().inputs(frame);
      inputs.frame_index = i;
      Result<void> drawn = first->record(cmd, inputs);
      if (!drawn.ok()) return drawn;
      inputs = other.value().inputs(frame);
      inputs.frame_index = i;
      return second.record(cmd, inputs);
    }));
  }
  first.reset();
  const Result<std::vector<glm::dvec3>> hazy = render(host(), second, frame);
  desc.tables_of = nullptr;
  Result<Effect> lone = Effect::create(info(), desc, params);
  ASSERT_OK(lone);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> built = lone.value().record_precompute(cmd);
    return built.ok() ? Result<void>() : built.error();
  }));
  const Result<std::vector<glm::dvec3>> alone = render(host(), lone.value(), frame);
  ASSERT_OK(hazy);
  ASSERT_OK(alone);
  EXPECT_EQ(hazy.value(), alone.value());
  EXPECT_NE(hazy.value(), b.value());
}

}  // namespace
}  // namespace tyndall
