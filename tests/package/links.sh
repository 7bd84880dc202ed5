#!/bin/sh
# Checks every link between the pages of the documentation: the file exists, and so does the heading that an anchor
# names. Checks also that files named in code spans exist, such as `src/effect/effect.cpp` or `scenes/oneil/*.toml`.
# Usage: links.sh SOURCE_FOLDER. Prints one line per broken link; the exit status is then 1.
set -u
cd "$1" || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Prints "heading PAGE ANCHOR", "link PAGE TARGET" and "path PAGE PATH" for the pages. An anchor is a heading in lower
# case, without punctuation, with hyphens for spaces. Code blocks are skipped.
set -- *.md docs/*.md docs/adr/*.md docs/generated/*.md docs/gpu/*.md
for page in tests/*.md tools/*.md; do [ -f "$page" ] && set -- "$@" "$page"; done
awk '
  FNR == 1 { fenced = 0 }
  /^```/ { fenced = !fenced; next }
  fenced || /^    / { next }
  /^#+ / {
    anchor = tolower($0)
    sub(/^#+ */, "", anchor)
    gsub(/[^a-z0-9 _-]/, "", anchor)
    gsub(/ /, "-", anchor)
    print "heading", FILENAME, anchor
  }
  {
    for (rest = $0; match(rest, /\]\([^) ]+\)/); rest = substr(rest, RSTART + RLENGTH))
      print "link", FILENAME, substr(rest, RSTART + 2, RLENGTH - 3)
    for (rest = $0; match(rest, /`[^`]+`/); rest = substr(rest, RSTART + RLENGTH)) {
      path = substr(rest, RSTART + 1, RLENGTH - 2)
      if (path !~ /^(apps|cmake|docs|examples|include|scenes|shaders|src|tests|tools)\/[^ ]*$/) continue
      if (path ~ /[<>$%]|NN|…/) continue
      gsub(/\{[^}]*\}/, "*", path)
      print "path", FILENAME, path
    }
  }' "$@" > "$work/found"
grep '^heading ' "$work/found" > "$work/headings"

while read -r kind page target; do
  case "$kind $target" in
    heading* | *' http://'* | *' https://'* | *' mailto:'*) ;;
    path*)
      found=no
      for file in $target; do [ -e "$file" ] && found=yes; done
      [ $found = yes ] || echo "$page: '$target': there is no such file"
      ;;
    link*)
      case "$page" in */*) folder=${page%/*} ;; *) folder=. ;; esac
      file=${target%%#*}
      if [ -z "$file" ]; then file=$page; else file=$folder/$file; fi
      if [ ! -e "$file" ]; then
        echo "$page: link to '$target': there is no such file"
      elif [ "$target" != "${target#*#}" ]; then
        echo "$page ${file#./} ${target#*#}" >> "$work/anchors"
      fi
      ;;
  esac
done < "$work/found" > "$work/failures"

# Anchors: a page is named relative to the repository, without "folder/../".
if [ -f "$work/anchors" ]; then
  while read -r page file anchor; do
    while :; do
      shorter=$(echo "$file" | sed -e 's,[^/.][^/]*/\.\./,,')
      [ "$shorter" = "$file" ] && break
      file=$shorter
    done
    grep -qxF -- "heading $file $anchor" "$work/headings" || echo "$page: link to '$file#$anchor': there is no such heading"
  done < "$work/anchors" >> "$work/failures"
fi

cat "$work/failures"
[ ! -s "$work/failures" ]
