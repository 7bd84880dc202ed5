// A buffer that the host writes for every frame while the device still reads what it held for the previous one.
#pragma once

#include <array>
#include <cstring>
#include <utility>

#include "gpu/frames_in_flight.hpp"
#include "gpu/resource.hpp"
#include "gpu/try.hpp"

namespace tyndall::gpu {

class UploadRing {
 public:
  static Result<UploadRing> create(const Device& device, const char* name, VkDeviceSize size,
                                   VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    UploadRing out;
    for (Buffer& copy : out.copies_) {
      TYNDALL_ASSIGN(copy, create_buffer(device, name, size, usage, MemoryKind::upload));
    }
    return out;
  }

  // Moves on to the next copy and returns its address. The commands that read it must have completed, which are those
  // of kFramesInFlight calls ago.
  void* next() {
    current_ = (current_ + 1) % copies_.size();
    return copies_[current_].mapped;
  }
  // Moves on to the next copy and writes `value` to it.
  template <typename T>
  void write(const T& value) {
    std::memcpy(next(), &value, sizeof value);
  }
  // Returns the copy that was written last.
  [[nodiscard]] VkBuffer buffer() const { return copies_[current_].buffer.get(); }
  [[nodiscard]] VkDeviceSize bytes() const {
    VkDeviceSize sum = 0;
    for (const Buffer& copy : copies_) sum += copy.bytes;
    return sum;
  }

 private:
  std::array<Buffer, kFramesInFlight> copies_;
  std::size_t current_ = 0;
};

}  // namespace tyndall::gpu
