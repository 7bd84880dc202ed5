#!/bin/sh
# Writes, for each Debian package, OUT/PACKAGE/{copyright,changelog.gz,changelog.Debian.gz}, and for the program the manual
# page OUT/tyndall.1.gz and the licences of libraries that are compiled into it. The same sources give the same bytes.
# usage: documents.sh SOURCE_FOLDER OUT RELEASE CONTACT
set -eu
source=$1 out=$2 release=$3 contact=$4
umask 022

# An entry for each version of CHANGELOG.md, newest first.
entries() {
  sed -n 's/^## \[\([0-9.]*\)\] - \([0-9-]*\)$/\1 \2/p' "$source/CHANGELOG.md" | while read -r version date; do
    printf 'tyndall (%s-%s) unstable; urgency=medium\n\n  * Version %s. The file changelog.gz lists the changes.\n\n -- %s  %s\n\n' \
      "$version" "$release" "$version" "$contact" "$(LC_ALL=C date -u -d "$date 12:00" -R)"
  done
}

for package in libtyndall0 libtyndall-dev tyndall python3-tyndall; do
  mkdir -p "$out/$package"
  cp "$source/tools/debian/copyright" "$out/$package/copyright"
  gzip -9nc "$source/CHANGELOG.md" > "$out/$package/changelog.gz"
  entries | gzip -9nc > "$out/$package/changelog.Debian.gz"
done
gzip -9nc "$source/docs/tyndall.1" > "$out/tyndall.1.gz"

# The libraries that Debian has as headers or archives only.
rm -rf "$out/tyndall/compiled-in"
mkdir -p "$out/tyndall/compiled-in"
for package in libimgui-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libglm-dev libstb-dev libshaderc-dev glslang-dev \
  spirv-tools libdraco-dev libmeshoptimizer-dev; do
  [ ! -f "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$out/tyndall/compiled-in/$package.txt"
done
