"""Conan recipe of the library: conan create . -o "&:shared=True" -o "&:post=True"."""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.build import check_min_cppstd
from conan.tools.files import copy, load


class Tyndall(ConanFile):
    name = "tyndall"
    description = "Outdoor light scattering: sky, haze and light shafts"
    license = "Apache-2.0"
    topics = ("vulkan", "atmosphere", "rendering")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "post": [True, False]}
    default_options = {"shared": False, "post": False}
    exports_sources = ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "shaders/*", "src/*", "tools/CMakeLists.txt",
                       "tools/embed_shaders.cpp", "tools/flatten_glsl.cpp", "tools/sanitizers/*")

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, "include", "tyndall", "version.h"))
        self.version = re.search(r'TYNDALL_VERSION_STRING "([^"]+)"', header).group(1)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        # The headers of the library include those of Vulkan.
        self.requires("vulkan-headers/[>=1.3]", transitive_headers=True)
        if self.options.post:
            self.requires("glm/[>=0.9.9]")

    def build_requirements(self):
        # glslc, spirv-opt and spirv-val compile the shaders; SPIRV-Cross reflects them.
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("shaderc/[>=2022]")
        self.tool_requires("spirv-tools/[>=1.3]")
        self.requires("spirv-cross/[>=1.3]", visible=False, headers=True, libs=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name, value in self.cmake_options().items():
            toolchain.cache_variables[name] = value
        toolchain.generate()
        CMakeDeps(self).generate()

    def cmake_options(self):
        return {
            "TYNDALL_BUILD_APPS": False,
            "TYNDALL_BUILD_TESTS": False,
            "TYNDALL_BUILD_POST": bool(self.options.post),
            "TYNDALL_BUILD_SHARED": bool(self.options.shared),
            "TYNDALL_INSTALL_STATIC": not self.options.shared,
        }

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # The package of CMake that the library installs, instead of one that Conan generates.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "tyndall"))
        self.cpp_info.libs = ["tyndall"] + (["tyndall_post"] if self.options.post else [])
        if self.settings.os == "Linux" and not self.options.shared:
            self.cpp_info.system_libs = ["m", "pthread"]
