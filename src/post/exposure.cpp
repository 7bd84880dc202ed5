#include "post/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"
#include "post_shaders.hpp"

namespace tyndall::post {
namespace {

using uint = std::uint32_t;
#include "shared/exposure.h"

static_assert(kLuminanceBins == kHistogramBins);
static_assert(sizeof(ExposureState) == 32 && sizeof(LuminanceCounts) == 4 + 4 * kHistogramBins,
              "the layouts of the exposure must agree with std430");

constexpr std::uint32_t kMaxSamples = 1U << 18U;  // approximate number of samples per picture
constexpr double kForever_s = 1.0e9;

// Returns the distance between samples in both directions [pixels].
std::uint32_t stride_of(VkExtent2D extent) {
  const double pixels = static_cast<double>(extent.width) * extent.height;
  return std::max(1U, static_cast<std::uint32_t>(std::ceil(std::sqrt(pixels / kMaxSamples))));
}

}  // namespace

double stop_of_bin(std::size_t bin) {
  return static_cast<double>(kLowestStop) + static_cast<double>(kStopsPerBin) * static_cast<double>(bin);
}

Result<Exposure> Exposure::create(const gpu::Device& device, std::uint32_t frames_in_flight) {
  Exposure out;
  out.device_ = &device;
  TYNDALL_ASSIGN(out.measure_, gpu::create_compute_pipeline(device, shaders::measure_luminance_comp));
  TYNDALL_ASSIGN(out.adapt_, gpu::create_compute_pipeline(device, shaders::adapt_exposure_comp));
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  const gpu::Pipeline* const both[] = {&out.measure_, &out.adapt_};
  TYNDALL_ASSIGN(out.sets_, gpu::DescriptorSets::create(device, both, std::max(frames_in_flight, 1U)));
  TYNDALL_ASSIGN(out.counts_, gpu::create_buffer(device, "luminance_counts", sizeof(LuminanceCounts), kUsage,
                                                 gpu::MemoryKind::device));
  TYNDALL_ASSIGN(out.state_,
                 gpu::create_buffer(device, "exposure_state", sizeof(ExposureState), kUsage, gpu::MemoryKind::device));
  for (std::uint32_t i = 0; i < std::max(frames_in_flight, 1U); ++i) {
    TYNDALL_ASSIGN(gpu::Buffer result,
                   gpu::create_buffer(device, "exposure_result", sizeof(ExposureState) + sizeof(LuminanceCounts),
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
    std::memset(result.mapped, 0, sizeof(ExposureState) + sizeof(LuminanceCounts));
    out.results_.push_back(std::move(result));
  }
  return out;
}

Result<void> Exposure::measure(VkCommandBuffer cmd, VkImageView from, VkExtent2D extent,
                               const TonemapSettings& settings, double seconds, std::uint32_t slot) {
  if (slot >= results_.size()) {
    return Error{ErrorCode::invalid_argument, "Exposure::measure: slot " + std::to_string(slot) +
                                                  " is out of range; expected less than frames_in_flight"};
  }
  const gpu::Label label(*device_, cmd, "exposure");
  const gpu::NamedResource resources[] = {gpu::named_image("radiance", from),
                                          gpu::named_buffer("counts_block", counts_.buffer.get()),
                                          gpu::named_buffer("exposure_block", state_.buffer.get())};
  TYNDALL_TRY(gpu::write_set(*device_, sets_.get(0, slot), measure_, resources));
  TYNDALL_TRY(gpu::write_set(*device_, sets_.get(1, slot), adapt_, resources));
  // The previous picture may still read the state for tone mapping, and copy its counts.
  constexpr VkPipelineStageFlags kBoth = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  constexpr VkAccessFlags kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  constexpr VkAccessFlags kAll = kWrites | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;
  gpu::barrier(*device_, cmd, kBoth, kWrites, kBoth, kAll);
  device_->vk.CmdFillBuffer(cmd, counts_.buffer.get(), 0, sizeof(LuminanceCounts), 0);
  if (!measured_) device_->vk.CmdFillBuffer(cmd, state_.buffer.get(), 0, sizeof(ExposureState), 0);
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);

  const std::uint32_t stride = stride_of(extent);
  gpu::bind(*device_, cmd, measure_, sets_.get(0, slot), &stride);
  constexpr std::uint32_t kSamplesOnSide = 64;  // per group
  const auto groups = [&](std::uint32_t pixels) {
    return (pixels + stride * kSamplesOnSide - 1) / (stride * kSamplesOnSide);
  };
  device_->vk.CmdDispatch(cmd, groups(extent.width), groups(extent.height), 1);
  gpu::compute_barrier(*device_, cmd);

  const struct {
    float seconds, middle_gray, least_luminance;
    std::uint32_t reset;
  } push = {static_cast<float>(settings.light_adaptation ? std::clamp(seconds, 0.0, kForever_s) : kForever_s),
            settings.middle_gray, settings.least_luminance, reset_ ? 1U : 0U};
  gpu::bind(*device_, cmd, adapt_, sets_.get(1, slot), &push);
  device_->vk.CmdDispatch(cmd, 1, 1, 1);
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT, kBoth,
               VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);

  const VkBufferCopy state = {0, 0, sizeof(ExposureState)};
  const VkBufferCopy counts = {0, sizeof(ExposureState), sizeof(LuminanceCounts)};
  const VkBuffer result = results_[slot].buffer.get();
  device_->vk.CmdCopyBuffer(cmd, state_.buffer.get(), result, 1, &state);
  device_->vk.CmdCopyBuffer(cmd, counts_.buffer.get(), result, 1, &counts);
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
               VK_ACCESS_HOST_READ_BIT);
  reset_ = false;
  measured_ = true;
  return {};
}

Measurement Exposure::read(std::uint32_t slot) const {
  Measurement out;
  if (slot >= results_.size()) return out;
  ExposureState state = {};
  LuminanceCounts counts = {};
  std::memcpy(&state, results_[slot].mapped, sizeof state);
  std::memcpy(&counts, static_cast<const std::byte*>(results_[slot].mapped) + sizeof state, sizeof counts);
  out.exposure = state.exposure;
  out.luminance = state.luminance;
  out.measured = state.measured;
  out.counted = state.counted;
  double all = counts.black;
  for (const std::uint32_t count : counts.bins) all += count;
  if (all == 0.0) return out;
  out.black = static_cast<float>(counts.black / all);
  for (std::size_t i = 0; i < kHistogramBins; ++i) out.share[i] = static_cast<float>(counts.bins[i] / all);
  return out;
}

VkDeviceSize Exposure::bytes() const {
  VkDeviceSize sum = counts_.bytes + state_.bytes;
  for (const gpu::Buffer& result : results_) sum += result.bytes;
  return sum;
}

}  // namespace tyndall::post
