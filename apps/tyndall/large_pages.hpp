// Large pages for the memory of this process.
#pragma once

namespace tyndall::cli {

// Restarts the program so that malloc uses large pages (glibc.malloc.hugetlb), where the system grants them on request.
// On a CPU device, images, buffers and the compiler of shaders use memory of malloc, and most of it for the first time:
// with large pages, `view` starts in three quarters of the time. malloc reads the setting before main(), hence the
// restart. Returns if there is nothing to gain or the restart fails. Does not override GLIBC_TUNABLES. Call it first in
// main().
void restart_with_large_pages(char** argv);

}  // namespace tyndall::cli
