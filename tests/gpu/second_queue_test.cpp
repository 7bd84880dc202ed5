// A frame in two parts on two queues, as docs/integration.md describes it: the first part on a queue for asynchronous
// work, the second on another one, with semaphores between them. If the device has one queue only, both parts go to it
// in submissions of their own with the same semaphores. The test prints which was used.
#include <array>
#include <cstdio>

#include "effect_frame.hpp"
#include "small_effect.hpp"

namespace tyndall {
namespace {

constexpr std::uint64_t kFrames = 5;
constexpr std::uint32_t kInFlight = 2;
// The stages that read and write what the parts share.
constexpr VkPipelineStageFlags kStages =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;

// The command buffers of a frame in flight, and the semaphores that follow them.
struct Slot {
  VkCommandBuffer first = VK_NULL_HANDLE, second = VK_NULL_HANDLE;
  VkSemaphore first_done = VK_NULL_HANDLE, frame_done = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
};

class SecondQueue : public testing::Test {
 protected:
  void SetUp() override {
    gpu::HostDesc desc;
    desc.validation = true;
    desc.validation_log = &messages_;
    desc.queues = 2;
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create(desc);
    ASSERT_OK(host);
    host_ = std::move(host).value();
    VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                    VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, host_->queue_family()};
    ASSERT_EQ(vkCreateCommandPool(device(), &pool, nullptr, &pool_), VK_SUCCESS);
    for (Slot& slot : slots_) {
      const VkCommandBufferAllocateInfo buffers = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                                   VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
      const VkSemaphoreCreateInfo semaphore = {VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
      const VkFenceCreateInfo fence = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
      ASSERT_EQ(vkAllocateCommandBuffers(device(), &buffers, &slot.first), VK_SUCCESS);
      ASSERT_EQ(vkAllocateCommandBuffers(device(), &buffers, &slot.second), VK_SUCCESS);
      ASSERT_EQ(vkCreateSemaphore(device(), &semaphore, nullptr, &slot.first_done), VK_SUCCESS);
      ASSERT_EQ(vkCreateSemaphore(device(), &semaphore, nullptr, &slot.frame_done), VK_SUCCESS);
      ASSERT_EQ(vkCreateFence(device(), &fence, nullptr, &slot.fence), VK_SUCCESS);
    }
  }

  void TearDown() override {
    if (host_ != nullptr) {
      host_->wait_idle();
      for (const Slot& slot : slots_) {
        vkDestroySemaphore(device(), slot.first_done, nullptr);
        vkDestroySemaphore(device(), slot.frame_done, nullptr);
        vkDestroyFence(device(), slot.fence, nullptr);
      }
      vkDestroyCommandPool(device(), pool_, nullptr);
      host_.reset();
    }
    for (const std::string& message : messages_) ADD_FAILURE() << message;
  }

  [[nodiscard]] VkDevice device() const { return host_->device().device; }

  // Records a command buffer and submits it. Null semaphores are left out.
  void submit(VkQueue queue, VkCommandBuffer cmd, const gpu::Host::Record& record, VkSemaphore wait, VkSemaphore signal,
              VkFence fence) {
    const VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                            VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    ASSERT_EQ(vkBeginCommandBuffer(cmd, &begin), VK_SUCCESS);
    ASSERT_OK(record(cmd));
    ASSERT_EQ(vkEndCommandBuffer(cmd), VK_SUCCESS);
    VkSubmitInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.waitSemaphoreCount = wait != VK_NULL_HANDLE ? 1 : 0;
    info.pWaitSemaphores = &wait;
    info.pWaitDstStageMask = &kStages;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &cmd;
    info.signalSemaphoreCount = signal != VK_NULL_HANDLE ? 1 : 0;
    info.pSignalSemaphores = &signal;
    const std::unique_lock<std::mutex> lock = host_->lock();
    ASSERT_EQ(vkQueueSubmit(queue, 1, &info, fence), VK_SUCCESS);
  }

  std::vector<std::string> messages_;  // outlives the host
  std::unique_ptr<gpu::Host> host_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::array<Slot, kInFlight> slots_ = {};
};

// Frames follow one another without a wait on the host, other than for the slot that is used again. The first part of a
// frame waits for the frame before it, because it writes the same memory.
TEST_F(SecondQueue, TakesTheFirstPart) {
  const VkQueue queues[] = {host_->queue(1), host_->queue()};
  std::printf("%s\n", queues[0] != queues[1] ? "two queues of one family" : "one queue, with separate submissions");
  TestFrame frames[kFrames];
  std::vector<FrameImages> images;
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    frames[i] = small_frame();
    frames[i].view = TestView::at(1000.0 + 700.0 * static_cast<double>(i), 0.3 * static_cast<double>(i), -0.1, 0.8);
    Result<FrameImages> made = FrameImages::create(*host_, frames[i], OutputFormat::rgba32f);
    ASSERT_OK(made);
    images.push_back(std::move(made).value());
  }
  Params params = small_params();
  EffectDesc desc = desc_for(frames[0]);
  desc.frames_in_flight = kInFlight;
  DeviceInfo info;
  info.instance = host_->device().instance;
  info.physical_device = host_->device().physical_device;
  info.device = device();
  info.get_instance_proc_addr = host_->get_instance_proc_addr();
  Result<Effect> effect = Effect::create(info, desc, params);
  ASSERT_OK(effect);
  std::vector<std::byte> expected[kFrames];
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    ASSERT_OK(host_->run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect.value().record_precompute(cmd);
      if (!built.ok()) return built.error();
      FrameInputs inputs = images[i].inputs(frames[i]);
      inputs.frame_index = i;
      return effect.value().record(cmd, inputs);
    }));
    Result<std::vector<std::byte>> bytes = images[i].output_bytes(*host_);
    ASSERT_OK(bytes);
    expected[i] = std::move(bytes).value();
    EXPECT_TRUE(i == 0 || expected[i] != expected[i - 1]);
    // Other pictures, which the parts have to replace.
    Result<FrameImages> made = FrameImages::create(*host_, frames[i], OutputFormat::rgba32f);
    ASSERT_OK(made);
    images[i] = std::move(made).value();
  }
  VkSemaphore before = VK_NULL_HANDLE;
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    const Slot& slot = slots_[i % kInFlight];
    ASSERT_EQ(vkWaitForFences(device(), 1, &slot.fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    ASSERT_EQ(vkResetFences(device(), 1, &slot.fence), VK_SUCCESS);
    FrameInputs inputs = images[i].inputs(frames[i]);
    inputs.frame_index = kFrames + i;
    const auto part = [&](FramePart which) {
      return [&, which](VkCommandBuffer cmd) { return effect.value().record(cmd, inputs, which); };
    };
    const bool last = i + 1 == kFrames;
    submit(queues[0], slot.first, part(FramePart::first), before, slot.first_done, VK_NULL_HANDLE);
    submit(queues[1], slot.second, part(FramePart::second), slot.first_done, last ? VK_NULL_HANDLE : slot.frame_done,
           slot.fence);
    before = slot.frame_done;
  }
  host_->wait_idle();
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    Result<std::vector<std::byte>> bytes = images[i].output_bytes(*host_);
    ASSERT_OK(bytes);
    EXPECT_TRUE(bytes.value() == expected[i]) << "frame " << i;
  }
}

}  // namespace
}  // namespace tyndall
