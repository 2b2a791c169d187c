#!/usr/bin/env python3
"""Writes docs/evidence/scenes.md: random scenes with holders, each result beside a run ten times as long.

    scripts/holders.py [--scenes N] [--seed S] [--program PATH] [--threads N]

Holders have 0.01 to 3 kg and 10^4 to 10^8 N/m. Every result that the program calls `periodic` or `decayed` is compared with the
mean over the last part of a run that lasts ten times as long and does not stop early.
"""

import argparse
import collections
import concurrent.futures
import json
import math
import random
import subprocess
import tempfile
from pathlib import Path

import runs

LAWS = ["coulomb", "regularised", "static_kinetic", "exponential", "prakash_clifton"]
CLAMPS = ["inner_side", "outer_side", "leading_end", "trailing_end", "both_sides", "both_ends", "whole_top"]
# Longest simulated time of a job [s]. The longest holders need more, and then end as not periodic.
LONGEST_S = 0.25
# Largest difference that counts as agreement: relative, or in standard errors of both.
RELATIVE, ERRORS = 0.01, 3.0
# What the detection lets the means drift.
DRIFT = 0.001


def log_uniform(draw, low, high):
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def scene(draw):
    """A study of one job."""
    mu = draw.uniform(0.1, 0.6)
    contact = {"law": draw.choice(LAWS), "mu": mu}
    if contact["law"] in ("static_kinetic", "exponential"):
        contact["mu_static"] = mu * draw.uniform(1.0, 1.5)
    if contact["law"] == "exponential":
        contact["speed_m_s"] = log_uniform(draw, 0.01, 0.5)
    if contact["law"] == "regularised":
        contact["speed_m_s"] = log_uniform(draw, 1e-4, 1e-2)
    if contact["law"] == "prakash_clifton":
        contact["length_m"] = log_uniform(draw, 1e-7, 1e-5)
    mass, stiffness = log_uniform(draw, 0.01, 3.0), log_uniform(draw, 1e4, 1e8)
    damping = 2.0 * log_uniform(draw, 0.003, 0.5) * math.sqrt(mass * stiffness)
    holder = {"mass_kg": mass, "stiffness_y_n_m": stiffness, "damping_y_n_s_m": damping}
    kind = draw.choice(["y", "y", "y", "y and z", "y and x", "y and rotation", "undamped", "damper alone in x"])
    if kind == "y and z":
        holder |= {"stiffness_z_n_m": 0.0, "damping_z_n_s_m": damping}
    elif kind == "y and x":
        holder |= {"stiffness_x_n_m": stiffness, "damping_x_n_s_m": damping}
    elif kind == "y and rotation":
        rotational = stiffness * 1e-4
        holder |= {
            "rotational_stiffness_x_nm_rad": rotational,
            "inertia_x_kg_m2": mass * 1e-4,
            "rotational_damping_x_nm_s_rad": damping * 1e-4,
        }
    elif kind == "undamped":
        del holder["damping_y_n_s_m"]
    elif kind == "damper alone in x":
        holder |= {"stiffness_x_n_m": 0.0, "damping_x_n_s_m": damping}
    return {
        "name": "holder",
        "scene": {
            "pin": {"elements": [4, 5, 4]},
            "clamp": {"side": draw.choice(CLAMPS), "width_m": 0.003},
            "contact": contact,
            "holder": holder,
        },
        "grid": {"omega_rpm": [log_uniform(draw, 0.05, 200.0)]},
    }


def solve(program, study, **run):
    """The record of the study's job."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "holder.json"
        path.write_text(json.dumps(study | {"run": run}))
        done = subprocess.run([program, "solve", str(path), "--json"], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{json.dumps(study)}\n{done.stderr}")
    return json.loads(done.stdout)


def status(record):
    # Programs before version 5 of the solver call it the outcome.
    return record.get("status", record.get("outcome"))


def compare(program, number, seed):
    """A scene, its result, and that of the long run; no long run if the result is neither periodic nor decayed."""
    study = scene(random.Random(f"{seed}-{number}"))
    short = solve(program, study, limit_s=LONGEST_S)
    long = None
    if status(short) in ("periodic", "decayed"):
        long = solve(program, study, limit_s=10.0 * short["simulated_s"], stop_early=False)
    return number, study, short, long


def difference(short, long):
    """Of μ*: relative, and in standard errors."""
    apart = abs(short["mu_star"] - long["mu_star"])
    error = math.hypot(short["mu_star_se"], long["mu_star_se"])
    return apart / abs(long["mu_star"]), apart / error if error else math.inf if apart else 0.0


def describe(study):
    parts, holder = study["scene"], study["scene"]["holder"]
    hz = math.sqrt(holder["stiffness_y_n_m"] / holder["mass_kg"]) / math.tau
    return f"{parts['contact']['law']}, μ {parts['contact']['mu']:.3f}, {parts['clamp']['side']}, {study['grid']['omega_rpm'][0]:.1f} rpm, " \
        f"{holder['mass_kg']:.3g} kg at {hz:.0f} Hz"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", default=str(runs.PROGRAM))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--dry-run", action="store_true", help="print the page instead of writing it")
    given = parser.parse_args()
    if given.program == str(runs.PROGRAM):
        runs.build()
    with concurrent.futures.ThreadPoolExecutor(given.threads) as pool:
        found = list(pool.map(lambda n: compare(given.program, n, given.seed), range(given.scenes)))
    counts = collections.Counter(status(short) for _, _, short, _ in found)
    compared = [(n, study, short, long, *difference(short, long)) for n, study, short, long in found if long]
    beyond_one = [row for row in compared if row[4] > RELATIVE]
    # Errors of long runs can be rounding, so that the tolerated drift is allowed, too.
    beyond_errors = [row for row in compared if row[5] > ERRORS and abs(row[2]["mu_star"] - row[3]["mu_star"]) > DRIFT]
    relative = sorted(row[4] for row in compared)
    above_mu = sum(
        short["mu_star"] > 1.0001 * study["scene"]["contact"]["mu"]
        for _, study, short, _ in found
        if study["scene"]["contact"]["law"] == "coulomb" and status(short) in ("periodic", "decayed")
    )
    share = lambda q: f"{100 * relative[int(q * (len(relative) - 1))]:.3f} %" if relative else "none"
    text = f"""# Holders

`scripts/holders.py` wrote this page. It draws {given.scenes} scenes (seed {given.seed}): holders of 0.01 to 3 kg on springs of 10⁴ to 10⁸ N/m, with 0.3 to 50 % of the
critical damping or none, some of which also move in x or z or rotate; five friction laws, seven clamps, 0.05 to 200 rpm, μ of 0.1 to 0.6, on meshes of 4 × 5 × 4 elements. A job may
simulate {LONGEST_S} s. Each result that is `periodic` or `decayed` stands beside a run that lasts ten times as long and does not stop early.

**Of {len(compared)} results, {len(beyond_one)} differ from the long run by more than 1 %**, and {len(beyond_errors)} by more than three standard errors and the
tolerated drift of {DRIFT}.
With Coulomb's law {above_mu} have a μ\\* above μ.

| | |
|---|---|
| `periodic` | {counts['periodic']} |
| `decayed` | {counts['decayed']} |
| `not_periodic`: the job makes no claim | {counts['not_periodic']} |
| median difference of μ\\* | {share(0.5)} |
| nine of ten differ by less than | {share(0.9)} |
| largest difference | {share(1.0)} |

"""
    if beyond_one:
        header = ["scene", "", "status", "simulated", "μ\\*", "after ten times as long", "difference", "standard errors"]
        rows = [
            [n, describe(study), status(short), f"{1e3 * short['simulated_s']:.1f} ms", f"{short['mu_star']:.5f} ± {short['mu_star_se']:.5f}",
             f"{long['mu_star']:.5f} ± {long['mu_star_se']:.5f} ({status(long)})", f"{100 * relative:.2f} %", f"{errors:.1f}"]
            for n, study, short, long, relative, errors in sorted(beyond_one, key=lambda row: -row[5])
        ]
        text += "Those that differ by more than 1 %:\n\n" + runs.table(header, rows)
    if given.dry_run:
        print(text)
    else:
        runs.write("holders", text)


if __name__ == "__main__":
    main()
