// Creation of an effect whose pipelines several threads create. A test of its own, because it is part of the short run
// with the thread sanitizer.
#include <stdexcept>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

class PipelineThreads : public GpuTest {};

// Several threads create the same pipelines as one, and their errors are errors of create().
TEST_F(PipelineThreads, CreateTheSamePipelinesAsOneThread) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  Params params = with_technique(Technique::epipolar);
  params.scattering.single = SingleScattering::integration;  // needs no tables
  params.scattering.multiple = MultipleScattering::none;
  EffectDesc desc = desc_for(frame);
  std::vector<std::byte> bytes[2];
  std::uint32_t created[2] = {};
  for (int i = 0; i < 2; ++i) {
    desc.pipeline_threads = i == 0 ? 1 : 4;
    Result<Effect> effect = Effect::create(info(), desc, params);
    ASSERT_OK(effect);
    created[i] = effect.value().prepare_pipelines(0).value().done;
    ASSERT_OK(
        host().run([&](VkCommandBuffer cmd) { return effect.value().record(cmd, images.value().inputs(frame)); }));
    Result<std::vector<std::byte>> output = images.value().output_bytes(host());
    ASSERT_OK(output);
    bytes[i] = output.value();
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(created[0], created[1]);
  DeviceInfo failing = info();
  failing.replace_shader = [](void*, std::string_view) -> std::span<const std::uint32_t> {
    throw std::runtime_error("no shader");
  };
  const Result<Effect> failed = Effect::create(failing, desc, params);
  ASSERT_FALSE(failed.ok());
  EXPECT_NE(failed.error().message.find("threw an exception"), std::string::npos) << failed.error().message;
  // A shader that does not write the output.
  failing.replace_shader = [](void*, std::string_view name) -> std::span<const std::uint32_t> {
    static constexpr std::uint32_t kEmpty[] = {0x07230203, 0x00010500, 0, 1, 0};
    return name == "unwarp_comp" ? std::span(kEmpty) : std::span<const std::uint32_t>();
  };
  const Result<Effect> without_output = Effect::create(failing, desc, params);
  ASSERT_FALSE(without_output.ok());
  EXPECT_NE(without_output.error().message.find("the shader unwarp_comp has no image at binding 5"), std::string::npos)
      << without_output.error().message;
  for (const std::uint32_t threads : {0U, 65U}) {
    desc.pipeline_threads = threads;
    EXPECT_FALSE(Effect::create(info(), desc, params).ok()) << threads;
  }
}

}  // namespace
}  // namespace tyndall
