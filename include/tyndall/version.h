// The version of the library that these headers belong to. CMakeLists.txt reads it from here. tyndall_version() of
// tyndall.h returns the version of the library that the program runs with.
#ifndef TYNDALL_VERSION_H
#define TYNDALL_VERSION_H

#define TYNDALL_VERSION_MAJOR 0
#define TYNDALL_VERSION_MINOR 2
#define TYNDALL_VERSION_PATCH 0
#define TYNDALL_VERSION_STRING "0.2.0"

// A version as one number, so that a later version is a larger number.
#define TYNDALL_MAKE_VERSION(major, minor, patch) ((major) << 22 | (minor) << 12 | (patch))
#define TYNDALL_VERSION TYNDALL_MAKE_VERSION(TYNDALL_VERSION_MAJOR, TYNDALL_VERSION_MINOR, TYNDALL_VERSION_PATCH)

#endif
