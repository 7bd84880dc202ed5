#!/usr/bin/env python3
"""Runs clang-tidy over the sources of a build folder and remembers which of them were clean.

Usage: tools/tidy.py BUILD [--jobs N] [--checks CHECKS] [--no-cache] FOLDER...

BUILD is a folder that Ninja has built, with compile_commands.json. FOLDERs are relative to the repository; the sources
below them are checked. --checks is added to the checks of .clang-tidy, as for clang-tidy. The exit status is 1 if there
is a warning.

clang-tidy takes several seconds a source, so a source is checked again only if something has changed that decides its
result: its compile command, the content of its own headers, the size or time of a system header, .clang-tidy, the checks
or the version of clang-tidy. Ninja knows the headers. Results are files without content, named by a hash, in
$XDG_CACHE_HOME/tyndall-tidy; those that have not been needed for 60 days are removed.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "tyndall-tidy"
LIFETIME_S = 60 * 24 * 3600


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def headers_by_object(build):
    """Returns the dependencies of every object that Ninja knows, as absolute paths."""
    headers, current = {}, None
    for line in output_of("ninja", "-C", build, "-t", "deps").splitlines():
        if line.startswith("    "):
            current.append(os.path.normpath(os.path.join(build, line.strip())))
        elif ": #deps" in line and line.endswith("(VALID)"):
            current = headers.setdefault(line.split(": #deps")[0], [])
        else:
            current = []
    return headers


class Fingerprints:
    """Fingerprints of files: a hash of the content within the repository, and size and time elsewhere."""

    def __init__(self):
        self.known = {}

    def of(self, path):
        if path not in self.known:
            if path.startswith(str(ROOT)):
                self.known[path] = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()
            else:
                status = os.stat(path)
                self.known[path] = f"{status.st_size} {status.st_mtime_ns}"
        return self.known[path]


def write_commands(build, entries):
    """Writes the compile commands without precompiled headers, which only the compiler that made them can read, and
    returns the folder."""
    folder = os.path.join(build, "tidy")
    os.makedirs(folder, exist_ok=True)
    headers = re.compile(r" -Winvalid-pch| -include \S*cmake_pch\.hxx")
    rows = [{**entry, "command": headers.sub("", entry["command"])} for entry in entries]
    with open(os.path.join(folder, "compile_commands.json"), "w", encoding="utf-8") as file:
        json.dump(rows, file)
    return folder


def object_of(entry):
    words = entry["command"].split()
    return words[words.index("-o") + 1]


def key_of(entry, headers, fingerprints, common):
    text = [common, entry["command"]]
    text += [f"{path} {fingerprints.of(path)}" for path in sorted({entry["file"], *headers})]
    return hashlib.sha256("\n".join(text).replace(str(ROOT), ".").encode()).hexdigest()


def check(file, arguments):
    # Warnings are what is printed on stdout; stderr only counts those that were suppressed.
    done = subprocess.run(["clang-tidy", *arguments, file], capture_output=True, text=True, cwd=ROOT)
    return done.returncode == 0 and not done.stdout.strip(), done.stdout or done.stderr


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--checks", default="")
    parser.add_argument("--no-cache", action="store_true")
    options = parser.parse_args()
    build = os.path.abspath(options.build)
    wanted = tuple(f"{ROOT / folder}/" for folder in options.folders)
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = {e["file"]: e for e in json.load(file) if e["file"].startswith(wanted)}
    entries = {file: e for file, e in entries.items() if not file.startswith(build)}
    arguments = ["-p", write_commands(build, entries.values()), "--quiet", "--warnings-as-errors=*",
                 "--extra-arg=-Wno-unknown-warning-option"]  # GCC's options may be among the compile commands
    if options.checks:
        arguments.append(f"--checks={options.checks}")
    common = "\n".join([output_of("clang-tidy", "--version"), (ROOT / ".clang-tidy").read_text(), options.checks])

    CACHE.mkdir(parents=True, exist_ok=True)
    for old in CACHE.iterdir():
        if time.time() - old.stat().st_mtime > LIFETIME_S:
            old.unlink(missing_ok=True)
    fingerprints, headers = Fingerprints(), headers_by_object(build)
    todo, unknown = {}, 0
    for file, entry in sorted(entries.items()):
        if object_of(entry) not in headers:
            unknown += 1  # built on request only
            continue
        key = key_of(entry, headers[object_of(entry)], fingerprints, common)
        if (CACHE / key).exists() and not options.no_cache:
            os.utime(CACHE / key)
        else:
            todo[file] = key
    print(f"clang-tidy: {len(todo)} of {len(entries)} sources have changed, {unknown} are not built", flush=True)

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        running = {pool.submit(check, file, arguments): file for file in todo}
        for done in concurrent.futures.as_completed(running):
            clean, text = done.result()
            if clean:
                (CACHE / todo[running[done]]).touch()
            else:
                failed += 1
                print(text, flush=True)
    if failed:
        sys.exit(f"clang-tidy: warnings in {failed} sources")


if __name__ == "__main__":
    main()
