#!/usr/bin/env python3
"""Prints how long a million directions and a single direction take, after a warm-up: medians of several calls. With --cost, also
the processor time of tables that are not stored yet, and of the path tracer.
"""
import statistics
import sys
import time

import numpy as np

import tyndall


def median_s(call, times):
    call()
    measured = []
    for _ in range(times):
        start = time.perf_counter()
        call()
        measured.append(time.perf_counter() - start)
    return statistics.median(measured)


def processor_s(call):
    start = time.process_time()
    call()
    return time.process_time() - start


zenith = np.random.default_rng(1).uniform(0.0, 180.0, 1_000_000)
air = tyndall.Atmosphere()
print(f"{air.device}")
for name, model in (("channels", air), ("xyz", tyndall.Atmosphere(color="xyz"))):
    print(f"{name}: 1000000 directions: {median_s(lambda: model.radiance(zenith, 60, 30), 3):.2f} s")
    print(f"{name}: 1 direction: {1e3 * median_s(lambda: model.radiance(30, 60), 200):.3f} ms")
if "--cost" in sys.argv[1:]:
    off = {"tables.cache": "off"}
    for name, light in (("three channels", {}), ("a colour", {"color": "xyz"}), ("6 wavelengths", {"wavelengths": np.linspace(400, 700, 6)})):
        print(f"tables of {name}: {processor_s(lambda: tyndall.Atmosphere(off, **light)):.1f} s of processor time")
    for name, light in (("three channels", {}), ("a colour", {"color": "xyz"}), ("40 wavelengths", {"wavelengths": np.linspace(400, 700, 40)})):
        traced = tyndall.Atmosphere(model="single", **light)
        cost = processor_s(lambda: traced.trace([30, 60], 50, samples=10000))
        print(f"20000 paths of 8 orders, {name}: {cost:.2f} s of processor time")
