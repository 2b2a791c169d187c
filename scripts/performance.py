#!/usr/bin/env python3
"""Writes docs/performance.md: how long figure7 takes on this machine and where the time goes.

The profile needs Linux's `perf` (Debian: linux-perf); without it that section says so.
"""

import json
import math
import os
import platform
import re
import shutil
import subprocess
import time

import runs

STUDY = "studies/figure7.json"


def cpu():
    try:
        with open("/proc/cpuinfo") as info:
            found = re.search(r"model name\s*:\s*(.*)", info.read())
            return found.group(1) if found else platform.machine()
    except OSError:
        return platform.machine()


def timed(threads, study=STUDY):
    """Wall and CPU seconds of the whole command on an empty database, and its rows."""
    database = f"performance-{threads}.db"
    for path in runs.WORK.glob(database + "*"):
        path.unlink()
    begun, cpu_begun = time.monotonic(), os.times()
    rows = runs.sweep(study, database=database, options=("--threads", str(threads)))
    wall = time.monotonic() - begun
    used = os.times().children_user - cpu_begun.children_user
    return wall, used, rows


def benchmark():
    """What `cargo bench` finds."""
    subprocess.run(["cargo", "bench", "--quiet", "--bench", "performance"], cwd=runs.ROOT, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return json.loads((runs.ROOT / "target" / "performance.json").read_text())


def coarse():
    """figure7 on the mesh that it had before the accuracy study."""
    study = json.loads((runs.ROOT / STUDY).read_text())
    study["name"] = "figure7_coarse"
    study["scene"]["pin"]["elements"] = [12, 15, 10]
    return study


def ramps():
    """Jobs of all regimes with the load ramped up at different speeds."""
    return {
        "name": "performance_ramps",
        "scene": {"pin": {"elements": [12, 15, 10]}, "clamp": {"width_m": 0.001}},
        "grid": {"ramp_s": [5e-4, 1e-3, 2e-3, 4e-3], "mu": [0.1, 0.2, 0.3, 0.4, 0.6], "omega_rpm": [0.5, 7, 35, 100]},
    }


def ramp_table():
    rows = runs.sweep(ramps())
    times = {}
    for row in rows:
        times.setdefault(row["ramp_s"], []).append(row)
    base = {(row["mu"], row["omega_rpm"]): row["mu_star"] for row in times[5e-4]}
    return runs.table(
        ["ramp [ms]", "simulated in all [ms]", "largest change of μ\\*"],
        [[f"{1e3 * ramp:.1f}", f"{1e3 * sum(row['simulated_s'] for row in jobs):.0f}",
          f"{max(abs(row['mu_star'] - base[row['mu'], row['omega_rpm']]) for row in jobs):.4f}"]
         for ramp, jobs in sorted(times.items())],
    )


def profile():
    if shutil.which("perf") is None:
        return "`perf` was not found, so there is no profile here.\n"
    data = runs.WORK / "perf.data"
    command = [runs.PROGRAM, "solve", str(runs.ROOT / STUDY), "--set", "mu=0.4", "--set", "omega_rpm=0.5"]
    subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-o", data, *command], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    report = subprocess.run(["perf", "report", "-i", data, "--stdio", "--no-children"], check=True, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    rows = []
    for line in report.splitlines():
        found = re.match(r"\s*([\d.]+)%\s+\S+\s+\S+\s+\[\S\]\s+(.*)", line)
        if found and float(found.group(1)) >= 0.5:
            rows.append([f"{float(found.group(1)):.1f} %", f"`{found.group(2).strip()}`"])
    return runs.table(["share", "function"], rows)


def machine_table(machine):
    rows = [["fused multiply-add", f"{machine['fused_gflops']:.0f} GFLOP/s"],
            ["plain multiplications and additions", f"{machine['plain_gflops']:.0f} GFLOP/s"]]
    rows += [[f"read and write, {level['bytes'] >> 10} kB", f"{level['gb_per_s']:.0f} GB/s"]
             for level in machine["bandwidth"]]
    return runs.table([f"one core, {machine['vectors']} vectors", ""], rows)


def mesh_table(cases):
    rows = []
    for case in cases:
        bound = max(case["arithmetic_bound_ns"], case["traffic_bound_ns"])
        rows.append([" × ".join(map(str, case["elements"])), case["lanes"],
                     *(f"{case[what]:.2f}" for what in ("product_ns", "step_ns", "job_ns")),
                     f"{bound:.2f}", f"{100 * bound / case['job_ns']:.0f} %"])
    return runs.table(["elements", "lanes", "product", "step", "job", "bound", "reached by job"], rows)


def main():
    runs.build()
    wall_1, cpu_1, _ = timed(1)
    wall_2, cpu_2, rows = timed(2)
    coarse_s, _, _ = timed(2, coarse())
    bench = benchmark()
    elements = json.loads((runs.ROOT / STUDY).read_text())["scene"]["pin"]["elements"]
    nodes = math.prod(n + 1 for n in elements)
    steps = sum(row["steps"] for row in rows)
    busy = sum(row["wall_s"] for row in rows)
    runs.write(
        "performance.md",
        "# How fast it is, and how fast it could be\n\n"
        "Written by `scripts/performance.py`; do not edit. "
        f"Machine: {cpu()}, {os.cpu_count()} cores, {platform.system()}. It is shared with others: its speed varies by tens of\n"
        "percent, sometimes by half, for seconds at a time.\n\n"
        "## Per node, step and job\n\n"
        "These times are from `cargo bench`, which runs all cases in turn in several rounds; the fastest round counts. They are in\n"
        "ns per node, step and job on one core. *Product* is y = K x. *Step* adds integration, supports and contact. *Job* is all\n"
        "that a sweep does: it adds energies, divergence guard, statistics and detection. A step takes 127 operations per node (100\n"
        "of the product, 27 of damping and integration; the contact face is not counted), which are never fused. It reads and\n"
        "writes 96 bytes of u and p per node. *Bound* is the time of the operations or of this traffic at the measured peaks,\n"
        "whichever is longer.\n\n"
        + machine_table(bench["machine"]) + "\n" + mesh_table(bench["meshes"])
        + "\nThe goal was 2.5 ns for a job with 8 lanes on 12 × 15 × 10 elements, 5 ns on 48 × 60 × 40, and 8 ns for one lane.\n"
        "The product prevents the first goal: it takes some 300 instructions for a block of eight numbers, of which two thirds\n"
        "are arithmetic. It is no faster on meshes whose scratch memory stays in the L1 cache, so it does not wait for memory. On\n"
        "large meshes with many lanes it does. There the program uses fewer lanes (1 beyond 20 000 nodes, 2 beyond 10 000, 4\n"
        "beyond 5 000), which changes no bit of a result.\n\n"
        "## What parts cost\n\n12 × 15 × 10 elements, 8 lanes, ns per node, step and job:\n\n"
        + runs.table(["with, or without", "with", "without"],
                     [[pair["what"], f"{pair['with_ns']:.2f}", f"{pair['without_ns']:.2f}"] for pair in bench["pairs"]])
        + "\nDifferences of a few tenths mean nothing: the placement of the arrays in memory changes the times by as much.\n\n"
        "## The sweep\n\n"
        "The whole command `tribosweep run studies/figure7.json` on an empty database, report included "
        f"({' × '.join(map(str, elements))} elements):\n\n"
        + runs.table(
            ["threads", "wall [s]", "CPU [s]", "jobs/min"],
            [[1, f"{wall_1:.1f}", f"{cpu_1:.1f}", f"{60 * len(rows) / wall_1:.0f}"],
             [2, f"{wall_2:.1f}", f"{cpu_2:.1f}", f"{60 * len(rows) / wall_2:.0f}"]],
        )
        + f"\nTwo threads were {wall_1 / wall_2:.2f} times as fast as one. The {len(rows)} jobs take {steps} steps of {nodes} "
        f"nodes: {1e9 * busy / (steps * nodes):.1f} ns of a core per node and step, everything included. With one job per thread\n"
        "the same command took 128 s on two threads and 245 s on one (an earlier day, the same kind of machine).\n\n"
        f"On 12 × 15 × 10 elements the same grid takes {coarse_s:.1f} s on two threads; with assembled stencils and one job per thread\n"
        "it took 58 to 65 s.\n\n"
        "## Time to the steady state\n\n"
        "Does a slower start shorten the transient? Twenty jobs of all regimes, 12 × 15 × 10 elements, load ramped up in:\n\n"
        + ramp_table()
        + "\nThe ramp is a small part of a job, and limit cycles are found at about the same time with every ramp. Starting from\n"
        "the final state of a neighbour in the grid was tried, too. Over fourteen pairs of jobs it took a quarter less simulated\n"
        "time and led to the same limit cycles. It was not adopted, because a result would then depend on which job ran first.\n"
        + "\n## Profile\n\nOne job (μ = 0.4, 0.5 rpm), one lane, sampled by `perf`:\n\n" + profile()
        + "\nThe vectorised entries (`vectorize_…`) are in this order the pass of the step, products of the energies (two every\n"
        "16 steps), contact, statistics, works of the contact forces and the constrained planes.\n",
    )


if __name__ == "__main__":
    main()
