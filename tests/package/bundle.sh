#!/bin/sh
# Checks the portable bundle: its size, that nothing in it names the machine that made it, that every library is in it or
# belongs to a system with a Vulkan driver, and that it runs in a root folder without anything else. Without ROOT, this
# root holds only the C and C++ libraries, the Vulkan loader and the CPU driver of this system, and the device that is
# used there is the CPU device. ROOT is a system, for example one made by tools/bundle/bookworm.sh.
# usage: bundle.sh ARCHIVE SOURCE_FOLDER BUILD_FOLDER [ROOT]
set -u
archive=$1 source=$2 build=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "bundle: $*"
  failures=$((failures + 1))
}

size=$(du -k "$archive" | cut -f 1)
[ "$size" -le 40960 ] || fail "the archive has $size KiB; at most 40960 are allowed"
mkdir "$work/unpacked"
tar -xf "$archive" -C "$work/unpacked" || exit 1
top=$work/unpacked/$(ls "$work/unpacked")

for place in "$source" "$build" "${HOME:-/nowhere}/" "$(uname -n)"; do
  [ ${#place} -gt 4 ] || continue
  found=$(grep -rlF -- "$place" "$top")
  [ -z "$found" ] || fail "these files name '$place':" $found
done
for file in README.md licences/tyndall.txt licences/libdraco7.txt examples/embed.cpp scenes/demo.toml bin/tyndall-view; do
  [ -e "$top/$file" ] || fail "'$file' is missing"
done

# Each library that a file needs is in the bundle, or one that every system with a Vulkan driver has.
for file in "$top"/bin/* "$top"/lib/*; do
  objdump -p "$file" | awk '$1 == "NEEDED" { print $2 }' | while read -r library; do
    case $library in
      libc.so.6 | libm.so.6 | libdl.so.2 | libpthread.so.0 | ld-linux-x86-64.so.2 | libstdc++.so.6 | libgcc_s.so.1 | libvulkan.so.1) ;;
      libX11.so.6) [ "${file##*/}" = libglfw.so.3 ] || echo "${file##*/} needs $library" ;;
      *) [ -e "$top/lib/$library" ] || echo "${file##*/} needs $library, which is missing" ;;
    esac
  done
  objdump -p "$file" | grep -E 'RPATH|RUNPATH' | grep -v '\$ORIGIN/../lib$' | sed "s,^,${file##*/}: ,"
done > "$work/problems"
[ -s "$work/problems" ] && { cat "$work/problems"; fail "libraries"; }

# Copies the files of this system that a driver needs into a root folder, at their own paths.
copy_closure() {
  for file; do
    ldd "$file" 2> /dev/null | grep -o '/[^ ]*' | while read -r library; do
      mkdir -p "$root${library%/*}"
      [ -e "$root$library" ] || cp -L "$library" "$root$library"
    done
    mkdir -p "$root${file%/*}"
    cp -L "$file" "$root$file"
  done
}

if [ $# -ge 4 ]; then
  root=$4
else
  root=$work/root
  icd=$(ls /usr/share/vulkan/icd.d/lvp_icd*.json | head -n 1)
  driver=$(sed -n 's/.*"library_path": *"\([^"]*\)".*/\1/p' "$icd")
  case $driver in /*) ;; *) driver=$(ldconfig -p | awk -v name="$driver" '$1 == name { print $NF; exit }') ;; esac
  loader=$(ldconfig -p | awk '$1 == "libvulkan.so.1" { print $NF; exit }')
  cxx=$(ldconfig -p | awk '$1 == "libstdc++.so.6" { print $NF; exit }')
  copy_closure "$driver" "$loader" "$cxx"
  mkdir -p "$root${icd%/*}" "$root/tmp" "$root/proc"
  cp "$icd" "$root$icd"
fi
rm -rf "$root/bundle"
cp -R "$top" "$root/bundle"
mkdir -p "$root/cache" "$root/mesa"
shaders=${MESA_SHADER_CACHE_DIR:-$build/tests/cache}
mkdir -p "$build/tests/cache" "$shaders"

# inside COMMAND...: runs a program in the root folder, with the tests' caches of tables and of compiled shaders. User
# namespaces stand in for the rights of root where there are any.
rights=
[ "$(id -u)" = 0 ] || rights=--map-root-user
inside() {
  # shellcheck disable=SC2016,SC2086  # expanded by the inner shell
  unshare --mount $rights sh -c 'mount --bind /proc "$1/proc" && mount --bind "$2" "$1/cache" \
    && mount --bind "$3" "$1/mesa" && shift 3 && exec "$@"' sh "$root" "$build/tests/cache" "$shaders" chroot "$root" "$@"
}
if ! unshare --mount $rights true 2> /dev/null; then
  echo "bundle: no rights to make a mount namespace; the programs were not run"
  [ $failures = 0 ] && exit 77
  exit 1
fi
export XDG_CACHE_HOME=/cache MESA_SHADER_CACHE_DIR=/mesa HOME=/ VK_LOADER_DEBUG=
unset VK_ICD_FILENAMES VK_DRIVER_FILES LD_LIBRARY_PATH

version=$(sed -n 's/.*TYNDALL_VERSION_STRING "\([^"]*\)".*/\1/p' "$source/include/tyndall/version.h")
inside /bundle/bin/tyndall --version > "$work/out" || fail "--version fails"
grep -qxF "tyndall $version" "$work/out" || fail "--version prints: $(cat "$work/out")"
inside /bundle/bin/tyndall devices > "$work/out" || fail "devices: $(cat "$work/out")"
grep -q '^\* 0 ' "$work/out" || fail "devices: no device is used: $(cat "$work/out")"
printf 'altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n100,60,30,20\n' > "$root/bundle/rays.csv"
inside /bundle/bin/tyndall probe --model single --queries /bundle/rays.csv > "$work/out" || fail "probe fails"
[ "$(wc -l < "$work/out")" = 2 ] || fail "probe prints: $(cat "$work/out")"
inside /bundle/bin/tyndall render /bundle/scenes/demo.toml --size 64x36 -o /bundle/picture.exr || fail "render fails"
[ -s "$root/bundle/picture.exr" ] || fail "render writes no picture"
inside /bundle/bin/tyndall render --set terrain.source=/bundle/README.md -o /bundle/no.png 2> "$work/err"
[ $? = 2 ] && grep -q 'built without GDAL' "$work/err" || fail "terrain.source: $(cat "$work/err")"
inside /bundle/bin/tyndall report --help > "$work/out" && grep -q -- '--seconds' "$work/out" || fail "report --help fails"
# Neither root has a display, and the one of this test has no X libraries either.
unset DISPLAY WAYLAND_DISPLAY
inside /bundle/bin/tyndall view 2> "$work/err"
[ $? = 1 ] || fail "view ends with another status than 1"
if [ $# -ge 4 ] && [ -n "$(find "$root/usr/lib" -name 'libX11.so.6')" ]; then
  grep -q 'there is no display' "$work/err" || fail "view: $(cat "$work/err")"
else
  grep -qF "cannot load 'libX11.so.6'" "$work/err" || fail "view: $(cat "$work/err")"
fi
rm -rf "$root/bundle"
[ $failures = 0 ]
