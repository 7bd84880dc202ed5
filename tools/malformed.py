#!/usr/bin/env python3
"""Gives the program malformed files of every kind, and checks how it ends.

usage: malformed.py PROGRAM [--count N] [--seed N] [--work FOLDER] [KIND...]

The files are the committed inputs of the fuzzers (tests/fuzz/corpus) and the shipped scenes with random changes: bytes are
changed, removed, repeated or replaced by numbers at the limits, and files end early. N files of each kind (150 by default) are
given to the verb that reads them. Some unchanged files of each kind come first, of which one must be read. Checks after every run:
  - The program ends by itself, with an exit status that its help documents.
  - A failure takes at most 5 s of processor time, prints one line that begins with "tyndall: error: ", and leaves no file.
  - A success leaves the output and nothing else.
Prints a table, and exits with status 1 if a check failed. Files that failed are in FOLDER/failed.
"""
import argparse
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
SMALL = ["--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"]
PICTURE = ["--size", "16x9", "--set", "shadows.resolution=512", *SMALL]
LIMIT_S = 5.0      # of processor time
HANGS_S = 120.0    # of time
# As in tests/fuzz/elevation_fuzz.cpp: the first byte of these inputs chooses the ending.
ENDINGS = ["tif", "asc", "hgt", "png", "dem", "grd", "xyz", "bil", "dt0", "ter", "img", "nc"]
NUMBERS = [b"0", b"-1", b"nan", b"inf", b"1e308", b"-1e-308", b"4294967296", b"99999999999999999999", b"", b"\"", b"\0"]


def inputs(name):
    return [path.read_bytes() for path in sorted((CORPUS / name).iterdir())]


def plain(name, ending):
    return [(data, ending) for data in inputs(name)]


def kinds(program, work):
    """Returns by name: the inputs with their endings, the ending of the output, and the arguments."""
    scenes = [(path.read_bytes(), "toml") for path in sorted((ROOT / "scenes").rglob("*.toml"))]
    elevation = [(data[1:], ENDINGS[data[0] % len(ENDINGS)]) for data in inputs("elevation") if data]
    return {
        "scene": (scenes, "png", lambda file, out: ["render", file, "--set", "terrain.source=none", "-o", out, *PICTURE]),
        "elevation": (elevation, "png",
                      lambda file, out: ["render", "--set", f"terrain.source={file}", "-o", out, *PICTURE]),
        "gltf": (plain("gltf", "gltf"), "png",
                 lambda file, out: ["render", "--set", f"meshes.source={file}", "--set", "terrain.source=none", "-o", out,
                                    *PICTURE]),
        "png": (plain("png", "png"), "png", lambda file, out: ["compare", file, file, "--diff", out]),
        "exr": (plain("exr", "exr"), "exr", lambda file, out: ["compare", file, file, "--diff", out]),
        "queries": (plain("queries", "csv"), "csv",
                    lambda file, out: ["probe", "--queries", file, "-o", out, *SMALL]),
        "sky list": (plain("sky_list", "csv"), None,
                     lambda file, out: ["sky", "--list", file, "--size", "8x4", "-o", f"{out}_%d.exr", *SMALL]),
        "manifest": ([(shard(program, work), "json")], "csv", lambda file, out: ["merge", out, file]),
    }


def shard(program, work):
    """Lets `probe` make a table and its manifest beside the inputs. Returns the manifest."""
    (work / "queries.csv").write_text("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n10,20,30,40\n50,60,70,80\n")
    subprocess.run([program, "probe", "--queries", work / "queries.csv", "--model", "reference", "--samples", "10", "--shard", "1/1",
                    "-o", work / "table.csv"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return next(work.glob("*.json")).read_bytes()


def changed(data, dice):
    data = bytearray(data)
    for _ in range(dice.choice([1, 1, 1, 2, 4])):
        at = dice.randrange(len(data) + 1)
        size = dice.choice([1, 1, 2, 4, 16, 64])
        change = dice.randrange(6)
        if change == 0:
            data[at:at + 1] = bytes([dice.randrange(256)])
        elif change == 1:
            del data[at:at + size]
        elif change == 2:
            data[at:at] = data[at:at + size] * dice.choice([1, 2, 50])
        elif change == 3:
            data[at:at + size] = dice.choice(NUMBERS)
        elif change == 4:
            data[at:at + size] = bytes([dice.choice([0, 255])]) * size
        elif at > 0:
            del data[at:]
    return bytes(data)


def run(program, arguments, cache):
    """Returns the exit status, what was printed to stderr and the processor time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([program, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              stdin=subprocess.DEVNULL, timeout=HANGS_S, env={**os.environ, "XDG_CACHE_HOME": cache})
    except subprocess.TimeoutExpired:
        return None, "", HANGS_S
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, done.stderr.decode(errors="replace"), seconds


def fault(arguments, status, errors, seconds, left):
    """Returns what is wrong with a run, or None."""
    if status is None or (status != 0 and seconds > LIMIT_S):
        return f"took {seconds:.1f} s"
    # `compare` has statuses of its own, and leaves the difference of pictures that differ.
    compares = arguments[0] == "compare"
    if status < 0 or status > (4 if compares else 2):
        return f"ended with status {status}"
    lines = [line for line in errors.splitlines() if not line.startswith("tyndall: note: ")]
    failed = status != 0 and not (compares and status == 2)
    if failed and (len(lines) != 1 or not lines[0].startswith("tyndall: error: ")):
        return f"printed {lines} with status {status}"
    if failed and left:
        return f"left {left} with status {status}"
    if any("tmp" in name or name.startswith(".") for name in left):
        return f"left {left}"
    return None if failed or left or compares else "left no output"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "tyndall_malformed")
    parser.add_argument("kinds", nargs="*")
    options = parser.parse_args()
    work = options.work
    shutil.rmtree(work, ignore_errors=True)
    (work / "failed").mkdir(parents=True)
    every = kinds(options.program, work)
    for name in options.kinds:
        if name not in every:
            sys.exit(f"malformed.py: there is no kind '{name}'; expected some of {', '.join(every)}")
    print("| kind | files | refused | read | findings | longest [s] |\n|---|--:|--:|--:|--:|--:|", flush=True)
    found = 0
    for name in options.kinds or every:
        seeds, ending, arguments_of = every[name]
        dice = random.Random(f"{options.seed} {name}")
        counts, whole, longest, findings = {True: 0, False: 0}, 0, 0.0, []
        unchanged = dice.sample(seeds, min(len(seeds), 5))
        for i in range(-len(unchanged), options.count):
            data, kind = unchanged[i] if i < 0 else dice.choice(seeds)
            file = work / f"input.{kind}"
            file.write_bytes(data if i < 0 else changed(data, dice))
            out = work / "out"
            shutil.rmtree(out, ignore_errors=True)
            out.mkdir()
            output = out / ("result" if ending is None else f"result.{ending}")
            arguments = arguments_of(str(file), str(output))
            status, errors, seconds = run(options.program, arguments, str(work / "cache"))
            wrong = fault(arguments, status, errors, seconds, sorted(path.name for path in out.iterdir()))
            if i < 0:
                whole += status == 0
            else:
                counts[status == 0] += 1
            longest = max(longest, seconds)
            if wrong:
                file.rename(work / "failed" / f"{name.replace(' ', '_')}_{i}.{kind}")
                findings.append(f"{name} {i}: {wrong}")
        if whole == 0:
            findings.append(f"{name}: no unchanged file is read")
        print(f"| {name} | {options.count} | {counts[False]} | {counts[True]} | {len(findings)} | {longest:.1f} |", flush=True)
        for line in findings:
            print(line, file=sys.stderr, flush=True)
        found += len(findings)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
