#!/bin/sh
# Checks that no text of the project uses the words of retired_words.txt: documentation, comments, strings and names.
# Files and folders of retired_words_remaining.txt are exempt until they are rewritten. The list may only get shorter.
# Usage: retired_words.sh SOURCE_FOLDER. Prints FILE:LINE:TEXT for each finding; the exit status is then 1.
#        retired_words.sh SOURCE_FOLDER --list prints the files with findings, for retired_words_remaining.txt.
set -u
cd "$1" || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed '/^#/d' tests/package/retired_words.txt > "$work/words"
sed -e '/^#/d' -e 's/[.]/\\./g' -e 's/^/^/' -e 's,\([^/]\)$,\1$,' tests/package/retired_words_remaining.txt > "$work/exempt"

find .ci .clang-tidy ./*.md Makefile CMakeLists.txt CMakePresets.json \
  apps cmake docs examples include scenes shaders src tests tools \
  -type f ! -name '*.png' ! -name '*.svg' ! -path 'tests/package/retired_words*' | sed 's,^\./,,' | sort > "$work/files"

if [ "${2-}" = --list ]; then
  xargs grep -lwiE -f "$work/words" < "$work/files"
  exit 0
fi
if grep -vE -f "$work/exempt" "$work/files" | xargs grep -nwiE -f "$work/words" /dev/null; then
  echo "These words are retired. CONTRIBUTING.md says how we write." >&2
  exit 1
fi
exit 0
