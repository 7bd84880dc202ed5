# Installs the libraries as a CMake package, and for pkg-config. Its components: runtime, development, licence; the program
# is the component program. find_package(tyndall) provides tyndall::static and
# tyndall::shared as far as they are installed, tyndall::effect as one of them, and tyndall::post if it was built.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tyndall)
if(NOT TYNDALL_INSTALL_STATIC AND NOT TYNDALL_BUILD_SHARED)
  message(FATAL_ERROR "TYNDALL_INSTALL_STATIC and TYNDALL_BUILD_SHARED are off: no library is left to install; expected at least one")
endif()
if(TYNDALL_INSTALL_STATIC)
  install(TARGETS tyndall_effect EXPORT tyndall COMPONENT development)
endif()
if(TYNDALL_BUILD_SHARED)
  install(TARGETS tyndall_shared EXPORT tyndall RUNTIME COMPONENT runtime LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
          ARCHIVE COMPONENT development)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/tyndall DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
install(FILES ${PROJECT_BINARY_DIR}/include/tyndall/atmosphere.glsl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tyndall
        COMPONENT development)
if(TARGET tyndall_post)
  install(TARGETS tyndall_post EXPORT tyndall COMPONENT development)
endif()
install(EXPORT tyndall NAMESPACE tyndall:: FILE tyndallTargets.cmake DESTINATION ${package_dir}
        COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/tyndallConfig.cmake.in ${PROJECT_BINARY_DIR}/tyndallConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tyndallConfigVersion.cmake
                                 VERSION ${PROJECT_VERSION} COMPATIBILITY ${TYNDALL_COMPATIBILITY})
install(FILES ${PROJECT_BINARY_DIR}/tyndallConfig.cmake ${PROJECT_BINARY_DIR}/tyndallConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/vulkan_headers.cmake DESTINATION ${package_dir} COMPONENT development)

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
install(FILES ${PROJECT_BINARY_DIR}/tyndall.pc DESTINATION ${pkgconfig_dir} COMPONENT development)
