# Provides Vulkan::Headers without the loader, which find_package(Vulkan) requires as well. A file of the installed package,
# and of the build of the library alone. Sets tyndall_VULKAN_INCLUDE_DIR to a false value if the headers are missing.
if(NOT TARGET Vulkan::Headers)
  find_path(tyndall_VULKAN_INCLUDE_DIR vulkan/vulkan.h HINTS "$ENV{VULKAN_SDK}/include")
  if(tyndall_VULKAN_INCLUDE_DIR)
    add_library(Vulkan::Headers INTERFACE IMPORTED)
    set_target_properties(Vulkan::Headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${tyndall_VULKAN_INCLUDE_DIR}")
  endif()
endif()
