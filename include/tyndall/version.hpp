// The version of the library that these headers belong to. CMakeLists.txt reads it from here.
#pragma once

#define TYNDALL_VERSION_MAJOR 0
#define TYNDALL_VERSION_MINOR 2
#define TYNDALL_VERSION_PATCH 0
#define TYNDALL_VERSION_STRING "0.2.0"
