// Which sanitizers a test is built with. With one, a program takes several times as long and needs more memory.
#pragma once

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
// It has functions of its own where tests replace `operator new` (tests/gpu/CMakeLists.txt) or pthread_mutex_lock().
#define TYNDALL_THREAD_SANITIZER
#endif
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TYNDALL_SANITIZERS
#endif
#endif

namespace tyndall {

#ifdef TYNDALL_SANITIZERS
constexpr bool kSanitizers = true;
#else
constexpr bool kSanitizers = false;
#endif

}  // namespace tyndall
