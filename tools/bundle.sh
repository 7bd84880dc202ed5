#!/bin/sh
# Packs the programs of tools/bundle/CMakeLists.txt, the shared libraries that a plain desktop lacks, the scenes, the
# example and the licences into out/tyndall-VERSION-linux-x86_64.tar.xz. Nothing in it names this machine, and the same
# inputs give the same bytes.
# usage: bundle.sh SOURCE_FOLDER BUILD_FOLDER OUTPUT_FOLDER
set -eu
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
mkdir -p "$3"
output=$(cd "$3" && pwd)
version=$(sed -n 's/.*TYNDALL_VERSION_STRING "\([^"]*\)".*/\1/p' "$source/include/tyndall/version.h")
name=tyndall-$version-linux-x86_64
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
top=$work/$name
umask 022
mkdir -p "$top/bin" "$top/lib" "$top/licences" "$top/share/tyndall" "$top/tools" "$top/examples"

# Libraries that every system with a Vulkan driver has. libstdc++ stays the system's, because the driver uses it too and
# an older copy would prevent it from loading; the Vulkan loader, because it belongs to the drivers.
system='libc.so|libm.so|libdl.so|libpthread.so|librt.so|ld-linux|libstdc\+\+.so|libgcc_s.so|libvulkan.so|linux-vdso'
desktop='libX11|libxcb|libXau|libXdmcp|libbsd|libmd'

for program in tyndall tyndall-view; do
  cp "$build/bundle/bin/$program" "$top/bin/"
  ldd "$build/bundle/bin/$program" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 } $2 == "=>" && $3 == "not" { print $1, "missing" }'
done | sort -u | grep -vE "^($system|$desktop)" > "$work/libraries"
while read -r library path; do
  [ "$path" = missing ] && { echo "bundle.sh: the library '$library' was not found" >&2; exit 1; }
  cp -L "$path" "$top/lib/$library"
  chmod 644 "$top/lib/$library"
  # The licence, from the package that the library belongs to.
  # By its file name, because a merged /usr gives the folder two names.
  file=$(readlink -f "$path")
  package=$(dpkg-query -S "*/${file##*/}" 2> /dev/null | sed 's/:.*//' | head -n 1) || package=
  if [ -n "$package" ] && [ -f "/usr/share/doc/$package/copyright" ]; then
    cp -L "/usr/share/doc/$package/copyright" "$top/licences/$package.txt"
  else
    echo "bundle.sh: no licence was found for '$library'; expected a Debian package" >&2
    exit 1
  fi
done < "$work/libraries"
# ImGui, toml++, CLI11, nlohmann-json and GLM are compiled into the programs.
for package in libimgui-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libglm-dev libxxhash-dev; do
  [ -f "/usr/share/doc/$package/copyright" ] || { echo "bundle.sh: no licence was found for '$package'" >&2; exit 1; }
  cp -L "/usr/share/doc/$package/copyright" "$top/licences/$package.txt"
done
for licence in "$top"/licences/*; do
  # The texts that Debian's files refer to.
  grep -o '/usr/share/common-licenses/[A-Za-z0-9.-]*[A-Za-z0-9]' "$licence" || true
done | sort -u | while read -r text; do
  [ -f "$text" ] || { echo "bundle.sh: no licence text '$text'; expected the package base-files" >&2; exit 1; }
  cp -L "$text" "$top/licences/${text##*/}"
done
cp "$source/LICENSE" "$top/licences/tyndall.txt"
chmod 644 "$top"/licences/*

cp -R "$source/scenes" "$top/share/tyndall/"
ln -s share/tyndall/scenes "$top/scenes"
cp "$source/examples/embed.cpp" "$top/examples/"
cp "$source/tools/bundle/README.md" "$source/CHANGELOG.md" "$top/"
cp "$source/tools/gpu_report.sh" "$top/tools/"
cp "$source/docs/gpu/README.md" "$top/tools/gpu_report.md"
# The values of the CPU device for `tyndall report`, if they were computed.
[ -d "$build/bundle/share/tyndall/report" ] && cp -R "$build/bundle/share/tyndall/report" "$top/share/tyndall/"
find "$top" -type d -exec chmod 755 {} +
chmod 755 "$top"/bin/*

# Version of the C and C++ libraries that the programs need.
newest() {
  # shellcheck disable=SC2046
  objdump -T "$top"/bin/* "$top"/lib/* | grep -o "$1_[0-9.]*" | sort -V | tail -n 1
}
sed -i -e "s/@VERSION@/$version/g" -e "s/@GLIBC@/$(newest GLIBC | sed 's/.*_//')/g" \
  -e "s/@GLIBCXX@/$(newest GLIBCXX)/g" "$top/README.md"

date=$(git -C "$source" log -1 --format=%ct 2> /dev/null) || date=0
(cd "$work" && find "$name" -print0 | LC_ALL=C sort -z |
  tar --no-recursion --null -T - --owner=0 --group=0 --numeric-owner --mtime="@$date" --format=gnu -cf - |
  xz --lzma2=preset=4,dict=32MiB > "$output/.$name.tar.xz")
mv "$output/.$name.tar.xz" "$output/$name.tar.xz"
echo "$output/$name.tar.xz: $(du -k "$output/$name.tar.xz" | cut -f 1) KiB, $(wc -l < "$work/libraries") libraries"
