#!/bin/sh
# Checks that no text of the project uses the words of retired_words.txt: documentation, comments, strings and names.
# Usage: retired_words.sh SOURCE_FOLDER. Prints FILE:LINE:TEXT for each finding; the exit status is then 1.
set -u
cd "$1" || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

find .ci .clang-tidy ./*.md Makefile CMakeLists.txt CMakePresets.json pyproject.toml setup.py \
  apps cmake docs examples include python scenes shaders src tests tools \
  -type f ! -name '*.png' ! -name '*.svg' ! -path 'tests/package/retired_words*' | sort > "$work/files"

# grep -w counts an underscore as a letter, so names such as kept_bytes need explicit boundaries.
sed -e '/^#/d' -e 's/^/(^|[^[:alnum:]])(/' -e 's/$/)([^[:alnum:]]|$)/' tests/package/retired_words.txt > "$work/words"
# Words of one lower-case letter sequence are also searched as parts of names such as isKept.
sed -n -e '/^#/d' -e '/^\[[a-z]\][a-z]*$/p' tests/package/retired_words.txt |
  sed -e 's/^\[\([a-z]\)\]\(.*\)$/\1 \2/' | while read -r first rest; do
  printf '[a-z0-9]%s%s([^a-z]|$)\n' "$(printf '%s' "$first" | tr '[:lower:]' '[:upper:]')" "$rest"
done > "$work/parts"

status=0
xargs grep -niE -f "$work/words" /dev/null < "$work/files" && status=1
xargs grep -nE -f "$work/parts" /dev/null < "$work/files" && status=1
if [ "$status" -ne 0 ]; then echo "These words are retired. CONTRIBUTING.md explains how we write." >&2; fi
exit "$status"
