# Optional parts of the program. Each is ON by default and then needs its library. A program that was built without one
# refuses what needs it in one line, and `tyndall --version` lists it.
option(TYNDALL_WITH_GDAL "Read elevation files with GDAL" ON)
option(TYNDALL_WITH_OPENEXR "Read and write EXR files with OpenEXR" ON)
option(TYNDALL_WITH_VIEWER "Build the viewer with GLFW and ImGui" ON)
option(TYNDALL_WITH_SHADERC "Reload shaders in the viewer with shaderc" ON)
option(TYNDALL_WITH_PYTHON "Build the Python package with pybind11" ON)
set(TYNDALL_FEATURES GDAL OPENEXR VIEWER SHADERC PYTHON)

# tyndall_require(FEATURE LIBRARY FOUND PACKAGE): ends the configuration if a feature's library was not found. PACKAGE is
# its name in Debian.
function(tyndall_require feature library found package)
  if(NOT found)
    message(FATAL_ERROR "TYNDALL_WITH_${feature}: ${library} was not found; expected the Debian package ${package}, or "
                        "-D TYNDALL_WITH_${feature}=OFF")
  endif()
endfunction()

# The tests use every library, so that no test is left out silently.
if(TYNDALL_BUILD_TESTS)
  foreach(feature ${TYNDALL_FEATURES})
    if(NOT TYNDALL_WITH_${feature})
      message(FATAL_ERROR "TYNDALL_BUILD_TESTS: the tests need TYNDALL_WITH_${feature}; expected -D TYNDALL_BUILD_TESTS=OFF")
    endif()
  endforeach()
endif()
