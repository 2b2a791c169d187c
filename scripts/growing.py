#!/usr/bin/env python3
"""Writes docs/evidence/growing.md: what plans that learn find, and what they save.

    scripts/growing.py

Runs studies/refine.json, branches.json, basins.json and sensitivity.json, and the uniform grids to compare with. Some ten
minutes on two cores. Results are kept in target/docs/docs.db.
"""

import csv
import math

import runs

UNIFORM_MU = {"mu": {"from": 0.2, "to": 0.5, "step": 0.002}, "omega_rpm": [4, 7, 12]}
UNIFORM_OMEGA = {"mu": [0.4, 0.5], "omega_rpm": {"from": 2, "to": 20, "step": 0.1}}
# What the program is asked for over the same ranges.
REFINED = {"mu": [0.2, 0.3, 0.4, 0.5], "omega_rpm": [2, 4, 7, 12, 20]}
KICKS_M_S = [0.02, 0.1, 0.3, 1.0]
NAMES = {
    "young_modulus_pa": "E", "poisson_ratio": "ν", "density_kg_m3": "ρ", "beta_r_s": "β_R", "load_n": "F",
    "clamp_width_m": "clamp width", "mu": "μ", "omega_rpm": "ω",
}


def found(study, table):
    """The lines of a table of a study's report."""
    with open(runs.WORK / "growing" / study["name"] / f"{table}.csv", newline="") as file:
        return list(csv.DictReader(file))


def sweep(study):
    return runs.sweep(study, options=("--replace", "--out", f"growing/{study['name']}"))


def refinement():
    base = runs.shipped("refine")
    refine = dict(base["refine"], curves={"over": "omega_rpm", "minimum_within": 0.1})
    learned = dict(base, name="growing_refined", grid=REFINED, refine=refine)
    learned["exclude"] = [{"mu": [0.2, 0.3], "omega_rpm": [2, 20]}]
    rows = sweep(learned)
    del base["refine"]
    of_mu = dict(base, name="growing_uniform_mu", grid=UNIFORM_MU)
    of_omega = dict(base, name="growing_uniform_omega", grid=UNIFORM_OMEGA)
    uniform_mu, uniform_omega = sweep(of_mu), sweep(of_omega)
    keys = {row["job"] for row in uniform_mu + uniform_omega}
    wall = lambda all_rows: sum({row["job"]: row["wall_s"] for row in all_rows}.values())
    thresholds = []
    for line in found(learned, "boundaries"):
        speed = float(line["omega_rpm"])
        own = sorted((row["mu"], is_unstable(row)) for row in uniform_mu if row["omega_rpm"] == speed)
        if not own:
            continue
        low = max((mu for mu, unstable in own if not unstable), default=None)
        high = min((mu for mu, unstable in own if unstable), default=None)
        thresholds.append([f"{speed:g}", f"{float(line['from']):.4f} – {float(line['to']):.4f}", f"{low:.3f} – {high:.3f}"])
    minima = []
    for line in found(learned, "minima"):
        mu = float(line["mu"])
        own = [row for row in uniform_omega if row["mu"] == mu and row["mu_star"] is not None]
        if not own:
            continue
        best = min(own, key=lambda row: row["mu_star"])
        minima.append([f"{mu:g}", f"{line['at']} ({line['from']} – {line['to']})", f"{float(line['value']):.4f}",
                       f"{best['omega_rpm']:g}", f"{best['mu_star']:.4f}"])
    waves = found(learned, "waves")
    return {"jobs": len(rows), "uniform": len(keys), "wall_s": wall(rows), "uniform_s": wall(uniform_mu + uniform_omega),
            "thresholds": thresholds, "minima": minima, "waves": len(waves)}


def is_unstable(row):
    """By the growth rate of the leading mode, where eigenvalues were computed, and else by how the run ended."""
    rate = row.get("mode_growth_rate_per_s")
    if rate is None:
        rate = row.get("growth_rate_per_s")
    return rate > 0 if rate is not None else row["regime"] != "stable"


def branches():
    study = runs.shipped("branches")
    sweep(study)
    two = [line for line in found(study, "branches") if line["hysteresis"] == "yes"]
    narrow = dict(study, name="growing_clamp_1mm", grid={"mu": [0.4], "omega_rpm": {"from": 6.6, "to": 7.1, "step": 0.1}})
    narrow["scene"] = dict(study["scene"], clamp={"side": "inner_side", "width_m": 0.001})
    narrow["numerics"] = {"beta_r_s": 5.0e-8}
    loose = dict(narrow, name="growing_clamp_1mm_loose")
    del loose["detection"], loose["run"]
    sweep(narrow)
    sweep(loose)
    steps = []
    for step_s in (4.0e-7, 2.0e-7):
        study = dict(narrow, name=f"growing_clamp_1mm_step_{step_s * 1e9:.0f}ns",
                     grid={"mu": [0.4], "omega_rpm": {"from": 6.6, "to": 7.3, "step": 0.1}})
        study["numerics"] = {"beta_r_s": 5.0e-8, "time_step_s": step_s}
        sweep(study)
        steps.append((f"{step_s * 1e6:g}", found(study, "branches")))
    steps.insert(0, ("0.85", found(narrow, "branches")))
    return {"steps": steps, "two": two, "narrow": found(narrow, "branches"), "loose": found(loose, "branches")}


def basins():
    lines = []
    for kick in KICKS_M_S:
        study = runs.shipped("basins")
        study["name"] = f"growing_basins_{kick:g}".replace(".", "_")
        study["continue"]["kick_m_s"] = kick
        sweep(study)
        for line in found(study, "basins"):
            lines.append([f"{kick:g}", line["mu_star"] or "–", line["frequency_hz"] or "–", f"{line['jobs']} of {line['of']}",
                          f"{float(line['share']):.2f} ({float(line['share_from']):.2f} – {float(line['share_to']):.2f})"])
    return lines


def sensitivity(speed):
    study = runs.shipped("sensitivity")
    study["name"] = f"growing_sensitivity_{speed}"
    study["samples"]["of"]["omega_rpm"] = {"uniform": [round(0.9 * speed, 6), round(1.1 * speed, 6)]}
    rows = sweep(study)
    out = f"growing/{study['name']}-indices"
    runs.tribosweep("sensitivity", study["name"], "--out", out)
    with open(runs.WORK / out / "sensitivity.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    return rows, lines


def indices(lines):
    """For each parameter its indices, the most important one for μ* first."""
    def cell(quantity, parameter, index):
        for line in lines:
            if (line["quantity"], line["parameter"], line["index"]) == (quantity, parameter, index):
                return float(line["value"]), f"{float(line['value']):.2f} ({float(line['low']):.2f} – {float(line['high']):.2f})"
        return -1.0, "–"
    ranked = sorted(NAMES, key=lambda name: -cell("mu_star", name, "pawn")[0])
    columns = [("mu_star", "first_order"), ("mu_star", "pawn"), ("frequency_hz", "first_order"), ("frequency_hz", "pawn"),
               ("regime", "shares")]
    chance = {line["quantity"]: float(line["by_chance"]) for line in lines if line["by_chance"]}
    table = [[NAMES[name], *(cell(quantity, name, index)[1] for quantity, index in columns)] for name in ranked]
    first = {name: cell("mu_star", name, "first_order")[0] for name in NAMES}
    return table, ranked, first, chance


def failed(rows):
    return sum(row["status"] == "failed" for row in rows)


def words(ranked, first):
    leading = [name for name in ranked if first[name] > 0.05]
    parts = [f"{NAMES[name]} ({100 * first[name]:.0f} %)" for name in leading]
    return ", ".join(parts)


def main():
    runs.build()
    refined = refinement()
    found_branches = branches()
    found_basins = basins()
    slow_rows, slow = sensitivity(7)
    fast_rows, fast = sensitivity(20)
    header = ["parameter", "μ\\*: first order", "μ\\*: PAWN", "frequency: first order", "frequency: PAWN", "regime: shares"]
    slow_table, slow_ranked, slow_first, slow_chance = indices(slow)
    fast_table, fast_ranked, fast_first, fast_chance = indices(fast)
    branch_lines = [[line["omega_rpm"], line["mu_star_up"], line["frequency_up_hz"], line["mu_star_down"],
                     line["frequency_down_hz"]] for line in found_branches["two"]]
    def at(lines, speed):
        line = next(line for line in lines if float(line["omega_rpm"]) == speed)
        ways = line["mu_star_up"], line["mu_star_down"]
        return ways[0] if abs(float(ways[0]) - float(ways[1])) < 1e-3 else " and ".join(sorted(ways))

    speeds = [6.8, 7.0]
    of_steps = runs.table(["Δt [µs]", *(f"μ\\* at {speed:g} rpm" for speed in speeds)],
                          [[step, *(at(lines, speed) for speed in speeds)] for step, lines in found_branches["steps"]])
    sliding_m_s = 7 * 2 * math.pi / 60 * 0.0914
    difference = lambda lines: max(abs(float(line["mu_star_up"]) - float(line["mu_star_down"])) for line in lines)
    of_thresholds = runs.table(["ω [rpm]", "boundary in μ, refined", "boundary in μ, uniform grid"], refined['thresholds'])
    of_minima = runs.table(["μ", "minimum at ω [rpm] (neighbours)", "μ\\* there", "uniform grid: ω [rpm]", "μ\\* there"], refined['minima'])
    of_branches = runs.table(["ω [rpm]", "μ\\* up", "frequency up [Hz]", "μ\\* down", "frequency down [Hz]"], branch_lines)
    of_basins = runs.table(["kick [m/s]", "μ\\*", "frequency [Hz]", "jobs", "share"], found_basins)
    of_slow = runs.table(header, slow_table)
    of_fast = runs.table(header, fast_table)
    # What the page says in words.
    assert difference(found_branches["narrow"]) < 1e-3 < difference(found_branches["loose"])
    assert all(difference([line]) > 5e-3 for line in found_branches["two"])
    frequency = {float(line["omega_rpm"]): float(line["frequency_up_hz"]) for line in found_branches["narrow"]}
    assert frequency[6.7] - frequency[6.9] > 2 * (frequency[6.6] - frequency[6.7])
    text = f"""# What plans that learn find

Written by `scripts/growing.py`; do not edit. Reference scene on 12 × 15 × 10 elements, β_R = 27.5 ns unless another one is named.
[points.md](../points.md#plans-that-learn) says how such studies are written.

## Where squeal begins, and where the curve turns

`studies/refine.json` with speeds up to 20 rpm, asked for the boundary of stability within 0.002 in μ and for the minimum of μ\\* within
0.1 rpm, needs **{refined['jobs']} jobs** in {refined['waves']} waves. Uniform grids that give the same (μ from 0.2 to 0.5 in steps of
0.002 at three speeds; 2 to 20 rpm in steps of 0.1 rpm at two μ) have {refined['uniform']} jobs:
**{refined['uniform'] / refined['jobs']:.1f} times as many**, and take {refined['uniform_s'] / refined['wall_s']:.1f} times the time of threads. Both were run.

{of_thresholds}
{of_minima}
Near its minimum μ\\* is flat, and its values differ by less than the detection of limit cycles leaves open. Then the two minima may be
some steps apart, with the same μ\\*.

## Two limit cycles at 7 rpm

All of this section has β_R = 50 ns. With a clamp of 2 mm and a step of 4·10⁻⁷ s (`studies/branches.json`), each job continues its neighbour, in steps of 0.1 rpm from 6 to 8 rpm
and back. From {found_branches['two'][0]['omega_rpm']} to {found_branches['two'][-1]['omega_rpm']} rpm the two ways are on different limit cycles:

{of_branches}
With a clamp of 1 mm there is one limit cycle only, although its frequency falls steeply from 6.7 to 6.9 rpm. With the usual detection the
two ways differ by up to {difference(found_branches['loose']):.4f} there, because a slow approach to the limit cycle already counts as periodic. With a
detection ten times as strict they differ by at most {difference(found_branches['narrow']):.4f}.

The smaller the time step, the larger the speed of this change: at 7 rpm there is one limit cycle with each step, with μ\\* near 0.264 on one
side of the change and near 0.268 on the other.

{of_steps}
How often random velocities lead from a limit cycle at 7 rpm to each of the two (clamp of 2 mm, `studies/basins.json`; 64 kicks of each size;
in brackets the interval that has the true share with 95 %):

{of_basins}
The speed of sliding is {sliding_m_s:.3f} m/s. A kick that is small beside it seldom changes the limit cycle; large ones lead to both about equally often.

## What should be measured best?

`studies/sensitivity.json`: {len(slow_rows)} points of a Sobol' sequence over eight parameters: E, F, μ and ω within 10 %, ν from 0.27 to 0.33, ρ within
5 %, β_R between half and twice its value, the clamp 1, 2 or 3 mm wide. {failed(slow_rows)} jobs failed. In brackets the intervals from 5 to 95 %.

At 7 rpm, near the minimum of μ\\*:

{of_slow}
The variance of μ\\* is explained by {words(slow_ranked, slow_first)}. A parameter without effect has PAWN up to {slow_chance['mu_star']:.2f} by chance.

At 20 rpm:

{of_fast}
The variance of μ\\* is explained by {words(fast_ranked, fast_first)}.

These shares belong to these ranges: the width of a clamp is seldom known, and it is varied most. So {NAMES[slow_ranked[0]]} is to be measured best at 7 rpm, then {NAMES[slow_ranked[1]]}; at 20 rpm {NAMES[fast_ranked[0]]}, then {NAMES[fast_ranked[1]]}.
"""
    runs.write("growing", text)


if __name__ == "__main__":
    main()
