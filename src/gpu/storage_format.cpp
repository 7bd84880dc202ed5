#include "gpu/storage_format.hpp"

#include <cstddef>
#include <initializer_list>

namespace tyndall::gpu {
namespace {

// Numbers of the SPIR-V specification 1.6, unified1: instructions (section 3.49), decorations (3.20), formats (3.11).
constexpr std::uint32_t kTypeImage = 25, kTypePointer = 32, kVariable = 59, kDecorate = 71;
constexpr std::uint32_t kBinding = 33;
constexpr std::uint32_t kRgba32f = 1, kRgba16f = 2;
constexpr std::size_t kHeaderWords = 5, kFormatOperand = 8;

// Returns the first instruction with an opcode that has certain words at certain operands (0 is the opcode itself), or
// an empty span. It has at least `words` words.
struct Operand {
  std::size_t at;
  std::uint32_t word;
};
std::span<std::uint32_t> find(std::span<std::uint32_t> spirv, std::uint32_t opcode, std::size_t words,
                              std::initializer_list<Operand> operands) {
  std::size_t at = kHeaderWords;
  while (at < spirv.size()) {
    const std::size_t length = spirv[at] >> 16U;
    if (length == 0 || length > spirv.size() - at) return {};
    const std::span<std::uint32_t> instruction = spirv.subspan(at, length);
    bool found = (instruction[0] & 0xFFFFU) == opcode && length >= words;
    for (const Operand& operand : operands) found = found && instruction[operand.at] == operand.word;
    if (found) return instruction;
    at += length;
  }
  return {};
}

}  // namespace

bool set_storage_format(std::span<std::uint32_t> spirv, const StorageFormat& format) {
  const std::uint32_t word = format.format == VK_FORMAT_R32G32B32A32_SFLOAT   ? kRgba32f
                             : format.format == VK_FORMAT_R16G16B16A16_SFLOAT ? kRgba16f
                                                                              : 0;
  if (word == 0) return false;
  const auto decoration = find(spirv, kDecorate, 4, {{2, kBinding}, {3, format.binding}});
  if (decoration.empty()) return false;
  const auto variable = find(spirv, kVariable, 4, {{2, decoration[1]}});
  if (variable.empty()) return false;
  const auto pointer = find(spirv, kTypePointer, 4, {{1, variable[1]}});
  if (pointer.empty()) return false;
  const auto image = find(spirv, kTypeImage, kFormatOperand + 1, {{1, pointer[3]}});
  if (image.empty()) return false;
  image[kFormatOperand] = word;
  return true;
}

}  // namespace tyndall::gpu
