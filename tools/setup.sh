#!/bin/sh
# Installs the Debian packages that are missing, with apt-get (and sudo when not root). On a system without
# apt-get, or where installing is not possible, it prints the required tools and continues.
# Arguments: additional packages.
set -u

packages="build-essential cmake ninja-build pkg-config ccache python3
glslc spirv-tools libspirv-cross-c-shared-dev
libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers
libglm-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
libglfw3-dev libx11-dev libimgui-dev libshaderc-dev xvfb xdotool openbox
libdraco-dev libmeshoptimizer-dev libstb-dev libopenexr-dev libpng-dev zlib1g-dev libxxhash-dev libgdal-dev libgtest-dev
python3-dev pybind11-dev python3-numpy python3-pytest python3-matplotlib
doxygen abigail-tools $*"

needs() {
  echo "Tyndall needs: a C++20 compiler, CMake 3.25, Ninja, pkg-config, Python 3, glslc, SPIRV-Tools, SPIRV-Cross (C API)," >&2
  echo "Vulkan 1.3 headers, loader, a driver and the validation layers, GLM, CLI11, toml++, nlohmann-json," >&2
  echo "stb, OpenEXR, libpng, zlib, xxHash, GDAL, GoogleTest, GLFW, ImGui, shaderc, pybind11, NumPy, pytest, matplotlib; Xvfb, xdotool and openbox for tests of windows." >&2
  echo "Optional: Draco and meshoptimizer, for glTF files that they compress; Doxygen, for the reference of the headers;" >&2
  echo "libabigail, for the check of the binary interface." >&2
  echo "Going on with what is installed." >&2
}

if ! command -v apt-get > /dev/null 2>&1 || ! command -v dpkg-query > /dev/null 2>&1; then
  needs
  exit 0
fi

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2> /dev/null) || status=""
  case "$status" in ii*) ;; *) missing="$missing $package" ;; esac
done
[ -z "$missing" ] && exit 0

as_root=""
if [ "$(id -u)" != 0 ]; then
  if command -v sudo > /dev/null 2>&1; then
    as_root="sudo"
  else
    echo "Missing Debian packages:$missing" >&2
    echo "They cannot be installed: not root, and there is no sudo." >&2
    needs
    exit 0
  fi
fi

# Shows how far apt-get is: in one line on a terminal, in a line every 50 steps otherwise. With what the packages depend
# on, each of them is downloaded, unpacked and set up.
show_progress() {
  awk -v terminal="$([ -t 1 ] && echo 1)" '
    function show(what) {
      if (terminal) printf "\r  %s: %d of %d steps\033[K", what, steps, total
      else if (steps % 50 == 0) printf "  %s: %d of %d steps\n", what, steps, total
      fflush()
    }
    / newly installed,/ { for (i = 2; i <= NF; ++i) if ($i == "newly") total += 3 * $(i - 1) }
    /^Get:/ && total { ++steps; show("downloading") }
    /^Unpacking / { ++steps; show("unpacking") }
    /^Setting up / { ++steps; show("setting up") }
    END { if (terminal) printf "\r\033[K" }'
}

echo "Installing:$missing"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2086  # the list is meant to be split
{
  if $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q update &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends $missing; then
    : > "$work/done"
  fi
} 2>&1 | tee "$work/log" | show_progress
if [ ! -e "$work/done" ]; then
  tail -n 5 "$work/log" >&2
  needs
fi
exit 0
