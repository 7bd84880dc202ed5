#!/bin/sh
# Builds a wheel with pip and Debian's packages, without a network, installs it into an empty folder, and uses it from there.
# With a build folder that is configured already, only what is missing is compiled.
# usage: wheel.sh SOURCE_FOLDER WORK_FOLDER [BUILD_FOLDER]
set -eu
source=$1 work=$(mkdir -p "$2" && cd "$2" && pwd)
python=/usr/bin/python3
rm -rf "$work"
mkdir -p "$work"
export TYNDALL_BUILD_FOLDER="${3:-}" PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore
(cd "$source" && $python -m pip wheel --no-build-isolation --no-index --no-deps --wheel-dir "$work" . > "$work/log" 2>&1) ||
  { cat "$work/log"; exit 1; }
$python -m pip install --no-index --no-deps --target "$work/site" "$work"/tyndall-*.whl > "$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
# Reads the name of the module's file, so that no other installation is tried.
(cd "$work" && PYTHONPATH=site $python -B - << 'END'
import importlib.metadata
import pathlib
import tyndall
assert pathlib.Path(tyndall.__file__).resolve().parent == pathlib.Path("site/tyndall").resolve(), tyndall.__file__
assert importlib.metadata.version("tyndall") == tyndall.__version__
light = tyndall.Atmosphere(model="single").radiance(60, 50, 30)
assert light.shape == (3,) and light[2] > light[0] > 0.0, light
print("wheel.sh: tyndall", tyndall.__version__, "installed and used; blue sky", light)
END
)
