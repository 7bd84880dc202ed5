#!/bin/sh
# Measures whether Tyndall is right and fast on this machine's GPU, in at most 8 minutes, and writes a folder of at most
# 16 MiB with a page (index.html) and the numbers (report.json). Needs no display. docs/gpu/README.md explains both.
# In the bundle it runs the program beside it; in the sources it runs the program that `make bundle` left in build/release.
# usage: gpu_report.sh [-o FOLDER] [OPTION of `tyndall report`]...
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
for program in "$top/bin/tyndall" "$top/build/release/bundle/bin/tyndall"; do
  [ -x "$program" ] && break
done
if [ ! -x "$program" ]; then
  echo "gpu_report.sh: there is no program at '$program'; expected the bundle, or the sources after 'make bundle'" >&2
  exit 2
fi
for argument; do
  case $argument in -o | --output | --output=* | --help | -h) exec "$program" report "$@" ;; esac
done
exec "$program" report -o "gpu-report-$(date -u +%Y%m%d-%H%M%S)" "$@"
