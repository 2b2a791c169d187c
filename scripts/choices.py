#!/usr/bin/env python3
"""Writes docs/evidence/choices.md and docs/evidence/figure7_bands.svg: what the paper leaves open, and what it changes.

Runs studies/figure7.json and the studies open_*.json, one for each choice; `inspect` of the reference job with each choice;
scenes within 20 % of the paper's that have its frequency; and meshes and time steps without damping. Only the claims and the
words of the comparison are written here; every number in the page is computed.
"""

import json
import math
import shutil

import physics
import reproduction
import runs
import undamped
from undamped import MU, has_settled, percent

HZ, OMEGA_MIN = 14_500, 6
SPEEDS_OF_FIGURE = runs.shipped("figure7")["grid"]["omega_rpm"]
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
            here = [(row["mu_star"], words, has_settled(row)) for words, row in named if (row["mu"], row["omega_rpm"]) == (mu, omega)]
            found = [(value, words) for value, words, settled in here if settled]
            low, high = min(found), max(found)
            widths[omega, mu] = (low, high)
            left = len(here) - len(found)
            cells.append(f"{low[0]:.3f} … {high[0]:.3f}" + (f", {left}~" if left else ""))
        lines.append(cells)
    return runs.table(["ω [rpm]", *(f"μ = {mu:g}" for mu in mus)], lines), widths


def ends(widths, rows):
    """How often each choice makes an end of a span that is wider than 1 % of mu, and how many of its jobs are in no span."""
    jobs = {words: own(rows[study], settings) for words, study, settings in CHOICES}
    for row in rows["open_branch"]:
        jobs.setdefault(f"continued {row['direction']}", []).append(row)
    count = {words: {"lowest": 0, "highest": 0} for words in jobs}
    for (_, mu), pair in widths.items():
        if pair[1][0] - pair[0][0] > 0.01 * mu:
            for side, (_, words) in zip(("lowest", "highest"), pair):
                count[words][side] += 1
    lines = []
    for words, of in sorted(count.items(), key=lambda item: -sum(item[1].values())):
        loose = [row["mu"] for row in jobs[words] if not has_settled(row)]
        by_mu = ", ".join(f"{loose.count(mu)} at {mu:g}" for mu in sorted(set(loose)))
        lines.append([words, of["lowest"], of["highest"], f"{len(loose)} of {len(jobs[words])}" + (f": {by_mu}" if loose else "")])
    return runs.table(["choice", "lowest μ\\*, points", "highest μ\\*, points", "jobs that did not settle, by μ"], lines)


def without_jobs(rows):
    """Where the elastic disk has no jobs: the values of mu and the speeds that it leaves out."""
    def left_out(name):
        return ", ".join(f"{value:g}" for value in sorted({row[name] for row in rows["open_top"]} - {row[name] for row in rows["open_disk"]}))
    return f"The elastic disk has no jobs at μ = {left_out('mu')} and none at {left_out('omega_rpm')} rpm."


def branches(rows):
    """Points at which the ways up and down in speed end in different limit cycles."""
    pairs = {}
    for row in rows:
        if has_settled(row):
            pairs.setdefault((row["mu"], row["omega_rpm"]), {})[row["direction"]] = row["mu_star"]
    both = {key: pair for key, pair in pairs.items() if len(pair) == 2}
    two = {key: pair for key, pair in both.items() if abs(pair["up"] / pair["down"] - 1) > 0.01}
    words = ", ".join(f"μ = {mu:g} and {omega:g} rpm ({pair['up']:.3f} on the way up, {pair['down']:.3f} on the way down)"
                      for (mu, omega), pair in sorted(two.items()))
    return (f"Points with two limit cycles whose μ\\* differ by more than 1 %: {len(two)} of {len(both)}" + (f", at {words}." if two else "."))


# --- the paper's claims ---

def at_all_speeds(rows):
    """The rows of each study, and at mu = 0.4 those at the speeds of figure7 that its grid leaves out."""
    found = {"figure7": rows["figure7"]}
    for study in ["open_damping", "open_clamp", "open_top", "open_disk"]:
        grid = runs.shipped(study)["grid"]
        grid["mu"] = [MU]
        grid["omega_rpm"] = [omega for omega in SPEEDS_OF_FIGURE if omega not in grid["omega_rpm"]]
        found[study] = rows[study] + runs.sweep(runs.shipped(study, name=f"all-speeds-{study}", grid=grid))
    return found


def inspected(number, study, settings):
    folder = runs.WORK / "choices" / str(number)
    given = [f"{name}={value}" for name, value in settings.items()]
    nodes = [argument for node in NODES for argument in ("--node", node)]
    runs.tribosweep("inspect", str(runs.ROOT / f"studies/{study}.json"), "omega_rpm=7", f"mu={MU}", *given, *nodes,
                    "--out", str(folder))
    return folder, json.loads((folder / "inspection.json").read_text())


def near(value, claimed, share):
    return value is not None and abs(value / claimed - 1) <= share


def frequency_range(rows, unit=""):
    """The frequencies over the speeds, and at how many speeds a job is periodic where it is not at all of them."""
    cycles = periodic_hz(rows).values()
    share = "" if len(cycles) == len(rows) else f" ({len(cycles)} of {len(rows)} periodic)"
    return f"{min(cycles):.0f}–{max(cycles):.0f}{unit}{share}" if cycles else "not periodic"


def separation_in_words(regimes):
    """From which speed on every job slips and separates without sticking, and that speed."""
    speeds = sorted(regimes)
    found = None
    for omega in reversed(speeds):
        if regimes[omega] != "slip_separation":
            break
        found = omega
    return ("at no speed" if found is None else f"from {found:g} rpm"), found


def claims(rows, folder, summary):
    """What a choice gives for each claim: the text, and whether it is the paper's."""
    # All choices have these speeds; figure7 has further ones, at which physics.py judges it.
    stable = [row for row in rows if row["mu"] <= 0.2 and row["omega_rpm"] in runs.shipped("open_top")["grid"]["omega_rpm"]]
    column = sorted(at(rows, MU), key=lambda row: row["omega_rpm"])
    lowest = physics.minimum(column)[2]
    separation, separates_from = separation_in_words({row["omega_rpm"]: row["regime"] for row in column})
    cycles = periodic_hz(column).values()
    front, rear, inside = summary["nodes"]
    face = summary["face"]
    turning = face["counter_clockwise"] / max(face["separating"], 1)
    forward = min(reproduction.towards_front(summary, change) for change in ("stick", "slip", "contact", "separation"))
    slow, fast = (node["relative_speed_max_m_s"] * MM_S for node in (front, rear))
    decayed = sum(row["status"] == "decayed" for row in stable)
    y = inside["peak_to_peak_m"][1] * UM
    lift, most, sigma = inside["lift_max_m"] * UM, face["lift_max_m"] * UM, inside["sigma_n_max_pa"] * MPA
    return [
        (f"{decayed} of {len(stable)}" if stable else "–", decayed == len(stable) if stable else None),
        (physics.minimum_in_words(column), near(lowest, OMEGA_MIN, 0.1)),
        (separation, separates_from == 35),
        (frequency_range(column), len(cycles) == len(column) and all(near(hz, HZ, 0.02) for hz in cycles)),
        (f"{y:.2f}", near(y, 2, 0.1)),
        (f"{lift:.2f}", near(lift, 0.15, 0.2)),
        (f"{most:.2f}", most <= 0.33),
        (f"{sigma:.2f}", near(sigma, 0.5, 0.1)),
        (f"{slow:.0f} and {fast:.0f}", near(slow, 180, 0.1) and near(fast, 210, 0.1)),
        (f"{100 * turning:.0f} %", turning > 0.99),
        (f"{100 * forward:.0f} %", forward > 0.99),
    ]


CLAIMS = [
    "stable up to μ = 0.2, ten ω", "minimum of μ\\* at 6 rpm ± 10 %", "slip–separation without stick from 35 rpm", "14 500 Hz ± 2 % at all ω",
    "y range of node 1: 2 µm ± 10 %", "node 1 lifts 0.15 µm ± 20 %", "no node lifts more than 0.3 µm + 10 %",
    "σ_n at node 1: 0.5 MPa ± 10 %", "slip up to 180 mm/s at the front, 210 at the rear, ± 10 %", "loops run counter-clockwise",
    "waves run from the rear to the front",
]


def claims_by_choices(rows):
    found = [claims(own(rows[study], settings), *inspected(number, study, settings))
             for number, (_, study, settings) in enumerate(CHOICES)]
    lines = [[claim, *(f"**{of[i][0]}**" if of[i][1] else of[i][0] for of in found)] for i, claim in enumerate(CLAIMS)]
    met = [sum(bool(holds) for _, holds in of) for of in found]
    out_of = [sum(holds is not None for _, holds in of) for of in found]
    lines.append(["claims met", *(f"{count} of {all_of}" for count, all_of in zip(met, out_of))])
    best = [i for i, count in enumerate(met) if count == max(met)]
    columns = [Searched(words, sorted(at(own(rows[study], settings), MU), key=lambda row: row["omega_rpm"]))
               for words, study, settings in CHOICES]
    return (runs.table(["claim", *(words for words, *_ in CHOICES)], lines), [CHOICES[i][0] for i in best],
            f"{met[best[0]]} of {out_of[best[0]]}", columns)


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
                lines.append([where, words, span, "–", "–", "–", "–"])
                continue

            def at_speeds(value, round_of):
                grid = {name: [value], "omega_rpm": SPEEDS_OF_FIGURE}
                return sorted(sweep_of(f"{round_of}-{label}", place, grid, **scene), key=lambda row: row["omega_rpm"])

            own_rows = at_speeds(value, "first")
            cycles = periodic_hz(own_rows)
            # The frequency varies with the speed: the middle of its range is to be the paper's.
            better = crossing(points, HZ * cycles[7] / middle(cycles)) if 7 in cycles else None
            if better is not None and better != value:
                value = better
                own_rows = at_speeds(value, "all-speeds")
                cycles = periodic_hz(own_rows)
            of = Searched(f"{words} {percent(value / base - 1)} ({where})" if base else f"{words} ({where})", own_rows)
            found.append(of)
            lines.append([where, words, span, percent(value / base - 1) if base else f"{value:.3g}", of.frequencies(), of.near_hz(),
                          f"{physics.minimum_in_words(own_rows)}, {of.lowest:.3f}" + (" **V**" if of.has_v else "")])
    header = ["top, clamp", "what is changed", "frequency at 7 rpm over the search [Hz]", "14.5 kHz at", "frequency over all speeds [Hz]",
              "within 2 % of 14.5 kHz", "minimum of μ\\*"]
    return runs.table(header, lines), found


def middle(cycles):
    return (min(cycles.values()) + max(cycles.values())) / 2


class Searched:
    """A scene at mu = 0.4 over the speeds of figure7: how far its frequency is from the paper's, and whether it has the V."""

    def __init__(self, words, rows):
        self.words, self.rows, self.cycles = words, rows, periodic_hz(rows)
        self.off = max((abs(hz / HZ - 1) for hz in self.cycles.values()), default=math.inf)
        self.spread = (max(self.cycles.values()) / middle(self.cycles) - 1) if self.cycles else math.inf
        self.lowest = min(row["mu_star"] for row in rows)
        self.has_v = near(physics.minimum(rows)[2], OMEGA_MIN, 0.1) and self.lowest < 0.3
        self.has_hz = self.off <= 0.02 and len(self.cycles) == len(rows)

    def frequencies(self, unit=""):
        return frequency_range(self.rows, unit)

    def near_hz(self):
        """The speeds around 6 rpm up to which the frequency stays within 2 % of the paper's."""
        speeds = [row["omega_rpm"] for row in self.rows]
        holds = [near(self.cycles.get(omega), HZ, 0.02) for omega in speeds]
        first = last = speeds.index(OMEGA_MIN)
        if not holds[first]:
            return "not at 6 rpm"
        while first > 0 and holds[first - 1]:
            first -= 1
        while last + 1 < len(speeds) and holds[last + 1]:
            last += 1
        return f"{speeds[first]:g}–{speeds[last]:g} rpm"


def similar():
    """mu* of the reference job, and of the same with less stiffness at the speed of the same state, with two dampings."""
    share, mesh = 0.855, [12, 15, 10]
    values = []
    for young, omega, beta_r_s in [(1, 7, 2.75e-8), (share, 7 / share**0.5, 2.75e-8), (share, 7 / share**0.5, 2.75e-8 / share**0.5)]:
        study = runs.shipped("open_top", name="similar", grid={"mu": [MU], "omega_rpm": [omega]}, numerics={"beta_r_s": beta_r_s})
        del study["damping"]
        study["scene"]["top"] = "tied_in_z"
        study["scene"]["pin"].update(elements=mesh, young_modulus_pa=young * 1e9)
        study["scene"]["load"] = {"force_n": 30.0, "ramp_s": 5e-4 / young**0.5}
        path = runs.WORK / "similar.json"
        path.write_text(json.dumps(study))
        values.append(json.loads(runs.tribosweep("solve", str(path), "--json"))["mu_star"])
    return (f"With E at {share} of its value on {' × '.join(map(str, mesh))} elements, at the speed of 7 rpm times {share}^(−½), μ\\* is {values[1]:.5f} "
            f"with β_R = 27.5 ns, {values[2]:.5f} with the scaled β_R, and {values[0]:.5f} with the E of before")


def main():
    runs.build()
    rows = {study: runs.sweep(f"studies/{study}.json") for study in ["figure7", *OPEN]}
    folder = runs.WORK / "choices" / "report"
    runs.tribosweep("report", "figure7", *OPEN, "--span", "--out", str(folder))
    shutil.copy(folder / "span.svg", runs.EVIDENCE / "figure7_bands.svg")
    band_table, widths = bands(rows)
    widest = max(widths.items(), key=lambda item: (item[1][1][0] - item[1][0][0]) / item[0][1])
    claim_table, best, met, choices = claims_by_choices(at_all_speeds(rows))
    search_table, found = searched()
    (omega, mu), (low, high) = widest
    best_words = " and ".join(f"“{words}”" for words in best)
    runs.write("choices", f"""# What the paper leaves open

Written by `scripts/choices.py`; do not edit. The paper (Baillet, d'Errico, Berthier, *Influence of sliding contact local dynamics
on macroscopic friction coefficient variation*, Revue européenne des éléments finis 14 (2005) 305–321) does not say everything that
its Figure 7 depends on. This page computes what each choice within its words changes. Each choice has a study:

| left open | the paper's words | `figure7` | the other choices | study |
| --- | --- | --- | --- | --- |
| damping | the method's β₂ lies between ½ and 1; Δt = 0.55·10⁻⁷ s | β₂ = 1: β_R = 27.5 ns | β₂ = ½ and ¾ | `open_damping` |
| which lines are held | “the first two lines of the pin's upper surface”: 1 mm, if its mesh has elements of 1 mm, which is likely | inner side | outer side, leading end, trailing end | `open_clamp` |
| the top face | “a uniformly normal displacement on the top”, and “F is applied to all the nodes of the upper surface” | tied in z | free in z | `open_top` |
| the disk | elastic, “thickness e 85 mm” | rigid | elastic steel, 85 mm | `open_disk` |
| what a run starts from | – | a coarser mesh | its neighbour, up and down in speed | `open_branch` |

All of them have the mesh and the numerics of the preset `standard`, so that the errors of [accuracy.md](accuracy.md) come on top.

## Figure 7 with bands

```text
tribosweep report figure7 {' '.join(OPEN)} --span
```

![Span of μ* over what the paper leaves open](figure7_bands.svg)

The line is `figure7`. The band goes from the smallest to the largest settled μ\\* of the choices that have one there; each dot is a job. `n~`:
n jobs did not settle there and are in no band. {without_jobs(rows)}

{band_table}
The widest band, in relation to μ, is that of μ = {mu:g} at {omega:g} rpm: {low[0]:.3f} ({low[1]}) to {high[0]:.3f} ({high[1]}). The
choices that make the ends of bands wider than 1 % of μ:

{ends(widths, rows)}
Without damping even jobs at μ = 0.1 keep vibrating: {undamped.growing_at(0.1, 75)}, {undamped.growing_at(0.2, 35)}.

**Two limit cycles.** {branches(rows["open_branch"])}

## The paper's statements by choices

At μ = 0.4 and all speeds of `figure7`; values of single nodes at 7 rpm. Node 1 is taken 1.5 mm behind the front edge
([paper.md](paper.md) says why). Bold: what the paper says; –: not run. The minimum is that of the means, also of runs that are not periodic.

{claim_table}
The most, {met}, are met by {best_words}. One choice is changed at a time: combinations were not run, and may meet more.

## A scene with 14.5 kHz and the V

{no_choice(choices)}

Does another scene have it? One thing is changed by up to 20 %, or a holder is added whose stiffness is 1 to 32 times that of the pin
(EA/h = 18 kN/mm; about x EA l²/12h), or a mass of 0.5 to 100 g (the pin has 4.5 g). The load is a force, so its own compliance in z changes
nothing. Where the frequency at 7 rpm passes 14.5 kHz, the scene is run at all speeds of `figure7`, and the change is corrected so that the middle of
the frequencies is 14.5 kHz. **V**: a minimum of μ\\* below 0.3 at 6 rpm within 10 %. The last three rows of the first scene are in N/m, N m and kg.

{search_table}
{no_scene(found, choices[0])}

A linear pin on a rigid disk is similar to itself: f is in proportion to √(E/ρ), and the speed of the minimum to F/√(Eρ). So a change of
E and ρ moves both. It leaves the values of μ\\* as they are if β_R is changed in proportion to √(ρ/E), too. {similar()}.

## Without damping

{undamped.section(HZ)}""")


def no_choice(choices):
    """Whether one of the choices has the paper's frequency, and which is nearest."""
    has = [of for of in choices if of.has_hz]
    if has:
        return "14.5 kHz within 2 % at all speeds: " + ", ".join(f"“{of.words}”" for of in has) + "."
    nearest = min(choices, key=lambda of: of.off)
    with_v = min((of for of in choices if of.has_v), key=lambda of: of.off)
    at_6 = any(near(of.cycles.get(OMEGA_MIN), HZ, 0.02) for of in choices)
    return (f"None of the choices has 14.5 kHz within 2 % at all speeds{'' if at_6 else ', and none at 6 rpm'}. The nearest is “{nearest.words}” ({nearest.frequencies(' Hz')}, "
            f"{100 * nearest.off:.1f} % off at most; its minimum of μ\\* is at {physics.minimum_in_words(nearest.rows)}). The nearest with the V is “{with_v.words}” "
            f"({with_v.frequencies(' Hz')}, {100 * with_v.off:.1f} %).")


def no_scene(found, figure7):
    """Whether a scene of the search has both; the nearest ones, and what would have to be true."""
    has = [of for of in found if of.has_hz and of.has_v]
    with_v = sorted((of for of in found if of.has_v), key=lambda of: of.off)
    near_ones = "; ".join(f"{of.words}: {of.frequencies(' Hz')}, {100 * of.off:.1f} % off at most, within 2 % at {of.near_hz()}" for of in with_v)
    if has:
        return "Scenes with both at all speeds: " + "; ".join(of.words for of in has) + "."
    return ("No scene has the V and 14.5 kHz within 2 % at all speeds. The nearest with the V: " + near_ones + ". What would have to be true: "
            f"the frequency of `figure7` varies over the speeds by ± {100 * figure7.spread:.1f} % about its middle, and E and ρ change all frequencies by one factor (at speeds that are scaled, too). So either the paper's "
            "14 500 Hz is the frequency of the middle speeds only, and its pin is softer or heavier by the shares above, or its frequency varies less with the speed than in any of these scenes with the V.")


if __name__ == "__main__":
    main()
