// Memory of this process.
#pragma once

#include <cstddef>

namespace tyndall::viewer {

// Sets up malloc for threads that come and go: one arena, and large blocks that return to the system when freed.
void configure_malloc();
// Returns the resident memory [KiB]; 0 where it is not known.
[[nodiscard]] long resident_kib();
// Returns the memory that malloc has given out [KiB]; 0 where it is not known.
[[nodiscard]] std::size_t allocated_kib();

}  // namespace tyndall::viewer
