#!/usr/bin/env python3
"""Writes docs/choices.md and docs/figure7_bands.svg: what the paper leaves open, and what it changes.

Runs studies/figure7.json and the studies open_*.json, one for each choice; `inspect` of the reference job with each choice;
scenes within 20 % of the paper's that have its frequency; and meshes and time steps without damping. Only the claims and the
words of the comparison are written here; every number in the page is computed.
"""

import math
import shutil
from pathlib import Path

import physics
import reproduction
import runs

HZ, OMEGA_MIN, MU = 14_500, 6, 0.4
OPEN = ["open_damping", "open_clamp", "open_top", "open_branch", "open_disk"]
# A choice: its words, its study, and the parameters by which its jobs are known there.
CHOICES = [
    ("figure7: β₂ = 1, inner side, tied top, rigid disk", "figure7", {}),
    ("β₂ = ¾", "open_damping", {"damping_beta2": 0.75}),
    ("β₂ = ½, no damping", "open_damping", {"damping_beta2": 0.5}),
    ("outer side held", "open_clamp", {"clamp_side": "outer_side"}),
    ("leading end held", "open_clamp", {"clamp_side": "leading_end"}),
    ("trailing end held", "open_clamp", {"clamp_side": "trailing_end"}),
    ("top free in z", "open_top", {}),
    ("elastic disk, 85 mm", "open_disk", {}),
]
UM, MM_S, MPA = 1e6, 1e3, 1e-6
NODES = ["front_centre", "rear_centre", reproduction.INSIDE]


def own(rows, settings):
    return [row for row in rows if all(row[name] == value for name, value in settings.items())]


def at(rows, mu, omega_rpm=None):
    return [row for row in rows if row["mu"] == mu and omega_rpm in (None, row["omega_rpm"]) and row["mu_star"] is not None]


def has_settled(row):
    return row["status"] in ("periodic", "decayed")


def percent(x):
    return f"{100 * x:+.1f} %"


# --- the band of Figure 7 ---

def bands(rows):
    """The span of mu* over all choices at each speed and mu, with the choice that makes each end."""
    named = [(words, row) for words, study, settings in CHOICES for row in own(rows[study], settings)]
    named += [(f"continued {row['direction']}", row) for row in rows["open_branch"]]
    speeds = sorted({row["omega_rpm"] for row in rows["open_top"]})
    mus = sorted({row["mu"] for row in rows["open_top"]})
    lines, widths = [], {}
    for omega in speeds:
        cells = [f"{omega:g}"]
        for mu in mus:
            found = [(row["mu_star"], words) for words, row in named
                     if row["mu"] == mu and row["omega_rpm"] == omega and has_settled(row)]
            low, high = min(found), max(found)
            widths[omega, mu] = (low, high)
            cells.append(f"{low[0]:.3f} … {high[0]:.3f}")
        lines.append(cells)
    return runs.table(["ω [rpm]", *(f"μ = {mu:g}" for mu in mus)], lines), widths


def ends(widths):
    """How often each choice makes an end of a span that is wider than 1 % of mu."""
    count = {}
    for (_, mu), pair in widths.items():
        if pair[1][0] - pair[0][0] > 0.01 * mu:
            for side, (_, words) in zip(("lowest", "highest"), pair):
                count.setdefault(words, {"lowest": 0, "highest": 0})[side] += 1
    ranked = sorted(count.items(), key=lambda item: -sum(item[1].values()))
    return runs.table(["choice", "lowest μ\\* at", "highest μ\\* at"],
                      [[words, f"{own['lowest']} points", f"{own['highest']} points"] for words, own in ranked])


def branches(rows):
    """Points at which the ways up and down in speed end in different limit cycles."""
    pairs = {}
    for row in rows:
        if has_settled(row):
            pairs.setdefault((row["mu"], row["omega_rpm"]), {})[row["direction"]] = row["mu_star"]
    both = {key: pair for key, pair in pairs.items() if len(pair) == 2}
    two = {key: pair for key, pair in both.items() if abs(pair["up"] / pair["down"] - 1) > 0.01}
    words = ", ".join(f"{pair['up']:.3f} and {pair['down']:.3f} at μ = {mu:g}, {omega:g} rpm"
                      for (mu, omega), pair in sorted(two.items()))
    return f"Of {len(both)} points, {len(two)} have two limit cycles whose μ\\* differ by more than 1 %" + (f": {words}." if two else ".")


# --- the paper's claims ---

def inspected(number, study, settings):
    folder = runs.WORK / "choices" / str(number)
    given = [f"{name}={value}" for name, value in settings.items()]
    nodes = [argument for node in NODES for argument in ("--node", node)]
    runs.tribosweep("inspect", str(runs.ROOT / f"studies/{study}.json"), "omega_rpm=7", f"mu={MU}", *given, *nodes,
                    "--out", str(folder))
    return folder, reproduction.json.loads((folder / "inspection.json").read_text())


def near(value, claimed, share):
    return value is not None and abs(value / claimed - 1) <= share


def claims(rows, folder, summary):
    """What a choice gives for each claim: the text, and whether it is the paper's."""
    stable = [row for row in rows if row["mu"] <= 0.2]
    column = sorted(at(rows, MU), key=lambda row: row["omega_rpm"])
    lowest = physics.minimum(column)[2]
    regimes = {row["omega_rpm"]: row["regime"] for row in column}
    cycles = [row["frequency_hz"] for row in column if row["status"] == "periodic" and row["frequency_hz"]]
    front, rear, inside = summary["nodes"]
    face = summary["face"]
    turning = face["counter_clockwise"] / max(face["separating"], 1)
    forward = min(reproduction.towards_front(summary, change) for change in ("stick", "slip", "contact", "separation"))
    slow, fast = (node["relative_speed_max_m_s"] * MM_S for node in (front, rear))
    decayed = sum(row["status"] == "decayed" for row in stable)
    y = inside["peak_to_peak_m"][1] * UM
    lift, most, sigma = inside["lift_max_m"] * UM, face["lift_max_m"] * UM, inside["sigma_n_max_pa"] * MPA
    return [
        (f"{decayed} of {len(stable)}" if stable else "not run", bool(stable) and decayed == len(stable)),
        (f"{lowest:.1f} rpm", near(lowest, OMEGA_MIN, 0.1)),
        (regimes.get(35, "not run").replace("_", "–"), regimes.get(35) == "slip_separation" and regimes.get(20) != "slip_separation"),
        (f"{min(cycles):.0f}–{max(cycles):.0f}" if cycles else "none", bool(cycles) and all(near(hz, HZ, 0.02) for hz in cycles)),
        (f"{y:.2f}", near(y, 2, 0.1)),
        (f"{lift:.2f}", near(lift, 0.15, 0.2)),
        (f"{most:.2f}", most <= 0.33),
        (f"{sigma:.2f}", near(sigma, 0.5, 0.1)),
        (f"{slow:.0f} and {fast:.0f}", near(slow, 180, 0.1) and near(fast, 210, 0.1)),
        (f"{100 * turning:.0f} %", turning > 0.99),
        (f"{100 * forward:.0f} %", forward > 0.99),
    ]


CLAIMS = [
    "stable up to μ = 0.2, all ω", "minimum of μ\\* at 6 rpm ± 10 %", "slip–separation from 35 rpm", "14 500 Hz ± 2 % at all ω",
    "y range of node 1: 2 µm ± 10 %", "node 1 lifts 0.15 µm ± 20 %", "no node lifts more than 0.3 µm + 10 %",
    "σ_n at node 1: 0.5 MPa ± 10 %", "slip up to 180 mm/s at the front, 210 at the rear, ± 10 %", "loops run counter-clockwise",
    "waves run from the rear to the front",
]


def claims_by_choices(rows):
    found = [claims(own(rows[study], settings), *inspected(number, study, settings))
             for number, (_, study, settings) in enumerate(CHOICES)]
    lines = [[claim, *(f"**{of[i][0]}**" if of[i][1] else of[i][0] for of in found)] for i, claim in enumerate(CLAIMS)]
    met = [sum(holds for _, holds in of) for of in found]
    lines.append(["claims met", *map(str, met)])
    best = [CHOICES[i][0] for i, count in enumerate(met) if count == max(met)]
    return runs.table(["claim", *(words for words, *_ in CHOICES)], lines), best, max(met), found


# --- scenes with the paper's frequency ---

SEARCHED = [
    ("young_modulus_pa", "Young's modulus of the pin", 1.0e9), ("density_kg_m3", "density of the pin", 2500.0),
    ("poisson_ratio", "Poisson's ratio", 0.3), ("size_z_m", "height of the pin", 0.010),
    ("size_y_m", "length of the pin in y", 0.015), ("size_x_m", "width of the pin in x", 0.012),
]
# Stiffnesses are 1 to 32 times the pin's own, EA/h = 18 kN/mm, and EA l_y²/12h about x. The pin has 4.5 g.
PIN_N_M, PIN_NM_RAD = 1.8e7, 1.8e7 * 0.015**2 / 12
TIMES = (1, 2, 4, 8, 16, 32)
HOLDERS = [
    ("holder_stiffness_y_n_m", "a holder that gives way in y", [PIN_N_M * times for times in TIMES], {}),
    ("holder_rotational_stiffness_x_nm_rad", "a holder that rocks about x", [PIN_NM_RAD * times for times in TIMES], {}),
    ("holder_mass_kg", "a mass that moves with the load in z", [0.0005, 0.001, 0.002, 0.005, 0.01, 0.1], {"stiffness_z_n_m": 0}),
]


def sweep_of(name, place, grid, **scene):
    top, side = place
    base = runs.shipped("open_top", name=name, grid={"mu": [MU], **grid})
    base["scene"]["top"] = top
    base["scene"]["clamp"]["side"] = side
    for part, fields in scene.items():
        base["scene"].setdefault(part, {}).update(fields)
    return runs.sweep(base)


def crossing(points, hz):
    """Where the frequency is the given one, by a straight line between neighbours; none if it is nowhere."""
    for (x0, f0), (x1, f1) in zip(points, points[1:]):
        if f0 and f1 and (f0 - hz) * (f1 - hz) <= 0:
            return float(f"{x0 + (hz - f0) * (x1 - x0) / (f1 - f0):.4g}")
    return None


def periodic_hz(rows):
    return {row["omega_rpm"]: row["frequency_hz"] for row in rows if row["status"] == "periodic" and row["frequency_hz"]}


PLACES = [(("tied_in_z", "inner_side"), "tied, inner side"), (("tied_in_z", "outer_side"), "tied, outer side"),
          (("free_in_z", "inner_side"), "free, inner side")]


def searched():
    """A row for each scene and each change, and the changes with which frequency and minimum are the paper's."""
    lines, found = [], []
    for place, where in PLACES:
        scans = [(name, words, [share * base for share in (0.8, 0.9, 1.0, 1.1, 1.2)], base, {}) for name, words, base in SEARCHED]
        if place == PLACES[0][0]:
            scans += [(name, words, values, None, {"holder": holder}) for name, words, values, holder in HOLDERS]
        for name, words, values, base, scene in scans:
            label = f"{'-'.join(place)}-{name}"
            rows = sweep_of(f"search-{label}", place, {name: values, "omega_rpm": [7]}, **scene)
            points = [(value, periodic_hz([row for row in rows if row[name] == value]).get(7)) for value in values]
            known = [hz for _, hz in points if hz]
            span = f"{min(known):.0f}–{max(known):.0f}" if known else "not periodic"
            value = crossing(points, HZ)
            if value is None:
                lines.append([where, words, span, "–", "–", "–"])
                continue
            speeds = [3, 4, 5, 6, 7, 8, 10, 12, 35]

            def at_speeds(value, round_of):
                own_rows = sweep_of(f"{round_of}-{label}", place, {name: [value], "omega_rpm": speeds}, **scene)
                return sorted(own_rows, key=lambda row: row["omega_rpm"])

            own_rows = at_speeds(value, "first")
            cycles = periodic_hz(own_rows)
            # The frequency varies with the speed: the middle of its range is to be the paper's.
            middle = (min(cycles.values()) + max(cycles.values())) / 2
            better = crossing(points, HZ * cycles[7] / middle) if 7 in cycles else None
            if better is not None and better != value:
                value = better
                own_rows = at_speeds(value, "second")
                cycles = periodic_hz(own_rows)
            off = max(abs(hz / HZ - 1) for hz in cycles.values())
            speed, lowest = physics.minimum(own_rows)[2], min(row["mu_star"] for row in own_rows)
            change = percent(value / base - 1) if base else f"{value:.3g}"
            holds = off <= 0.02 and near(speed, OMEGA_MIN, 0.1) and lowest < 0.3
            if holds:
                found.append(f"{words} {change} ({where}: within {100 * off:.1f} %, minimum {lowest:.3f} at {speed:.1f} rpm)")
            lines.append([where, words, span, change, f"{min(cycles.values()):.0f}–{max(cycles.values()):.0f} Hz",
                          f"{speed:.1f} rpm, {lowest:.3f}" + (" **both**" if holds else "")])
    header = ["top, clamp", "what is changed", "frequency at 7 rpm over the search [Hz]", "14.5 kHz at", "frequency over 3–35 rpm",
              "minimum of μ\\*"]
    return runs.table(header, lines), found


# --- without damping ---

MESHES = [[12, 15, 10], [24, 30, 20], [36, 45, 30], [48, 60, 40]]
FACTORS = [0.5, 0.6, 1.0]
SPEEDS = [2, 7, 35]


def undamped():
    base = runs.shipped("open_damping", name="undamped",
                        grid={"elements": MESHES, "damping_beta2": FACTORS, "mu": [MU], "omega_rpm": SPEEDS})
    rows = runs.sweep(base)
    steps = runs.sweep(runs.shipped("open_damping", name="undamped-steps", grid={
        "elements": MESHES[:2], "damping_beta2": [0.5], "safety_factor": [0.7, 0.35, 0.175], "mu": [MU], "omega_rpm": SPEEDS}))

    def row_of(elements, beta2, omega):
        return next(row for row in rows if row["elements"] == elements and row["damping_beta2"] == beta2 and row["omega_rpm"] == omega)

    def cell(row):
        mark = "" if has_settled(row) else "~"
        return f"{row['mu_star']:.4f}{mark}"

    lines, last = [], {}
    for beta2 in FACTORS:
        for omega in SPEEDS:
            series = [row_of(elements, beta2, omega) for elements in MESHES]
            values = [row["mu_star"] for row in series]
            last[beta2, omega] = abs(values[-1] / values[-2] - 1)
            lines.append([f"{beta2:g}", f"{(beta2 - 0.5) * 55:.3g} ns", f"{omega}", *map(cell, series),
                          percent(values[-2] / values[-3] - 1), percent(values[-1] / values[-2] - 1)])
    meshes = runs.table(["β₂ at 55 ns", "β_R", "ω [rpm]", *(" × ".join(map(str, e)) for e in MESHES), "24 → 36", "36 → 48"], lines)
    by_step = []
    for elements in MESHES[:2]:
        for omega in SPEEDS:
            own_rows = {row["safety_factor"]: row for row in steps if row["elements"] == elements and row["omega_rpm"] == omega}
            values = [own_rows[factor]["mu_star"] for factor in (0.7, 0.35, 0.175)]
            by_step.append([" × ".join(map(str, elements)), f"{omega}", *(cell(own_rows[factor]) for factor in (0.7, 0.35, 0.175)),
                            percent(values[1] / values[0] - 1), percent(values[2] / values[1] - 1)])
    table = runs.table(["mesh", "ω [rpm]", "0.7 of the limit", "0.35", "0.175", "first halving", "second halving"], by_step)
    aperiodic = [row for row in rows if row["damping_beta2"] == 0.5 and not has_settled(row)]
    return meshes, table, last, aperiodic, rows


def main():
    runs.build()
    rows = {study: runs.sweep(f"studies/{study}.json") for study in ["figure7", *OPEN]}
    folder = runs.WORK / "choices" / "report"
    runs.tribosweep("report", "figure7", *OPEN, "--span", "--out", str(folder))
    shutil.copy(folder / "span.svg", runs.ROOT / "docs" / "figure7_bands.svg")
    band_table, widths = bands(rows)
    widest = max(widths.items(), key=lambda item: (item[1][1][0] - item[1][0][0]) / item[0][1])
    claim_table, best, met, _ = claims_by_choices(rows)
    search_table, both = searched()
    meshes, steps, last, aperiodic, all_undamped = undamped()
    (omega, mu), (low, high) = widest
    best_words = " and ".join(f"“{words}”" for words in best)
    fine = {beta2: max(last[beta2, speed] for speed in SPEEDS) for beta2 in FACTORS}
    runs.write("choices.md", f"""# What the paper leaves open

Written by `scripts/choices.py`; do not edit. The paper (Baillet, d'Errico, Berthier, *Influence of sliding contact local dynamics
on macroscopic friction coefficient variation*, Revue européenne des éléments finis 14 (2005) 305–321) does not say everything that
its Figure 7 depends on. This page computes what each choice within its words changes. Each choice has a study:

| left open | the paper's words | `figure7` | the other choices | study |
| --- | --- | --- | --- | --- |
| damping | the method's β₂ lies between ½ and 1; Δt = 0.55·10⁻⁷ s | β₂ = 1: β_R = 27.5 ns | β₂ = ½ and ¾ | `open_damping` |
| which lines are held | “the first two lines of the pin's upper surface” | inner side, 1 mm | outer side, leading end, trailing end | `open_clamp` |
| the top face | “a uniformly normal displacement on the top”, and “F is applied to all the nodes of the upper surface” | tied in z | free in z | `open_top` |
| the disk | elastic, “thickness e 85 mm” | rigid | elastic steel, 85 mm | `open_disk` |
| what a run starts from | – | a coarser mesh | its neighbour, up and down in speed | `open_branch` |

All of them have the mesh and the numerics of the preset `standard`, so that the errors of [accuracy.md](accuracy.md) come on top.

## Figure 7 with bands

```text
tribosweep report figure7 {' '.join(OPEN)} --span
```

![Span of μ* over what the paper leaves open](figure7_bands.svg)

The line is `figure7`. The band goes from the smallest to the largest settled μ\\* of all choices; each dot is a job.

{band_table}
The widest band, in relation to μ, is that of μ = {mu:g} at {omega:g} rpm: {low[0]:.3f} ({low[1]}) to {high[0]:.3f} ({high[1]}). The
choices that make the ends of bands wider than 1 % of μ:

{ends(widths)}
**Two limit cycles.** {branches(rows["open_branch"])}

## The paper's statements by choices

At μ = 0.4; values of single nodes at 7 rpm. Node 1 is taken 1.5 mm behind the front edge
([reproduction.md](reproduction.md) says why). Bold: what the paper says.

{claim_table}
The most, {met} of {len(CLAIMS)}, are met by {best_words}.

## A scene with 14.5 kHz and the V

One thing is changed by up to 20 %, or a holder is added whose stiffness is 1 to 32 times that of the pin
(EA/h = 18 kN/mm; about x EA l²/12h), or a mass of 0.5 to 100 g (the pin has 4.5 g). The load is a force, so its own compliance in z changes
nothing. Where the frequency at 7 rpm passes 14.5 kHz, the scene is run over the speed, and the change is corrected so that the middle of
the frequencies over the speed is 14.5 kHz. “Both” stands for 14.5 kHz within 2 % at all these speeds and a minimum of μ\\* below 0.3 at
6 rpm within 10 %. The last three rows of the first scene are in N/m, N m and kg.

{search_table}
{in_words(both)}

A linear pin on a rigid disk is similar to itself: f is in proportion to √(E/ρ), and the speed of the minimum to F/√(Eρ). So a change of
E and ρ moves both and leaves the values of μ\\* as they are.

## Without damping

Does μ\\* converge with the mesh and the time step as β_R goes to 0? μ = 0.4, `~`: not periodic within 40 ms.

{meshes}
The time step, without damping:

{steps}
Between the two finest meshes μ\\* changes by at most {100 * fine[0.5]:.1f} % without damping, {100 * fine[0.6]:.1f} % with β₂ = 0.6 and
{100 * fine[1.0]:.1f} % with β₂ = 1. {len(aperiodic)} of {sum(row["damping_beta2"] == 0.5 for row in all_undamped)} jobs without damping did not become periodic.
{undamped_in_words(fine)}

For your own pin this means: give its loss factor. β_R = 27.5 ns is η = {100 * 2 * math.pi * HZ * 2.75e-8:.2f} % at 14.5 kHz. Polymers have 1 to 10 %, that is β_R
of {0.01 / (2 * math.pi * HZ) * 1e9:.0f} to {0.1 / (2 * math.pi * HZ) * 1e9:.0f} ns at this frequency, where μ\\* depends less on the mesh
([accuracy.md](accuracy.md)) and more on the damping.
""")


def in_words(both):
    if not both:
        return "No change within these limits has both."
    return "Both are had by: " + "; ".join(both) + "."


def undamped_in_words(fine):
    if fine[0.5] > 2 * fine[1.0]:
        return ("So the undamped values are still moving on meshes on which the damped ones stand: short waves that only damping removes take "
                "part in them. They are values of a mesh, not of the continuum.")
    return "So the undamped values move no more than the damped ones on these meshes."


if __name__ == "__main__":
    main()
