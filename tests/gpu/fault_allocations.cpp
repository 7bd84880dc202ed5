// Replaces `operator new` by one that can fail. Not for programs with the thread sanitizer, which has functions of its
// own.
#include <cstdlib>
#include <new>

#include "faults.hpp"

[[gnu::noinline]] void* operator new(std::size_t size) {
  const bool fails = tyndall::faults::host_allocation_fails(__builtin_return_address(0));
  if (void* const made = fails ? nullptr : std::malloc(size > 0 ? size : 1); made != nullptr) return made;
  throw std::bad_alloc();
}
// Only the driver calls this. The version of the address sanitizer returns memory that free() must not receive.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size > 0 ? size : 1); }
[[gnu::noinline]] void operator delete(void* pointer) noexcept { std::free(pointer); }
[[gnu::noinline]] void operator delete(void* pointer, std::size_t) noexcept { std::free(pointer); }
