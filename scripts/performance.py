#!/usr/bin/env python3
"""Writes docs/evidence/speed.md: how long figure7 takes on this machine, and what its settings save.

Every number in the page is computed. Takes an hour and a half on two cores; they must be idle. With the names of parts, only these are
measured again, and the others are those of the last run; `page` measures nothing.
"""

import argparse
import json
import math
import os
import platform
import re
import statistics
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


def figure7(**changes):
    """The study with top-level members replaced."""
    return json.loads((runs.ROOT / STUDY).read_text()) | changes


def timed(threads, study):
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


def machine_table(machine):
    rows = [["fused multiply-add", f"{machine['fused_gflops']:.0f} GFLOP/s"],
            ["plain multiplications and additions", f"{machine['plain_gflops']:.0f} GFLOP/s"]]
    rows += [[f"read and write, {level['bytes'] >> 10} kB", f"{level['gb_per_s']:.0f} GB/s"]
             for level in machine["bandwidth"]]
    return runs.table([f"one core, {machine['vectors']} vectors", ""], rows)


# How figure7 can be solved: in words, with the settings, and whether a preset uses it.
OLD = {"precision": "double", "start": "rest", "stability": "simulate"}
FAST = {"precision": "single", "start": "nested", "stability": "eigenvalues"}
WAYS = [
    ("double, from rest, all simulated: the default without a preset", OLD),
    ("+ eigenvalues", OLD | {"stability": "eigenvalues"}),
    ("+ single precision", OLD | {"precision": "single"}),
    ("+ single precision, nested start", FAST | {"stability": "simulate"}),
    ("+ single precision, nested start, eigenvalues: the presets", FAST),
    ("the presets with steps of 0.9 of the limit (dropped)", FAST | {"safety_factor": 0.9}),
    ("the presets with 10 cycles and half the drift (dropped)", FAST | {"cycles": 10, "drift_tolerance": 0.0005}),
]
# A change of μ* from which on a job is counted.
LARGE = 0.003
# Each way is timed so often, in alternating order.
ROUNDS = 2


def solved(name, settings):
    """CPU seconds of figure7 with these settings on an empty database, and its rows."""
    study = figure7(name=name)
    study["numerics"] = study.get("numerics", {}) | {key: settings[key] for key in ("precision", "safety_factor") if key in settings}
    study["run"] = {"start": settings["start"]}
    study["detection"] = {key: settings[key] for key in ("cycles", "drift_tolerance") if key in settings}
    study["stability"] = settings["stability"]
    _, used, rows = timed(2, study)
    return used, {(row["mu"], row["omega_rpm"]): row for row in rows}


def way_table():
    """CPU time of every way, what it changes in the results of the first one, and which jobs the presets change."""
    times, rows = [[] for _ in WAYS], [None for _ in WAYS]
    for turn in range(ROUNDS):
        order = range(len(WAYS)) if turn % 2 == 0 else reversed(range(len(WAYS)))
        for i in order:
            used, rows[i] = solved(f"way_{i}", WAYS[i][1])
            times[i].append(used)
    table = []
    for (words, _), used, found in zip(WAYS, times, rows):
        table.append([words, f"{statistics.median(used):.0f}",
                      f"{statistics.median(times[0]) / statistics.median(used):.2f}", *changes(rows[0], found)])
    heads = ["way", "CPU [s]", "times as fast", "other statuses or regimes", "median, largest change of μ\\*", f"beyond {100 * LARGE:g} %",
             "largest change of f", "of a share"]
    of_presets = rows[[settings for _, settings in WAYS].index(FAST)]
    return runs.table(heads, table) + "\n" + in_words(rows[0], of_presets)


def in_words(before, after):
    """Which jobs change by more than `LARGE`, and what the jobs of the second sweep take."""
    large = []
    for (mu, omega_rpm), old in before.items():
        new = after[mu, omega_rpm]
        change = new["mu_star"] / old["mu_star"] - 1
        if abs(change) > LARGE:
            period = ", and the period doubles" if old["frequency_hz"] and new["frequency_hz"] and new["frequency_hz"] < 0.6 * old["frequency_hz"] else ""
            large.append(f"at μ = {mu:g} and {omega_rpm:g} rpm by {100 * change:+.1f} %{period}")
    periodic = [row for row in after.values() if row["status"] == "periodic"]
    by_modes = [row for row in after.values() if row["decided_by"] == "eigenvalues"]
    simulated = statistics.mean(row["simulated_s"] for row in periodic)
    cycles = statistics.mean(row["simulated_s"] * row["frequency_hz"] for row in periodic)
    return (
        f"With the presets {len(large)} of {len(before)} jobs change by more than {100 * LARGE:g} %" + (": " + "; ".join(large) if large else "")
        + ". [solving.md](../solving.md#a-start-from-a-coarser-mesh) says why single jobs can.\n\n"
        f"What is left: a periodic job simulates {1e3 * simulated:.1f} ms on its own mesh on average, which are {cycles:.0f} of its cycles. "
        f"Eigenvalues decide {len(by_modes)} of {len(after)} jobs.\n"
        "Longer steps and fewer cycles are no defaults, because they change more jobs or save little."
        " The state of a neighbour in the grid as a start is none, because a result would depend on which job ran first.\n"
    )


def changes(before, after):
    """What changes from one sweep to another: counts and largest changes over all jobs."""
    words = ("status", "regime")
    shares = ("stick_share", "slip_share", "separated_share")
    pairs = [(before[point], after[point]) for point in before]
    other = sum(any(a[word] != b[word] for word in words) for a, b in pairs)
    mu_star = sorted(abs(b["mu_star"] / a["mu_star"] - 1) for a, b in pairs)
    # A doubled period is half the frequency. It is counted with μ*.
    frequency = [abs(b["frequency_hz"] / a["frequency_hz"] - 1) for a, b in pairs
                 if a["frequency_hz"] and b["frequency_hz"]]
    share = max(abs(b[name] - a[name]) for a, b in pairs for name in shares)
    return [str(other), f"{100 * mu_star[len(mu_star) // 2]:.3f} %, {100 * mu_star[-1]:.2f} %",
            str(sum(change > LARGE for change in mu_star)), f"{100 * max(frequency):.2f} %", f"{share:.4f}"]


def mesh_table(cases):
    rows = []
    for case in cases:
        bound = max(case["arithmetic_bound_ns"], case["traffic_bound_ns"])
        if bound > case["job_ns"]:
            raise SystemExit(f"{case}: a job is faster than this machine's peaks allow, so the benchmark's own loops are not optimized")
        rows.append([" × ".join(map(str, case["elements"])), case["precision"], case["lanes"],
                     *(f"{case[what]:.2f}" for what in ("product_ns", "step_ns", "job_ns")),
                     f"{bound:.2f}", f"{100 * bound / case['job_ns']:.0f} %"])
    return runs.table(["elements", "precision", "lanes", "product", "step", "job", "bound", "reached by job"], rows)


def sweep():
    """The whole command with one and with two threads."""
    wall_1, cpu_1, _ = timed(1, figure7())
    wall_2, cpu_2, rows = timed(2, figure7())
    return {"wall_1": wall_1, "cpu_1": cpu_1, "wall_2": wall_2, "cpu_2": cpu_2, "jobs": len(rows), "steps": sum(row["steps"] for row in rows)}


PARTS = {"sweep": sweep, "ways": way_table, "bench": benchmark, "ramps": ramp_table}


def measured(wanted):
    """What all parts have found."""
    path = runs.WORK / "performance.json"
    found = json.loads(path.read_text()) if path.exists() else {}
    for part in [part for part in wanted or PARTS if part != "page"]:
        found[part] = PARTS[part]()
        path.write_text(json.dumps(found))
    missing = [part for part in PARTS if part not in found]
    if missing:
        raise SystemExit(f"not measured yet: {', '.join(missing)}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="PART", help="the parts that are measured again (default: all)")
    wanted = parser.parse_args().parts
    unknown = [part for part in wanted if part not in (*PARTS, "page")]
    if unknown:
        parser.error(f"no such part: {', '.join(unknown)}; there are {', '.join(PARTS)}")
    runs.build()
    found = measured(wanted)
    bench, of_sweep, ways = found["bench"], found["sweep"], found["ways"]
    wall_1, cpu_1, wall_2, cpu_2, jobs, steps = (of_sweep[name] for name in ("wall_1", "cpu_1", "wall_2", "cpu_2", "jobs", "steps"))
    elements = json.loads((runs.ROOT / STUDY).read_text())["scene"]["pin"]["elements"]
    nodes = math.prod(n + 1 for n in elements)
    runs.write(
        "performance",
        "# How fast it is\n\n"
        "Written by `scripts/performance.py`; do not edit. "
        f"Machine: {cpu()}, {os.cpu_count()} cores, {platform.system()}. It is shared with others: its speed varies by tens of\n"
        "percent, sometimes by half, for seconds at a time.\n\n"
        "## Per node, step and job\n\n"
        "These times are from `cargo bench`, which runs all cases in turn in several rounds; the fastest round counts. They are in\n"
        "ns per node, step and job on one core. *Product* is y = K x. *Step* adds integration, supports and contact. *Job* is all\n"
        "that a sweep does: it adds energies, divergence guard, statistics and detection. A step takes 127 operations per node (100\n"
        "of the product, 27 of damping and integration; the contact face is not counted), which are never fused. It reads and\n"
        "writes 12 numbers of u and p per node. *Bound* is the time of the operations or of this traffic at the measured peaks,\n"
        "whichever is longer.\n\n"
        + machine_table(bench["machine"]) + "\n" + mesh_table(bench["meshes"])
        + "\nThe product is no faster on meshes whose scratch memory stays in the L1 cache, so it does not wait for memory. On large meshes with\n"
        "many lanes it does. There the program uses fewer lanes, which changes no bit of a result.\n\n"
        "## What parts cost\n\n12 × 15 × 10 elements, 8 lanes, ns per node, step and job:\n\n"
        + runs.table(["with, or without", "with", "without"],
                     [[pair["what"], f"{pair['with_ns']:.2f}", f"{pair['without_ns']:.2f}"] for pair in bench["pairs"]])
        + "\nDifferences of a few tenths mean nothing: the placement of the arrays in memory changes the times by as much.\n\n"
        "## The sweep\n\n"
        "The whole command `tribosweep run studies/figure7.json` on an empty database, report included "
        f"({' × '.join(map(str, elements))} elements):\n\n"
        + runs.table(
            ["threads", "wall [s]", "CPU [s]", "jobs/min"],
            [[1, f"{wall_1:.1f}", f"{cpu_1:.1f}", f"{60 * jobs / wall_1:.0f}"],
             [2, f"{wall_2:.1f}", f"{cpu_2:.1f}", f"{60 * jobs / wall_2:.0f}"]],
        )
        + f"\nTwo threads were {wall_1 / wall_2:.2f} times as fast as one. "
        f"The runs of the {jobs} jobs on their own mesh take {steps} steps of {nodes} nodes.\n\n"
        "## Ways to solve it\n\n"
        f"The same sweep in different ways, on two threads: medians of {ROUNDS} runs in alternating order. Changes are those from\n"
        "the first way, over all jobs.\n\n"
        + ways
        + "From rest there is no coarser run. Then little is known above the band of the modes, and eigenvalues decide few jobs or none\n"
        "([eigenvalues.md](eigenvalues.md)).\n\n"
        "## Time to the steady state\n\n"
        "Does a slower start shorten the transient? Twenty jobs of all regimes, 12 × 15 × 10 elements, load ramped up in:\n\n"
        + found["ramps"]
        + "\nThe ramp is a small part of a job.\n",
    )


if __name__ == "__main__":
    main()
