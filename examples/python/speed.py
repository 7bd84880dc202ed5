#!/usr/bin/env python3
"""Prints how long a million directions and a single direction take, after a warm-up: medians of several calls."""
import statistics
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


air = tyndall.Atmosphere()
zenith = np.random.default_rng(1).uniform(0.0, 180.0, 1_000_000)
print(f"{air.device}")
print(f"1000000 directions: {median_s(lambda: air.radiance(zenith, 60, 30), 5):.2f} s")
print(f"1 direction: {1e3 * median_s(lambda: air.radiance(30, 60), 200):.3f} ms")
