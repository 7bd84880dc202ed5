#!/bin/sh
# Renders the pictures of docs/spectral.md: a valley in four kinds of air at noon and at sunset, and a day.
#   tools/air_pictures.sh TYNDALL FOLDER
set -e
tyndall=$1
folder=$2
scenes=$(cd "$(dirname "$0")/../scenes" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for air in clean_continental urban clean_maritime desert; do
  echo "include = ['$scenes/valley.toml', '$scenes/air/$air.toml']" > "$work/$air.toml"
  "$tyndall" render "$work/$air.toml" --allow-outside --size 320x180 -o "$folder/air_${air}_noon.png"
  "$tyndall" render "$work/$air.toml" --allow-outside --size 320x180 --set sun.elevation_deg=1.5 --set sun.azimuth_deg=56 \
    -o "$folder/air_${air}_sunset.png"
done
frame=0
for time in 02:30 03:30 04:15 06:00 11:30 17:00 18:45 19:40 20:30; do
  "$tyndall" render "$scenes/day.toml" --size 160x120 --set sun.time=2026-06-21T$time:00Z -o "$folder/day_$frame.png"
  frame=$((frame + 1))
done
