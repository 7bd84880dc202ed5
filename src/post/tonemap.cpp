#include "post/tonemap.hpp"

#include <algorithm>
#include <cstdint>

#include "gpu/try.hpp"
#include "post_shaders.hpp"

namespace tyndall::post {
namespace {

using uint = std::uint32_t;
#include "post/constant_ids.h"

}  // namespace

Result<Tonemap> Tonemap::create(const gpu::Device& device, std::uint32_t frames_in_flight) {
  Tonemap out;
  out.device_ = &device;
  for (std::uint32_t i = 0; i < kOperators; ++i) {
    const gpu::Constant constants[] = {{kOperatorId, i}};
    TYNDALL_ASSIGN(out.pipelines_[i], gpu::create_compute_pipeline(device, shaders::tonemap_comp, constants));
    out.pipelines_[i].name = "tonemap";
  }
  const gpu::Pipeline* const first[] = {&out.pipelines_[0]};
  out.slots_ = std::max(frames_in_flight, 1U);
  TYNDALL_ASSIGN(out.sets_, gpu::DescriptorSets::create(device, first, out.slots_));
  TYNDALL_ASSIGN(out.exposure_, Exposure::create(device, frames_in_flight));
  return out;
}

Result<void> Tonemap::record(VkCommandBuffer cmd, VkImageView from, VkImageView to, VkExtent2D extent,
                             const TonemapSettings& settings, std::uint32_t slot) const {
  if (slot >= slots_) {
    return Error{ErrorCode::invalid_argument, "Tonemap::record: slot " + std::to_string(slot) +
                                                  " is out of range; expected less than frames_in_flight"};
  }
  if (settings.auto_exposure && !exposure_.measured()) {
    return Error{ErrorCode::invalid_argument,
                 "Tonemap::record: auto_exposure is on, but nothing was measured; expected Exposure::measure() before"};
  }
  if (static_cast<std::uint32_t>(settings.op) >= kOperators) {
    return Error{ErrorCode::invalid_argument, "TonemapSettings::op is out of range; expected a value of Operator"};
  }
  const gpu::Pipeline& pipeline = pipelines_[static_cast<std::size_t>(settings.op)];
  const gpu::Label label(*device_, cmd, pipeline.name);
  const gpu::NamedResource resources[] = {gpu::named_image("radiance", from), gpu::named_image("display", to),
                                          gpu::named_buffer("exposure_block", exposure_.state())};
  const struct {
    float exposure;
    std::uint32_t auto_exposure;
    float white_point, saturation;
  } push = {settings.exposure, settings.auto_exposure ? 1U : 0U, settings.white_point, settings.saturation};
  TYNDALL_TRY(gpu::write_set(*device_, sets_.get(0, slot), pipeline, resources));
  gpu::bind(*device_, cmd, pipeline, sets_.get(0, slot), &push);
  gpu::dispatch(*device_, cmd, pipeline, extent.width, extent.height);
  return {};
}

}  // namespace tyndall::post
