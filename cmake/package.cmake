# Installs the libraries as a CMake package, and for pkg-config. find_package(tyndall) provides tyndall::static and
# tyndall::shared as far as they are installed, tyndall::effect as one of them, and tyndall::post if it was built.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tyndall)
if(NOT TYNDALL_INSTALL_STATIC AND NOT TYNDALL_BUILD_SHARED)
  message(FATAL_ERROR "TYNDALL_INSTALL_STATIC and TYNDALL_BUILD_SHARED are off: no library is left to install; expected at least one")
endif()
if(TYNDALL_INSTALL_STATIC)
  install(TARGETS tyndall_effect EXPORT tyndall)
endif()
if(TYNDALL_BUILD_SHARED)
  install(TARGETS tyndall_shared EXPORT tyndall)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/tyndall DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
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
                                 VERSION ${PROJECT_VERSION} COMPATIBILITY ${TYNDALL_COMPATIBILITY})
install(FILES ${PROJECT_BINARY_DIR}/tyndallConfig.cmake ${PROJECT_BINARY_DIR}/tyndallConfigVersion.cmake DESTINATION ${package_dir})

# The paths of the file for pkg-config start from its own place, so that the installation can be moved as a whole.
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
set(pkgconfig_prefix ${CMAKE_INSTALL_PREFIX})
if(NOT IS_ABSOLUTE ${pkgconfig_dir})
  file(RELATIVE_PATH up ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
  set(pkgconfig_prefix "\${pcfiledir}/${up}")
endif()
cmake_path(APPEND pkgconfig_libdir "\${prefix}" ${CMAKE_INSTALL_LIBDIR})
cmake_path(APPEND pkgconfig_includedir "\${prefix}" ${CMAKE_INSTALL_INCLUDEDIR})
configure_file(${PROJECT_SOURCE_DIR}/cmake/tyndall.pc.in ${PROJECT_BINARY_DIR}/tyndall.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/tyndall.pc DESTINATION ${pkgconfig_dir})
