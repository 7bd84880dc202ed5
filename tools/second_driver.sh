#!/bin/sh
# Puts a second Vulkan driver for the tests into a folder: SwiftShader, two files of Debian's package chromium-common,
# which is downloaded but not installed. Without Debian or a network, it says so and succeeds; the tests are skipped then.
# Usage: tools/second_driver.sh FOLDER
set -u

package=chromium-common
folder=$1
library=libvk_swiftshader.so
manifest=vk_swiftshader_icd.json
[ -e "$folder/$library" ] && [ -e "$folder/$manifest" ] && exit 0

skip() {
  echo "The second Vulkan driver is missing: $1. Its tests are skipped." >&2
  exit 0
}
command -v apt-get > /dev/null 2>&1 && command -v dpkg-deb > /dev/null 2>&1 || skip "it comes from a Debian package"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Downloading as root warns that the folder is not accessible to the user of apt-get, which does not matter.
fetch() { (cd "$work" && apt-get -qq download "$package" > log 2>&1); }
if ! fetch; then
  if [ "$(id -u)" = 0 ]; then apt-get -qq update > /dev/null 2>&1; else sudo -n apt-get -qq update > /dev/null 2>&1; fi
  fetch || skip "the package $package could not be downloaded ($(tail -n 1 "$work/log"))"
fi
dpkg-deb --fsys-tarfile "$work"/"$package"_*.deb |
  tar -x -C "$work" --wildcards --transform 's|.*/||' "*/$library" "*/$manifest" 2> /dev/null
[ -e "$work/$library" ] && [ -e "$work/$manifest" ] || skip "the package $package does not contain it"
mkdir -p "$folder" && mv "$work/$library" "$work/$manifest" "$folder" || exit 1
