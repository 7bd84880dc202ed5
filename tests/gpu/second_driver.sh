#!/bin/sh
# Runs a command with the second Vulkan driver only. Exits with 77, which CTest shows as skipped, if it is missing.
# Usage: second_driver.sh MANIFEST COMMAND...
manifest=$1
shift
if [ ! -e "$manifest" ]; then
  echo "Skipped: the second Vulkan driver is missing ($manifest). tools/second_driver.sh fetches it."
  exit 77
fi
export VK_DRIVER_FILES="$manifest" VK_ICD_FILENAMES="$manifest"
exec "$@"
