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


def timed(threads):
    """Wall and CPU seconds of the whole command on an empty database, and its rows."""
    database = f"performance-{threads}.db"
    for path in runs.WORK.glob(database + "*"):
        path.unlink()
    begun, cpu_begun = time.monotonic(), os.times()
    runs.tribosweep("run", str(runs.ROOT / STUDY), "--threads", str(threads), database=database)
    wall = time.monotonic() - begun
    used = os.times().children_user - cpu_begun.children_user
    return wall, used, runs.sweep(STUDY, database=database)


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


def main():
    runs.build()
    wall_1, cpu_1, _ = timed(1)
    wall_2, cpu_2, rows = timed(2)
    elements = json.loads((runs.ROOT / STUDY).read_text())["scene"]["pin"]["elements"]
    nodes = math.prod(n + 1 for n in elements)
    steps = sum(row["steps"] for row in rows)
    busy = sum(row["wall_s"] for row in rows)
    slowest = sorted(rows, key=lambda row: -row["wall_s"])[:5]
    runs.write(
        "performance.md",
        "# How long figure7 takes, and where the time goes\n\n"
        "Written by `scripts/performance.py`; do not edit. One job a thread, one lane. The product with K and the\n"
        "motion of the unconstrained nodes are one pass in vectors; contact, energies and statistics are scalar code.\n"
        f"Mesh: {' × '.join(map(str, elements))} elements.\n\n"
        f"Machine: {cpu()}, {os.cpu_count()} cores, {platform.system()}. The whole command "
        "`tribosweep run studies/figure7.json` on an empty database, report included:\n\n"
        + runs.table(
            ["threads", "wall [s]", "CPU [s]", "jobs/min"],
            [[1, f"{wall_1:.1f}", f"{cpu_1:.1f}", f"{60 * len(rows) / wall_1:.0f}"],
             [2, f"{wall_2:.1f}", f"{cpu_2:.1f}", f"{60 * len(rows) / wall_2:.0f}"]],
        )
        + "\nThe machine is shared: its speed varies by tens of percent between runs (compare the CPU seconds), and so does "
        + f"the ratio. Two threads were {wall_1 / wall_2:.2f} times as fast as one here. The {len(rows)} jobs take {steps} steps of {nodes} "
        f"nodes: {1e9 * busy / (steps * nodes):.0f} ns per node and step, contact, damping, energies and statistics "
        "included (two threads, solver time only).\n\n"
        "The dearest jobs:\n\n"
        + runs.table(["μ", "ω [rpm]", "status", "simulated [ms]", "solver time [s]"],
                     [[row["mu"], row["omega_rpm"], row["status"], f"{1e3 * row['simulated_s']:.1f}",
                       f"{row['wall_s']:.2f}"] for row in slowest])
        + "\n## Profile\n\nOne job (μ = 0.4, 0.5 rpm), sampled by `perf`:\n\n" + profile()
        + "\nThe vectorised entries (`vectorize_…`) are the pass of the step, the products of the energies (two of every 18\n"
        "products, every 16 steps) and the motion of the constrained planes.\n",
    )


if __name__ == "__main__":
    main()
