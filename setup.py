"""Builds the Python package: the extension module with CMake, the rest with setuptools. pyproject.toml describes it.

TYNDALL_BUILD_FOLDER: folder for CMake, build/wheel by default. One that is configured already is used as it is.
TYNDALL_CMAKE_ARGUMENTS: more arguments for cmake, separated by spaces.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("TYNDALL_BUILD_FOLDER") or SOURCE / "build" / "wheel").resolve()


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        if not (BUILD / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", *self.configuration()], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "tyndall_python"], check=True)
        suffix = pathlib.Path(self.get_ext_filename("_core")).name
        built = BUILD / "python" / "tyndall" / suffix
        if not built.exists():
            raise SystemExit(f"tyndall: error: '{BUILD}': {suffix} was not built; expected a build for {sys.executable}")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(built, target)

    @staticmethod
    def configuration():
        options = ["-D", "CMAKE_BUILD_TYPE=Release", "-D", "TYNDALL_BUILD_TESTS=OFF", "-D", "TYNDALL_WITH_VIEWER=OFF",
                   "-D", "TYNDALL_WITH_PYTHON=ON", "-D", f"TYNDALL_PYTHON={sys.executable}"]
        try:
            import pybind11
            options += ["-D", f"pybind11_DIR={pybind11.get_cmake_dir()}"]
        except (ImportError, AttributeError):
            pass  # CMake looks for Debian's pybind11-dev
        return options + shlex.split(os.environ.get("TYNDALL_CMAKE_ARGUMENTS", ""))


version = re.search(r'TYNDALL_VERSION_STRING "([^"]*)"', (SOURCE / "include/tyndall/version.h").read_text()).group(1)
(SOURCE / "build").mkdir(exist_ok=True)
setup(version=version, package_dir={"": "python"}, packages=["tyndall"], ext_modules=[Extension("tyndall._core", [])],
      cmdclass={"build_ext": CMakeBuild}, zip_safe=False,
      options={"egg_info": {"egg_base": "build"}, "build": {"build_base": "build/wheel-files"}})
