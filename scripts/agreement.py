#!/usr/bin/env python3
"""Writes its part of docs/evidence/paper.md: the program beside a second solver, and what stopping early changes.

The second solver is scripts/peers/second.py, and the modes are those of scripts/peers/modes.py. They need numpy, scipy and CalculiX:
TRIBOSWEEP_PYTHON names a Python that has the first two.
"""

import json
import math
import os
import subprocess
import sys

import runs

SPEEDS = [0.5, 2, 6, 7, 35, 100]
# The scene of scripts/peers/second.py: the reference scene with a clamp of 2 mm.
COARSE = {"elements": [6, 8, 5], "clamp_width_m": 0.002, "mu": 0.4, "omega_rpm": 7, "time_step_s": 1.75e-6, "limit_s": 0.02, "ramp_s": 1e-3, "beta_r_s": 2e-8}
STEPS = [1.6e-6, 8e-7, 4e-7, 5.5e-8]
MESHES = [
    {"elements": [6, 8, 5], "time_step_s": 1.73e-6},
    {"elements": [12, 15, 10], "time_step_s": 8.85e-7},
    {"elements": [18, 22, 15], "time_step_s": 5.83e-7},
    {"elements": [12, 15, 10], "time_step_s": 8.85e-7, "clamp_width_m": 0.001, "ramp_s": 5e-4, "omega_rpm": 6},
    {"elements": [12, 15, 10], "time_step_s": 8.85e-7, "clamp_width_m": 0.001, "ramp_s": 5e-4, "omega_rpm": 12},
]


def peer(script, *arguments, cases=None):
    """What a script of scripts/peers prints."""
    python = os.environ.get("TRIBOSWEEP_PYTHON", sys.executable)
    command = [python, str(runs.ROOT / "scripts/peers" / script), *arguments]
    done = subprocess.run(command, input=json.dumps(cases), stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def second(cases):
    """What the second solver finds."""
    return peer("second.py", cases=cases)


def modes():
    rows = []
    for row in peer("modes.py", str(runs.PROGRAM), "--json"):
        rows.append([row["program"], row["mass"], *(f"{own[0]:.2f} Hz, {own[1]:+.2f} 1/s" for own in (row["found"], row["assembly"])), row["contact_nodes"], f"{row['apart']:.1e}"])
    return (runs.table(["program", "mass", "leading mode", "the same by the assembly", "nodes in contact", "difference, relative"], rows)
            + "\nBoth differences are below 2e-05, as the script requires.\n")


def calculix_version():
    return subprocess.run(["ccx", "-v"], stdout=subprocess.PIPE, text=True, check=False).stdout.split()[-1]


def program(case, stops=False):
    """What the program finds."""
    numbers = "-".join(str(value) for value in case.values()).replace(" ", "").translate(str.maketrans("[],.", "____"))
    study = {
        "name": f"agreement-{numbers}" + ("-early" if stops else ""),
        "scene": {"pin": {"elements": case["elements"]}, "clamp": {"side": "inner_side", "width_m": case["clamp_width_m"]},
                  "load": {"force_n": 30, "ramp_s": case["ramp_s"]}},
        "numerics": {"beta2": 0.5, "beta_r_s": case["beta_r_s"], "time_step_s": case["time_step_s"]},
        "run": {"limit_s": case["limit_s"]} if stops else {"limit_s": case["limit_s"], "stop_early": False, "average_last_fraction": 0.4},
        "grid": {"mu": [case["mu"]], "omega_rpm": [case["omega_rpm"]]},
    }
    [row] = runs.sweep(study)
    return row


def pair(own, row):
    """Cells with μ*, frequency and shares of both."""
    found = [row[f"{name}_share"] for name in ("stick", "slip", "separated")]
    return [
        f"{own['mu_star']:.5f}", f"{row['mu_star']:.5f}", f"{abs(row['mu_star'] - own['mu_star']):.5f}",
        f"{own['frequency_hz']:.0f}", f"{row['frequency_hz']:.0f}" if row["frequency_hz"] else "",
        " / ".join(f"{share:.3f}" for share in own["shares"]), f"{max(abs(a - b) for a, b in zip(found, own['shares'])):.4f}",
    ]


HEADER = ["μ*, second", "μ*", "difference", "f [Hz], second", "f [Hz]", "stick / slip / separated, second", "largest difference of a share"]


def speeds():
    cases = [{**COARSE, "omega_rpm": omega} for omega in SPEEDS]
    rows = []
    for case, own in zip(cases, second(cases)):
        row, stopped = program(case), program(case, stops=True)
        end = f"{stopped['status']}, {1e3 * stopped['simulated_s']:.1f} ms, {stopped['mu_star'] - row['mu_star']:+.4f}"
        rows.append([f"μ 0.4, {case['omega_rpm']:g} rpm", *pair(own, row), f"{own['n_over_f'][0]:.2f}–{own['n_over_f'][1]:.2f}", f"{row['n_over_f_min']:.2f}–{row['n_over_f_max']:.2f}", end])
    stable = {**COARSE, "mu": 0.2}
    [own] = second([stable])
    row = program(stable)
    cells = pair(own, row)
    rows.append(["μ 0.2, 7 rpm", *cells[:3], "decays", row["status"], *cells[5:], f"{own['n_over_f'][0]:.2f}–{own['n_over_f'][1]:.2f}", f"{row['n_over_f_min']:.2f}–{row['n_over_f_max']:.2f}", ""])
    largest = max(float(row[3]) for row in rows)
    return (runs.table(["case", *HEADER, "N/F, second", "N/F (smoothed over 2 µs)", "stopped early: Δμ*"], rows)
            + f"\nThe largest difference of μ* in this table is {largest:.5f}.\n")


def time_steps():
    cases = [{**COARSE, "time_step_s": step} for step in STEPS]
    found = [program(case) for case in cases]
    coarse, middle, fine, finest = (row["mu_star"] for row in found)
    first, second_ = coarse - middle, middle - fine
    limit = fine - second_ * second_ / (first - second_)
    lines = [[f"{case['time_step_s']:g}", *pair(own, row)] for case, own, row in zip(cases, second(cases), found)]
    return (
        runs.table(["Δt [s]", *HEADER], lines)
        + f"\nThe first three steps alone give the observed order {math.log2(first / second_):.2f} and (Aitken) the limit "
        f"{limit:.4f}; the step of 5.5·10⁻⁸ s gives {finest:.4f}, first-order Richardson from the second and third "
        f"{2 * fine - middle:.4f}. The order is between one and two: nodes close and stick "
        "within a step, which is of first order, and the integrator in between is of second order.\n"
    )


def meshes():
    cases = [{**COARSE, "beta_r_s": 5e-8, "limit_s": 0.01, **own} for own in MESHES]
    rows = []
    for case, own in zip(cases, second(cases)):
        name = f"{' × '.join(map(str, case['elements']))}, clamp {1e3 * case['clamp_width_m']:g} mm, {case['omega_rpm']} rpm"
        rows.append([name, f"{case['time_step_s']:g}", *pair(own, program(case))])
    return runs.table(["mesh", "Δt [s]", *HEADER], rows)


def coarse_figure7(name, run=None):
    """The points of figure7 on 12 × 15 × 10 elements."""
    study = runs.shipped("figure7", name=name, run=run or {})
    study["scene"]["pin"]["elements"] = [12, 15, 10]
    return study


def early_stop():
    early = runs.sweep(coarse_figure7("figure7-early"))
    full = runs.sweep(coarse_figure7("figure7-whole", {"limit_s": 0.02, "stop_early": False,
                                                       "average_last_fraction": 0.4}))
    changes = [(abs(a["mu_star"] - b["mu_star"]), a) for a, b in zip(early, full)
               if a["status"] in ("periodic", "decayed")]
    changes.sort(key=lambda pair: -pair[0])
    stopped = [(a, b) for a, b in zip(early, full) if a["status"] in ("periodic", "decayed")]
    simulated = sum(a["simulated_s"] for a, _ in stopped), sum(b["simulated_s"] for _, b in stopped)
    worst = [[f"{row['mu']:g}", f"{row['omega_rpm']:g}", row["status"], f"{1e3 * row['simulated_s']:.2f}",
              f"{row['mu_star']:.4f}", f"{change:.5f}"] for change, row in changes[:6]]
    median = changes[len(changes) // 2][0]
    return (
        f"The points of `figure7` on 12 × 15 × 10 elements, with its damping (β_R = 27.5 ns). Each of the {len(changes)} jobs that stopped early is compared with the mean over the last "
        f"40 % of 20 ms of the same job. The median change of μ* is {median:.5f}, the largest {changes[0][0]:.5f}. Simulated time: "
        f"{simulated[0]:.2f} s instead of {simulated[1]:.2f} s. The largest changes:\n\n"
        + runs.table(["μ", "ω [rpm]", "status", "stopped at [ms]", "μ*", "change"], worst)
    )


def main():
    runs.build()
    runs.write(
        "agreement",
        "# Agreement with a second solver\n\n"
        "Written by `scripts/agreement.py`; do not edit. The second solver, `scripts/peers/second.py`, is written in Python and shares nothing with\n"
        "the program but the equations ([theory.md](theory.md)). Every night it is compared with the program on three jobs. Scene: the reference scene with a clamp of 2 mm on\n"
        "6 × 8 × 5 elements, F ramped over 1 ms, β_R = 2·10⁻⁸ s, central difference, Δt = 1.75·10⁻⁶ s, statistics over\n"
        "the last 40 % of 20 ms.\n\n"
        "## Speeds\n\n" + speeds()
        + "\nThe last column is for runs that stop at the periodic state: status, simulated time and change of μ*.\n\n"
        "At 0.5 rpm this lightly damped case does not become periodic in 20 ms: the amplitude of N beats over about\n"
        "five cycles. The program reports it as `not_periodic`.\n\n"
        "## Time step (7 rpm)\n\n" + time_steps()
        + "\n## Mesh and clamp (β_R = 5·10⁻⁸ s, 10 ms)\n\n" + meshes()
        + "\n## Friction modes in three programs\n\n"
        f"The leading mode of steady sliding on 12 × 15 × 10 elements with a clamp of 1 mm, μ = 0.4, a straight track and no damping. tribosweep has a lumped mass, CalculiX {calculix_version()} a\n"
        "consistent one, and an assembly with scipy both (`scripts/peers/modes.py`). Differences are of the complex eigenvalue, relative to its size.\n\n" + modes()
        + "\n## What stopping early changes\n\n" + early_stop(),
    )


if __name__ == "__main__":
    main()
