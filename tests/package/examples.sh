#!/bin/sh
# Runs the examples with the validation layer and its synchronisation validation, which must report nothing.
# usage: examples.sh PROGRAM_FOLDER WORK_FOLDER
set -eu
programs=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LOADER_DEBUG=layer
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
failures=0
for name in embed engine glass clouds spheres; do
  case $name in
    embed) set -- "$work/embed.rgba" '^radiance of the sky: ' ;;
    engine) set -- "$work/embed.rgba" '^\(irradiance from the sky\|eye [01]\)' ;;
    glass) set -- "$work/glass.rgba" '^the pane from the froxel volume ' ;;
    clouds) set -- "$work/clouds" '^clear: ' ;;
    spheres) set -- "$work/spheres.ppm" '^$' ;;
  esac
  status=0
  "$programs/$name" "$1" > "$work/output" 2> "$work/loader" || status=$?
  grep -v "$2" "$work/output" > "$work/unexpected" || true
  if [ $status != 0 ] || [ -s "$work/unexpected" ]; then
    echo "$name: status $status; expected 0 and no messages of the validation layer"
    cat "$work/unexpected"
    failures=1
  elif ! grep -q 'Insert instance layer .*VK_LAYER_KHRONOS_validation' "$work/loader"; then
    echo "$name: the validation layer was not loaded"
    failures=1
  else
    echo "$name: $(head -n 1 "$work/output")"
  fi
done
exit $failures
