#!/usr/bin/env python3
"""Runs clang-tidy over the C++ files of a build that the ledger does not cover.

Usage: tools/tidy.py BUILD [--update] [--jobs N] FOLDER...
       tools/tidy.py BUILD --all [--checks CHECKS] [--jobs N] FOLDER...

BUILD is a folder that Ninja has built, with compile_commands.json. FOLDERs are relative to the repository. The exit status
is 1 if there is a warning.

The ledger, tools/tidy/clean.txt, lists the files that were found clean, each with a hash of its own text (without
comments on lines of their own), .clang-tidy, the warning options of the project and the major version of clang-tidy. The
headers that a file includes are not part of its hash: a change to a header checks the header, not every file that
includes it. A header is checked by way of one source that includes it; its own, if there is one. --update writes the
ledger. A file that the ledger lists but that does not exist is an error unless --update is given.

--all checks every source and leaves the ledger alone. --checks is added to the checks of .clang-tidy, as for clang-tidy.
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

ROOT = pathlib.Path(__file__).resolve().parent.parent
LEDGER = ROOT / "tools" / "tidy" / "clean.txt"
ENDINGS = (".cpp", ".hpp", ".h", ".inl", ".glsl", ".def")


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def dependencies_by_object(build):
    """Returns the files that each object depends on, as absolute paths, as far as Ninja knows them."""
    dependencies, current = {}, []
    for line in output_of("ninja", "-C", build, "-t", "deps").splitlines():
        if line.startswith("    "):
            current.append(os.path.normpath(os.path.join(build, line.strip())))
        elif ": #deps" in line and line.endswith("(VALID)"):
            current = dependencies.setdefault(line.split(": #deps")[0], [])
        else:
            current = []
    return dependencies


def object_of(entry):
    words = entry["command"].split()
    return words[words.index("-o") + 1]


class Project:
    """The sources of a build, the files of the repository that each includes, and the hash of a file."""

    def __init__(self, build, folders):
        self.build = build
        wanted = tuple(f"{folder.rstrip('/')}/" for folder in folders)
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            entries = {self.name(entry["file"]) or "": entry for entry in json.load(file)}
        known = dependencies_by_object(build)
        # Sources that are built on request only, and have not been built, may lack generated headers.
        self.entries = {name: entry for name, entry in sorted(entries.items())
                        if name.startswith(wanted) and object_of(entry) in known}
        self.files = {}  # by source
        for source, entry in self.entries.items():
            names = {self.name(path) for path in known.get(object_of(entry), [])}
            self.files[source] = {source} | {n for n in names if n and n.startswith(wanted) and n.endswith(ENDINGS)}
        version = re.search(r"version (\d+)", output_of("clang-tidy", "--version")).group(1)
        texts = [(ROOT / name).read_text(encoding="utf-8") for name in (".clang-tidy", "cmake/warnings.cmake")]
        self.common = "\n".join([version, *texts])

    def name(self, path):
        """Returns the path relative to the repository, or None for a file elsewhere or in the build folder."""
        if not path.startswith(f"{ROOT}/") or path.startswith(f"{self.build}/"):
            return None
        return path[len(f"{ROOT}/"):]

    def hash(self, name):
        # Comments on lines of their own are ignored, unless they are instructions to clang-tidy.
        text = re.sub(rb"(?m)^[ \t]*//(?!.*NOLINT).*\n", b"", (ROOT / name).read_bytes())
        return hashlib.sha256(self.common.encode() + text).hexdigest()[:16]

    def all_files(self):
        return sorted(set().union(*self.files.values()))

    def sources_for(self, names):
        """Returns sources that include all these files, each with those that it is responsible for."""
        chosen = {name: {name} for name in names if name in self.entries}
        for name in names:
            if name in self.entries:
                continue
            including = [source for source, files in self.files.items() if name in files]
            own = [source for source in including if pathlib.Path(source).stem == pathlib.Path(name).stem]
            best = own or [source for source in including if source in chosen] or including
            chosen.setdefault(min(best, key=lambda source: (len(self.files[source]), source)), set()).add(name)
        return chosen

    def write_commands(self):
        """Writes the compile commands without what clang cannot read, precompiled headers and an option of GCC, and
        returns the folder."""
        folder = os.path.join(self.build, "tidy")
        os.makedirs(folder, exist_ok=True)
        headers = re.compile(r" -Winvalid-pch| -include \S*cmake_pch\.hxx")
        constants = " -fsingle-precision-constant", " -Xclang -cl-single-precision-constant"
        rows = [{**entry, "command": headers.sub("", entry["command"]).replace(*constants)}
                for entry in self.entries.values()]
        with open(os.path.join(folder, "compile_commands.json"), "w", encoding="utf-8") as file:
            json.dump(rows, file)
        return folder


def read_ledger():
    if not LEDGER.exists():
        return {}
    rows = [line.split(maxsplit=1) for line in LEDGER.read_text(encoding="utf-8").splitlines() if line]
    return {name: value for value, name in rows}


def write_ledger(clean):
    LEDGER.parent.mkdir(parents=True, exist_ok=True)
    LEDGER.write_text("".join(f"{value} {name}\n" for name, value in sorted(clean.items())), encoding="utf-8")


def check(source, arguments):
    # Warnings are what is printed on stdout; stderr only counts those that were suppressed.
    done = subprocess.run(["clang-tidy", *arguments, source], capture_output=True, text=True, cwd=ROOT)
    return done.returncode == 0 and not done.stdout.strip(), done.stdout or done.stderr


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build")
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--checks", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    if (options.update and options.all) or (options.checks and not options.all):
        parser.error("--update: invalid with --all; --checks: expected --all")
    project = Project(os.path.abspath(options.build), options.folders)
    ledger = {} if options.all else read_ledger()
    gone = [name for name in ledger if not (ROOT / name).is_file()]
    if gone and not options.update:
        sys.exit("\n".join(f"{LEDGER.relative_to(ROOT)}: no file '{name}'; expected a ledger written by make tidy"
                           for name in gone))
    clean = {name: value for name, value in ledger.items() if name not in gone}
    files = project.all_files()
    todo = project.sources_for([name for name in files if ledger.get(name) != project.hash(name)])
    print(f"clang-tidy: {len(files)} files, {sum(map(len, todo.values()))} to check in {len(todo)} sources", flush=True)

    arguments = ["-p", project.write_commands(), "--quiet", "--warnings-as-errors=*",
                 "--extra-arg=-Wno-unknown-warning-option"]  # the folder may be GCC's
    if options.checks:
        arguments.append(f"--checks={options.checks}")
    failed = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        hashes = {name: project.hash(name) for names in todo.values() for name in names}
        running = {pool.submit(check, source, arguments): source for source in todo}
        for done in concurrent.futures.as_completed(running):
            source = running[done]
            is_clean, text = done.result()
            if is_clean:
                clean.update({name: hashes[name] for name in todo[source]})
            else:
                failed.append(source)
                print(text, flush=True)
            if options.update:
                write_ledger(clean)  # after each source, so that nothing is lost when the run is ended
    if options.update:
        write_ledger({name: value for name, value in clean.items() if name not in hashes or clean[name] == hashes[name]})
    if failed:
        sys.exit(f"clang-tidy: warnings in {len(failed)} sources")


if __name__ == "__main__":
    main()
