#!/usr/bin/env python3
"""Checks what the shared library exports, needs and is called.

usage: exports.py LIBRARY INCLUDE_FOLDER SONAME

Every exported symbol must be a function that a public header declares with TYNDALL_API, or a member of a class that it
declares so; and every such function must be exported. The library must have the given SONAME and need no Vulkan loader.
"""
import re
import subprocess
import sys


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def without_comments(path):
    with open(path, encoding="utf-8") as file:
        return re.sub(r"//[^\n]*", "", file.read())


def declared_names(folder):
    """Names of functions in C, of functions in C++, and of classes with the names of their members."""
    c = set(re.findall(r"TYNDALL_API\b[^;(]*?\b(tyndall_\w+)\(", without_comments(f"{folder}/tyndall/tyndall.h")))
    functions, members = set(), set()
    for header in ("atmosphere.hpp", "effect.hpp", "params.hpp", "phase_table.hpp", "sky_probe.hpp"):
        text = without_comments(f"{folder}/tyndall/{header}")
        functions |= set(re.findall(r"TYNDALL_API\b(?!\s*\w+\s*\{)[^;({]*?\b(\w+)\(", text))
        for name, body in re.findall(r"class TYNDALL_API (\w+) \{(.*?)\n\};", text, re.S):
            body = re.sub(r"\bfriend [^;]*;|\btemplate <[^;]*;|\b\w+\(\) = default;", "", body)
            body = re.sub(r"(\b\w+|operator==)\([^()]*\)[^;{}]*\{[^{}]*\}", "", body)  # defined in the class
            if "operator()(" in body:
                members.add(f"{name}::operator")
            members |= {f"{name}::{member}" for member in re.findall(r"(~?\b\w+|operator=)\(", body)
                        if member not in ("operator",)}
    return c, functions, members


def main():
    library, folder, soname = sys.argv[1:]
    c, functions, members = declared_names(folder)
    expected = c | {f"tyndall::{name}" for name in functions | members}
    found, problems = set(), []
    for line in output("nm", "--dynamic", "--defined-only", "--demangle", library).splitlines():
        symbol = line.split(None, 2)[2]
        name = re.sub(r"(\[abi:\w+\])?\(.*", "", symbol)
        found.add(name)
        if name not in expected:
            problems.append(f"{library}: exports {symbol}; expected only what public headers declare with TYNDALL_API")
    problems += [f"{library}: does not export {name}, which a public header declares" for name in sorted(expected - found)]
    dynamic = output("readelf", "--dynamic", "--wide", library)
    actual = re.findall(r"\(SONAME\).*\[(.*)\]", dynamic)
    if actual != [soname]:
        problems.append(f"{library}: has the SONAME {actual}; expected {soname}")
    problems += [f"{library}: needs {name}; expected no Vulkan loader"
                 for name in re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic) if "vulkan" in name]
    if len(c) < 30 or len(members) < 15:
        problems.append(f"{folder}: only {len(c)} functions of C and {len(members)} members were found; the search is broken")
    print("\n".join(problems) or f"{len(found)} names are exported, {len(c)} of them C; the SONAME is {soname}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
