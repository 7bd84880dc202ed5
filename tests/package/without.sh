#!/bin/sh
# Checks a program that was built without a library: what needs the library is refused in one line with exit status 2,
# the program does not load the library, and `--version` lists what is missing.
# usage: without.sh gdal|openexr|viewer|shaderc|any PROGRAM
set -u
name=$1 program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "tyndall_without_$name: $*"
  failures=$((failures + 1))
}

# refuses MESSAGE ARGUMENT...: the program ends with status 2, prints one line that contains MESSAGE, and writes nothing.
refuses() {
  message=$1
  shift
  "$program" "$@" > "$work/out" 2> "$work/err"
  status=$?
  [ $status = 2 ] || fail "'$*' ends with status $status; expected 2: $(cat "$work/err")"
  [ "$(wc -l < "$work/err")" = 1 ] || fail "'$*' prints $(wc -l < "$work/err") lines of errors; expected 1"
  grep -qF -- "$message" "$work/err" || fail "'$*' prints '$(cat "$work/err")'; expected '$message'"
  [ -s "$work/out" ] && fail "'$*' prints to the standard output"
  for file in "$work"/new*; do
    [ -e "$file" ] && fail "'$*' leaves the file $file"
  done
}

# lacks FEATURE LIBRARY...: `--version` lists the feature as missing, and the program does not load the libraries.
lacks() {
  "$program" --version | grep '^built without: ' | grep -qF -- "$1" || fail "--version does not list '$1' as missing"
  shift
  for library; do
    ldd "$program" | grep -q "$library" && fail "it loads $library"
  done
}

# has FEATURE: `--version` lists the feature as built in.
has() {
  "$program" --version | grep '^built with: ' | grep -qF -- "$1" || fail "--version does not list '$1' as built in"
}

for feature in gdal openexr viewer shaderc; do
  is_missing=no
  [ "$name" = any ] || [ "$name" = $feature ] && is_missing=yes
  [ "$name" = viewer ] && [ $feature = shaderc ] && is_missing=yes
  case $feature-$is_missing in
    gdal-yes)
      lacks 'elevation files (GDAL)' libgdal
      : > "$work/mountain.tif"
      refuses 'terrain.source: built without GDAL; elevation files cannot be read' render \
        --set "terrain.source=$work/mountain.tif" --size 32x32 -o "$work/new.png"
      ;;
    openexr-yes)
      lacks 'EXR files (OpenEXR)' libOpenEXR libImath
      printf 'v/1\001' > "$work/a.exr"
      for verb in 'render -o' 'sky --sun-elevation-deg 20 --sun-azimuth-deg 0 -o'; do
        # shellcheck disable=SC2086  # split on purpose
        refuses 'built without OpenEXR; EXR files cannot be read or written' $verb "$work/new.exr"
      done
      refuses 'built without OpenEXR' tables -o "$work/new"
      refuses 'built without OpenEXR' compare "$work/a.exr" "$work/a.exr" --diff "$work/new.exr"
      "$program" compare "$work/a.exr" "$work/a.exr" 2>&1 | grep -q 'built without OpenEXR' || fail "compare reads an EXR"
      ;;
    viewer-yes)
      lacks 'viewer (GLFW, ImGui)' libglfw
      refuses 'tyndall view: built without the viewer' view
      ;;
    shaderc-yes) lacks 'shader reloading (shaderc)' ;;
    gdal-no) has 'elevation files (GDAL)' ;;
    openexr-no) has 'EXR files (OpenEXR)' ;;
    viewer-no) has 'viewer (GLFW, ImGui)' ;;
    shaderc-no) has 'shader reloading (shaderc)' ;;
  esac
done

# Everything else works.
printf 'altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n100,60,30,20\n' > "$work/rays.csv"
"$program" probe --model homogeneous --queries "$work/rays.csv" > "$work/out" 2> "$work/err" || fail "probe: $(cat "$work/err")"
[ "$(wc -l < "$work/out")" = 2 ] || fail "probe does not compute the ray"
[ $failures = 0 ]
