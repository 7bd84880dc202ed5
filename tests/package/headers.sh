#!/bin/sh
# Compiles each public header alone, twice in one source, with many warnings as errors, with GCC and Clang as far as they
# are installed: the C interface as C99, C11 and C++20, the others as C++20.
# usage: headers.sh INCLUDE_FOLDER
set -eu
warnings="-Wall -Wextra -Wconversion -Wsign-conversion -Wpedantic -Wshadow -Wundef -Werror"
count=0

compile() { # COMPILER LANGUAGE STANDARD HEADER
  printf '#include <tyndall/%s>\n#include <tyndall/%s>\nextern int not_empty;\n' "$4" "$4" |
    "$1" -x "$2" -std="$3" $warnings -fsyntax-only -I "$include" - || {
    echo "$4 is not clean with $1 -std=$3"
    exit 1
  }
  count=$((count + 1))
}

include=$1
for compiler in gcc clang; do
  command -v "$compiler" > /dev/null || continue
  for header in tyndall.h tyndall_memory.h export.h version.h; do
    compile "$compiler" c c99 "$header"
    compile "$compiler" c c11 "$header"
    compile "$compiler" c++ c++20 "$header"
  done
  for header in atmosphere.hpp conventions.hpp effect.hpp memory.hpp params.hpp photometry.hpp post.hpp post_settings.hpp result.hpp sky_probe.hpp types.hpp version.hpp; do
    compile "$compiler" c++ c++20 "$header"
  done
done
[ "$count" -gt 0 ] || { echo "neither gcc nor clang is installed"; exit 1; }
echo "$count compilations of headers gave no warning"
