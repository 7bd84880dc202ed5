#!/usr/bin/env python3
"""Prints how long a million directions and a single direction take, after a warm-up: medians of several calls. With --cost, also
how long tables take that are not stored yet, and paths of the path tracer.
"""
import statistics
import sys
import time

import numpy as np

import tyndall


def median_s(call, times, warm_up=True):
    if warm_up:
        call()
    measured = []
    for _ in range(times):
        start = time.perf_counter()
        call()
        measured.append(time.perf_counter() - start)
    return statistics.median(measured)


zenith = np.random.default_rng(1).uniform(0.0, 180.0, 1_000_000)
air = tyndall.Atmosphere()
print(f"{air.device}")
for name, model in (("channels", air), ("xyz", tyndall.Atmosphere(color="xyz"))):
    print(f"{name}: 1000000 directions: {median_s(lambda: model.radiance(zenith, 60, 30), 3):.2f} s")
    print(f"{name}: 1 direction: {1e3 * median_s(lambda: model.radiance(30, 60), 200):.3f} ms")
if "--cost" in sys.argv[1:]:
    off = {"tables.cache": "off"}
    print(f"tables of three channels: {median_s(lambda: tyndall.Atmosphere(off), 1, False):.1f} s")
    print(f"tables of a colour: {median_s(lambda: tyndall.Atmosphere(off, color='xyz'), 1, False):.1f} s")
    print(f"tables of 6 wavelengths: {median_s(lambda: tyndall.Atmosphere(off, wavelengths=np.linspace(400, 700, 6)), 1, False):.1f} s")
    for name, light in (("three channels", {}), ("a colour", {"color": "xyz"}), ("40 wavelengths", {"wavelengths": np.linspace(400, 700, 40)})):
        traced = tyndall.Atmosphere(model="single", **light)
        print(f"100000 paths of {name}: {median_s(lambda: traced.trace([30, 60], 50, samples=50000), 1, False):.1f} s")
