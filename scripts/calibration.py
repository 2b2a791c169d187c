#!/usr/bin/env python3
"""Synthetic experiments for `tribosweep calibrate`: is the truth inside the region that the data leave?

    scripts/calibration.py PROGRAM FOLDER [COUNT]   run experiments that docs/evidence/calibration.csv lacks, up to COUNT, and write the page
    scripts/calibration.py again NUMBER             run an experiment with two free parameters again, and end with 3 if the answer is not the kept one
    scripts/calibration.py                          write docs/evidence/calibration_proof.md from docs/evidence/calibration.csv
    scripts/calibration.py --check                  whether the page is what the numbers say

Each experiment draws a truth, runs it on a finer mesh than the fit uses, adds 2 % of noise to μ* and the frequency at 8 speeds, and lets
the program find the region. FOLDER keeps the databases, so that an interrupted run goes on. Experiments 0 to 9 are also solved by least
squares (Levenberg and Marquardt), with the same mesh and the same data.
"""

import csv
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import evidence
import runs

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "docs/evidence/calibration.csv"
PAGE = ROOT / "docs/evidence/calibration_proof.md"

EXPERIMENTS = 40
SPEEDS_RPM = [3.5, 5, 7, 10, 14, 20, 28, 40]
NOISE = 0.02
FIT = [20, 24, 16]
TRUE = [30, 36, 24]
# Lower and upper end; all are drawn from equal ratios but for μ.
RANGES = {
    "mu": ("uniform", 0.3, 0.6),
    "young_modulus_pa": ("log_uniform", 1.0e9, 4.0e9),
    "beta_r_s": ("log_uniform", 7.0e-8, 2.5e-7),
    "holder_stiffness_y_n_m": ("log_uniform", 2.0e6, 5.0e7),
}
# Free parameters of the experiments, in turn: 24 with two, 10 with three, 6 with four.
FREE = (
    [["mu", "young_modulus_pa"]] * 12
    + [["mu", "beta_r_s"]] * 6
    + [["young_modulus_pa", "beta_r_s"]] * 6
    + [["mu", "young_modulus_pa", "beta_r_s"]] * 6
    + [["mu", "young_modulus_pa", "holder_stiffness_y_n_m"]] * 4
    + [list(RANGES)] * 6
)
# The holder of those with one; its stiffness is free.
HOLDER = {"mass_kg": 0.005, "stiffness_y_n_m": 1.0e7, "damping_y_n_s_m": 20.0}
FIXED = {"mu": 0.45, "young_modulus_pa": 2.0e9, "beta_r_s": 2.0e-7}
LEAST_SQUARES = 10
COLUMNS = [
    "number", "free", "inside", "share", "points", "jobs", "implausibility", "best_error", "least_squares_points", "least_squares_error", "version",
]


def study(name, free, elements):
    """A study of the scene of the paper with these free parameters."""
    scene = {
        "pin": {"elements": elements, "young_modulus_pa": FIXED["young_modulus_pa"]},
        "contact": {"mu": FIXED["mu"]},
        # A strip that ends at a row of nodes of all meshes.
        "clamp": {"side": "inner_side", "width_m": 0.0024},
    }
    if "holder_stiffness_y_n_m" in free:
        scene["holder"] = HOLDER
    of = {name: {RANGES[name][0]: list(RANGES[name][1:])} for name in free}
    numerics = {"precision": "single", "safety_factor": 0.7, "beta_r_s": FIXED["beta_r_s"]}
    return {
        "name": name, "scene": scene, "numerics": numerics, "run": {"start": "nested"},
        "detection": {"tolerance": 0.01, "drift_tolerance": 0.001},
        "samples": {"design": "sobol", "count": 1, "of": of},
        "grid": {"omega_rpm": SPEEDS_RPM},
    }


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode not in (0, 2):
        sys.exit(f"{' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def truth(free, number):
    """The true values: inside the middle 90 % of each range."""
    draw = random.Random(f"truth {number}")
    values = {}
    for name in free:
        kind, low, high = RANGES[name]
        u = 0.05 + 0.9 * draw.random()
        x = low + u * (high - low) if kind == "uniform" else low * (high / low) ** u
        values[name] = float(f"{x:.4g}")
    return values


def solve(program, folder, db, name, free, elements, values):
    """The results at all speeds: (speed, μ*, frequency or None)."""
    file = folder / f"{name}.json"
    content = study(name, free, elements)
    del content["samples"]
    file.write_text(json.dumps(content))
    settings = [argument for key, x in values.items() for argument in ("--set", f"{key}={x!r}")]
    run(program, "run", file, "--db", db, "--out", folder / "out", "--replace", *settings)
    rows = csv.DictReader(run(program, "export", name, "--db", db).splitlines())
    found = []
    for row in rows:
        if row["status"] in ("periodic", "decayed"):
            hz = float(row["frequency_hz"]) if row["status"] == "periodic" else None
            found.append((float(row["omega_rpm"]), float(row["mu_star"]), hz))
    return found


def measured(points, number, file):
    """Writes the points with noise. Returns them."""
    draw = random.Random(f"noise {number}")
    lines = ["omega_rpm,mu_star,mu_star_error,frequency_hz,frequency_error_hz,squeals"]
    noisy = []
    for omega, mu_star, hz in points:
        m = mu_star * (1 + NOISE * draw.gauss(0, 1))
        f = hz and hz * (1 + NOISE * draw.gauss(0, 1))
        noisy.append((omega, m, f))
        of_f = f"{f:.6g},{NOISE * f:.4g},yes" if f else ",,no"
        lines.append(f"{omega},{m:.5g},{NOISE * m:.4g},{of_f}")
    file.write_text("\n".join(lines) + "\n")
    return noisy


def place(name, x):
    kind, low, high = RANGES[name]
    return (x - low) / (high - low) if kind == "uniform" else math.log(x / low) / math.log(high / low)


def value(name, u):
    kind, low, high = RANGES[name]
    return low + u * (high - low) if kind == "uniform" else low * (high / low) ** u


def linear(matrix, right):
    """Solves a small linear system by elimination."""
    n = len(right)
    rows = [row[:] + [r] for row, r in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][k] * x[k] for k in range(i + 1, n))) / rows[i][i]
    return x


def least_squares(program, folder, number, free, data):
    """The values of Levenberg and Marquardt's method from the middle of the ranges, and the points that it ran."""
    points = 0

    def residuals(u):
        nonlocal points
        points += 1
        db = folder / f"least_squares_{number}.db"
        values = {name: float(f"{value(name, x):.6g}") for name, x in zip(free, u)}
        own = {omega: (m, f) for omega, m, f in solve(program, folder, db, "ls", free, FIT, values)}
        found = []
        for omega, m, f in data:
            mu_star, hz = own.get(omega, (None, None))
            found.append(10.0 if mu_star is None else (mu_star - m) / (NOISE * m))
            if f:
                found.append(10.0 if hz is None else (hz - f) / (NOISE * f))
        return found

    u = [0.5] * len(free)
    r = residuals(u)
    damping = 1.0e-2
    for _ in range(12):
        step = 0.02
        columns = []
        for k in range(len(u)):
            shifted = u[:]
            shifted[k] += step if u[k] < 0.9 else -step
            columns.append([(b - a) / (shifted[k] - u[k]) for a, b in zip(r, residuals(shifted))])
        normal = [[sum(a * b for a, b in zip(x, y)) for y in columns] for x in columns]
        gradient = [sum(a * b for a, b in zip(x, r)) for x in columns]
        better = False
        for _ in range(4):
            damped = [[x * (1 + damping * (i == j)) for j, x in enumerate(row)] for i, row in enumerate(normal)]
            move = linear(damped, gradient)
            trial = [min(1.0, max(0.0, a - b)) for a, b in zip(u, move)]
            own = residuals(trial)
            if sum(x * x for x in own) < sum(x * x for x in r):
                change = max(abs(a - b) for a, b in zip(u, trial))
                u, r, damping, better = trial, own, damping / 5, True
                break
            damping *= 8
        if not better or change < 2.0e-3:
            break
    return {name: value(name, x) for name, x in zip(free, u)}, points


def experiment(program, folder, number, with_least_squares):
    free = FREE[number]
    values = truth(free, number)
    points = solve(program, folder, folder / "truth.db", f"truth{number}", free, TRUE, values)
    data = folder / f"data{number}.csv"
    noisy = measured(points, number, data)
    key = "-".join(free)
    file = folder / f"fit{number}.json"
    content = study(f"fit{number}", free, FIT)
    del content["grid"]
    file.write_text(json.dumps(content, indent=1))
    # One database for each set of free parameters: the first points are the same jobs.
    at = ",".join(f"{name}={x!r}" for name, x in values.items())
    answer = json.loads(run(program, "calibrate", file, "--data", data, "--db", folder / f"{key}.db",
                            "--out", folder / f"out{number}", "--json", "--replace", "--at", at))
    (folder / f"answer{number}.json").write_text(json.dumps({"truth": values, **answer}, indent=1))
    inside = not answer["at"]["ruled_out"]
    error = lambda best: max(abs(place(name, best[name]) - place(name, values[name])) for name in free)
    row = {
        "number": number, "free": " ".join(free), "inside": "yes" if inside else "no",
        "share": f"{1 - answer['ruled_out']:.3g}", "points": answer["points"], "jobs": answer["jobs"],
        "implausibility": f"{answer['at']['implausibility']:.3g}",
        "best_error": f"{error(answer['best']):.3f}" if answer["best"] else "",
        "version": run(program, "--version").split()[1],
    }
    if with_least_squares:
        best, solves = least_squares(program, folder, number, free, noisy)
        row |= {"least_squares_points": solves, "least_squares_error": f"{error(best):.3f}"}
    return row


def again(number):
    """Runs an experiment with two free parameters again; the others take hours. Ends with `DIFFERS` if its answer is not the kept one."""
    runs.build()
    short = [row for row in rows() if len(row["free"].split()) == 2]
    kept = short[number % len(short)]
    with tempfile.TemporaryDirectory() as folder:
        found = experiment(str(runs.PROGRAM), Path(folder), int(kept["number"]), False)
    names = ["free", "inside", "share", "points", "jobs", "implausibility", "best_error"]
    texts = {name: str(found[name]) for name in names}
    print(f"experiment {kept['number']}: {', '.join(f'{name} {texts[name]}' for name in names)}")
    differ = runs.differences(f"experiment {kept['number']}", {name: kept[name] for name in names}, texts)
    runs.end_again("calibration_proof", number % len(short), len(short), differ)


def rows():
    if not TABLE.exists():
        return []
    with TABLE.open() as file:
        return list(csv.DictReader(file))


def write(all_rows):
    all_rows = sorted(all_rows, key=lambda row: int(row["number"]))
    with TABLE.open("w") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(all_rows)


KINDS = {2: "two", 3: "three", 4: "four"}
# What is asked of the answers: points by the number of free parameters, share of the ranges with two.
MOST_POINTS = {2: 60, 3: 105, 4: 150}


def middle(values):
    values = sorted(values)
    return values[len(values) // 2]


def page(all_rows):
    """The page, from the kept numbers."""
    inside = [row for row in all_rows if row["inside"] == "yes"]
    lines = [
        "# Calibrations whose truth is known",
        "",
        "Written by `scripts/calibration.py` from [calibration.csv](calibration.csv), which the same script fills from runs; do not edit.",
        "",
        f"[`calibrate`](../calibrate.md) was given {len(all_rows)} synthetic experiments. **The truth was inside the region in {len(inside)} of them**.",
        "",
        f"Each experiment draws a truth from the ranges below, runs it at {len(SPEEDS_RPM)} speeds on {' × '.join(map(str, TRUE))} elements, and adds normal noise",
        f"of {100 * NOISE:.0f} % to μ\\* and to the frequency. The fit has {' × '.join(map(str, FIT))} elements, no discrepancy, and the usual settings. The scene is that of the paper with a clamp of",
        "2.4 mm; experiments with a free holder have a spring-held clamp.",
        "",
        "| parameter | range |",
        "| --- | --- |",
    ]
    lines += [f"| `{name}` | {low:g} to {high:g}{', equal ratios' if kind == 'log_uniform' else ''} |" for name, (kind, low, high) in RANGES.items()]
    lines += [
        "",
        "| free parameters | experiments | truth inside | share left: median | largest | points: median | most |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    sets = list(dict.fromkeys(row["free"] for row in all_rows))
    for free in sets:
        own = [row for row in all_rows if row["free"] == free]
        shares, points = [float(row["share"]) for row in own], [int(row["points"]) for row in own]
        hits = sum(row["inside"] == "yes" for row in own)
        names = ", ".join(f"`{name}`" for name in free.split())
        lines.append(
            f"| {names} | {len(own)} | {hits} | {100 * middle(shares):.2g} % | {100 * max(shares):.2g} % | {middle(points)} | {max(points)} |"
        )
    for count, word in KINDS.items():
        own = [row for row in all_rows if len(row["free"].split()) == count]
        if own:
            most = max(int(row["points"]) for row in own)
            small = sum(float(row["share"]) <= 0.1 for row in own)
            lines += ["", f"With {word} free parameters at most {most} points were run, and at most a tenth of the ranges was left in {small} of {len(own)}."]
    wide = [row["free"].split() for row in all_rows if len(row["free"].split()) == 2 and float(row["share"]) > 0.1]
    if wide and all("beta_r_s" in free for free in wide):
        lines += ["", "With two free parameters, more than a tenth was left only where `beta_r_s` is one of them."]
    out = [row for row in all_rows if row["inside"] != "yes"]
    if out:
        words = "; ".join(
            f"experiment {row['number']} ({row['free'].replace(' ', ', ')}): implausibility {row['implausibility']}, {100 * float(row['share']):.2g} % left"
            for row in out
        )
        lines += ["", f"The truth was ruled out in: {words}."]
    own = [row for row in all_rows if row["least_squares_points"]]
    if own:
        lines += [
            "",
            "## Beside least squares",
            "",
            "The same data and the same mesh, with the method of Levenberg and Marquardt from the middle of the ranges (differences of 2 % of a range). Errors are the",
            "largest distance of a parameter from the truth, as a share of its range. Least squares give one point and say nothing of what else explains the data.",
            "",
            "| experiment | best run: points | error | least squares: points | error |",
            "| --- | --- | --- | --- | --- |",
        ]
        lines += [
            f"| {row['number']} | {row['points']} | {row['best_error']} | {row['least_squares_points']} | {row['least_squares_error']} |" for row in own
        ]
    return "\n".join(lines) + "\n"


def write_page():
    for name, text in evidence.with_part("calibration_proof", page(rows())).items():
        (PAGE.parent / name).write_text(text)


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["again"]:
        again(int(arguments[1]))
    if arguments[:1] == ["--check"] or not arguments:
        if not arguments:
            write_page()
        for name, text in evidence.with_part("calibration_proof", page(rows())).items():
            if (PAGE.parent / name).read_text() != text:
                sys.exit(f"docs/evidence/{name} is not what docs/evidence/calibration.csv says: run scripts/calibration.py")
        return
    program, folder = str(Path(arguments[0]).resolve()), Path(arguments[1])
    count = int(arguments[2]) if len(arguments) > 2 else EXPERIMENTS
    folder.mkdir(parents=True, exist_ok=True)
    known = rows()
    # Each set of free parameters in turn, so that an interrupted run has some of all.
    order = sorted(range(EXPERIMENTS), key=lambda number: FREE[:number].count(FREE[number]))
    for number in order[:count]:
        if any(int(row["number"]) == number for row in known):
            continue
        row = experiment(program, folder, number, number < LEAST_SQUARES)
        print(row, flush=True)
        known.append(row)
        write(known)
    evidence.stamp("calibration_proof")
    write_page()


if __name__ == "__main__":
    main()
