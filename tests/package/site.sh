#!/bin/sh
# Opens the site in Chromium without a window: the first page and a page of the reference have their titles, the search finds
# functions of every interface, and nothing fails to load. Leaves screenshots in WORK_FOLDER.
# usage: site.sh SITE_FOLDER WORK_FOLDER
set -eu
site=$1 work=$2
command -v chromium > /dev/null || { echo "chromium is not installed"; exit 77; }
rm -rf "$work"
mkdir -p "$work/profile"
fail() {
  echo "site.sh: $*"
  exit 1
}

python3 -u -m http.server --bind 127.0.0.1 --directory "$site" 0 > "$work/server" 2> "$work/requests" &
server=$!
trap 'kill $server' EXIT
port=""
for _ in 1 2 3 4 5 6 7 8 9 10; do
  port=$(sed -n 's/.* port \([0-9]*\) .*/\1/p' "$work/server")
  [ -n "$port" ] && break
  sleep 0.5
done
[ -n "$port" ] || fail "the server does not start: $(cat "$work/requests")"

browser() {
  timeout 120 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$work/profile" \
    --virtual-time-budget=15000 "$@" 2> "$work/browser"
}
contains() {  # PAGE TEXT
  browser --dump-dom "http://127.0.0.1:$port/$1" > "$work/dom.html"
  grep -q "$2" "$work/dom.html" || fail "$1 does not contain '$2'"
}

contains index.html "Documentation"
contains api/python.html "tyndall.Atmosphere.radiance"
contains api/cpp.html "record_precompute"
contains api/c.html "tyndall_effect_create"
contains generated/parameters.html "aerosol_density"
contains "search.html?q=aerial_perspective" "api/python.html"
contains "search.html?q=record_precompute" "api/cpp.html"
contains "search.html?q=epipole" "epipolar.html"
# Browsers request an icon, which the site does not have.
missing=$(grep -v favicon "$work/requests" | grep '" 404 ' || true)
[ -z "$missing" ] || fail "$missing"
for page in index api/python generated/parameters python; do
  browser --window-size=1280,1600 --screenshot="$work/$(echo "$page" | tr / _).png" "http://127.0.0.1:$port/$page.html"
done
browser --window-size=1280,1000 --screenshot="$work/search.png" "http://127.0.0.1:$port/search.html?q=transmittance"
echo "site.sh: pages, search and screenshots in $work"
