// The format of the output in compiled shaders: one word of each module, for pictures of rgba16f and rgba32f.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "effect/frame_steps.hpp"
#include "gpu/storage_format.hpp"

namespace tyndall {
namespace {

using Words = std::vector<std::uint32_t>;

const gpu::Binding* output_of(const gpu::Shader& shader) {
  const auto found = std::find_if(shader.bindings.begin(), shader.bindings.end(),
                                  [](const gpu::Binding& b) { return b.name == name_of(Resource::output_color); });
  return found == shader.bindings.end() ? nullptr : &*found;
}

// Returns the shaders that write the output, of all techniques, targets and representations of light.
std::set<const gpu::Shader*> shaders_with_output() {
  std::set<const gpu::Shader*> out;
  for (const Target target : {Target::cpu, Target::gpu}) {
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
      for (const std::uint32_t variant : {0U, 1U, 2U, 3U, 4U}) {
        Params params;
        params.scattering.color = color;
        if (variant == 1) params.scattering.technique = Technique::brute_force;
        if (variant == 2) params.scattering.technique = Technique::froxels;
        params.scattering.downscale = variant == 3 ? 2 : 1;
        params.epipolar.show_sampling = variant == 3;
        params.scattering.enabled = variant != 4;
        for (const Step& step : frame_steps({}, params, {{1280, 720}, 4, 0, false, false, target})) {
          if (step.dispatches() && output_of(*step.pipeline.shader) != nullptr) out.insert(step.pipeline.shader);
        }
      }
    }
  }
  return out;
}

// Returns how many words of both modules differ.
std::size_t differences(const Words& a, const Words& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

// Counts the instructions with an opcode that have a word at an operand.
std::size_t count_of(const Words& spirv, std::uint32_t opcode, std::size_t operand, std::uint32_t word) {
  std::size_t count = 0;
  for (std::size_t at = 5; at < spirv.size(); at += spirv[at] >> 16U) {
    if ((spirv[at] & 0xFFFFU) == opcode && (spirv[at] >> 16U) > operand && spirv[at + operand] == word) ++count;
  }
  return count;
}

TEST(OutputFormat, OneWordOfEachShaderChanges) {
  const std::set<const gpu::Shader*> shaders = shaders_with_output();
  EXPECT_EQ(shaders.size(), 32U);  // seven passes with four variants, and two passes that carry no light
  for (const gpu::Shader* shader : shaders) {
    const Words original(shader->spirv.begin(), shader->spirv.end());
    const std::uint32_t binding = output_of(*shader)->binding;
    Words changed = original;
    ASSERT_TRUE(gpu::set_storage_format(changed, {binding, VK_FORMAT_R16G16B16A16_SFLOAT})) << shader->name;
    EXPECT_EQ(changed, original) << shader->name;
    ASSERT_TRUE(gpu::set_storage_format(changed, {binding, VK_FORMAT_R32G32B32A32_SFLOAT})) << shader->name;
    EXPECT_EQ(differences(changed, original), 1U) << shader->name;
    // No other image has that type: a type has one pointer for images, and it has one variable.
    const auto [a, b] = std::mismatch(changed.begin(), changed.end(), original.begin());
    const std::uint32_t type = *(b - 7);
    EXPECT_EQ(*(b - 8), (9U << 16U) | 25U) << shader->name;  // OpTypeImage without an access qualifier
    EXPECT_EQ(count_of(original, 32, 3, type), 1U) << shader->name;
    for (std::size_t at = 5; at < original.size(); at += original[at] >> 16U) {
      if ((original[at] & 0xFFFFU) != 32 || original[at + 3] != type) continue;
      EXPECT_EQ(count_of(original, 59, 1, original[at + 1]), 1U) << shader->name;
    }
  }
}

TEST(OutputFormat, WhatCannotBeChangedStaysAsItIs) {
  const gpu::Shader& shader = **shaders_with_output().begin();
  const Words original(shader.spirv.begin(), shader.spirv.end());
  const std::uint32_t binding = output_of(shader)->binding;
  const auto expect_refused = [&](Words words, gpu::StorageFormat format) {
    const Words before = words;
    EXPECT_FALSE(gpu::set_storage_format(words, format));
    EXPECT_EQ(words, before);
  };
  expect_refused(original, {binding, VK_FORMAT_R8G8B8A8_UNORM});
  expect_refused(original, {99, VK_FORMAT_R32G32B32A32_SFLOAT});
  expect_refused({}, {binding, VK_FORMAT_R32G32B32A32_SFLOAT});
  const std::size_t decorations = 400;  // the words that lead to the image are near the beginning
  for (std::size_t words = 0; words < std::min(decorations, original.size()); ++words) {
    Words damaged(original.begin(), original.begin() + static_cast<std::ptrdiff_t>(words));
    gpu::set_storage_format(damaged, {binding, VK_FORMAT_R32G32B32A32_SFLOAT});
    damaged = original;
    damaged[words] ^= 0xFFFF0000U;
    gpu::set_storage_format(damaged, {binding, VK_FORMAT_R32G32B32A32_SFLOAT});
  }
}

}  // namespace
}  // namespace tyndall
