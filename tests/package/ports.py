#!/usr/bin/env python3
"""Checks the vcpkg port and the Conan recipe without these programs.

usage: ports.py CMAKE SOURCE_FOLDER WORK_FOLDER COMPILER

Runs the portfile with replacements for vcpkg's functions, and the recipe with a replacement for Conan's modules. The options
that they pass to CMake must be options of the project, and must configure a build of the library alone, in which neither
programs nor the Vulkan loader occur. The version is that of the header.
"""
import json
import os
import re
import runpy
import subprocess
import sys
import types

STUBS = """
set(VCPKG_LIBRARY_LINKAGE {linkage})
set(CURRENT_PACKAGES_DIR {work}/packages)
set(CURRENT_HOST_INSTALLED_DIR {tools})
set(VCPKG_HOST_EXECUTABLE_SUFFIX "")
set(PORT tyndall)
function(vcpkg_check_features)
  cmake_parse_arguments(arg "" "OUT_FEATURE_OPTIONS" "FEATURES" ${{ARGN}})
  list(GET arg_FEATURES 1 option)
  set(${{arg_OUT_FEATURE_OPTIONS}} -D${{option}}={post} PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  cmake_parse_arguments(arg "" "SOURCE_PATH" "OPTIONS" ${{ARGN}})
  message(STATUS "source=${{arg_SOURCE_PATH}}")
  foreach(option ${{arg_OPTIONS}})
    message(STATUS "option=${{option}}")
  endforeach()
endfunction()
foreach(name vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig)
  cmake_language(EVAL CODE "function(${{name}})\\nendfunction()")
endforeach()
function(vcpkg_install_copyright)
  cmake_parse_arguments(arg "" "" "FILE_LIST" ${{ARGN}})
  if(NOT EXISTS ${{arg_FILE_LIST}})
    message(FATAL_ERROR "there is no file ${{arg_FILE_LIST}}")
  endif()
endfunction()
"""

problems = []


def version_of(source):
    with open(f"{source}/include/tyndall/version.h", encoding="utf-8") as file:
        return re.search(r'TYNDALL_VERSION_STRING "([^"]+)"', file.read()).group(1)


def port_options(cmake, source, work, linkage, post):
    port = f"{source}/tools/ports/vcpkg/tyndall"
    script = f"{work}/port.cmake"
    # Folders like those of vcpkg, with links to the tools of this system.
    for tool, folder in (("glslc", "shaderc"), ("spirv-opt", "spirv-tools"), ("spirv-val", "spirv-tools")):
        os.makedirs(f"{work}/host/tools/{folder}", exist_ok=True)
        path = f"{work}/host/tools/{folder}/{tool}"
        if not os.path.islink(path):
            found = subprocess.run(["sh", "-c", f"command -v {tool}"], capture_output=True, text=True, check=True).stdout
            os.symlink(found.strip(), path)
    with open(script, "w", encoding="utf-8") as file:
        file.write(STUBS.format(linkage=linkage, work=work, post=post, tools=f"{work}/host"))
        file.write(f"include({port}/portfile.cmake)\n")
    ran = subprocess.run([cmake, "-P", script], capture_output=True, text=True, check=False)
    output = ran.stdout + ran.stderr
    if ran.returncode != 0:
        problems.append(f"portfile.cmake fails: {output}")
    if not re.search(rf"source={re.escape(os.path.realpath(source))}$", output, re.M):
        problems.append(f"portfile.cmake: the source folder is not {source}: {output}")
    if not os.path.exists(f"{work}/packages/share/tyndall/usage"):
        problems.append("portfile.cmake does not install the file usage")
    return re.findall(r"option=(.*)", output)


def recipe_options(source, shared, post):
    """Loads the recipe with a replacement for Conan. Returns its options, and the sources that it exports."""
    def module(name, **members):
        sys.modules[name] = types.ModuleType(name)
        sys.modules[name].__dict__.update(members)

    class Base:
        recipe_folder = source

        def __init__(self):
            self.options = types.SimpleNamespace(shared=shared, post=post)
            self.settings = types.SimpleNamespace(os="Linux")
            self.required = []
            self.cpp_info = types.SimpleNamespace(set_property=lambda *_: None, builddirs=[])

        def requires(self, name, **_):
            self.required.append(name)

        def tool_requires(self, name):
            self.required.append(name)

    def read(_, path):
        with open(path, encoding="utf-8") as file:
            return file.read()

    variables = {}
    toolchain = types.SimpleNamespace(cache_variables=variables, generate=lambda: None)
    module("conan", ConanFile=Base)
    module("conan.tools")
    module("conan.tools.cmake", CMake=None, CMakeDeps=lambda _: types.SimpleNamespace(generate=lambda: None),
           CMakeToolchain=lambda _: toolchain, cmake_layout=lambda _: None)
    module("conan.tools.build", check_min_cppstd=lambda recipe, version: None)
    module("conan.tools.files", copy=None, load=read)
    recipe = runpy.run_path(f"{source}/conanfile.py")["Tyndall"]()
    for step in ("set_version", "layout", "requirements", "build_requirements", "validate", "generate", "package_info"):
        getattr(recipe, step)()
    if recipe.version != version_of(source):
        problems.append(f"conanfile.py: the version is {recipe.version}; expected {version_of(source)}")
    expected = {"vulkan-headers", "shaderc", "spirv-tools", "spirv-cross", "cmake"} | ({"glm"} if post else set())
    if {name.split("/")[0] for name in recipe.required} != expected:
        problems.append(f"conanfile.py requires {recipe.required}; expected {sorted(expected)}")
    for pattern in recipe.exports_sources:
        if not os.path.exists(os.path.join(source, pattern.removesuffix("/*"))):
            problems.append(f"conanfile.py exports '{pattern}', which does not exist")
    return [f"-D{name}={'ON' if value else 'OFF'}" for name, value in variables.items()], recipe.exports_sources


def configure(cmake, source, work, compiler, name, options, exported=None):
    """Configures the project, and checks which targets there are."""
    build = f"{work}/{name}"
    if exported:
        # The recipe must export every file that the configuration reads.
        copy = f"{work}/exported"
        if not os.path.isdir(copy):
            for pattern in exported:
                path = pattern.removesuffix("/*")
                target = os.path.join(copy, path)
                os.makedirs(os.path.dirname(target), exist_ok=True)
                subprocess.run(["cp", "-R", os.path.join(source, path), target], check=True)
        source = copy
    ran = subprocess.run([cmake, "-G", "Ninja", "-S", source, "-B", build, f"-DCMAKE_CXX_COMPILER={compiler}",
                          "-DCMAKE_BUILD_TYPE=Release", *options], capture_output=True, text=True, check=False)
    output = ran.stdout + ran.stderr
    if ran.returncode != 0:
        problems.append(f"{name}: the configuration fails: {output}")
        return
    if "Manually-specified variables were not used" in output:
        problems.append(f"{name}: CMake does not know an option: {output[output.index('Manually'):]}")
    commands = subprocess.run(["ninja", "-C", build, "-t", "commands"], capture_output=True, text=True, check=True).stdout
    post = any(option in options for option in ("-DTYNDALL_BUILD_POST=ON", "-DTYNDALL_BUILD_POST=1"))
    shared = any(option in options for option in ("-DTYNDALL_BUILD_SHARED=ON", "-DTYNDALL_BUILD_SHARED=1"))
    for what, expected in (("/apps/", False), ("/src/scene/", False), ("libvulkan", False), ("tone_mapper.cpp", post),
                           ("libtyndall.so", shared), ("effect_api.cpp", True)):
        if (what in commands) != expected:
            problems.append(f"{name}: the commands of the build contain {what}: {not expected}; expected {expected}")


def main():
    cmake, source, work, compiler = sys.argv[1:]
    source = os.path.realpath(source)
    subprocess.run(["rm", "-rf", work], check=True)
    os.makedirs(work)
    with open(f"{source}/tools/ports/vcpkg/tyndall/vcpkg.json", encoding="utf-8") as file:
        manifest = json.load(file)
    if manifest["version"] != version_of(source):
        problems.append(f"vcpkg.json: the version is {manifest['version']}; expected {version_of(source)}")
    for linkage, post in (("static", "OFF"), ("dynamic", "ON")):
        options = port_options(cmake, source, work, linkage, post)
        if len(options) != 8:
            problems.append(f"portfile.cmake passes {len(options)} options; expected 8")
        configure(cmake, source, work, compiler, f"vcpkg_{linkage}", options)
    for shared, post in ((True, False), (False, True)):
        options, exported = recipe_options(source, shared, post)
        configure(cmake, source, work, compiler, f"conan_{shared}", options, exported)
    print("\n".join(problems) or "the vcpkg port and the Conan recipe configure the library")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
