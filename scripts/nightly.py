#!/usr/bin/env python3
"""Compares an export of the mini study with its reference values.

    python3 scripts/nightly.py JOBS.csv FOLDER      compare; writes FOLDER/summary.md and FOLDER/nightly.csv
    python3 scripts/nightly.py JOBS.csv --accept    make these the reference values

The reference is scripts/nightly_reference.csv. It is not the truth, because the mesh is coarse: it is what this program
computed when it was accepted. Whoever accepts new values says why in the commit. Needs only Python's standard library.
"""

import csv
import sys
from pathlib import Path

REFERENCE = Path(__file__).resolve().parent / "nightly_reference.csv"

# The moment at which a run is found periodic and stops may differ although the physics is the same. docs/accuracy.md
# ("What stopping early changes") has what this changes with the study's own detection settings. These are the largest
# changes there, over all meshes and steps.
MU_STAR = 0.124e-2
FREQUENCY = 0.016e-2
SHARE = 0.0005
# The step follows from mesh and material by the eigenvalues of small matrices: only rounding may change it.
TIME_STEP = 1e-9

# Figure: tolerance, and whether it is relative to the reference.
TOLERANCES = {
    "mu_star": (MU_STAR, True),
    "frequency_hz": (FREQUENCY, True),
    "stick_share": (SHARE, False),
    "slip_share": (SHARE, False),
    "separated_share": (SHARE, False),
    "time_step_s": (TIME_STEP, True),
}
SAME = ["status", "regime"]
POINT = ["omega_rpm", "mu"]
COLUMNS = POINT + SAME + list(TOLERANCES)


def broken(why):
    """Ends with another code than a drift does."""
    print(why, file=sys.stderr)
    sys.exit(2)


def read(path):
    """The lines of a table by their grid point."""
    try:
        with open(path, newline="") as file:
            lines = list(csv.DictReader(file))
    except OSError as error:
        broken(error)
    missing = set(COLUMNS) - set(lines[0] if lines else [])
    if missing:
        broken(f"{path}: no column {', '.join(sorted(missing))}")
    return {tuple(float(line[name]) for name in POINT): line for line in lines}


def compare_figure(name, found, expected):
    """(difference in words, whether it is within the tolerance, the tolerance in words)"""
    if name in SAME or not found or not expected:
        return ("", found == expected, "the same")
    tolerance, is_relative = TOLERANCES[name]
    difference = float(found) - float(expected)
    if is_relative:
        difference /= float(expected)
    unit = " relative" if is_relative else ""
    return (f"{difference:+.2e}", abs(difference) <= tolerance, f"{tolerance:g}{unit}")


def compare(found, reference):
    """One line per value: point, figure, reference, found, difference, tolerance, verdict."""
    lines = []
    for point in sorted(set(found) | set(reference)):
        if point not in found or point not in reference:
            where = "the reference" if point in found else "the sweep"
            lines.append([*point, "job", "", "", "", "", f"not in {where}"])
            continue
        for name in SAME + list(TOLERANCES):
            values = reference[point][name], found[point][name]
            difference, is_within, tolerance = compare_figure(name, values[1], values[0])
            lines.append([*point, name, *values, difference, tolerance, "ok" if is_within else "DRIFT"])
    return lines


def summary(lines, found):
    drifted = [line for line in lines if line[-1] != "ok"]
    text = ["# Nightly sweep\n"]
    verdict = f"**{len(drifted)} of {len(lines)} figures have drifted.**" if drifted else "No drift."
    text.append(f"{verdict} {len(found)} jobs, {len(lines)} figures compared with `scripts/nightly_reference.csv`.\n")
    if drifted:
        text.append("| ω [rpm] | μ | figure | reference | found | difference | tolerance |")
        text.append("| ---: | ---: | :--- | ---: | ---: | ---: | ---: |")
        for omega, mu, name, expected, value, difference, tolerance, verdict in drifted:
            what = name if name != "job" else verdict
            text.append(f"| {omega:g} | {mu:g} | {what} | {expected} | {value} | {difference} | {tolerance} |")
        text.append("")
    text.append("| ω [rpm] | μ | outcome | regime | μ\\* | f [Hz] | time [s] |")
    text.append("| ---: | ---: | :--- | :--- | ---: | ---: | ---: |")
    for (omega, mu), line in sorted(found.items(), key=lambda item: (item[0][1], item[0][0])):
        figures = [line["status"], line["regime"], rounded(line["mu_star"], 4), rounded(line["frequency_hz"], 0)]
        text.append(f"| {omega:g} | {mu:g} | {' | '.join(figures)} | {rounded(line['wall_s'], 2)} |")
    return "\n".join(text) + "\n"


def rounded(cell, digits):
    return f"{float(cell):.{digits}f}" if cell else "–"


def accept(found):
    with open(REFERENCE, "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows(found.values())


def main():
    if len(sys.argv) != 3:
        broken(__doc__)
    found = read(sys.argv[1])
    if sys.argv[2] == "--accept":
        accept(found)
        return 0
    folder = Path(sys.argv[2])
    lines = compare(found, read(REFERENCE))
    with open(folder / "nightly.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([*POINT, "figure", "reference", "found", "difference", "tolerance", "verdict"])
        table.writerows(lines)
    text = summary(lines, found)
    (folder / "summary.md").write_text(text)
    print(text, end="")
    return 1 if any(line[-1] != "ok" for line in lines) else 0


if __name__ == "__main__":
    sys.exit(main())
