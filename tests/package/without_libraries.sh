#!/bin/sh
# Configures the program without its optional libraries, one by one and all together. A library that is left out is not
# searched for; a library that is missing ends the configuration with one clear line. Checks in the build's list of
# commands that each option replaces the sources that use its library.
# usage: without_libraries.sh CMAKE SOURCE_FOLDER WORK_FOLDER COMPILER
set -u
cmake=$1 source=$2 work=$3 compiler=$4
rm -rf "$work"
mkdir -p "$work"
failures=0

fail() {
  echo "$*"
  failures=$((failures + 1))
}

# A pkg-config that knows none of the libraries.
cat > "$work/pkg-config" << END
#!/bin/sh
for argument; do
  case "\$argument" in gdal* | glfw3* | imgui* | OpenEXR*) exit 1 ;; esac
done
exec pkg-config "\$@"
END
chmod +x "$work/pkg-config"

# configure OPTION...: configures in the same folder again, with the options that differ.
configure() {
  "$cmake" -G Ninja -S "$source" -B "$work/build" -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_BUILD_TYPE=Release \
    -D TYNDALL_BUILD_TESTS=OFF "$@" > "$work/log" 2>&1
}

# uses SOURCE yes|no: a source is compiled, or not.
uses() {
  if grep -q "/$1" "$work/commands"; then found=yes; else found=no; fi
  [ $found = "$2" ] || fail "$features: $1 is compiled: $found; expected $2"
}

# check FEATURES: the commands that build the program with these features.
check() {
  features=$1
  ninja -C "$work/build" -t commands tyndall > "$work/commands" || fail "$features: there is no way to build tyndall"
  gdal=no openexr=no viewer=no shaderc=no
  for feature in $features; do
    case $feature in GDAL) gdal=yes ;; OPENEXR) openexr=yes ;; VIEWER) viewer=yes ;; SHADERC) shaderc=yes ;; esac
  done
  [ $viewer = no ] && shaderc=no
  uses elevation_open.cpp $gdal
  uses exr.cpp $openexr
  uses viewer_loop.cpp $viewer
  uses shader_reload.cpp $shaderc
  for library in gdal:gdal openexr:OpenEXR viewer:glfw shaderc:shaderc_combined; do
    eval "expected=\$${library%%:*}"
    if tail -n 1 "$work/commands" | grep -q "${library#*:}"; then found=yes; else found=no; fi
    [ $found = "$expected" ] || fail "$features: linked with ${library#*:}: $found; expected $expected"
  done
}

# turned WITH...: the options that turn exactly these features on.
turned() {
  for feature in GDAL OPENEXR VIEWER SHADERC; do
    state=OFF
    for with; do [ "$with" = $feature ] && state=ON; done
    printf ' -D TYNDALL_WITH_%s=%s' $feature $state
  done
}

hide="-D PKG_CONFIG_EXECUTABLE=$work/pkg-config -D TYNDALL_LIB_shaderc_combined="
# shellcheck disable=SC2046,SC2086  # the options are split on purpose
configure $hide $(turned) || { cat "$work/log"; fail "without any library: the configuration fails"; }
check ''
while read -r feature library; do
  with=$feature
  [ "$feature" = SHADERC ] && with="VIEWER SHADERC" && hide_viewer="-D PKG_CONFIG_EXECUTABLE=$(command -v pkg-config)"
  # shellcheck disable=SC2046,SC2086
  configure ${hide_viewer:-} $(turned $with) && fail "$feature: the configuration succeeds without $library"
  tr '\n' ' ' < "$work/log" | tr -s ' ' | grep -qF "TYNDALL_WITH_$feature: $library was not found; expected the Debian package" ||
    { cat "$work/log"; fail "$feature: no message says that $library was not found"; }
done << END
GDAL GDAL
OPENEXR OpenEXR
VIEWER GLFW
SHADERC the library shaderc_combined of shaderc
END

configure -U 'TYNDALL_LIB_*' -U PKG_CONFIG_EXECUTABLE $(turned OPENEXR VIEWER SHADERC) || fail "without GDAL: the configuration fails"
check 'OPENEXR VIEWER SHADERC'
for features in 'GDAL VIEWER SHADERC' 'GDAL OPENEXR SHADERC' 'GDAL OPENEXR VIEWER'; do
  # shellcheck disable=SC2046,SC2086
  configure $(turned $features) || { cat "$work/log"; fail "with $features: the configuration fails"; }
  check "$features"
done
# The tests use all of them.
configure -D TYNDALL_BUILD_TESTS=ON && fail "the tests are configured without shaderc"
tr '\n' ' ' < "$work/log" | tr -s ' ' | grep -qF 'TYNDALL_BUILD_TESTS: the tests need TYNDALL_WITH_SHADERC' ||
  fail "no message says that the tests need shaderc"
[ $failures = 0 ]
