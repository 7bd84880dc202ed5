#include "gpu/timer.hpp"

#include "gpu/try.hpp"

namespace tyndall::gpu {

namespace {

// At least these bits of a timestamp are valid in every queue family that has timestamps (Vulkan 1.3,
// VkQueueFamilyProperties::timestampValidBits). The difference of two timestamps, cut to them, is the duration if that
// is shorter than 2^36 ticks, which is a minute or more.
constexpr std::uint64_t kValidTicks = (std::uint64_t{1} << 36U) - 1;

// Records a full barrier. On CPU devices, a timed pass must not overlap with others.
void settle(const Device& device, VkCommandBuffer cmd) {
  barrier(device, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
          VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

}  // namespace

Result<Timer> Timer::create(const Device& device, std::uint32_t slots, std::uint32_t scopes) {
  Timer out;
  out.device_ = &device;
  out.scopes_ = scopes;
  out.settles_ = device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  VkQueryPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = slots * scopes * 2;
  VkQueryPool pool = VK_NULL_HANDLE;
  const VkResult result = device.vk.CreateQueryPool(device.device, &info, device.allocator, &pool);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating", "the timestamp queries");
  out.pool_ = Handle<VkQueryPool>(device, pool);
  out.names_.resize(slots);
  for (auto& names : out.names_) names.reserve(scopes);
  out.results_.reserve(scopes);
  out.ticks_.resize(static_cast<std::size_t>(scopes) * 2);
  return out;
}

void Timer::begin_frame(VkCommandBuffer cmd, std::uint32_t slot) {
  slot_ = slot;
  names_[slot].clear();
  whole_ = 0;
  device_->vk.CmdResetQueryPool(cmd, pool_.get(), slot * scopes_ * 2, scopes_ * 2);
}

void Timer::write(VkCommandBuffer cmd, std::size_t scope, std::uint32_t which) {
  const auto query = static_cast<std::uint32_t>((slot_ * scopes_ + scope) * 2) + which;
  device_->vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_.get(), query);
}

void Timer::begin_whole(VkCommandBuffer cmd, const char* name) {
  std::vector<const char*>& names = names_[slot_];
  if (settles_ || names.size() == scopes_) return;
  write(cmd, names.size(), 0);
  names.push_back(name);
  whole_ = names.size();
}

void Timer::end_whole(VkCommandBuffer cmd) {
  if (whole_ == 0) return;
  write(cmd, whole_ - 1, 1);
  whole_ = 0;
}

void Timer::begin(VkCommandBuffer cmd, const char* name) {
  std::vector<const char*>& names = names_[slot_];
  open_ = names.size() < scopes_;
  if (!open_) return;
  if (settles_) settle(*device_, cmd);
  write(cmd, names.size(), 0);
  if (settles_) settle(*device_, cmd);
  names.push_back(name);
}

void Timer::end(VkCommandBuffer cmd) {
  if (!open_) return;
  open_ = false;
  if (settles_) settle(*device_, cmd);
  write(cmd, names_[slot_].size() - 1, 1);
}

std::span<const TimedScope> Timer::read(std::uint32_t slot) {
  results_.clear();
  const std::vector<const char*>& names = names_[slot];
  if (names.empty()) return {};
  const auto count = static_cast<std::uint32_t>(names.size() * 2);
  const VkResult result = device_->vk.GetQueryPoolResults(device_->device, pool_.get(), slot * scopes_ * 2, count,
                                                          count * 8, ticks_.data(), 8, VK_QUERY_RESULT_64_BIT);
  if (result != VK_SUCCESS) return {};
  const double ms_per_tick = static_cast<double>(device_->properties.limits.timestampPeriod) * 1e-6;
  for (std::size_t i = 0; i < names.size(); ++i) {
    results_.push_back(
        {names[i], static_cast<double>((ticks_[2 * i + 1] - ticks_[2 * i]) & kValidTicks) * ms_per_tick});
  }
  return results_;
}

}  // namespace tyndall::gpu
