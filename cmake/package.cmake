# Installs the libraries as a CMake package. find_package(tyndall) provides tyndall::effect, and tyndall::post if it was built.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tyndall)
install(TARGETS tyndall_effect EXPORT tyndall)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/tyndall DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET tyndall_post)
  # Its headers, and those of the Vulkan layer that they include, are in a separate folder: #include "post/tonemap.hpp".
  install(TARGETS tyndall_post tyndall_gpu EXPORT tyndall)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/post ${PROJECT_SOURCE_DIR}/src/gpu DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tyndall-post
          FILES_MATCHING PATTERN "*.hpp" PATTERN host.hpp EXCLUDE)
endif()
install(EXPORT tyndall NAMESPACE tyndall:: FILE tyndallTargets.cmake DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/tyndallConfig.cmake.in ${PROJECT_BINARY_DIR}/tyndallConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tyndallConfigVersion.cmake
                                 VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tyndallConfig.cmake ${PROJECT_BINARY_DIR}/tyndallConfigVersion.cmake DESTINATION ${package_dir})
