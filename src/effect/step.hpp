// A step of the effect as data: which shader runs with which specialisation constants, over how much work, and what it
// reads and writes. frame_steps.cpp and table_steps.cpp make lists of steps. Pipelines, barriers, debug labels,
// timings and memory follow from these lists. No Vulkan object is needed to make or to
// examine one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "effect/resources.hpp"
#include "effect/shared.hpp"
#include "gpu/shader.hpp"

namespace tyndall {

// Values of the specialisation constants, by the ids of shaders/shared/constant_ids.h.
struct Specialisation {
  std::array<std::uint8_t, shared::kSpecialisationIds> values = {};

  [[nodiscard]] std::uint8_t& operator[](std::uint32_t id) { return values[id]; }
  [[nodiscard]] std::uint8_t operator[](std::uint32_t id) const { return values[id]; }
  bool operator==(const Specialisation&) const = default;
};

// What a pipeline is found by: the shader, and the values of those constants that the shader has. Others are 0.
struct PipelineKey {
  const gpu::Shader* shader = nullptr;
  Specialisation constants;
  bool operator==(const PipelineKey&) const = default;
};
[[nodiscard]] PipelineKey pipeline_key(const gpu::Shader& shader, const Specialisation& constants);

struct Step {
  enum class Kind : std::uint8_t {
    dispatch,           // over `invocations`
    dispatch_indirect,  // over the items of the list `chosen`
    reset_list,         // makes the list `chosen` empty; `push` holds the groups along z of its dispatches
    clear,              // fills `chosen` with zeros
    copy,               // from `chosen` to `target`
    host_read           // records no command: makes `chosen` visible to the host
  };
  const char* name = "";  // of the pass: its debug label, its timing and its row in the documentation
  Kind kind = Kind::dispatch;
  Resource chosen = Resource::none;  // also what the bindings `work` and `node` stand for
  Resource target = Resource::none;
  PipelineKey pipeline;
  std::array<std::uint32_t, 2> push = {};  // push constants
  VkExtent3D invocations = {1, 1, 1};

  [[nodiscard]] bool dispatches() const { return kind == Kind::dispatch || kind == Kind::dispatch_indirect; }
};

// What a step does with a resource: VK_ACCESS_* flags.
struct Use {
  Resource resource = Resource::none;
  VkAccessFlags access = 0;
};
struct Uses {
  std::array<Use, 24> list = {};
  std::size_t count = 0;

  void add(Resource resource, VkAccessFlags access) { list[count++] = {resource, access}; }
  [[nodiscard]] const Use* begin() const { return list.data(); }
  [[nodiscard]] const Use* end() const { return list.data() + count; }
};
// Reads and writes follow from the bindings of the shader and whether GLSL declares them readonly or writeonly.
[[nodiscard]] Uses uses_of(const Step& step);
// The resources of the bindings of a shader, in the order of gpu::Shader::bindings.
[[nodiscard]] std::span<const Resource> bound_resources(const gpu::Shader& shader);

constexpr VkAccessFlags kWriteAccess = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;

// Finds the barriers between steps: before a step, everything that it reads or overwrites has to be complete and
// visible. One memory barrier serves all resources of a step.
class HazardTracker {
 public:
  struct Barrier {
    VkPipelineStageFlags from = 0;  // 0: no barrier is needed
    VkAccessFlags from_access = 0;
    VkPipelineStageFlags to = 0;
    VkAccessFlags to_access = 0;
  };

  // Adds what commands before the first step may have done with a resource.
  void assume(Resource resource, VkAccessFlags access);
  // Returns the barrier that has to precede a step, and takes note of the barrier and of the step.
  [[nodiscard]] Barrier before(const Uses& uses);

 private:
  struct State {
    VkAccessFlags written = 0;  // the last writes
    VkAccessFlags visible = 0;  // accesses that see them
    VkAccessFlags read = 0;     // reads since then
    VkAccessFlags ordered = 0;  // writes that wait for these reads
  };
  std::array<State, kResources> states_ = {};
};

}  // namespace tyndall
