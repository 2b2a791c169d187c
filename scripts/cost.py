#!/usr/bin/env python3
"""Writes docs/evidence/speed.md: what `validate` says before a run, and how long the run then takes.

With names of studies as arguments, only these are measured.
"""

import json
import os
import sys
import time

import runs

# Pins of other materials. Their times scale with the time that a shear wave takes over the pin's height.
SOFT = {
    "name": "cost_soft_pin",
    "preset": "draft",
    "scene": {
        "pin": {"size_m": [0.01, 0.01, 0.005], "young_modulus_pa": 5e6, "poisson_ratio": 0.45, "density_kg_m3": 1100},
        "clamp": {"side": "whole_top"},
        "load": {"force_n": 2.0, "ramp_s": 2.5e-3},
    },
    "numerics": {"beta_r_s": 1e-6},
    "run": {"limit_s": 0.2},
    "detection": {"decay_observation_s": 0.04},
    "grid": {"mu": [0.3, 0.6], "omega_rpm": [1, 3, 10, 30, 100]},
}
STEEL = {
    "name": "cost_steel_pin",
    "preset": "draft",
    "scene": {
        "pin": {"young_modulus_pa": 2.1e11, "poisson_ratio": 0.3, "density_kg_m3": 7800},
        "clamp": {"width_m": 0.001},
        "load": {"force_n": 1000, "ramp_s": 6.1e-5},
    },
    "numerics": {"beta_r_s": 6e-9},
    "run": {"limit_s": 0.0049},
    "detection": {"decay_observation_s": 0.00098},
    "grid": {"mu": [0.2, 0.4, 0.6], "omega_rpm": [10, 30, 100, 300, 1000]},
}
STUDIES = ["mini", "clamps", "figure7", "work_precision", SOFT, STEEL]
ELASTIC = "figure7-elastic"
LARGE = {
    "name": "cost_large",
    "scene": {"pin": {"elements": [120, 150, 100]}, "clamp": {"width_m": 0.001}},
}

COLUMNS = ["study", "meshes or steps", "jobs", "predicted [s]", "limit [s]", "run [s]", "inside", "share", "memory predicted [MB]", "measured [MB]"]
INSIDE = COLUMNS.index("inside")


def seconds(value):
    return f"{value:.2f}" if value < 1 else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def megabytes(value):
    return f"{value / 1e6:.0f}"


def name_of(study):
    return study if isinstance(study, str) else study["name"]


def path_of(study):
    if isinstance(study, str):
        return runs.ROOT / "studies" / f"{study}.json"
    path = runs.WORK / f"{study['name']}.json"
    path.write_text(json.dumps(study, indent=2))
    return path


def measured(study):
    """The forecast of a study on an empty database, and its run: wall seconds, largest memory, share of the limit."""
    path = path_of(study)
    database = f"cost-{path.stem}.db"
    for old in runs.WORK.glob(database + "*"):
        old.unlink()
    forecast = json.loads(runs.tribosweep("validate", str(path), "--json", database=database))
    begun = time.monotonic()
    environment = dict(os.environ, TRIBOSWEEP_DB=str(runs.WORK / database))
    process = os.posix_spawn(
        str(runs.PROGRAM), [str(runs.PROGRAM), "run", str(path), "--out", str(runs.WORK / "cost-report")], environment,
        file_actions=[(os.POSIX_SPAWN_OPEN, number, os.devnull, os.O_WRONLY, 0) for number in (1, 2)],
    )
    _, status, usage = os.wait4(process, 0)
    wall = time.monotonic() - begun
    assert status == 0, f"{path}: {status}"
    rows = [json.loads(line) for line in
            runs.tribosweep("export", forecast["study"], "--format", "json", database=database).splitlines()]
    limit_s = max(group["limit_s"] for group in forecast["groups"])
    share = sum(row["simulated_s"] for row in rows) / limit_s / len(rows)
    return forecast, wall, usage.ru_maxrss * 1024, share


def row(study):
    forecast, wall, memory, share = measured(study)
    low, high, limit = (forecast["time_s"][name] for name in ("low", "high", "limit"))
    is_inside = "yes" if low <= wall <= high else f"no, {wall / (low if wall < low else high):.2f}"
    return [name_of(study), len(forecast["groups"]), forecast["jobs"], f"{seconds(low)} – {seconds(high)}", seconds(limit),
            seconds(wall), is_inside, f"{share:.2f}", megabytes(forecast["memory_bytes"]), megabytes(memory)]


def main():
    runs.build()
    everything = [*STUDIES, ELASTIC]
    wanted = sys.argv[1:] or [name_of(study) for study in everything]
    rows = [row(study) for study in everything if name_of(study) in wanted]
    large = runs.tribosweep("validate", str(path_of(LARGE)), database="cost-large.db")
    # No path of this machine.
    large = large.replace(f"{runs.WORK}/", "")
    runs.write(
        "cost",
        "# What a study takes, predicted and measured\n\n"
        f"Written by `scripts/cost.py`; do not edit. Machine: {os.cpu_count()} cores. It is shared with others, and its speed\n"
        "varies.\n\n"
        "`tribosweep validate` predicts the time of a study from three things:\n\n"
        "* **Nodes and steps.** The model of every batch is built, so nodes, time step and the number of steps up to the time\n"
        "  limit are those of the run.\n"
        "* **The speed.** It is that of the jobs that have finished in the database, whatever their studies and machines. The more\n"
        "  their times scatter, the wider its range. While fewer than ten jobs have finished, a typical speed is taken: 3 to 12 ns per\n"
        "  node and step of a thread. The first forecast on a machine is so the widest: the ends of its range differ by a factor of\n"
        "  about 10 for a study of a hundred jobs, and by a factor of about 5 later. The forecasts below are such first ones.\n"
        "* **When the jobs end.** A job ends when its state is periodic or decays, and nobody knows when that is. Most periodic\n"
        "  jobs end after 0.3 to 1 decay observations (`detection.decay_observation_s`), and stable ones after 1 to 1.7, both\n"
        "  after the ramp of the load. A job that never becomes periodic runs to its limit, which is five observations by default.\n"
        "  So the mean over a study is taken between 0.4 and 1.7 observations, plus the cycles that count, and the fewer jobs\n"
        "  there are, the further beyond.\n\n"
        "The range that is printed contains both uncertainties. "
        f"The times of {sum(cells[INSIDE] == 'yes' for cells in rows)} of {len(rows)} studies lie in their predicted ranges; the column\n"
        "*inside* says by what factor one does not.\n"
        "*Limit* is the time if every job runs to its time limit. *Share* is the simulated time over that limit, on average.\n"
        "The memory is that of the whole process with its two threads: the largest resident memory of `run`. Complex modes, by which\n"
        "eigenvalues decide stable jobs (`figure7`), take most of it; without them a thread takes some 10 MB on that mesh, and the process 12 MB.\n"
        "The memory is predicted within a factor of two or so.\n\n"
        + runs.table(COLUMNS, rows)
        + "\nA mesh of 120 × 150 × 100 elements, which is beyond what a sweep is for:\n\n```text\n" + large + "```\n",
    )


if __name__ == "__main__":
    main()
