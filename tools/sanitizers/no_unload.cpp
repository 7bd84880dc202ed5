// Replaces dlclose() in executables that are built with sanitizers. The suppressions of this folder name the libraries
// of drivers and layers, and a sanitizer can only name a library that is still loaded when it reports.
#include <dlfcn.h>

extern "C" int dlclose(void* /*handle*/) noexcept { return 0; }
