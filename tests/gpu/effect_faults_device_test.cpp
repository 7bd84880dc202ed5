// After failures on a real device, the picture is unchanged byte for byte.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "gpu_test.hpp"
#include "small_effect.hpp"

namespace tyndall {
namespace {

using faults::Kind;

class EffectFaultsOnDevice : public GpuTest {
 protected:
  void build(Effect& effect) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect.record_precompute(cmd);
      if (!built) return built.error();
      return {};
    }));
  }
  std::vector<std::byte> draw(Effect& effect, FrameImages& images, const TestFrame& frame) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) { return effect.record(cmd, images.inputs(frame)); }));
    Result<std::vector<std::byte>> bytes = images.output_bytes(host());
    EXPECT_OK(bytes);
    return bytes ? std::move(bytes).value() : std::vector<std::byte>();
  }
  // Fails every fifth call, which includes every kind of call and nearly every object. The fake device covers the
  // others.
  template <typename Change>
  long refuse_everywhere(Effect& effect, FrameImages& images, const TestFrame& frame, const Change& change) {
    const std::vector<std::byte> before = draw(effect, images, frame);
    const MemoryUsage memory = effect.memory();
    const Progress progress = effect.precompute_progress();
    for (long n = 0; n < 300; n += 5) {
      faults::arm(Kind::vulkan, n);
      const Result<void> refused = change(effect);
      const bool failed = faults::disarm();
      EXPECT_EQ(refused.ok(), !failed) << n;
      if (!failed) return n;
      EXPECT_EQ(draw(effect, images, frame), before) << n;
      EXPECT_EQ(effect.memory().persistent, memory.persistent) << n;
      EXPECT_EQ(effect.precompute_progress().done, progress.done) << n;
      EXPECT_EQ(effect.precompute_progress().total, progress.total) << n;
    }
    return -1;
  }
};

TEST_F(EffectFaultsOnDevice, ThePictureIsUnchanged) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  DeviceInfo device = info();
  device.get_instance_proc_addr = faults::get_instance_proc_addr;
  // Creating pipelines takes most of the time. With many slices and without downscaling, few are needed.
  Params params = small_params();
  params.epipolar.slices = 512;
  Params others = other_params();
  others.epipolar.slices = 600;
  others.scattering.downscale = 1;
  others.scattering.multiple = params.scattering.multiple;
  Result<Effect> made = Effect::create(device, desc_for(frame), params);
  ASSERT_OK(made);
  Effect effect = std::move(made).value();
  build(effect);
  // Creates the pipelines first, so that the failures below are those of buffers and images. No tables are built.
  ASSERT_OK(effect.set_params(others));
  ASSERT_OK(effect.set_params(params));
  const std::vector<std::byte> first = draw(effect, images.value(), frame);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame, [&](Effect& e) { return e.set_params(others); }), 50);
  build(effect);
  const std::vector<std::byte> other = draw(effect, images.value(), frame);
  EXPECT_NE(other, first);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame,
                              [](Effect& e) {
                                return e.set_limits({200, 100}, 4, 200);
                              }),
            10);
  EXPECT_EQ(draw(effect, images.value(), frame), other);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame, [](Effect& e) { return e.set_shadow_colors(true); }), 1);
  EXPECT_EQ(draw(effect, images.value(), frame), other);
}

// An effect is destroyed after commands were recorded, before and after they have run.
TEST_F(EffectFaultsOnDevice, DestroyingInFlightIsReported) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  std::vector<std::string> said;
  DeviceInfo device = info();
  device.message_user = &said;
  device.message = [](void* user, Severity, std::string_view text) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(text);
  };
  Params params = with_technique(Technique::brute_force);
  params.tables.size = {4, 8, 8, 4};
  EffectDesc desc = desc_for(frame);
  desc.check_inputs = true;
  Result<Effect> made = Effect::create(device, desc, params);
  ASSERT_OK(made);
  std::optional<Effect> effect(std::move(made).value());
  const auto reports = [&] {
    return std::count_if(said.begin(), said.end(),
                         [](const std::string& s) { return s.find("is destroyed") != std::string::npos; });
  };
  draw(*effect, images.value(), frame);
  FrameInputs inputs = images.value().inputs(frame);
  inputs.frame_index = 1;
  Result<void> recorded;
  // The commands are recorded but not submitted, because `record` returns an error.
  EXPECT_FALSE(host()
                   .run([&](VkCommandBuffer cmd) -> Result<void> {
                     recorded = effect->record(cmd, inputs);
                     return Error{ErrorCode::invalid_argument, "not submitted"};
                   })
                   .ok());
  ASSERT_OK(recorded);
  effect.reset();
  EXPECT_EQ(reports(), 1);
  made = Effect::create(device, desc, params);
  ASSERT_OK(made);
  effect.emplace(std::move(made).value());
  draw(*effect, images.value(), frame);
  effect.reset();
  EXPECT_EQ(reports(), 1);
}

}  // namespace
}  // namespace tyndall
