// Several pictures in one frame, and recordings that would overwrite each other's constants.
#include <optional>
#include <string>
#include <vector>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

class EffectViews : public GpuTest {
 protected:
  static Params light_params() {
    Params params = precise_params();
    params.scattering.technique = Technique::epipolar;
    params.scattering.integration_steps = 12;
    return params;
  }
  // Creates an effect whose messages are collected in texts_.
  Result<Effect> create(const EffectDesc& desc) {
    DeviceInfo device = info();
    device.message = [](void* user, Severity, std::string_view text) {
      static_cast<std::vector<std::string>*>(user)->emplace_back(text);
    };
    device.message_user = &texts_;
    return Effect::create(device, desc, light_params());
  }
  std::vector<std::string> texts_;
};

TestFrame left_eye() { return small_frame(); }
TestFrame right_eye() {
  TestFrame frame = small_frame();
  frame.view = TestView::at(2500.0, 0.9, -0.1, 0.8);
  return frame;
}

TEST_F(EffectViews, EqualThePicturesOfSingleViews) {
  EffectDesc desc = desc_for(left_eye());
  desc.views = 2;
  desc.timings = true;
  desc.counters = true;
  Result<Effect> effect = create(desc);
  ASSERT_OK(effect);
  const Result<MemoryUsage> planned = query_memory(info(), desc, light_params());
  ASSERT_OK(planned);
  EXPECT_EQ(planned.value().host, effect.value().memory().host);
  std::vector<FrameImages> images;
  std::vector<std::vector<std::byte>> alone;
  const TestFrame frames[2] = {left_eye(), right_eye()};
  for (const TestFrame& frame : frames) {
    Result<FrameImages> made = FrameImages::create(host(), frame, OutputFormat::rgba32f);
    ASSERT_OK(made);
    const FrameInputs inputs = made.value().inputs(frame);
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return effect.value().record(cmd, inputs); }));
    Result<std::vector<std::byte>> bytes = made.value().output_bytes(host());
    ASSERT_OK(bytes);
    alone.push_back(std::move(bytes).value());
    Result<FrameImages> fresh = FrameImages::create(host(), frame, OutputFormat::rgba32f);
    ASSERT_OK(fresh);
    images.push_back(std::move(fresh).value());
  }
  ASSERT_NE(alone[0], alone[1]);
  // Record both frames into one command buffer, so that neither has run when the other is recorded.
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    FrameInputs inputs = images[0].inputs(frames[0]);
    inputs.frame_index = 7;
    Result<void> recorded = effect.value().record(cmd, inputs);
    if (!recorded.ok()) return recorded;
    inputs = images[1].inputs(frames[1]);
    inputs.frame_index = 7;
    inputs.view = 1;
    return effect.value().record(cmd, inputs);
  }));
  for (std::size_t i = 0; i < 2; ++i) {
    const Result<std::vector<std::byte>> bytes = images[i].output_bytes(host());
    ASSERT_OK(bytes);
    EXPECT_EQ(bytes.value(), alone[i]) << i;
    const auto view = static_cast<std::uint32_t>(i);
    EXPECT_GT(effect.value().counters(7, view).samples_marched, 0U) << i;
    EXPECT_GT(effect.value().timings(7, view).size(), 1U) << i;
  }
  EXPECT_EQ(effect.value().counters(7, 2).samples_marched, 0U);
  EXPECT_TRUE(effect.value().timings(7, 2).empty());
  EXPECT_EQ(texts_, std::vector<std::string>());
}

TEST_F(EffectViews, TheSameFrameTwiceIsAnErrorUntilItHasCompleted) {
  const TestFrame frame = left_eye();
  Result<Effect> effect = create(desc_for(frame));
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(effect);
  ASSERT_OK(images);
  FrameInputs inputs = images.value().inputs(frame);
  Result<void> first, second;
  const auto record_both = [&](std::uint64_t first_index, std::uint64_t second_index) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      inputs.frame_index = first_index;
      first = effect.value().record(cmd, inputs);
      inputs.frame_index = second_index;
      second = effect.value().record(cmd, inputs);
      return {};
    }));
  };
  record_both(4, 4);
  EXPECT_OK(first);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::invalid_argument);
  for (const char* word : {"frame_index 4", "view 0", "not completed", "EffectDesc::views"}) {
    EXPECT_NE(second.error().message.find(word), std::string::npos) << second.error().message;
  }
  // The host has waited, so the slot is free for any frame index.
  record_both(4, 5);
  EXPECT_OK(first);
  EXPECT_OK(second);
  record_both(0, 1);
  EXPECT_OK(first);
  EXPECT_OK(second);
  EXPECT_EQ(texts_, std::vector<std::string>());
  // More frames are in flight than frames_in_flight, 2.
  record_both(6, 8);
  EXPECT_OK(first);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::invalid_argument);
  for (const char* word : {"frame_index 8", "frame 6", "frames_in_flight (2)"}) {
    EXPECT_NE(second.error().message.find(word), std::string::npos) << second.error().message;
  }
  record_both(8, 9);
  EXPECT_OK(first);
  EXPECT_OK(second);
  EXPECT_EQ(texts_, std::vector<std::string>());
}

TEST_F(EffectViews, NumbersOutOfRangeAreRefused) {
  EffectDesc desc = desc_for(left_eye());
  for (const std::uint32_t views : {0U, kMaxViews + 1}) {
    desc.views = views;
    const Result<Effect> effect = create(desc);
    ASSERT_FALSE(effect.ok());
    EXPECT_NE(effect.error().message.find("EffectDesc::views"), std::string::npos);
    EXPECT_FALSE(query_memory(info(), desc).ok());
  }
}

}  // namespace
}  // namespace tyndall
