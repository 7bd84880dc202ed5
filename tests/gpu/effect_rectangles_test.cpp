// A picture may be a rectangle of larger images. Its bytes are those of a picture with images of its own size, and the
// rest of the images is neither read nor written.
#include <cmath>
#include <cstring>
#include <functional>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

constexpr std::size_t kTexelBytes = 16;

struct Mode {
  const char* name;
  std::function<void(Params&)> change;
};

const Mode kModes[] = {
    {"epipolar", [](Params&) {}},
    {"few slices", [](Params& p) { p.epipolar.slices = 32; }},
    {"extinction per pixel", [](Params& p) { p.scattering.extinction = Extinction::per_pixel; }},
    {"depth breaks", [](Params& p) { p.epipolar.correct_depth_breaks = true; }},
    {"samples shown", [](Params& p) { p.epipolar.show_sampling = true; }},
    {"halved", [](Params& p) { p.scattering.downscale = 2; }},
    {"quartered", [](Params& p) { p.scattering.downscale = 4; }},
    {"homogeneous", [](Params& p) { p.scattering.medium = MediumKind::homogeneous; }},
    {"brute force", [](Params& p) { p.scattering.technique = Technique::brute_force; }},
    {"disabled", [](Params& p) { p.scattering.enabled = false; }},
};

class EffectRectangles : public GpuTest {
 protected:
  Result<std::vector<std::byte>> draw(Effect& effect, const TestFrame& frame) {
    Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
    if (!images.ok()) return images.error();
    const Result<void> drawn =
        host().run([&](VkCommandBuffer cmd) { return effect.record(cmd, images.value().inputs(frame)); });
    if (!drawn.ok()) return drawn.error();
    return images.value().output_bytes(host());
  }
};

// Returns a frame with scene and sky at all four edges, so that reads beyond them would be visible.
TestFrame picture(VkExtent2D extent) {
  TestFrame frame = small_frame();
  frame.extent = extent;
  frame.background = {0.2F, 0.1F, 0.4F};
  frame.distance_m = [](std::uint32_t x, std::uint32_t y) {
    return (x / 5 + y / 4) % 3 == 0 ? 0.0 : 3000.0 + 100.0 * x;
  };
  return frame;
}

TEST_F(EffectRectangles, EqualPicturesOfTheirOwnSize) {
  Params params = precise_params();
  params.scattering.technique = Technique::epipolar;
  params.scattering.integration_steps = 12;
  TestFrame shape = small_frame();
  shape.extent = {24, 16};
  Result<Effect> effect = Effect::create(info(), desc_for(shape), params);
  ASSERT_OK(effect);
  for (const Mode& mode : kModes) {
    Params changed = params;
    mode.change(changed);
    ASSERT_OK(effect.value().set_params(changed));
    // Every mode has an odd size. The first mode also has whole blocks of pixels, a single column, a single row, and a
    // rectangle in the corner of the image.
    const bool usual = &mode == &kModes[0];
    for (const VkExtent2D extent : {VkExtent2D{23, 13}, {24, 12}, {1, 9}, {9, 1}, {22, 15}}) {
      if (!usual && extent.width != 23) continue;
      const TestFrame alone = picture(extent);
      TestFrame within = alone;
      within.image_extent = {40, 30};
      if (extent.width != 22) {
        within.offsets.color = {7, 5};
        within.offsets.depth = {3, 11};
        within.offsets.output = {16, 2};
      }
      const Result<std::vector<std::byte>> expected = draw(effect.value(), alone);
      const Result<std::vector<std::byte>> image = draw(effect.value(), within);
      ASSERT_OK(expected);
      ASSERT_OK(image);
      std::size_t differing = 0;
      std::size_t touched = 0;
      for (std::uint32_t y = 0; y < within.image_extent.height; ++y) {
        for (std::uint32_t x = 0; x < within.image_extent.width; ++x) {
          const std::byte* texel = image.value().data() + (y * within.image_extent.width + x) * kTexelBytes;
          const std::uint32_t px = x - static_cast<std::uint32_t>(within.offsets.output.x);
          const std::uint32_t py = y - static_cast<std::uint32_t>(within.offsets.output.y);
          if (px < extent.width && py < extent.height) {
            const std::byte* own = expected.value().data() + (py * extent.width + px) * kTexelBytes;
            differing += std::memcmp(texel, own, kTexelBytes) != 0 ? 1 : 0;
          } else {
            const std::vector<std::byte> unwritten(kTexelBytes, std::byte{0xFF});
            touched += std::memcmp(texel, unwritten.data(), kTexelBytes) != 0 ? 1 : 0;
          }
        }
      }
      EXPECT_EQ(differing, 0U) << mode.name << " " << extent.width << "x" << extent.height;
      EXPECT_EQ(touched, 0U) << mode.name << " " << extent.width << "x" << extent.height;
    }
  }
}

TEST_F(EffectRectangles, OffsetsOutsideTheImagesAreRefused) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  Result<Effect> effect = Effect::create(info(), desc_for(frame), precise_params());
  ASSERT_OK(effect);
  const auto message = [&](const std::function<void(FrameInputs&)>& change) {
    FrameInputs inputs = images.value().inputs(frame);
    change(inputs);
    std::string text;
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<void> result = effect.value().record(cmd, inputs);
      if (!result.ok()) text = result.error().message;
      return {};
    }));
    return text;
  };
  EXPECT_EQ(message([](FrameInputs&) {}), "");
  EXPECT_NE(message([](FrameInputs& f) { f.color.offset.x = -1; }).find("FrameInputs::color"), std::string::npos);
  EXPECT_NE(message([](FrameInputs& f) { f.depth.offset.y = -7; }).find("FrameInputs::depth"), std::string::npos);
  EXPECT_NE(message([](FrameInputs& f) { f.output.offset.x = 2000000000; }).find("FrameInputs::output"),
            std::string::npos);
  EXPECT_NE(message([](FrameInputs& f) { f.shadow_maps.offset.x = 1; }).find("shadow_maps"), std::string::npos);
}

}  // namespace
}  // namespace tyndall
