"""The part of docs/evidence/choices.md about beta_R -> 0: meshes, time steps, short waves and modes without damping."""

import cmath
import csv
import json
import math

import runs

MU = 0.4
MESHES = [[12, 15, 10], [24, 30, 20], [36, 45, 30], [48, 60, 40]]
FACTORS = [0.5, 0.6, 1.0]
SPEEDS = [2, 7, 35]
SHORT_HZ = 2e5


def has_settled(row):
    return row["status"] in ("periodic", "decayed")


def percent(x):
    return f"{100 * x:+.1f} %"


def meshes_and_steps():
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
            last[beta2, omega] = (abs(values[-1] / values[-2] - 1), all(map(has_settled, series[-2:])))
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


def spectrum(values):
    """The power of each frequency of a series whose length is a power of two (Cooley and Tukey), after a Hann window."""
    def transformed(x):
        if len(x) == 1:
            return x
        even, odd = transformed(x[0::2]), transformed(x[1::2])
        turned = [cmath.exp(-2j * math.pi * k / len(x)) * value for k, value in enumerate(odd)]
        return [a + b for a, b in zip(even, turned)] + [a - b for a, b in zip(even, turned)]

    count, mean = len(values), sum(values) / len(values)
    window = [(value - mean) * (0.5 - 0.5 * math.cos(2 * math.pi * i / count)) for i, value in enumerate(values)]
    return [abs(value)**2 for value in transformed(window)[: count // 2]]


def short_waves():
    """The share of short waves in the velocity of the front node, on three meshes, with and without damping."""
    kept = runs.WORK / "short_waves.json"
    shares = json.loads(kept.read_text()) if kept.exists() else {}
    lines = []
    for beta2 in (0.5, 1.0):
        for omega in (2, 35):
            cells = []
            for elements in MESHES[:3]:
                mesh = "x".join(map(str, elements))
                key = f"{beta2} {omega} {mesh}"
                if key not in shares:
                    of = runs.history("studies/open_damping.json", damping_beta2=beta2, mu=MU, omega_rpm=omega, elements=mesh,
                                      limit_s=0.01, stop_early="false")
                    count = 2**int(math.log2(0.7 * len(of["time_s"])))
                    step_s = (of["time_s"][-1] - of["time_s"][-count]) / (count - 1)
                    power = spectrum(of["front_centre_y_velocity_m_s"][-count:])
                    shares[key] = sum(power[math.ceil(SHORT_HZ * count * step_s):]) / sum(power)
                    kept.write_text(json.dumps(shares))
                cells.append(f"{100 * shares[key]:.1f} %")
            lines.append([f"{beta2:g}", omega, *cells])
    return runs.table(["β₂ at 55 ns", "ω [rpm]", *(" × ".join(map(str, e)) for e in MESHES[:3])], lines)


def growing_at(mu, omega_rpm):
    """The leading mode of steady sliding without damping, below the end of the band."""
    table = runs.WORK / "choices-modes.csv"
    runs.tribosweep("stability", str(runs.ROOT / "studies/open_damping.json"), *runs.set_arguments(
        {"damping_beta2": 0.5, "mu": mu, "omega_rpm": omega_rpm}), "--no-thresholds", "--modes", "1", "--csv", str(table),
        "--out", str(runs.WORK / "choices" / "modes"), "--name", "choices-modes", "--replace")
    with open(table, newline="") as file:
        [mode] = csv.DictReader(file)
    return (f"at μ = {mu:g} and {omega_rpm:g} rpm a mode at {float(mode['frequency_hz']) / 1e3:.1f} kHz has the growth rate "
            f"{float(mode['growth_rate_per_s']):.0f} 1/s")


def section(hz):
    """The whole section of the page; hz is the paper's frequency."""
    meshes, steps, last, aperiodic, rows = meshes_and_steps()
    fine = {beta2: max(last[beta2, omega][0] for omega in SPEEDS) for beta2 in FACTORS}
    periodic = max((change for (beta2, _), (change, both) in last.items() if beta2 == 0.5 and both), default=None)
    of_means = "" if periodic is None else f" ({100 * periodic:.1f} % where both runs are periodic; the others are means of runs that are not)"
    verdict = ("So the undamped values still move on meshes on which the damped ones no longer do." if fine[0.5] > 2 * fine[1.0] else
               "So the undamped values move no more than the damped ones on these meshes.")
    return f"""Does μ\\* converge with the mesh and the time step as β_R goes to 0? μ = 0.4, `~`: not periodic within 40 ms.

{meshes}
The time step, without damping:

{steps}
Between the two finest meshes μ\\* changes by at most {100 * fine[0.5]:.1f} % without damping{of_means},
{100 * fine[0.6]:.1f} % with β₂ = 0.6 and {100 * fine[1.0]:.1f} % with β₂ = 1. {len(aperiodic)} of {sum(row["damping_beta2"] == 0.5 for row in rows)} jobs without damping did not become periodic.
{verdict}

Short waves are the likely reason. The share of frequencies above {SHORT_HZ / 1e3:.0f} kHz in the power of the front node's velocity in y, in the last part of 10 ms:

{short_waves()}
The coarsest mesh has hardly any such waves, finer ones have them, and damping removes them. This suggests that the undamped values are those of a mesh and not of the
continuum; it is no proof.

For your own pin this means: give its loss factor. β_R = 27.5 ns is η = {100 * 2 * math.pi * hz * 2.75e-8:.2f} % at 14.5 kHz. Polymers have 1 to 10 %, that is β_R
of {0.01 / (2 * math.pi * hz) * 1e9:.0f} to {0.1 / (2 * math.pi * hz) * 1e9:.0f} ns at this frequency, where μ\\* depends less on the mesh
([accuracy.md](accuracy.md)) and more on the damping.
"""
