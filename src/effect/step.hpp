// A step of the effect as data: the shader, its specialisation constants, the size of its dispatch, and the resources
// that it reads and writes. frame_steps.cpp and table_steps.cpp create lists of steps. Pipelines, barriers, debug
// labels, timings and memory follow from these lists. No Vulkan objects are needed to create or examine a step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "effect/resources.hpp"
#include "effect/shared.hpp"
#include "gpu/shader.hpp"
#include "tyndall/params.hpp"

namespace tyndall::gpu {
struct Device;
}

namespace tyndall {

// Values of the specialisation constants, indexed by the ids of shaders/shared/constant_ids.h.
struct Specialisation {
  std::array<std::uint8_t, shared::kSpecialisationIds> values = {};

  [[nodiscard]] std::uint8_t& operator[](std::uint32_t id) { return values[id]; }
  [[nodiscard]] std::uint8_t operator[](std::uint32_t id) const { return values[id]; }
  bool operator==(const Specialisation&) const = default;
};

// Identifies a pipeline: the shader and the values of its constants. Constants that the shader does not have are 0.
struct PipelineKey {
  const gpu::Shader* shader = nullptr;
  Specialisation constants;
  bool operator==(const PipelineKey&) const = default;
};
[[nodiscard]] PipelineKey pipeline_key(const gpu::Shader& shader, const Specialisation& constants);

// Returns the kind of device for which passes are chosen.
[[nodiscard]] Target target_of(const gpu::Device& device);
// Returns the variant of a shader for a target and a representation of light: the shader with "_spectral", "_gpu" or
// "_spectral_gpu" appended to its name. A shader that has no such variant serves all.
[[nodiscard]] const gpu::Shader& variant_for(const gpu::Shader& shader, Target target,
                                             ColorMode color = ColorMode::rgb);

struct Step {
  enum class Kind : std::uint8_t {
    dispatch,           // over `invocations`
    dispatch_indirect,  // over the items of the list `chosen`
    reset_list,         // makes the list `chosen` empty
    clear,              // fills `chosen` with zeros
    copy,               // from `chosen` to `target`
    host_read           // records no command: makes `chosen` visible to the host
  };
  const char* name = "";  // of the pass, in debug labels, timings and documentation
  Kind kind = Kind::dispatch;
  Resource chosen = Resource::none;  // also the resource of the bindings `work` and `ray`
  Resource target = Resource::none;
  PipelineKey pipeline;
  std::array<std::uint32_t, 2> push = {};  // push constants
  VkExtent3D invocations = {1, 1, 1};

  [[nodiscard]] bool dispatches() const { return kind == Kind::dispatch || kind == Kind::dispatch_indirect; }
};

// Identifies a descriptor set among those of a frame or a build: steps with the same shader and the same chosen
// resource have the same bindings.
struct SetKey {
  const gpu::Shader* shader = nullptr;
  Resource chosen = Resource::none;  // none if the shader has no binding for it
  bool operator==(const SetKey&) const = default;
};
// Precondition: step.dispatches().
[[nodiscard]] SetKey set_key(const Step& step);

// The accesses of a step to a resource, as VK_ACCESS_* flags.
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
// Returns the accesses of a step. They follow from the bindings of the shader, and from the qualifiers `readonly` and
// `writeonly` in GLSL.
[[nodiscard]] Uses uses_of(const Step& step);
// Returns the resources of a shader's bindings, in the order of gpu::Shader::bindings.
[[nodiscard]] std::span<const Resource> bound_resources(const gpu::Shader& shader);

constexpr VkAccessFlags kWriteAccess = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;

// Determines the barriers between steps. Before a step, all accesses that conflict with it must be complete and
// visible. One memory barrier serves all resources of a step.
class HazardTracker {
 public:
  struct Barrier {
    VkPipelineStageFlags from = 0;  // 0: no barrier is needed
    VkAccessFlags from_access = 0;
    VkPipelineStageFlags to = 0;
    VkAccessFlags to_access = 0;
  };

  // Adds possible accesses of earlier commands to a resource. To be called before the first step.
  void assume(Resource resource, VkAccessFlags access);
  // Returns the barrier that must precede a step, and updates the state for both.
  [[nodiscard]] Barrier before(const Uses& uses);

 private:
  struct State {
    VkAccessFlags written = 0;  // the last writes
    VkAccessFlags visible = 0;  // accesses to which they are visible
    VkAccessFlags read = 0;     // reads since then
    VkAccessFlags ordered = 0;  // writes that are ordered after these reads
  };
  std::array<State, kResources> states_ = {};
};

}  // namespace tyndall
