// The private Vulkan layer: bindings by name, timers, transfers, and the selection of the device.
#include <chrono>
#include <cstring>

#include "gpu/descriptors.hpp"
#include "gpu/timer.hpp"
#include "gpu_layer_shaders.hpp"
#include "gpu_test.hpp"

namespace tyndall::gpu {
namespace {

class GpuLayer : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    make(fill_, create_compute_pipeline(host().device(), shaders::fill_comp));
    make(seed_, create_buffer(host().device(), "seed", 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::upload));
    make(values_,
         create_buffer(host().device(), "values", 64 * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::readback));
    const float seed = 2.0F;
    std::memcpy(seed_.mapped, &seed, sizeof seed);
  }
  void TearDown() override {
    fill_ = {};
    seed_ = {};
    values_ = {};
    GpuTest::TearDown();
  }

  template <typename T>
  static void make(T& target, Result<T> made) {
    ASSERT_OK(made);
    target = std::move(made).value();
  }

  void record(VkCommandBuffer cmd, std::uint32_t steps, const Pipeline& pipeline) {
    const NamedResource resources[] = {named_buffer("value_block", values_.buffer.get()),
                                       named_buffer("not_a_binding", seed_.buffer.get()),
                                       named_buffer("seed_block", seed_.buffer.get())};
    EXPECT_OK(gpu::bind(host().sets(), cmd, pipeline, resources, &steps));
    dispatch(host().device(), cmd, pipeline, 64);
    barrier(host().device(), cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_HOST_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  }

  Pipeline fill_;
  Buffer seed_, values_;
};

TEST_F(GpuLayer, ResourcesAreBoundByNameWhateverTheirOrder) {
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    record(cmd, 0, fill_);
    return {};
  }));
  const auto* values = static_cast<const float*>(values_.mapped);
  for (int i = 0; i < 64; ++i) EXPECT_EQ(values[i], 2.0F);
  // A specialisation constant selects a variant.
  const Constant constants[] = {{0, 5}};
  const Result<Pipeline> variant = create_compute_pipeline(host().device(), shaders::fill_comp, constants);
  ASSERT_OK(variant);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    record(cmd, 0, variant.value());
    return {};
  }));
  for (int i = 0; i < 64; ++i) EXPECT_EQ(values[i], 7.0F);
}

TEST_F(GpuLayer, ABindingThatIsMissingIsNamed) {
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const std::uint32_t steps = 0;
    const auto expect_missing = [&](std::span<const NamedResource> resources, const std::string& name) {
      const Result<void> bound = gpu::bind(host().sets(), cmd, fill_, resources, &steps);
      ASSERT_FALSE(bound.ok());
      EXPECT_NE(bound.error().message.find("nothing is bound to " + name), std::string::npos) << bound.error().message;
    };
    const NamedResource one[] = {named_buffer("seed_block", seed_.buffer.get())};
    expect_missing(one, "value_block");
    const NamedResource other[] = {named_buffer("seed_bloc", seed_.buffer.get()),
                                   named_buffer("value_block", values_.buffer.get())};
    expect_missing(other, "seed_block");
    expect_missing({}, "");
    return {};
  }));
}

// Binds more sets than one pool of the arena holds, each with different resources. The sets of one command buffer are
// available again for the next one.
TEST_F(GpuLayer, EachBindOfACommandBufferHasItsOwnSet) {
  constexpr std::uint32_t kBinds = 70;
  std::vector<Buffer> seeds, values;
  for (std::uint32_t i = 0; i < kBinds; ++i) {
    Result<Buffer> seed =
        create_buffer(host().device(), "seed", 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::upload);
    Result<Buffer> value =
        create_buffer(host().device(), "value", 64 * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::readback);
    ASSERT_OK(seed);
    ASSERT_OK(value);
    seeds.push_back(std::move(seed).value());
    values.push_back(std::move(value).value());
  }
  for (std::uint32_t run = 0; run < 3; ++run) {
    for (std::uint32_t i = 0; i < kBinds; ++i) {
      const auto seed = static_cast<float>(100 * run + i);
      std::memcpy(seeds[i].mapped, &seed, sizeof seed);
    }
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      for (std::uint32_t i = 0; i < kBinds; ++i) {
        const std::uint32_t steps = 0;
        const NamedResource resources[] = {named_buffer("value_block", values[i].buffer.get()),
                                           named_buffer("seed_block", seeds[i].buffer.get())};
        EXPECT_TRUE(gpu::bind(host().sets(), cmd, fill_, resources, &steps).ok());
        dispatch(host().device(), cmd, fill_, 64);
      }
      barrier(host().device(), cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
              VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    for (std::uint32_t i = 0; i < kBinds; ++i) {
      EXPECT_EQ(*static_cast<const float*>(values[i].mapped), static_cast<float>(100 * run + i));
    }
  }
}

TEST_F(GpuLayer, TimersMeasureWhatTheyEnclose) {
  Result<Timer> timer = Timer::create(host().device(), 2, 3);
  ASSERT_OK(timer);
  const auto wall_start = std::chrono::steady_clock::now();
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    timer.value().begin_frame(cmd, 1);
    const char* const names[] = {"long", "short", "middle", "too many"};
    const std::uint32_t steps[] = {60000, 600, 6000, 600};  // llvmpipe ends loops after 65535 iterations
    for (int i = 0; i < 4; ++i) {
      timer.value().begin(cmd, names[i]);
      record(cmd, steps[i], fill_);
      timer.value().end(cmd);
    }
    return {};
  }));
  const double wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall_start).count();
  const std::span<const TimedScope> scopes = timer.value().read(1);
  ASSERT_EQ(scopes.size(), 3U);
  EXPECT_STREQ(scopes[0].name, "long");
  EXPECT_STREQ(scopes[2].name, "middle");
  double sum = 0.0;
  for (const TimedScope& scope : scopes) {
    EXPECT_GT(scope.milliseconds, 0.0);
    sum += scope.milliseconds;
  }
  EXPECT_LE(sum, wall_ms);
  // Scope 0 has ten times the work of scope 2. A busy machine may delay one of them, but not by that factor.
  EXPECT_GT(scopes[0].milliseconds, 2.0 * scopes[2].milliseconds);
  EXPECT_TRUE(timer.value().read(0).empty());  // nothing was recorded there
}

TEST_F(GpuLayer, TransfersPreserveEveryByte) {
  std::vector<std::uint8_t> bytes(5 * 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(7 * i);
  const auto same = [&](const Result<std::vector<std::byte>>& got, std::size_t from, std::size_t size) {
    ASSERT_OK(got);
    ASSERT_EQ(got.value().size(), size);
    EXPECT_EQ(std::memcmp(got.value().data(), bytes.data() + from, size), 0);
  };
  constexpr VkBufferUsageFlags kBoth = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  Result<Buffer> buffer = create_buffer(host().device(), "bytes", bytes.size(), kBoth, MemoryKind::device);
  ASSERT_OK(buffer);
  ASSERT_OK(upload(host(), buffer.value(), bytes.data(), bytes.size()));
  same(download(host(), buffer.value(), bytes.size()), 0, bytes.size());
  // Two layers, odd sizes, and tightly packed rows.
  const ImageDesc desc = {
      "layers",
      VK_FORMAT_R8G8_UNORM,
      {5, 3, 1},
      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
      2};
  Result<Image> image = create_image(host().device(), desc);
  ASSERT_OK(image);
  EXPECT_EQ(image.value().bytes, image_bytes(host().device(), desc));
  ASSERT_OK(upload(host(), image.value(), bytes.data(), bytes.size(), VK_IMAGE_LAYOUT_GENERAL));
  same(download(host(), image.value(), VK_IMAGE_LAYOUT_GENERAL, 0, 2), 0, 30);
  same(download(host(), image.value(), VK_IMAGE_LAYOUT_GENERAL, 1, 2), 30, 30);
}

TEST_F(GpuLayer, ValidationMessagesAreReceived) {
  // Verifies that mistakes are reported, which every other test relies on. It uses its own host, so that this message
  // does not fail the test.
  std::vector<std::string> heard;
  {
    Result<std::unique_ptr<Host>> own = Host::create({"", true, &heard});
    ASSERT_OK(own);
    const Device& device = own.value()->device();
    Result<Buffer> buffer = create_buffer(device, "hazard", 64, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::device);
    ASSERT_OK(buffer);
    EXPECT_TRUE(heard.empty());
    ASSERT_OK(own.value()->run([&](VkCommandBuffer cmd) -> Result<void> {
      device.vk.CmdFillBuffer(cmd, buffer.value().buffer.get(), 0, 64, 1);
      device.vk.CmdFillBuffer(cmd, buffer.value().buffer.get(), 0, 64, 2);  // a second write without a barrier
      return {};
    }));
    EXPECT_EQ(heard.size(), 1U);
    EXPECT_EQ(own.value()->validation_messages(), 1U);
    EXPECT_NE(own.value()->validation_text().find("SYNC-HAZARD-WRITE"), std::string::npos);
  }
}

TEST_F(GpuLayer, DevicesAreListedAndChosen) {
  const Result<std::vector<DeviceRow>> rows = Host::list();
  ASSERT_OK(rows);
  ASSERT_FALSE(rows.value().empty());
  int chosen = 0;
  for (const DeviceRow& row : rows.value()) {
    EXPECT_FALSE(row.name.empty());
    chosen += row.chosen ? 1 : 0;
    if (row.chosen) {
      EXPECT_TRUE(row.missing.empty());
      EXPECT_EQ(row.name, host().device_name());
    }
  }
  EXPECT_EQ(chosen, 1);
  // A device can be selected by its index, or by a part of its name in upper or lower case.
  const Result<std::vector<DeviceRow>> first = Host::list("0");
  ASSERT_OK(first);
  EXPECT_TRUE(first.value()[0].chosen);
  std::string part = host().device_name().substr(1, 5);
  for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_OK(Host::create({part, false}));
  for (const char* const wrong : {"99", "no such device", "-1", "18446744073709551616"}) {
    const Result<std::unique_ptr<Host>> none = Host::create({wrong, false});
    ASSERT_FALSE(none.ok()) << wrong;
    EXPECT_EQ(none.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(none.error().message.find(host().device_name()), std::string::npos);  // lists the available devices
    EXPECT_FALSE(Host::list(wrong).ok());
  }
}

}  // namespace
}  // namespace tyndall::gpu
