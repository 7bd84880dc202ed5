#!/bin/sh
# Makes a bare Debian system in a folder, with nothing but the drivers of Mesa, for tests/package/bundle.sh. Needs root and
# the package debootstrap. TYNDALL_DEBIAN_MIRROR is used instead of Debian's own mirror. Does nothing if the folder is
# complete.
# usage: bookworm.sh FOLDER
set -eu
[ -e "$1/made" ] && exit 0
rm -rf "$1"
mkdir -p "$1"
debootstrap --variant=minbase --include=mesa-vulkan-drivers bookworm "$1" "${TYNDALL_DEBIAN_MIRROR:-http://deb.debian.org/debian}"
: > "$1/made"
