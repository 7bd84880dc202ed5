// A frame that is recorded in two parts: its picture is that of the whole frame, byte for byte, and calls that would
// not fit between the parts are refused and change nothing.
#include <functional>
#include <string>
#include <vector>

#include "small_effect.hpp"

namespace tyndall {
namespace {

class EffectParts : public GpuTest {};

struct Mode {
  const char* name;
  std::function<void(Params&)> set;
};
const Mode kModes[] = {
    {"default", [](Params&) {}},
    {"multi-pass", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass; }},
    {"instanced", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced; }},
    {"without tree", [](Params& p) { p.epipolar.min_max_tree = false; }},
    {"downscaled", [](Params& p) { p.scattering.downscale = 2; }},
    {"with froxels", [](Params& p) { p.froxels.enabled = true; }},
    {"froxels", [](Params& p) { p.scattering.technique = Technique::froxels; }},
    {"brute force", [](Params& p) { p.scattering.technique = Technique::brute_force; }},
    {"homogeneous", [](Params& p) { p.scattering.medium = MediumKind::homogeneous; }},
    {"spectral", [](Params& p) { p.scattering.color = ColorMode::spectral; }},
    {"disabled", [](Params& p) { p.scattering.enabled = false; }},
};

Params params_of(const Mode& mode) {
  Params params = precise_params();
  params.scattering.technique = Technique::epipolar;
  params.scattering.integration_steps = 12;
  params.epipolar.slices = params.epipolar.samples = 64;
  params.froxels.columns = params.froxels.rows = params.froxels.slices = 16;
  mode.set(params);
  return params;
}

// The shadow maps are drawn between the parts: before, they hold other depths.
TEST_F(EffectParts, ThePictureIsThatOfTheWholeFrame) {
  const TestFrame frame = small_frame();
  TestFrame before = frame;
  before.shadow_depth = [](std::uint32_t, double u, double) { return u < 0.5 ? 1.0F : 0.0F; };
  EffectDesc desc = desc_for(frame);
  desc.timings = desc.counters = true;
  Result<Effect> effect = Effect::create(info(), desc, params_of(kModes[0]));
  ASSERT_OK(effect);
  std::uint64_t frame_index = 0;
  enum Way { whole, one_buffer, two_buffers, shadows_between, kWays };
  for (const Mode& mode : kModes) {
    SCOPED_TRACE(mode.name);
    ASSERT_OK(effect.value().set_params(params_of(mode)));
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect.value().record_precompute(cmd);
      return built.ok() ? Result<void>() : built.error();
    }));
    std::vector<std::byte> pictures[kWays];
    std::size_t passes = 0;
    std::uint64_t steps = 0;
    for (int way = 0; way < kWays; ++way) {
      SCOPED_TRACE(way);
      Result<FrameImages> images =
          FrameImages::create(host(), way == shadows_between ? before : frame, OutputFormat::rgba32f);
      ASSERT_OK(images);
      FrameInputs inputs = images.value().inputs(frame);
      inputs.frame_index = ++frame_index;
      const auto record = [&](FramePart part) {
        return [&, part](VkCommandBuffer cmd) { return effect.value().record(cmd, inputs, part); };
      };
      if (way == whole) {
        ASSERT_OK(host().run(record(FramePart::whole)));
      } else if (way == one_buffer) {
        ASSERT_OK(host().run([&](VkCommandBuffer cmd) {
          const Result<void> first = record(FramePart::first)(cmd);
          return first.ok() ? record(FramePart::second)(cmd) : first;
        }));
      } else {
        ASSERT_OK(host().submit(record(FramePart::first)));
        if (way == shadows_between) ASSERT_OK(images.value().draw_shadows(host(), frame));
        ASSERT_OK(host().run(record(FramePart::second)));
      }
      Result<std::vector<std::byte>> bytes = images.value().output_bytes(host());
      ASSERT_OK(bytes);
      pictures[way] = std::move(bytes).value();
      EXPECT_TRUE(pictures[way] == pictures[whole]);
      const std::size_t timed = effect.value().timings(frame_index).size();
      const std::uint64_t counted = effect.value().counters(frame_index).march_steps;
      if (way == whole) {
        passes = timed;
        steps = counted;
      }
      // On GPUs there is one more entry "effect".
      EXPECT_GE(timed, passes);
      EXPECT_LE(timed, passes + 1);
      EXPECT_EQ(counted, steps);
    }
  }
}

// An engine that loses its images between the parts drops the frame: the output stays as it is, and later frames, also
// one with the same number, have the usual picture. The second part of a dropped frame is an error.
TEST_F(EffectParts, AFrameCanBeDroppedAfterItsFirstPart) {
  const TestFrame frame = small_frame();
  TestFrame other = frame;
  other.view = TestView::at(2500.0, 0.9, -0.1, 0.8);
  EffectDesc desc = desc_for(frame);
  desc.frames_in_flight = 1;
  desc.counters = true;
  Result<Effect> effect = Effect::create(info(), desc, params_of(kModes[0]));
  ASSERT_OK(effect);
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  Result<FrameImages> dropped = FrameImages::create(host(), other, OutputFormat::rgba32f);
  ASSERT_OK(images);
  ASSERT_OK(dropped);
  const auto draw = [&](FrameImages& to, const TestFrame& what, std::uint64_t frame_index, FramePart part) {
    FrameInputs inputs = to.inputs(what);
    inputs.frame_index = frame_index;
    return host().run([&](VkCommandBuffer cmd) { return effect.value().record(cmd, inputs, part); });
  };
  const auto picture = [&](FrameImages& of) {
    Result<std::vector<std::byte>> bytes = of.output_bytes(host());
    return bytes.ok() ? std::move(bytes).value() : std::vector<std::byte>();
  };
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> built = effect.value().record_precompute(cmd);
    return built.ok() ? Result<void>() : built.error();
  }));
  ASSERT_OK(draw(images.value(), frame, 0, FramePart::whole));
  const std::vector<std::byte> expected = picture(images.value());
  const std::vector<std::byte> before = picture(dropped.value());
  EXPECT_GT(effect.value().counters(0).samples_marched, 0U);

  ASSERT_OK(draw(dropped.value(), other, 1, FramePart::first));
  FrameInputs lost;  // no image is left
  lost.frame_index = 1;
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return effect.value().record(cmd, lost, FramePart::drop); }));
  EXPECT_TRUE(picture(dropped.value()) == before);
  EXPECT_EQ(effect.value().counters(1).samples_marched, 0U);
  EXPECT_FALSE(draw(dropped.value(), other, 1, FramePart::second).ok());
  ASSERT_OK(draw(images.value(), frame, 1, FramePart::whole));
  EXPECT_TRUE(picture(images.value()) == expected);

  // Both parts in one command buffer. The next frame waits for it.
  FrameInputs inputs = dropped.value().inputs(other);
  inputs.frame_index = 2;
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) {
    const Result<void> first = effect.value().record(cmd, inputs, FramePart::first);
    const Result<void> drop = effect.value().record(cmd, inputs, FramePart::drop);
    EXPECT_FALSE(effect.value().record(cmd, inputs).ok());  // the same frame again, before its commands have completed
    return first.ok() ? drop : first;
  }));
  EXPECT_TRUE(picture(dropped.value()) == before);
  ASSERT_OK(draw(images.value(), frame, 3, FramePart::first));
  ASSERT_OK(draw(images.value(), frame, 3, FramePart::second));
  EXPECT_TRUE(picture(images.value()) == expected);
}

// Two views of a frame, each in two parts, in one command buffer.
TEST_F(EffectParts, ViewsFollowOneAnother) {
  TestFrame frames[2] = {small_frame(), small_frame()};
  frames[1].view = TestView::at(2500.0, 0.9, -0.1, 0.8);
  EffectDesc desc = desc_for(frames[0]);
  desc.views = 2;
  Result<Effect> effect = Effect::create(info(), desc, params_of(kModes[0]));
  ASSERT_OK(effect);
  std::vector<std::byte> pictures[2][2];
  for (const bool parts : {false, true}) {
    std::vector<FrameImages> images;
    for (const TestFrame& frame : frames) {
      Result<FrameImages> made = FrameImages::create(host(), frame, OutputFormat::rgba32f);
      ASSERT_OK(made);
      images.push_back(std::move(made).value());
    }
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      for (std::uint32_t view = 0; view < 2; ++view) {
        FrameInputs inputs = images[view].inputs(frames[view]);
        inputs.view = view;
        Result<void> recorded = effect.value().record(cmd, inputs, parts ? FramePart::first : FramePart::whole);
        if (recorded.ok() && parts) recorded = effect.value().record(cmd, inputs, FramePart::second);
        if (!recorded.ok()) return recorded;
      }
      return {};
    }));
    for (std::size_t view = 0; view < 2; ++view) {
      Result<std::vector<std::byte>> bytes = images[view].output_bytes(host());
      ASSERT_OK(bytes);
      pictures[parts ? 1 : 0][view] = std::move(bytes).value();
    }
  }
  EXPECT_TRUE(pictures[0][0] == pictures[1][0]);
  EXPECT_TRUE(pictures[0][1] == pictures[1][1]);
  EXPECT_FALSE(pictures[0][0] == pictures[0][1]);
}

void expect_refused(const Result<void>& result, std::initializer_list<const char*> words) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
  const std::string& text = result.error().message;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << text << "\nlacks: " << word;
}

TEST(EffectPartsRefusals, PartsOutOfOrderAreErrors) {
  Effect effect = make(Built::in_part);
  FrameInputs inputs = fake_frame();
  inputs.frame_index = 7;
  faults::forget_commands();
  expect_refused(effect.record(kCommands, inputs, FramePart::second),
                 {"FramePart::second", "frame_index 7", "view 0", "no first part", "expected FramePart::first"});
  expect_refused(effect.record(kCommands, inputs, static_cast<FramePart>(4)), {"4", "expected FramePart::whole"});
  EXPECT_EQ(faults::command_hash(), 0U);

  ASSERT_OK(effect.record(kCommands, inputs, FramePart::first));
  faults::forget_commands();
  FrameInputs next = inputs;
  next.frame_index = 8;
  for (const FramePart part : {FramePart::whole, FramePart::first}) {
    for (const FrameInputs& other : {inputs, next}) {
      expect_refused(effect.record(kCommands, other, part),
                     {"first part of frame_index 7", "expected FramePart::second or drop of this frame"});
    }
  }
  const Progress progress = effect.precompute_progress();
  const auto of = [](const Result<Progress>& result) { return result ? Result<void>() : Result<void>(result.error()); };
  const char* text = "expected FramePart::second or drop before this call";
  expect_refused(effect.set_params(other_params()), {"Effect::set_params", "frame_index 7", text});
  expect_refused(effect.set_limits({8, 8}, 1, 64), {"Effect::set_limits", text});
  expect_refused(effect.set_shadow_colors(true), {"Effect::set_shadow_colors", text});
  expect_refused(of(effect.record_precompute(kCommands, 1)), {"Effect::record_precompute", text});
  expect_refused(effect.record_load_tables(kCommands, number<VkBuffer>(1000005)), {"record_load_tables", text});
  EXPECT_EQ(faults::command_hash(), 0U);
  EXPECT_EQ(effect.precompute_progress().done, progress.done);
  EXPECT_EQ(affected(effect.params(), small_params()), 0U);

  // The second part can be recorded nevertheless, and then all that was refused.
  EXPECT_OK(effect.record(kCommands, inputs, FramePart::second));
  expect_refused(effect.record(kCommands, inputs, FramePart::second), {"no first part"});
  expect_refused(effect.record(kCommands, inputs, FramePart::drop), {"FramePart::drop of frame_index 7", "no first"});
  EXPECT_OK(effect.record(kCommands, next, FramePart::first));
  expect_refused(effect.record(kCommands, inputs, FramePart::drop),
                 {"FramePart::drop of frame_index 7", "first part of frame_index 8", "expected the same frame_index"});
  FrameInputs other_view = next;
  other_view.view = 1;
  expect_refused(effect.record(kCommands, other_view, FramePart::drop), {"view 1", "expected the same"});
  EXPECT_OK(effect.record(kCommands, next, FramePart::drop));
  expect_refused(effect.record(kCommands, next, FramePart::second), {"no first part"});
  next.frame_index = 9;
  EXPECT_OK(effect.record(kCommands, next));
  EXPECT_OK(effect.set_params(other_params()));
  EXPECT_OK(effect.set_limits({8, 8}, 1, 64));
  EXPECT_OK(effect.set_shadow_colors(true));
  EXPECT_OK(effect.record_precompute(kCommands, 1));
}

TEST(EffectPartsRefusals, OtherInputsAreErrors) {
  Effect effect = make(Built::completely);
  const FrameInputs inputs = fake_frame();
  ASSERT_OK(effect.record(kCommands, inputs, FramePart::first));
  faults::forget_commands();
  std::vector<Cascade> moved(inputs.cascades.begin(), inputs.cascades.end());
  moved[1].far_m = 2000.0F;
  const auto refused = [&](const char* member, const std::function<void(FrameInputs&)>& change) {
    FrameInputs other = inputs;
    change(other);
    expect_refused(effect.record(kCommands, other, FramePart::second),
                   {member, "of FramePart::second differs", "expected the same inputs"});
  };
  refused("FrameInputs::frame_index", [](FrameInputs& i) { i.frame_index = 1; });
  refused("FrameInputs::view", [](FrameInputs& i) { i.view = 1; });
  refused("FrameInputs::extent", [](FrameInputs& i) { i.extent.height = 31; });
  refused("FrameInputs::color", [](FrameInputs& i) { i.color.offset.x = 1; });
  refused("FrameInputs::depth", [](FrameInputs& i) { i.depth.layout = VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL; });
  refused("FrameInputs::shadow_maps", [](FrameInputs& i) { i.shadow_maps.view = i.color.view; });
  refused("FrameInputs::shadow_colors", [](FrameInputs& i) { i.shadow_colors.view = i.color.view; });
  refused("FrameInputs::shadow_color_depths", [](FrameInputs& i) { i.shadow_color_depths = true; });
  refused("FrameInputs::shadow_resolution", [](FrameInputs& i) { i.shadow_resolution = 32; });
  refused("FrameInputs::cascades", [&](FrameInputs& i) { i.cascades = moved; });
  refused("FrameInputs::cascades", [](FrameInputs& i) { i.cascades = i.cascades.first(1); });
  refused("FrameInputs::first_marched_cascade", [](FrameInputs& i) { i.first_marched_cascade = 1; });
  refused("FrameInputs::camera", [](FrameInputs& i) { i.camera.world_from_view.m[12] = 1.0F; });
  refused("FrameInputs::sun", [](FrameInputs& i) { i.sun.irradiance.y = 2.0F; });
  refused("FrameInputs::output", [](FrameInputs& i) { i.output.view = number<VkImageView>(1000009); });
  refused("FrameInputs::clouds", [](FrameInputs& i) { i.clouds.map_from_world.m[12] = 1.0F; });
  refused("FrameInputs::clouds", [](FrameInputs& i) { i.clouds.map.view = i.color.view; });
  refused("FrameInputs::lowest_ground_m", [](FrameInputs& i) { i.lowest_ground_m = -1.0F; });
  EXPECT_EQ(faults::command_hash(), 0U);
  // A copy of the cascades counts as equal.
  moved[1].far_m = inputs.cascades[1].far_m;
  FrameInputs copy = inputs;
  copy.cascades = moved;
  EXPECT_OK(effect.record(kCommands, copy, FramePart::second));
}

// The first part takes the slot of its frame, and neither part allocates.
TEST(EffectPartsRefusals, NeitherPartAllocates) {
  Effect effect = make(Built::completely);
  for (const faults::Kind kind : {faults::Kind::vulkan, faults::Kind::host}) {
    FrameInputs inputs = fake_frame();
    faults::arm(kind, 0);
    bool first = effect.record(kCommands, inputs, FramePart::first).ok();
    bool second = effect.record(kCommands, inputs, FramePart::drop).ok();
    inputs.frame_index = 1;
    first = effect.record(kCommands, inputs, FramePart::first).ok() && first;
    second = effect.record(kCommands, inputs, FramePart::second).ok() && second;
    EXPECT_FALSE(faults::disarm());
    EXPECT_TRUE(first && second);
  }
}

TEST(EffectPartsRefusals, DestructionBetweenThePartsIsReported) {
  std::vector<std::string> texts;
  DeviceInfo device = faults::fake_device();
  device.message = [](void* user, Severity, std::string_view text) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(text);
  };
  device.message_user = &texts;
  for (const FramePart end : {FramePart::second, FramePart::drop, FramePart::first}) {
    const bool complete = end != FramePart::first;
    Result<Effect> effect = Effect::create(device, small_desc(), small_params());
    ASSERT_OK(effect);
    ASSERT_OK(effect.value().record(kCommands, fake_frame(), FramePart::first));
    if (complete) ASSERT_OK(effect.value().record(kCommands, fake_frame(), end));
    texts.clear();
    effect = Error{ErrorCode::invalid_argument, ""};
    const bool said = texts.size() == 1 && texts[0].find("between the two parts of a frame") != std::string::npos;
    EXPECT_EQ(said, !complete) << (texts.empty() ? "" : texts[0]);
  }
}

}  // namespace
}  // namespace tyndall
