#include "effect/step_recorder.hpp"

#include <string>

#include "gpu/try.hpp"

namespace tyndall {

Result<void> StepRecorder::record(const Step& step) {
  if (step.dispatches()) return dispatch(step);
  barrier_before(step);
  transfer(step);
  return {};
}

void StepRecorder::barrier_before(const Step& step) {
  const HazardTracker::Barrier b = hazards_.before(uses_of(step));
  if (b.from != 0) gpu::barrier(device_, cmd_, b.from, b.from_access, b.to, b.to_access);
}

namespace {

Error failure(const Step& step, const std::string& what) {
  return {ErrorCode::invalid_argument, what + " of the pass " + step.name};
}

}  // namespace

Result<void> StepRecorder::write(const Step& step, const gpu::Pipeline& pipeline, SetCache::Set& set) {
  const std::span<const Resource> bound = bound_resources(*step.pipeline.shader);
  std::array<const gpu::Descriptor*, gpu::kMaxBindings> descriptors = {};
  for (std::size_t i = 0; i < bound.size(); ++i) {
    const bool placeholder = info_of(bound[i]).lifetime == Lifetime::chosen;
    const Resource resource = placeholder ? step.chosen : bound[i];
    const gpu::Descriptor& descriptor = resources_[resource];
    if (descriptor.buffer.buffer == VK_NULL_HANDLE && descriptor.image.imageView == VK_NULL_HANDLE) {
      return failure(step, std::string("nothing is bound to ") + name_of(resource));
    }
    descriptors[i] = &descriptor;
  }
  gpu::write_set(device_, set.set, pipeline, std::span(descriptors).first(bound.size()));
  set.written = true;
  return {};
}

Result<void> StepRecorder::dispatch(const Step& step) {
  const gpu::Pipeline* pipeline = pipelines_.find(step.pipeline);
  if (pipeline == nullptr) return failure(step, "there is no pipeline");
  SetCache::Set* set = sets_.find(set_key(step), slot_);
  if (set == nullptr) return failure(step, "there is no descriptor set");
  if (!set->written) TYNDALL_TRY(write(step, *pipeline, *set));
  const gpu::Label label(device_, cmd_, step.name);
  barrier_before(step);
  if (timer_ != nullptr) timer_->begin(cmd_, step.name);
  gpu::bind(device_, cmd_, *pipeline, set->set, step.push.data());
  if (step.kind == Step::Kind::dispatch_indirect) {
    device_.vk.CmdDispatchIndirect(cmd_, resources_[step.chosen].buffer.buffer, 0);
  } else {
    const VkExtent3D& n = step.invocations;
    gpu::dispatch(device_, cmd_, *pipeline, n.width, n.height, n.depth);
  }
  if (timer_ != nullptr) timer_->end(cmd_);
  return {};
}

void StepRecorder::transfer(const Step& step) {
  const VkDescriptorBufferInfo& buffer = resources_[step.chosen].buffer;
  switch (step.kind) {
    case Step::Kind::reset_list: {
      constexpr shared::WorkList empty = {0, 1, 1, 0};
      device_.vk.CmdUpdateBuffer(cmd_, buffer.buffer, buffer.offset, sizeof empty, &empty);
      return;
    }
    case Step::Kind::clear: device_.vk.CmdFillBuffer(cmd_, buffer.buffer, buffer.offset, buffer.range, 0); return;
    case Step::Kind::copy: {
      const VkDescriptorBufferInfo& target = resources_[step.target].buffer;
      const VkBufferCopy region = {buffer.offset, target.offset, buffer.range};
      device_.vk.CmdCopyBuffer(cmd_, buffer.buffer, target.buffer, 1, &region);
      return;
    }
    default: return;
  }
}

}  // namespace tyndall
