#!/bin/sh
# Tries what a new user of the Python package does: installs its Debian package with apt in a bare Debian system, and runs the
# first example of docs/python.md there. Prints how long both take. debootstrap makes the system in FOLDER in each run.
# Needs root, debootstrap and Debian's archive; TYNDALL_DEBIAN_MIRROR is used instead of Debian's own mirror.
# usage: first_figure.sh FOLDER DEB_FOLDER PAGE
set -eu
root=$1 debs=$2 page=$3
fail() {
  echo "first_figure.sh: $*" >&2
  exit 1
}
umount_all() { ! mountpoint -q "$root/proc" || umount "$root/proc"; }

[ "$(id -u)" = 0 ] || fail "needs root"
umount_all
rm -rf "$root"
mkdir -p "$root"
debootstrap --variant=minbase bookworm "$root" "${TYNDALL_DEBIAN_MIRROR:-http://deb.debian.org/debian}" > "$root.log" ||
  { tail -n 5 "$root.log" >&2; fail "debootstrap failed"; }
trap umount_all EXIT
mount -t proc proc "$root/proc"
mkdir "$root/user"
cp "$debs"/python3-tyndall_*.deb "$root/user/"
# The first block of Python on the page.
awk '/^```python$/ { found = 1; next } /^```$/ && found { exit } found' "$page" > "$root/user/figure.py"
lines=$(wc -l < "$root/user/figure.py")
[ "$lines" -gt 0 ] || fail "$page has no example"

inside() { chroot "$root" /usr/bin/env -i HOME=/user PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
inside apt-get -q update > "$root.log" 2>&1 || { tail -n 5 "$root.log" >&2; fail "apt-get update failed"; }
started=$(date +%s)
inside sh -c 'apt-get -q install -y /user/python3-tyndall_*.deb python3-matplotlib' > "$root.log" 2>&1 ||
  { tail -n 5 "$root.log" >&2; fail "apt-get install failed"; }
installed=$(date +%s)
inside sh -c 'cd /user && python3 figure.py' || fail "the example fails"
finished=$(date +%s)
inside sh -c 'cd /user && python3 figure.py' || fail "the example fails the second time"
again=$(date +%s)
[ "$(head -c 4 "$root/user/sky.png" | tail -c 3)" = PNG ] || fail "the example has not written sky.png"
cp "$root/user/sky.png" "$root.png"
echo "Debian package with matplotlib and a driver installed in $((installed - started)) s; the $lines lines of $page took" \
  "$((finished - installed)) s, the second time $((again - finished)) s. The figure is at $root.png"
