#!/usr/bin/env python3
"""Writes docs/evidence/eigenvalues.md: how accurate the eigenvalues of steady sliding are, where they decide, and what they save.

    scripts/eigenvalues.py [--part convergence|coexistence|economy]... [--program FILE]
    scripts/eigenvalues.py --page

Without --part, all three parts are measured. What a part has measured is kept in target/docs, so the page always has the
latest tables of all parts. --page writes the page and measures nothing. With --program, nothing is built.
"""

import argparse
import csv
import json
import math
import os
from pathlib import Path

import runs

# Converged modes of an independent assembly, by scripts/peers/lagrange.py.
CONVERGED = json.loads((runs.ROOT / "scripts/peers/converged.json").read_text())
MESHES = [[12, 15, 10], [24, 30, 20], [36, 45, 30]]
POINTS = [(0.4, 7), (0.2, 35)]
# The damping of the converged modes, which is not that of figure7.
PEER_BETA_R_S = 5e-8
SIDES = ["inner_side", "trailing_end", "both_ends"]
FRICTIONS = [round(0.15 + 0.01 * i, 2) for i in range(16)]
SPEEDS = [0.2, 0.5, 1, 2, 5, 20, 100]
SUDDEN = {
    "name": "eigenvalues_sudden",
    "stability": "simulate",
    "scene": {
        "pin": {"elements": [12, 15, 10]},
        "clamp": {"width_m": 0.001},
        "load": {"force_n": 30.0, "ramp_s": 0},
    },
    "damping": {"beta2": 1.0, "at_time_step_s": 5.5e-8},
    "grid": {"clamp_side": SIDES, "mu": FRICTIONS, "omega_rpm": SPEEDS},
}
# μp/(ρ c_s) of the reference pin at μ = 1, and the speed of the track at 1 rpm.
NATURAL_M_S = 30.0 / (0.012 * 0.015) / (2500 * math.sqrt(1e9 / 2.6 / 2500))
TRACK_M_S = 0.0914 * 2 * math.pi / 60
STUDIES = ["figure7", "clamps"]


def remove(database):
    for old in runs.WORK.glob(database + "*"):
        old.unlink()


def modes(study, database, **settings):
    """The leading mode at each point of a study."""
    table = runs.WORK / "eigenvalues.csv"
    runs.tribosweep("stability", str(study), *runs.set_arguments(settings), "--no-thresholds", "--modes", "1", "--csv",
                    str(table), "--out", str(runs.WORK / "eigenvalues-report"), "--name", "eigenvalues", "--replace",
                    database=database)
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def convergence():
    """The leading modes on three meshes: with the damping of figure7, and where there is a converged mode, with its damping."""
    cases = [(mu, speed, {}) for mu, speed in POINTS]
    cases += [(mode["mu"], mode["omega_rpm"], {"beta_r_s": PEER_BETA_R_S}) for mode in CONVERGED["modes"]]
    found = []
    for mu, speed, damping in cases:
        for elements in MESHES:
            database = "eigenvalues-convergence.db"
            remove(database)
            [mode] = modes(runs.ROOT / "studies/figure7.json", database, mu=mu, omega_rpm=speed,
                           elements=json.dumps([elements]), **damping)
            found.append({"mu": mu, "omega_rpm": speed, "elements": elements, **damping, "frequency_hz": float(mode["frequency_hz"]),
                          "growth_per_s": float(mode["growth_rate_per_s"]), "residual": float(mode["residual"])})
    return found


def coexistence():
    database = "eigenvalues-coexistence.db"
    runs.sweep(SUDDEN, database)
    lines = runs.tribosweep("export", SUDDEN["name"], "--all", "--format", "json", database=database).splitlines()
    path = runs.WORK / f"{SUDDEN['name']}.json"
    found = {(mode["clamp_side"], float(mode["omega_rpm"]), float(mode["mu"])): float(mode["growth_rate_per_s"])
             for mode in modes(path, database)}
    jobs = [{"side": row["clamp_side"], "omega_rpm": row["omega_rpm"], "mu": row["mu"], "status": row["status"],
             "regime": row["regime"], "measured_per_s": row["growth_rate_per_s"], "mu_star": row["mu_star"],
             "n_over_f": [row["n_over_f_min"], row["n_over_f_max"]],
             "growth_per_s": found[row["clamp_side"], row["omega_rpm"], row["mu"]]}
            for row in map(json.loads, lines)]
    thresholds = []
    for side in SIDES:
        for speed in SPEEDS:
            own = [(mu, found[side, speed, mu]) for mu in FRICTIONS]
            pair = next((pair for pair in zip(own, own[1:]) if pair[0][1] <= 0 < pair[1][1]), None)
            if pair:
                between = [round(pair[0][0] + 0.002 * i, 3) for i in range(1, 5)]
                finer = modes(path, database, clamp_side=side, omega_rpm=speed, mu=json.dumps(between))
                own = [pair[0], *((float(mode["mu"]), float(mode["growth_rate_per_s"])) for mode in finer), pair[1]]
                thresholds.append([side, speed, crossing(sorted(own))])
    return {"jobs": jobs, "thresholds": thresholds}


def crossing(points):
    """The μ at which the growth rate changes its sign, by linear interpolation."""
    for (low, a), (high, b) in zip(points, points[1:]):
        if a <= 0 < b:
            return low - a * (high - low) / (b - a)


def economy():
    found = {}
    for study in STUDIES:
        for decider in ("simulate", "eigenvalues"):
            database = f"eigenvalues-{study}-{decider}.db"
            remove(database)
            arguments = [str(runs.PROGRAM), "run", str(runs.ROOT / "studies" / f"{study}.json"), "--set",
                         f"stability={decider}", "--out", str(runs.WORK / "eigenvalues-report")]
            process = os.posix_spawn(
                arguments[0], arguments, dict(os.environ, TRIBOSWEEP_DB=str(runs.WORK / database)),
                file_actions=[(os.POSIX_SPAWN_OPEN, number, os.devnull, os.O_WRONLY, 0) for number in (1, 2)],
            )
            _, status, usage = os.wait4(process, 0)
            assert status == 0, f"{study}: {status}"
            lines = runs.tribosweep("export", study, "--all", "--format", "json", database=database).splitlines()
            wanted = ("omega_rpm", "mu", "clamp_side", "status", "mu_star", "decided_by", "wall_s")
            jobs = [{name: row.get(name) for name in wanted} for row in map(json.loads, lines)]
            found.setdefault(study, {})[decider] = {"cpu_s": usage.ru_utime, "jobs": jobs}
    return found


PARTS = {"convergence": convergence, "coexistence": coexistence, "economy": economy}


def stored(part):
    return runs.WORK / f"eigenvalues-{part}.json"


def signed(value):
    """Percent of a relative difference."""
    return f"{100 * value:+.1f}"


def order(values, sizes):
    """The order p with which v + c hᵖ goes through three values, finest last; None if they do not converge."""
    first, second = values[0] - values[1], values[1] - values[2]
    if first * second <= 0 or abs(first) <= abs(second):
        return None
    wanted = first / second

    def ratio(p):
        return (sizes[0]**p - sizes[1]**p) / (sizes[1]**p - sizes[2]**p)

    low, high = 0.01, 10.0
    if not ratio(low) < wanted < ratio(high):
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if ratio(middle) < wanted else (low, middle)
    return low


def convergence_tables(found):
    lines, orders, independent = [], [], []
    for mu, speed in POINTS:
        of_point = [mode for mode in found if (mode["mu"], mode["omega_rpm"]) == (mu, speed)]
        own = [mode for mode in of_point if "beta_r_s" not in mode]
        for mode in own:
            lines.append([mu, speed, " × ".join(map(str, mode["elements"])), f"{mode['frequency_hz']:.0f}",
                          f"{mode['growth_per_s']:.1f}", f"{mode['residual']:.0e}"])
        sizes = [1 / mode["elements"][0] for mode in own]
        cells = []
        for name in ("frequency_hz", "growth_per_s"):
            values = [mode[name] for mode in own]
            p = order(values, sizes)
            if p is None:
                cells += ["not monotonic" if (values[0] - values[1]) * (values[1] - values[2]) <= 0 else "below 0",
                          "", signed(values[1] / values[2] - 1)]
                continue
            limit = values[2] - (values[1] - values[2]) / ((sizes[1] / sizes[2])**p - 1)
            cells += [f"{p:.1f}", f"{limit:.1f}" if name == "growth_per_s" else f"{limit:.0f}",
                      signed(values[1] / limit - 1)]
        orders.append([mu, speed, *cells])
        if of_peer(mu, speed):
            independent.append(independent_line(mu, speed, [mode for mode in of_point if "beta_r_s" in mode]))
    middle = " × ".join(map(str, MESHES[1]))
    errors = [f"error on {' × '.join(map(str, elements))} [%]" for elements in MESHES]
    return {
        "convergence": runs.table(["μ", "ω [rpm]", "elements", "frequency [Hz]", "growth rate [1/s]", "residual"], lines),
        "orders": runs.table(["μ", "ω [rpm]", "order of the frequency", "its limit [Hz]", f"difference on {middle} [%]",
                              "order of the growth rate", "its limit [1/s]", f"difference on {middle} [%]"], orders),
        "independent": runs.table(["μ", "ω [rpm]", "frequency [Hz]", "growth rate [1/s]", *errors], independent),
        "independent_words": independent_words([mode for mode in found if "beta_r_s" in mode]),
    }


def of_peer(mu, speed):
    """The converged mode of a point; None where there is none."""
    return next((mode for mode in CONVERGED["modes"] if (mode["mu"], mode["omega_rpm"]) == (mu, speed)), None)


def independent_line(mu, speed, own):
    """The converged mode of the independent assembly, and the errors of this program's growth rates."""
    peer = of_peer(mu, speed)
    cells = [f"{peer[name]['value']:.0f} ± {max(peer[name]['error'], 1):.0f}" for name in ("frequency_hz", "growth_per_s")]
    limit = peer["growth_per_s"]["value"]
    return [mu, speed, *cells, *(f"{100 * (mode['growth_per_s'] - limit) / abs(limit):+.1f}" for mode in own)]


def independent_words(modes_of_it):
    """What the independent assembly is, and what it and this program give on the same mesh with the same damping."""
    peer = of_peer(*POINTS[0])
    first, last = peer["levels"][0], peer["levels"][-1]
    same = peer["trilinear"]
    [own] = [mode for mode in modes_of_it if mode["elements"] == same["elements"]]
    return (
        "The converged modes are from an independent assembly (`scripts/peers/lagrange.py`): "
        f"hexahedra of order {last['order']} with a consistent\nmass, on a mesh graded towards the edges of the clamp and of the base, with {last['unknowns']} "
        "unknowns. ± is the change from its\nlast but one mesh. With trilinear elements and a lumped mass on "
        f"{' × '.join(map(str, same['elements']))} it gives {same['frequency_hz']:.1f} Hz and {same['growth_per_s']:.1f} 1/s at μ = {POINTS[0][0]},\n"
        f"this program {own['frequency_hz']:.1f} Hz and {own['growth_per_s']:.1f} 1/s. On a mesh that is coarser at the ends of the base ({first['unknowns']} unknowns) it gives {first['growth_per_s']:.0f} 1/s, and\n"
        "another assembly of that kind 6143 to 6150 1/s: the last half millimetre of the base lifts off, and a mesh has to see this.\n"
        "So a limit that uniform meshes like these are extrapolated to is not the limit: their element size is that of the part that lifts off."
    )


def speed_ratio(mu, omega_rpm):
    """The disk's speed over the natural speed of the pin."""
    return TRACK_M_S * omega_rpm / (NATURAL_M_S * mu)


def demanded(mu, omega_rpm):
    """The distance that src/mechanics/stability/decision.rs demands."""
    return 0.08 * (1 + speed_ratio(mu, omega_rpm)**-0.5)


def coexistence_tables(measured):
    found = measured["jobs"]
    thresholds = {(side, speed): mu_c for side, speed, mu_c in measured["thresholds"]}
    lines, largest, unsafe, reserve = [], 0.0, 0, math.inf
    for side in SIDES:
        for omega_rpm in SPEEDS:
            own = sorted((job for job in found if (job["side"], job["omega_rpm"]) == (side, omega_rpm)),
                         key=lambda job: job["mu"])
            mu_c = thresholds.get((side, omega_rpm))
            cells = [f"`{side}`", omega_rpm]
            if mu_c is None:
                is_unstable = own[0]["growth_per_s"] > 0
                lines.append([*cells, f"≤ {own[0]['mu']}" if is_unstable else f"> {own[-1]['mu']}", *[""] * 4])
                continue
            below = [job for job in own if job["mu"] < mu_c and job["growth_per_s"] < 0]
            cycles = [job["mu"] for job in below if job["status"] == "periodic"]
            cells.append(f"{mu_c:.3f}")
            if cycles:
                distance = mu_c / cycles[0] - 1
                wanted = demanded(cycles[0], omega_rpm)
                largest, unsafe = max(largest, distance), unsafe + (distance > wanted)
                reserve = min(reserve, wanted / distance)
                cells += [f"{cycles[0]:.2f}", f"{100 * distance:.1f}", f"{speed_ratio(cycles[0], omega_rpm):.2f}",
                          f"{100 * wanted:.0f}"]
            else:
                cells += ["none", "", f"{speed_ratio(mu_c, omega_rpm):.2f}", f"{100 * demanded(mu_c, omega_rpm):.0f}"]
            lines.append(cells)
    counts = {}
    for job in found:
        counts.setdefault(job["status"], [0, 0])[job["growth_per_s"] > 0] += 1
    names = {"decayed": "decays", "periodic": "periodic", "not_periodic": "not periodic", "failed": "failed"}
    known = [job for job in found if job["status"] in ("decayed", "periodic")]
    same = sum((job["status"] == "periodic") == (job["growth_per_s"] > 0) for job in known)
    unfinished = [job for job in found if job["status"] == "not_periodic" and job["growth_per_s"] < 0]
    decaying = [job for job in unfinished if job["regime"] == "undecided" and (job["measured_per_s"] or 0) < 0]
    small = [job for job in unfinished if job not in decaying]
    decayed = [job for job in found if job["status"] == "decayed" and job["measured_per_s"] is not None]
    errors = sorted(abs(job["measured_per_s"] / job["growth_per_s"] - 1) for job in decayed)
    return {
        "coexistence": runs.table(
            ["clamp", "ω [rpm]", "μ_c", "lowest μ of a cycle below μ_c", "distance [%]", "speed / natural speed",
             "distance demanded [%]"], lines),
        "counts": runs.table(["the run", "growth rate < 0", "growth rate > 0"],
                             [[names[status], *pair] for status, pair in sorted(counts.items())]),
        "runs": len(found), "known": len(known), "agreeing": same, "largest": f"{100 * largest:.0f}",
        "beside": sum(job["status"] == "periodic" for job in known if job["growth_per_s"] < 0),
        "late": sum(job["status"] == "decayed" for job in known if job["growth_per_s"] > 0), "reserve": f"{reserve:.1f}",
        "small": len(small), "small_n": f"{100 * median([max(abs(ratio - 1) for ratio in job['n_over_f']) for job in small]):.2g}",
        "small_mu": f"{100 * median([1 - job['mu_star'] / job['mu'] for job in small]):.2g}",
        "small_mu_most": f"{100 * max(1 - job['mu_star'] / job['mu'] for job in small):.2g}",
        "unfinished": len(unfinished), "decaying": len(decaying), "decayed": len(decayed),
        "median": f"{100 * errors[len(errors) // 2]:.1f}", "tenth": f"{100 * errors[9 * len(errors) // 10]:.0f}",
        "unsafe": "No cycle was found beyond the distance that is demanded there." if unsafe == 0 else
                  f"At {unsafe} of these points the cycle is farther from the threshold than is demanded.",
    }


def median(values):
    return sorted(values)[len(values) // 2]


def mean(values):
    return sum(values) / len(values) if values else math.nan


def key(job):
    """The job's place in its grid."""
    return job["clamp_side"] or "", job["omega_rpm"], job["mu"]


def economy_tables(found):
    lines, each, same = [], [], []
    for study in STUDIES:
        runs_of, default = (found[study][name] for name in ("simulate", "eigenvalues"))
        pairs = [(a, b) for a, b in zip(sorted(runs_of["jobs"], key=key), sorted(default["jobs"], key=key))]
        assert all(key(a) == key(b) for a, b in pairs)
        decided = [pair for pair in pairs if pair[1]["decided_by"] == "eigenvalues"]
        if study == "figure7":
            decided_figure7 = decided
        lines.append([f"`{study}`", len(pairs), sum(a["status"] == "decayed" for a, _ in pairs), len(decided),
                      f"{runs_of['cpu_s']:.1f}", f"{default['cpu_s']:.1f}", signed(default["cpu_s"] / runs_of["cpu_s"] - 1)])
        groups = {"decided by eigenvalues": decided,
                  "stable, decided by the run": [p for p in pairs if p[0]["status"] == "decayed" and p not in decided],
                  "periodic": [p for p in pairs if p[0]["status"] == "periodic"],
                  "not periodic": [p for p in pairs if p[0]["status"] == "not_periodic"]}
        for name, own in groups.items():
            if own:
                before, after = mean([a["wall_s"] for a, _ in own]), mean([b["wall_s"] for _, b in own])
                each.append([f"`{study}`", name, len(own), f"{before:.2f}", f"{after:.2f}", signed(after / before - 1)])
        equal = sum(a["status"] == b["status"] for a, b in pairs)
        stable = [abs(a["mu_star"] / b["mu_star"] - 1) for a, b in pairs if b["status"] == a["status"] == "decayed"]
        identical = sum(a["mu_star"] == b["mu_star"] for a, b in pairs if b["decided_by"] != "eigenvalues")
        same.append([f"`{study}`", f"{equal} of {len(pairs)}", f"{100 * max(stable):.4f} %" if stable else "no stable jobs",
                     f"{identical} of {len(pairs) - len(decided)}"])
    before, after = (mean([pair[i]["wall_s"] for pair in decided_figure7]) for i in (0, 1))
    change = {study: signed(found[study]["eigenvalues"]["cpu_s"] / found[study]["simulate"]["cpu_s"] - 1) for study in STUDIES}
    return {
        "decided": f"{100 * (1 - after / before):.0f}", "whole": change["figure7"], "clamps": change["clamps"],
        "economy": runs.table(["study", "jobs", "stable", "decided by eigenvalues", "CPU `simulate` [s]",
                               "CPU `eigenvalues` [s]", "difference [%]"], lines),
        "each": runs.table(["study", "jobs that are", "number", "`simulate` [s]", "`eigenvalues` [s]", "difference [%]"],
                           each),
        "same": runs.table(["study", "equal status", "largest difference of μ\\* of stable jobs",
                            "other jobs with an identical μ\\*"], same),
    }


def page():
    missing = [part for part in PARTS if not stored(part).exists()]
    if missing:
        print(f"no page yet: {', '.join(missing)} not measured")
        return
    found = {part: json.loads(stored(part).read_text()) for part in PARTS}
    runs.write("eigenvalues", PAGE.format(
        **convergence_tables(found["convergence"]), **coexistence_tables(found["coexistence"]),
        **economy_tables(found["economy"]), cores=os.cpu_count(), frictions=f"{FRICTIONS[0]} … {FRICTIONS[-1]}",
        peer_ns=1e9 * PEER_BETA_R_S,
        natural=f"{0.3 * NATURAL_M_S:.3f}", at_natural=f"{0.3 * NATURAL_M_S / TRACK_M_S:.1f}"))


PAGE = """\
# Eigenvalues of steady sliding: accuracy, and what they decide

Written by `scripts/eigenvalues.py`; do not edit. [theory.md](theory.md#eigenvalues) has the equations.
The pin, the load and the damping (β_R = 27.5 ns) are those of `studies/figure7.json` unless another one is named, and every clamp is 1 mm wide.

## How a job is decided

With `"stability": "eigenvalues"` the program computes the modes of steady sliding before a job runs. The job is *decayed*
without a run if all modes decay at its μ and at a larger μ. The larger μ is needed because a limit cycle can exist beside stable
sliding, just below the threshold μ_c. The distance in μ is 8 % (1 + s^(−1/2)), and the larger μ is rounded up to a multiple of
0.01. Here s is the disk's speed over the natural speed μp/(ρ c_s), with the mean contact pressure p, the density ρ and the speed
c_s of shear waves. For the reference pin and μ = 0.3 the natural speed is {natural} m/s, which is {at_natural} rpm.

A growth rate counts as negative only if it is so by more than its error, in continuous time and with the time step of the run.
The error is estimated from the residuals of the right and the left eigenvector in the full problem. A mode is corrected only
until its sign is clear, and a job with a mode that clearly grows is simulated without further corrections.

The basis holds all nodes of the contact face in z. Where nodes are lifted it also has the responses to forces on them, because a mode may
be mainly their motion. The basis has the modes of the pin up to a frequency, its *band*, and near the end of the band it has them badly. So modes are
judged one by one up to 85 % of the band. A job is decided only if more than that is known [above it](#what-is-known-above-the-band).

A job that [starts from a coarser mesh](../solving.md#a-start-from-a-coarser-mesh) is judged after its run there, and only if that run
found no limit cycle.

## What is known above the band

Modes are not looked for at all frequencies, so a verdict names its band and what is known above it: `band_hz` and `above_band` of the
tables, `show` and the page. A mode that is listed is one in any case. *Stable* is said only with the first two of these:

| `above_band` | what is known | where |
| --- | --- | --- |
| `nothing` | All modes of the mesh were looked for. | blocks of up to 500 displacements; other pins on a rigid disk whose modes are all within reach of the search, which is so on meshes of some hundred nodes |
| `damped` | No mode can grow there: a bound. | pins with enough damping, without holders, on a rigid disk, with friction that does not fall with the speed |
| `coarser_run` | Nobody looked, but the job's own run on the coarser mesh, which carries such vibrations, decayed; and damping wins with the largest gain of the known modes. | decided jobs of a preset on the reference scene, such as the stable ones of `figure7` |
| `not_looked_at` | Nothing. The table says "no mode below … grows", not "stable", and a job is not decided without its run. | all others: large blocks with little damping, elastic disks, holders |

**The bound.** Let the coupling by friction turn no more than the share γ of the elastic energy: |Im qᴴK_μq| ≤ γ Re qᴴK_μq for all q. Then no
mode grows above the frequency γ/(2πβ_R). It follows from the real and the imaginary part of the equation of a mode (the head of
`src/mechanics/stability/bound.rs` has the steps), and holds for every speed, because the damping of sideways slip only helps. γ is estimated by a Lanczos
iteration and taken 10 % larger. It is not small: soft motions of the whole pin under the disk's grip set it, and it grows with the mesh (a block held at its whole top, β_R = 10⁻⁶ s and
μ = 0.2: 171 kHz on 6 × 8 × 5 and 446 kHz on 12 × 15 × 10 elements). On 6 × 8 × 5 elements of the reference pin with a clamp of 2 mm and μ = 0.1, γ is 0.69, so that β_R must be above 2.7·10⁻⁶ s
before the bound lies in the band. So it helps strongly damped pins with little friction, and nothing else.

**The search.** Pins that are no plain blocks, on a rigid disk, are searched window by window from 0 up to that frequency, the largest one of the
mesh, or a budget of windows: 50 000 over the number of unknowns, at most 120. A cylinder of 12 mm with 4500 unknowns is searched up to
some 70 kHz, and its mode at 41 kHz is found. An elastic disk is searched in its band only.

[eigenvalues.md](eigenvalues.md) has random pins of all shapes, clamps, laws and dampings: what eigenvalues say beside the end of a run.

All other jobs are simulated. So eigenvalues never say that a job is periodic, and they give no limit cycle. `tribosweep stability`
prints all growth rates, without this distance.

## Convergence with the mesh

The leading mode is the one with the largest growth rate. *Residual* is the relative residual of the mode in the full problem.

{convergence}
The order is that of v + c hᵖ through the three meshes, with the element size h. The difference is that of the value on the middle mesh
from the limit h → 0; without a limit it is that from the finest mesh.

{orders}
The limit of an extrapolation is not known to be right. These are converged modes with β_R = {peer_ns:.0f} ns, and how far the growth rate
with the same damping is from them on each mesh:

{independent}
{independent_words}

The supports and the contact face end in corners, where stresses are singular. So an order below two is expected.

## Limit cycles beside stable sliding

{runs} jobs on 12 × 15 × 10 elements with a sudden load (no ramp) are simulated, at μ = {frictions} in steps of 0.01. A
sudden load disturbs sliding more than the usual ramp. The growth rate of each job comes from `tribosweep stability`. μ_c is
interpolated between points that are 0.002 apart. *Distance* is μ_c/μ − 1 for the lowest μ with a limit cycle. The speed and the
distance that is demanded belong to the same μ, or to μ_c if there was no cycle below it.

{coexistence}
The largest distance at which a cycle was found is {largest} %. {unsafe}
The demanded distance is at least {reserve} times the one found.
A grid of 0.01 does not show cycles that are closer to the threshold.

{counts}
Of the {known} runs that decay or are periodic, {agreeing} agree with the sign of the growth rate. {beside} runs are
limit cycles beside stable sliding, below the thresholds in the table. Runs that decay although a growth rate is positive: {late}.
{unfinished} runs with a negative growth rate reached their time limit. In {decaying} of them all
nodes slip and the measured growth rate is negative, so they were still decaying. In the {small} others a small vibration without a period remains,
with which a few nodes stick: N differs from F by {small_n} % in the median, and μ\\* is below μ by {small_mu} % in the median and {small_mu_most} % at most. It suggests that modes above
the band grow, which the growth rates here do not have; eigenvalues decide a job only if more is known [above the band](#what-is-known-above-the-band). The growth rate that the program measures in the
{decayed} runs that decayed differs from the eigenvalue by {median} % in the median, and by less than {tenth} % in nine of ten.

## What eigenvalues save

Each study ran twice on an empty database, with the default `"stability": "simulate"` and with `"eigenvalues"`. CPU is the user
time of the whole command with two threads, its report included. The machine has {cores} cores and is shared with others, so
times vary by some percent.

{economy}
The next table has the mean time of a job (`wall_s` of the export). The time is wall time
on a shared machine, so it is rougher than the CPU time. `figure7` has the way of its preset, with single precision and a start from
a coarser mesh, so its periodic jobs pay nothing. `clamps` has the defaults, and each of its jobs pays for its modes and its run.

{each}
The last table compares the results. A job that is simulated has the same bits in both cases.

{same}
Without a preset the default is `simulate`. The presets `standard` and `reference` choose `eigenvalues`. Statuses and μ\\* are the
same, and a stable job of `figure7` that eigenvalues decide takes {decided} % less time. The CPU time of the whole `figure7` differs
by {whole} %. That of `clamps` differs by {clamps} %, because its mesh is coarse, its runs are short, and none of its jobs is stable.

## What is not covered

* **Modes above the band**, [unless more is known](#what-is-known-above-the-band). A weakly damped pin (small β_R) can have growing modes there that
  `tribosweep stability` does not list: it says how far it looked. For jobs that a preset decides, the largest gain of the known modes is
  taken for all others, and the run on the coarser mesh has decayed. This is no proof.
* **Bases of which most nodes are lifted.** Beyond 30 lifted nodes the basis has patterns of forces on them instead of one force each. With 90 of
  99 nodes lifted it lacked a decaying mode of 23 kHz. Growing modes were found there.
* **Modes follow their shapes.** A correction continues a mode by the eigenvector of the larger basis that is most like it. Of
  two modes that are nearly equal in shape and frequency, one can take the place of the other.
* **The distance in μ.** It rests on runs, not on a theorem. The runs have one pin, one mesh and one load, and one way to start.
* **Other scenes.** Modes cover holders, bases that are not flat, and all friction laws but `prakash_clifton`. The errors and the
  distance in μ were measured for Coulomb's law, an ideal clamp and a flat base only. So presets leave other scenes to their
  runs. If a study itself says `eigenvalues`, they decide with a holder, with gaps and with `regularised`, too.
* **Elastic disks and other pins** (cylinders, tilted pins, regions, meshes from files). `tribosweep stability` finds their modes by sparse
  factors of pin and disk together, in a band of up to 2.5 times c_s/(4h) of the pin's height h, and on a rigid disk [beyond it](#what-is-known-above-the-band). It takes up to 30 000 unknowns; 9000 take some
  10 s for each of several frequencies, 17 000 some minutes. The disk's rotation and gyroscopic terms are neglected. Eigenvalues do not decide such jobs, because the distance in μ was not measured there.
* **Friction with a state** (`prakash_clifton`), run-out and contact layers. `tribosweep stability` refuses such a study.
* **Large vibrations, stick and lift-off.** Modes are small vibrations about steady sliding. They do not give the amplitude,
  frequency or μ\\* of a limit cycle.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", action="append", choices=PARTS)
    parser.add_argument("--program", help="do not build; run this program")
    parser.add_argument("--page", action="store_true", help="measure nothing; write the page again")
    options = parser.parse_args()
    if options.page:
        return page()
    if options.program:
        runs.PROGRAM = Path(options.program).resolve()
        runs.WORK.mkdir(parents=True, exist_ok=True)
    else:
        runs.build()
    for part in options.part or PARTS:
        stored(part).write_text(json.dumps(PARTS[part]()))
    page()


if __name__ == "__main__":
    main()
