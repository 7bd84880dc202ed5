// TYNDALL_API marks the functions and classes that the shared library exports. TYNDALL_HIDDEN marks a class inside such
// a class that it does not export.
#ifndef TYNDALL_EXPORT_H
#define TYNDALL_EXPORT_H

#if defined(_WIN32)
#define TYNDALL_HIDDEN
#if defined(TYNDALL_EXPORTS)  // while the shared library is built
#define TYNDALL_API __declspec(dllexport)
#elif defined(TYNDALL_SHARED)  // set by the CMake target for programs that use the shared library
#define TYNDALL_API __declspec(dllimport)
#else
#define TYNDALL_API
#endif
#elif defined(__GNUC__)
#define TYNDALL_API __attribute__((visibility("default")))
#define TYNDALL_HIDDEN __attribute__((visibility("hidden")))
#else
#define TYNDALL_API
#define TYNDALL_HIDDEN
#endif

#endif
