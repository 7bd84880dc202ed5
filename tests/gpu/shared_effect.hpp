// Draws frames with one effect, which all tests of a program share, and compares techniques.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "box_scene.hpp"
#include "gpu/device.hpp"

namespace tyndall {

using Picture = std::vector<glm::dvec3>;

// Returns parameters for small pictures. Samples have the same distance as with the defaults in large pictures. The
// tables are built quickly, and both techniques use the same ones.
inline Params small_params() {
  Params params;
  params.tables.size = {8, 32, 16, 8};
  params.tables.orders = 2;
  params.epipolar.slices = 128;
  params.epipolar.samples = 64;
  return params;
}

inline Params by_brute_force(Params params) {
  params.scattering.technique = Technique::brute_force;
  return params;
}

inline std::string hundredths(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// All tests of a program share a device and an effect, because creating an effect takes longer than drawing many
// pictures.
class SharedEffect : public testing::Test {
 protected:
  static EffectDesc desc() {
    EffectDesc out;
    out.max_extent = {4096, 256};
    out.frames_in_flight = 3;
    out.output_format = OutputFormat::rgba32f;
    out.max_cascades = kMaxCascades;
    out.max_shadow_resolution = 512;
    out.counters = true;
    out.shadow_colors = with_colors_;
    out.clouds = with_clouds_;
    return out;
  }
  static void SetUpTestSuite() {
    Result<std::unique_ptr<gpu::Host>> host =
        gpu::Host::create({"", true, &messages_, &shared_pipelines::get_instance_proc_addr});
    ASSERT_TRUE(host.ok()) << "the GPU tests need a Vulkan 1.3 device and the Khronos validation layer: "
                           << host.error().message;
    host_ = std::move(host).value();
    make(effect_, desc());
  }
  static void TearDownTestSuite() {
    effect_.reset();
    EXPECT_EQ(shared_pipelines::release(), 0U) << "pipelines that have not been destroyed";
    host_.reset();
    report_messages();
  }
  void SetUp() override { ASSERT_TRUE(effect_.has_value()); }
  void TearDown() override {
    images_.reset();
    report_messages();
  }
  static void report_messages() {
    for (const std::string& message : messages_) ADD_FAILURE() << message;
    messages_.clear();
  }

  static gpu::Host& host() { return *host_; }
  static DeviceInfo info() {
    const gpu::Device& device = host_->device();
    DeviceInfo out;
    out.instance = device.instance;
    out.physical_device = device.physical_device;
    out.device = device.device;
    out.get_instance_proc_addr = host_->get_instance_proc_addr();
    return out;
  }
  static void make(std::optional<Effect>& effect, const EffectDesc& desc) {
    Result<Effect> made = Effect::create(info(), desc, small_params());
    ASSERT_OK(made);
    effect.emplace(std::move(made).value());
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect->record_precompute(cmd);
      if (!built.ok()) return built.error();
      return {};
    }));
  }
  Effect& effect() { return own_effect_ ? *own_effect_ : *effect_; }

  // Sets the frame for the following calls of draw().
  void show(const BoxScene& scene) { show(frame_of(scene)); }
  void show(const TestFrame& frame) {
    frame_ = frame;
    Result<FrameImages> images = FrameImages::create(host(), frame_, OutputFormat::rgba32f);
    ASSERT_OK(images);
    images_.emplace(std::move(images).value());
  }
  [[nodiscard]] const TestFrame& frame() const { return frame_; }
  FrameImages& images() { return *images_; }

  // Draws the frame. Checks that every pixel is finite and, unless `may_be_black`, not black.
  Picture draw(const Params& params, const std::string& name, bool may_be_black = false) {
    const std::size_t pixels = static_cast<std::size_t>(frame_.extent.width) * frame_.extent.height;
    Picture picture(pixels, glm::dvec3(-1.0));
    EXPECT_OK(effect().set_params(params));
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) { return effect().record(cmd, images().inputs(frame_)); }));
    Result<Picture> output = images().output(host());
    EXPECT_OK(output);
    if (output.ok()) picture = std::move(output).value();
    std::size_t bad = 0;
    for (const glm::dvec3& p : picture) {
      bool fine = may_be_black || std::max({p.x, p.y, p.z}) > 0.0;
      for (int c = 0; c < 3; ++c) fine = fine && std::isfinite(p[c]) && p[c] >= 0.0;
      bad += fine ? 0 : 1;
    }
    EXPECT_EQ(bad, 0U) << name << ": pixels that are black, negative or not finite";
    return picture;
  }
  Counters counters() { return effect().counters(0); }

  // Draws the frame with both techniques and checks the PSNR.
  Likeness expect_alike(const std::string& name, const Params& params, double floor_db) {
    const Picture reference = draw(by_brute_force(params), name + ", brute force", params.scattering.only);
    const Picture picture = draw(params, name, params.scattering.only);
    const Likeness likeness = compare(picture, reference, frame_.extent);
    EXPECT_GE(likeness.psnr_db, floor_db) << name << ", mean relative error " << likeness.mean_relative_error;
    RecordProperty("dB: " + name, hundredths(likeness.psnr_db) + " floor " + hundredths(floor_db) + " mean " +
                                      std::to_string(likeness.mean_relative_error) + " worst " +
                                      std::to_string(likeness.worst_relative_error));
    return likeness;
  }

  std::optional<Effect> own_effect_;        // used instead of the shared one
  static inline bool with_colors_ = false;  // of the shared effect; must be set before it is created
  static inline bool with_clouds_ = false;

 private:
  TestFrame frame_;
  std::optional<FrameImages> images_;
  static inline std::vector<std::string> messages_;
  static inline std::unique_ptr<gpu::Host> host_;
  static inline std::optional<Effect> effect_;
};

}  // namespace tyndall
