#!/usr/bin/env python3
"""Runs the fuzzers for a long time and writes a table of what they did.

usage: fuzz.py [--seconds N] [--output FILE] BUILD CORPUS [NAME...]

BUILD is a folder that the preset "fuzz" has built, CORPUS the folder of committed inputs (tests/fuzz/corpus), and each
NAME a fuzzer; all of them are run without names, one after another, for N seconds each (60 by default). Inputs that
reach new code are added to BUILD/corpus, so that the next run goes on from there. A finding, that is, an input that
crashes, hangs, allocates without bound or breaks a promise, goes to BUILD/findings. BUILD/fuzz.json counts the executions of each
fuzzer; the count starts again when the fuzzer has been rebuilt from other sources. Exit status: 0 without findings,
1 otherwise.
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

# A second is enough for every input; the limit leaves room for a busy machine.
TIMEOUT_S = 20
MEMORY_MIB = 3072
# Address space for one object [MiB]. Only the part that is written takes memory.
RESERVED_MIB = 65536
INTERRUPTED = 72  # exit status of libFuzzer


def number(pattern, text, default=0):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else default


def hangs(program, path, environment):
    """Returns whether an input that took too long also needs that much processor time, not only on a busy machine."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (TIMEOUT_S, TIMEOUT_S))
    return subprocess.run([program.resolve(), path.resolve(), "-timeout=86400"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, env=environment, preexec_fn=limit).returncode != 0


def run(build, corpus, name, seconds, state):
    """Runs one fuzzer and adds to its state. Returns the paths of its findings, and the exit status."""
    program = build / "bin" / f"fuzz_{name}"
    digest = hashlib.sha256(program.read_bytes()).hexdigest()
    if state.get("program") != digest:
        state.clear()
        state.update(program=digest, executions=0, seconds=0, findings=0)
    grown, findings = build / "corpus" / name, build / "findings"
    for folder in (grown, findings, build / "logs"):
        folder.mkdir(parents=True, exist_ok=True)
    before = set(findings.glob(f"{name}-*"))
    log = build / "logs" / f"{name}.log"
    environment = dict(os.environ, ASAN_OPTIONS="allocator_may_return_null=1:detect_leaks=1",
                       UBSAN_OPTIONS="print_stacktrace=1")
    with log.open("w") as out:
        process = subprocess.Popen(
            [program.resolve(), grown.resolve(), (corpus / name).resolve(), f"-max_total_time={seconds}",
             f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MIB}", f"-malloc_limit_mb={RESERVED_MIB}",
             "-print_final_stats=1", "-print_funcs=0", "-use_value_profile=1",
             f"-artifact_prefix={findings.resolve()}/{name}-"], stdout=out, stderr=out, stdin=subprocess.DEVNULL,
            env=environment, cwd=build, preexec_fn=lambda: os.nice(19))
        try:
            process.wait()
        except KeyboardInterrupt:
            process.wait()  # libFuzzer also receives the signal and prints its statistics
            raise
        finally:
            text = log.read_text(errors="replace")
            found = sorted(set(findings.glob(f"{name}-*")) - before)
            slow = (f"{name}-timeout-", f"{name}-slow-unit-")
            busy = [path for path in found if path.name.startswith(slow) and not hangs(program, path, environment)]
            for path in busy:
                path.unlink()
            found = [path for path in found if path not in busy]
            status = 0 if busy and not found else process.returncode
            executed = number(r"stat::number_of_executed_units: (\d+)", text, number(r"^#(\d+)", text))
            state["executions"] += executed
            state["seconds"] += number(r"Done \d+ runs in (\d+) second", text, seconds)
            state["findings"] += len(found) + (status not in (0, None, INTERRUPTED) and not found)
            state["edges"] = number(r"\((\d+) inline 8-bit counters\)", text)
            state["covered"] = number(r"cov: (\d+)", text, state.get("covered", 0))
            state["inputs"] = len(list(grown.iterdir())) + len(list((corpus / name).iterdir()))
    return found, status


def table(states):
    lines = ["<!-- Written by `make fuzz`. -->", "",
             "| fuzzer | executions | findings | inputs in the corpus | edges reached | of edges in the program |",
             "|---|---|---|---|---|---|"]
    def thousands(value):
        return f"{value:,}".replace(",", " ")
    for name, state in sorted(states.items()):
        lines.append(f"| `{name}` | {thousands(state['executions'])} | {state['findings']} | {state['inputs']} | "
                     f"{thousands(state['covered'])} | {thousands(state['edges'])} |")
    total = sum(state["executions"] for state in states.values())
    findings = sum(state["findings"] for state in states.values())
    lines.append(f"| together | {thousands(total)} | {findings} | | | |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("corpus", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    every = sorted(path.name for path in options.corpus.iterdir() if path.is_dir())
    for name in options.names:
        if name not in every:
            sys.exit(f"fuzz.py: there is no fuzzer '{name}'; expected one of {', '.join(every)}")
    record = options.build / "fuzz.json"
    states = json.loads(record.read_text()) if record.exists() else {}
    failed = False
    try:
        for name in options.names or every:
            found, status = run(options.build, options.corpus, name, options.seconds, states.setdefault(name, {}))
            state = states[name]
            print(f"{name}: {state['executions']} executions, {state['covered']} of {state['edges']} edges, "
                  f"{state['findings']} findings", flush=True)
            for path in found:
                print(f"  {path}", flush=True)
            if status == INTERRUPTED:
                raise KeyboardInterrupt
            if status != 0:
                failed = True
                print(f"  exit status {status}: see {options.build / 'logs' / name}.log", flush=True)
    except KeyboardInterrupt:
        failed = True
    finally:
        states = {name: state for name, state in states.items() if "edges" in state and name in every}
        record.write_text(json.dumps(states, indent=1) + "\n")
        if options.output:
            options.output.write_text(table(states))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
