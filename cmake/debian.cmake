# Debian packages through CPack: libtyndall0 (shared library), libtyndall-dev (headers, static libraries, packages of CMake and
# pkg-config), tyndall (the program) and python3-tyndall. `make packages` builds them; tests/package/debian.sh installs, runs and removes them.
find_program(TYNDALL_DPKG_DEB dpkg-deb)
if(NOT TYNDALL_DPKG_DEB OR NOT TYNDALL_BUILD_SHARED OR NOT TYNDALL_INSTALL_STATIC)
  return()
endif()
set(TYNDALL_PACKAGE_RELEASE 1 CACHE STRING "Revision of the Debian packages")
set(TYNDALL_PACKAGE_CONTACT "Tyndall maintainers <maintainers@tyndall.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(package_version ${PROJECT_VERSION}-${TYNDALL_PACKAGE_RELEASE})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tyndall)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each component has a description
set(CPACK_PACKAGE_VENDOR Tyndall)
set(CPACK_PACKAGE_CONTACT "${TYNDALL_PACKAGE_CONTACT}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# Permissions of folders do not depend on the umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${TYNDALL_PACKAGE_RELEASE})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libtyndall0)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Outdoor light scattering for engines: shared library
Tyndall records sky, aerial perspective and light shafts into the Vulkan
command buffer of an engine, from its colour, depth and shadow maps.

This package contains the shared library, for C and C++.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtyndall-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# libvulkan-dev contains the headers of Vulkan, which those of Tyndall include.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libtyndall0 (= ${package_version}), libvulkan-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Outdoor light scattering for engines: development files
Tyndall records sky, aerial perspective and light shafts into the Vulkan
command buffer of an engine, from its colour, depth and shadow maps.

This package contains headers, static libraries, and files for CMake and
pkg-config.")
if(TYNDALL_BUILD_APPS)
  list(APPEND CPACK_COMPONENTS_ALL program)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tyndall)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
  set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Outdoor light scattering: command line and viewer
Tyndall renders the blue of the sky, the red of sunset, the haze on distant
hills and the shafts of light between them, on any Vulkan 1.3 device.

This package contains the program tyndall, which renders, measures and
exports, and its scenes.")
endif()
if(TARGET tyndall_python)
  list(APPEND CPACK_COMPONENTS_ALL python_package)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_NAME python3-tyndall)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_SHLIBDEPS ON)
  # The extension module belongs to one minor version of Python.
  get_target_property(python_minor tyndall_python TYNDALL_PYTHON_MINOR)
  math(EXPR python_next "${python_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_DEPENDS "python3 (>= 3.${python_minor}~), python3 (<< 3.${python_next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
  set(CPACK_COMPONENT_PYTHON_PACKAGE_DESCRIPTION "Outdoor light scattering: Python module
Tyndall answers how bright the sky is, at any hour and through any air:
radiance, irradiance, transmittance and aerial perspective as NumPy arrays,
from tables on a Vulkan device or from a path tracer.

This package contains the module tyndall for Python 3.")
endif()
# The SONAME contains the minor version, but the name of the package does not. Packages that depend on this one therefore require
# this minor version.
math(EXPR next_minor "${PROJECT_VERSION_MINOR} + 1")
set(debian_dir ${PROJECT_BINARY_DIR}/debian)
file(WRITE ${debian_dir}/shlibs "libtyndall ${TYNDALL_COMPATIBLE_VERSION} libtyndall0 (>= ${PROJECT_VERSION}), libtyndall0 (<< ${PROJECT_VERSION_MAJOR}.${next_minor}~)\n")
file(WRITE ${debian_dir}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${debian_dir}/shlibs ${debian_dir}/triggers)
# CPack writes scripts that call ldconfig, as the trigger does, unless there are others.
foreach(script postinst postrm)
  file(WRITE ${debian_dir}/${script} "#!/bin/sh\nset -e\n# The trigger ldconfig does everything.\nexit 0\n")
  list(APPEND CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${debian_dir}/${script})
endforeach()

# Python's byte code is compiled at installation, and removed.
foreach(script postinst:py3compile prerm:py3clean)
  string(REPLACE ":" ";" script ${script})
  list(GET script 0 name)
  list(GET script 1 command)
  file(WRITE ${debian_dir}/python/${name} "#!/bin/sh\nset -e\nif [ -z \"\${DPKG_ROOT:-}\" ] && command -v ${command} > /dev/null; then ${command} -p python3-tyndall; fi\nexit 0\n")
  list(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_PACKAGE_CONTROL_EXTRA ${debian_dir}/python/${name})
endforeach()

# Documents of the packages, which other installations do not get.
execute_process(COMMAND sh ${PROJECT_SOURCE_DIR}/tools/debian/documents.sh ${PROJECT_SOURCE_DIR} ${debian_dir} ${TYNDALL_PACKAGE_RELEASE}
                        "${TYNDALL_PACKAGE_CONTACT}" COMMAND_ERROR_IS_FATAL ANY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md
             ${PROJECT_SOURCE_DIR}/tools/debian/documents.sh)
install(FILES ${debian_dir}/tyndall.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program EXCLUDE_FROM_ALL)
foreach(pair runtime:libtyndall0 development:libtyndall-dev program:tyndall python_package:python3-tyndall)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  if(component IN_LIST CPACK_COMPONENTS_ALL)
    install(DIRECTORY ${debian_dir}/${package}/ DESTINATION share/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
    if(EXISTS ${PROJECT_SOURCE_DIR}/tools/debian/${package}.overrides)
      install(FILES ${PROJECT_SOURCE_DIR}/tools/debian/${package}.overrides DESTINATION share/lintian/overrides RENAME ${package}
              COMPONENT ${component} EXCLUDE_FROM_ALL)
    endif()
  endif()
endforeach()
include(CPack)
