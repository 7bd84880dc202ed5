#!/bin/sh
# Builds the Debian packages, checks them with lintian as far as it is installed, installs them into a root folder whose package
# database is a copy of this system's, runs the program, builds and runs a program in C with the library, and removes all
# packages. Nothing of them may be left.
# usage: debian.sh BUILD_FOLDER WORK_FOLDER SOURCE_FOLDER VERSION [python]
set -eu
build=$1 work=$2 source=$3 version=$4
packages="libtyndall0 libtyndall-dev tyndall"
[ "${5:-}" != python ] || packages="$packages python3-tyndall"
rm -rf "$work"
mkdir -p "$work/deb"
work=$(cd "$work" && pwd)  # dpkg runs the scripts of packages in another folder

fail() {
  echo "debian.sh: $*"
  exit 1
}

# The test compresses less than `make packages`, to save time. Run again with fakeroot, which gives files to root.
if [ "$(id -u)" = 0 ]; then as_root=""; else as_root=fakeroot; fi
command -v dpkg-deb > /dev/null || { echo "dpkg is not installed"; exit 77; }
[ -z "$as_root" ] || command -v fakeroot > /dev/null || { echo "fakeroot is not installed"; exit 77; }
if [ -n "${TYNDALL_DEB_FOLDER:-}" ]; then
  cp "$TYNDALL_DEB_FOLDER"/*.deb "$work/deb/"
else
  (umask 022 && cpack --config "$build/CPackConfig.cmake" -B "$work/deb" -D CPACK_THREADS=0 \
    -D CPACK_DEBIAN_COMPRESSION_TYPE="${TYNDALL_DEB_COMPRESSION:-gzip}" > "$work/log" 2>&1) || { cat "$work/log"; exit 1; }
  rm -rf "$work/deb/_CPack_Packages"
fi
for package in $packages; do
  set -- "$work/deb/${package}_$version"-*.deb
  [ -e "$1" ] || fail "$package was not built"
done

if command -v lintian > /dev/null; then
  # The packages of this test have no folder for the architecture, because the build that they are made from has the prefix
  # /usr/local. Those of `make packages` do.
  suppressed=pkg-config-unavailable-for-cross-compilation
  [ -z "${TYNDALL_DEB_FOLDER:-}" ] || suppressed=""
  lintian ${suppressed:+--suppress-tags $suppressed} --fail-on error,warning --tag-display-limit 0 "$work"/deb/*.deb > "$work/lintian" 2>&1 || { cat "$work/lintian"; exit 1; }
else
  echo "lintian is not installed: the packages are not checked"
fi

root=$work/root
mkdir -p "$root/var/lib"
# Copy the database of installed packages, so that dpkg can check the dependencies.
cp -R /var/lib/dpkg "$root/var/lib/dpkg"
rm -rf "$root/var/lib/dpkg/lock"* "$root/var/lib/dpkg/triggers"/* "$root/var/lib/dpkg/info"/*
for name in $packages; do
  ! grep -qx "Package: $name" "$root/var/lib/dpkg/status" || fail "$name is installed on this system"
done
dpkg_in_root() {
  $as_root dpkg --root="$root" --force-not-root,bad-path,script-chrootless --log=/dev/null "$@" > "$work/log" 2>&1 || {
    grep -v 'files list file for package' "$work/log"
    fail "dpkg $* failed"
  }
}
(cd "$root" && find . -path ./var/lib/dpkg -prune -o -print | sort) > "$work/before"
dpkg_in_root --install "$work"/deb/*.deb
for package in $packages; do
  dpkg-query --admindir="$root/var/lib/dpkg" -W -f '${db:Status-Abbrev}' $package | grep -q '^ii' || fail "$package is not installed"
done

# The installed program and library work.
[ "$("$root/usr/bin/tyndall" --version | head -n 1)" = "tyndall $version" ] || fail "the program is not version $version"
printf 'altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,60,50,30\n' > "$work/rays.csv"
"$root/usr/bin/tyndall" probe --queries "$work/rays.csv" --model single > "$work/radiance.csv" || fail "the program does not work"
grep -q '^0,60,50,30,0\.0[0-9]*,0\.0' "$work/radiance.csv" || fail "the program returns $(cat "$work/radiance.csv")"
[ -f "$root/usr/share/tyndall/scenes/noon.toml" ] || fail "the scenes are not installed"
case "$packages" in *python3*)
  modules=$(cd "$root/usr/lib/python3/dist-packages" && pwd)
  red=$(sed -n '2s/^0,60,50,30,\([^,]*\),.*/\1/p' "$work/radiance.csv")
  (cd / && PYTHONPATH=$modules /usr/bin/python3 -B -c "import tyndall
assert tyndall.__file__.startswith('$modules') and tyndall.__version__ == '$version', tyndall
assert abs(tyndall.Atmosphere(model='single').radiance(60, 50, 30)[0] - $red) < 1e-7") || fail "the Python module does not work" ;;
esac
libraries=$(dirname "$(find "$root/usr/lib" -name libtyndall.so)")
flags=$(PKG_CONFIG_PATH=$libraries/pkgconfig pkg-config --cflags --libs tyndall)
# shellcheck disable=SC2086  # the flags are split on purpose
cc -std=c99 "$source/examples/embed.c" -o "$work/embed_c" $flags -lvulkan
LD_LIBRARY_PATH=$libraries "$work/embed_c" > "$work/embed.log" || fail "the program in C fails: $(cat "$work/embed.log")"
cmake -S "$source/tests/package/consumer" -B "$work/consumer" -G Ninja -D CMAKE_PREFIX_PATH="$root/usr" > "$work/log" 2>&1 ||
  { cat "$work/log"; fail "CMake does not find the package"; }

# The manual page lists every verb of the program.
"$root/usr/bin/tyndall" --help | sed -n '/^Verbs:/,/^$/s/^  \([a-z]*\) .*/\1/p' > "$work/verbs"
[ "$(wc -l < "$work/verbs")" -gt 8 ] || fail "the verbs of the program were not found"
while read -r verb; do
  zcat "$root/usr/share/man/man1/tyndall.1.gz" | grep -qx "\.B $verb" || fail "the manual page lacks the verb $verb"
done < "$work/verbs"

# Packages that depend on the library require its minor version.
mkdir -p "$work/user/debian"
printf 'Source: user\n\nPackage: user\nArchitecture: any\n' > "$work/user/debian/control"
if command -v dpkg-shlibdeps > /dev/null; then
  depends=$(cd "$work/user" && LD_LIBRARY_PATH=$libraries dpkg-shlibdeps --ignore-missing-info -l"$libraries" \
    -L"$root/var/lib/dpkg/info/libtyndall0.shlibs" -O "$work/embed_c" 2> "$work/log") || { cat "$work/log"; fail "dpkg-shlibdeps fails"; }
  echo "$depends" | grep -q 'libtyndall0 (>= [0-9.]*), libtyndall0 (<< 0\.[0-9]*~)' ||
    fail "dpkg-shlibdeps gives '$depends'; expected the minor version of libtyndall0"
fi

# shellcheck disable=SC2086
dpkg_in_root --purge $packages
(cd "$root" && find . -path ./var/lib/dpkg -prune -o -print | sort) > "$work/after"
diff "$work/before" "$work/after" > "$work/left" || fail "after their removal the packages have left: $(grep '^>' "$work/left")"
echo "$packages: built, installed, used and removed"
