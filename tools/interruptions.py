#!/usr/bin/env python3
"""Interrupts tyndall at random moments, and checks what it leaves.

Runs of several verbs are ended by SIGINT, SIGTERM or SIGKILL, a few times in a row in the same folder; then a last run
completes the work. Checks after every interruption:
  - A file under its final name has the contents of an undisturbed run. A manifest lists such files only.
  - SIGINT and SIGTERM end the program within a second, with one line that says what is finished.
And after the last run: everything is there with the same contents, and temporary files of killed runs are gone.
Prints a table, and exits with status 1 if a check failed.
"""
import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]
SMALL = ["--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"]
LIMIT_S = 1.0  # from SIGINT or SIGTERM to the end
QUERIES = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n" + "".join(
    f"{100 * i},{5 * i},50,20\n" for i in range(12))
SKIES = "sun_elevation_deg,sun_azimuth_deg\n" + "".join(f"{5 * i},{20 * i}\n" for i in range(8))


def commands(folder):
    """Returns the arguments of every verb, which write into `folder`/out."""
    out = os.path.join(folder, "out")
    queries = os.path.join(folder, "queries.csv")
    skies = os.path.join(folder, "skies.csv")
    return {
        "render": ["render", "--size", "32x18", "--frames", "8", "--time-step", "2", "--set", "terrain.source=none",
                   "--set", "sun.animate=true", "--set", "tonemap.light_adaptation=false",
                   "-o", f"{out}/f_%d.exr", "--resume", *SMALL],
        "sky": ["sky", "--list", skies, "--size", "32x16", "--sun", "split", "-o", f"{out}/sky_%d.exr", "--resume", *SMALL],
        "tables": ["tables", "-o", f"{out}/tables", *SMALL],
        "probe": ["probe", "--queries", queries, "--model", "reference", "--samples", "20000", "-o", f"{out}/r.csv", "--resume"],
        "validate": ["validate", "--rays", "18", "--samples", "40", "--orders", "2", "-o", f"{out}/v.html",
                     "--markdown", f"{out}/v.md", "--resume", *SMALL],
    }


def catches(pid, number):
    """Returns whether a process has a handler for the signal, which it has once it has read its arguments."""
    with open(f"/proc/{pid}/status") as file:
        caught = [line.split()[1] for line in file if line.startswith("SigCgt:")]
    return bool(caught) and int(caught[0], 16) >> (number - 1) & 1 == 1


class Check:
    def __init__(self, program, work):
        self.program = program
        self.work = work
        self.failures = []
        self.rows = {}

    def start(self, arguments, errors):
        environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(self.folder, "cache"))
        return subprocess.Popen([self.program, *arguments], stdout=subprocess.DEVNULL, stderr=errors, env=environment)

    def prepare(self, name):
        self.folder = os.path.join(self.work, name)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(os.path.join(self.folder, "out"))
        with open(os.path.join(self.folder, "queries.csv"), "w") as file:
            file.write(QUERIES)
        with open(os.path.join(self.folder, "skies.csv"), "w") as file:
            file.write(SKIES)

    def complete(self, arguments):
        """Runs to the end, and returns the errors and the seconds."""
        with tempfile.TemporaryFile() as errors:
            begin = time.monotonic()
            status = self.start(arguments, errors).wait(timeout=300)
            seconds = time.monotonic() - begin
            errors.seek(0)
            text = errors.read().decode(errors="replace")
        if status != 0:
            self.fail(arguments[0], f"status {status} of an undisturbed run: {text}")
        return text, seconds

    def fail(self, verb, text):
        self.failures.append(f"{verb}: {text}")
        print(f"FAILED {verb}: {text}", file=sys.stderr)

    def files(self, where="out"):
        """Returns the names and contents of all files below a folder."""
        found = {}
        top = os.path.join(self.folder, where)
        for folder, _, names in os.walk(top):
            for name in names:
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, top)] = file.read()
        return found

    def compare(self, verb, good, what, complete):
        """Compares the files with those of an undisturbed run."""
        made = self.files()
        for name, contents in made.items():
            if os.path.basename(name).startswith(".tyndall-") or "/.tyndall-" in "/" + name:
                if complete:
                    self.fail(verb, f"{what}: '{name}' is left")
                continue
            if name not in good:
                self.fail(verb, f"{what}: '{name}' is not a file of an undisturbed run")
            elif ".shard-" in name and name.endswith(".json"):
                self.check_manifest(verb, contents, made, what, complete)
            elif name.endswith("tables.json"):
                json.loads(contents)  # contains times
            elif contents != good[name]:
                self.fail(verb, f"{what}: '{name}' has other contents")
        if complete:
            for name in good:
                if name not in made:
                    self.fail(verb, f"{what}: '{name}' is missing")

    def check_manifest(self, verb, contents, made, what, complete):
        manifest = json.loads(contents)
        for item in manifest["items"]:
            for file in item["files"]:
                if len(made.get(file["file"], b"")) != file["bytes"]:
                    self.fail(verb, f"{what}: the manifest lists '{file['file']}', which is not there")
        if complete and not manifest["complete"]:
            self.fail(verb, f"{what}: the manifest is not complete")

    def leftovers(self):
        """Makes all temporary files older than a minute, so that the next run removes them. Returns their number."""
        count = 0
        for folder, folders, names in os.walk(self.folder):
            for name in names + folders:
                if name.startswith(".tyndall-"):
                    count += 1
                    os.utime(os.path.join(folder, name), (time.time() - 120,) * 2)
        return count

    def interrupt(self, verb, arguments, number, delay, row):
        with tempfile.TemporaryFile() as errors:
            process = self.start(arguments, errors)
            time.sleep(delay)
            # Before it has a handler, the program has begun nothing and may end without a word.
            handles = process.poll() is None and catches(process.pid, number)
            begin = time.monotonic()
            process.send_signal(number)
            try:
                status = process.wait(timeout=5.0)
            except subprocess.TimeoutExpired:
                process.kill()
                status = process.wait()
                self.fail(verb, f"{number.name} after {delay:.3f} s: it did not end in 5 s")
            seconds = time.monotonic() - begin
            errors.seek(0)
            text = errors.read().decode(errors="replace")
        what = f"{number.name} after {delay:.3f} s"
        if status == 0:
            row["complete"] += 1
            return what
        row["interrupted"] += 1
        if status != -number:
            self.fail(verb, f"{what}: status {status}: {text}")
        if number != signal.SIGKILL:
            row["slowest"] = max(row["slowest"], seconds)
            if seconds > LIMIT_S:
                self.fail(verb, f"{what}: it took {seconds:.2f} s to end")
            if text.count("tyndall: interrupted: ") != 1 and (handles or text):
                self.fail(verb, f"{what}: no word about what is finished, but: {text!r}")
        return what

    def run(self, verb, count, chain):
        self.prepare("good-" + verb)
        arguments = commands(self.folder)[verb]
        self.complete(arguments)
        good = self.files()
        # The time of a run with what the caches have by then, such as compiled pipelines.
        shutil.rmtree(os.path.join(self.folder, "out"))
        os.makedirs(os.path.join(self.folder, "out"))
        _, duration = self.complete(arguments)
        row = self.rows[verb] = {"interrupted": 0, "complete": 0, "slowest": 0.0, "leftovers": 0}
        done = 0
        while done < count:
            self.prepare(verb)
            # Half of the runs start with an empty cache, so that its files are interrupted as well. That takes long.
            cache = os.path.join(self.work, "good-" + verb, "cache")
            if os.path.exists(cache) and (count < 20 or random.random() < 0.5):
                shutil.copytree(cache, os.path.join(self.folder, "cache"))
            arguments = commands(self.folder)[verb]
            for _ in range(min(chain, count - done)):
                what = self.interrupt(verb, arguments, random.choice(SIGNALS), random.uniform(0.0, duration), row)
                self.compare(verb, good, what, False)
                done += 1
            row["leftovers"] += self.leftovers()
            text, _ = self.complete(arguments)
            if "damaged" in text:
                self.fail(verb, f"after {what}: {text}")
            self.compare(verb, good, f"the run after {what}", True)
            for name in self.files("cache"):
                if "/.tyndall-" in "/" + name:
                    self.fail(verb, f"the run after {what}: '{name}' is left in the cache")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=200, help="interruptions in all")
    parser.add_argument("--chain", type=int, default=4, help="interruptions before the run that completes the work")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("verbs", nargs="*", help="render, sky, tables, probe, validate [all]")
    options = parser.parse_intermixed_args()
    random.seed(options.seed)
    verbs = options.verbs or list(commands(""))
    with tempfile.TemporaryDirectory(prefix="tyndall-interruptions-") as work:
        check = Check(os.path.abspath(options.program), work)
        for i, verb in enumerate(verbs):
            check.run(verb, options.count // len(verbs) + (i < options.count % len(verbs)), options.chain)
    print("| verb | interrupted | ended before the signal | temporary files, all removed | slowest end after SIGINT or SIGTERM |")
    print("|---|--:|--:|--:|--:|")
    for verb, row in check.rows.items():
        print(f"| `{verb}` | {row['interrupted']} | {row['complete']} | {row['leftovers']} | {row['slowest']:.2f} s |")
    total = sum(row["interrupted"] for row in check.rows.values())
    print(f"\n{total} interruptions, {len(check.failures)} failures")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
