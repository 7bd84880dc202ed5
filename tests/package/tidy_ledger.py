#!/usr/bin/env python3
"""Checks tools/tidy.py with a small project: a file with a warning fails and a changed file is not covered by the ledger.

usage: tidy_ledger.py SOURCE WORK. The exit status is 77 if clang-tidy is not installed.
"""
import pathlib
import shutil
import subprocess
import sys

CLEAN = "inline int size_of(int n) { return n; }\n"
WARNING = "inline int size_of(int n) { return static_cast<int>(sizeof(sizeof(n))); }\n"  # bugprone-sizeof-expression
FAILURES = []


def expect(condition, what):
    if not condition:
        FAILURES.append(what)
        print("failed:", what)


class Project:
    def __init__(self, source, work):
        shutil.rmtree(work, ignore_errors=True)
        self.folder = work
        for name in ("tools/tidy.py", ".clang-tidy", "cmake/warnings.cmake"):
            (work / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source / name, work / name)
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\nproject(small CXX)\n"
                   "set(CMAKE_EXPORT_COMPILE_COMMANDS ON)\nadd_library(small OBJECT src/one.cpp src/two.cpp)\n")
        self.write("src/one.hpp", CLEAN)
        self.write("src/one.cpp", '#include "one.hpp"\nint one() { return size_of(1); }\n')
        self.write("src/two.cpp", "int two() { return 2; }\n")
        subprocess.run(["cmake", "-G", "Ninja", "-S", work, "-B", work / "build"], check=True, capture_output=True)
        subprocess.run(["ninja", "-C", work / "build"], check=True, capture_output=True)

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def ledger(self):
        path = self.folder / "tools/tidy/clean.txt"
        return [line.split()[1] for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []

    def tidy(self, *options):
        done = subprocess.run([sys.executable, self.folder / "tools/tidy.py", self.folder / "build", *options, "src"],
                              capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


def main():
    if not shutil.which("clang-tidy"):
        print("clang-tidy is not installed")
        sys.exit(77)
    project = Project(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
    project.write("src/one.hpp", WARNING)
    status, text = project.tidy("--update")
    expect(status == 1 and "bugprone-sizeof-expression" in text, "a header with a warning fails")
    expect(project.ledger() == ["src/two.cpp"], "only the file without a warning is recorded")
    project.write("src/one.hpp", CLEAN)
    expect(project.tidy("--update")[0] == 0, "clean files pass")
    expect(project.ledger() == ["src/one.cpp", "src/one.hpp", "src/two.cpp"], "clean files are recorded")
    expect("3 files, 0 to check" in project.tidy()[1], "recorded files are not checked again")
    project.write("src/two.cpp", "int two() { return sizeof(sizeof(2)); }\n")
    status, text = project.tidy()
    expect(status == 1 and "1 to check in 1 sources" in text, "a changed file is checked, and fails with a warning")
    expect(project.tidy("--all")[1].startswith("clang-tidy: 3 files, 3 to check in 2 sources"), "--all ignores the ledger")
    project.write(".clang-tidy", "Checks: '-*,misc-unused-using-decls'\n")
    expect("3 to check" in project.tidy()[1], "other checks check every file again")
    (project.folder / "src/two.cpp").rename(project.folder / "src/three.cpp")
    status, text = project.tidy()
    expect(status == 1 and "clean.txt: no file 'src/two.cpp'" in text, "a file that does not exist is an error")
    sys.exit(1 if FAILURES else 0)


if __name__ == "__main__":
    main()
