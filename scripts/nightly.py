#!/usr/bin/env python3
"""Compares exports of the mini study with their reference values.

    python3 scripts/nightly.py FOLDER               compare; writes FOLDER/summary.md and FOLDER/nightly.csv
    python3 scripts/nightly.py FOLDER --accept      make these the reference values

FOLDER has an export (`tribosweep export STUDY --all --csv jobs.csv`) in a folder for each sweep, which has the name of its study. The
reference is scripts/nightly_reference.csv. It is not the truth, because the meshes are coarse: it is what this program computed when it
was accepted. Whoever accepts new values says why in the commit. Needs only Python's standard library.
"""

import csv
import sys
from pathlib import Path

REFERENCE = Path(__file__).resolve().parent / "nightly_reference.csv"

# Double precision from rest. The moment at which a run is found periodic and stops may differ although the physics is the same.
# docs/evidence/accuracy.md ("What stopping early changes") has what this changes with the study's own detection settings. These are the largest
# changes there, over all meshes and steps. The step follows from mesh and material by the eigenvalues of small matrices: only
# rounding may change it. Each figure has its tolerance, and whether it is relative to the reference.
MINI = {
    "mu_star": (0.124e-2, True),
    "frequency_hz": (0.016e-2, True),
    "stick_share": (0.0005, False),
    "slip_share": (0.0005, False),
    "separated_share": (0.0005, False),
    "time_step_s": (1e-9, True),
}
# The way of the presets: single precision, a start from a coarser mesh, eigenvalues. A result has the same bits on every machine, so these may
# differ by the rounding of their text only. Growth rates of modes come from iterations, whose last digits depend on the order of sums in
# dense products; a millionth of the rate is a thousand times more than that and far below what matters.
STANDARD = {name: (1e-12, True) for name in MINI} | {"growth_rate_per_s": (1e-6, True)}
TOLERANCES = {"mini": MINI, "mini-standard": STANDARD}
# The last three say which way a job went.
SAME = ["status", "regime", "precision", "decided_by", "start_outcome"]
POINT = ["study", "omega_rpm", "mu"]
COLUMNS = POINT + SAME + list(STANDARD)


def broken(why):
    """Ends with another code than a drift does."""
    print(why, file=sys.stderr)
    sys.exit(2)


def read(path):
    """The lines of a table by their study and grid point."""
    try:
        with open(path, newline="") as file:
            lines = list(csv.DictReader(file))
    except OSError as error:
        broken(error)
    missing = set(COLUMNS) - set(lines[0] if lines else [])
    if missing:
        broken(f"{path}: no column {', '.join(sorted(missing))}")
    return {(line["study"], float(line["omega_rpm"]), float(line["mu"])): line for line in lines}


def compare_figure(study, name, found, expected):
    """(difference in words, whether it is within the tolerance, the tolerance in words)"""
    if name in SAME or not found or not expected:
        return ("", found == expected, "the same")
    tolerance, is_relative = TOLERANCES[study][name]
    difference = float(found) - float(expected)
    if is_relative and float(expected) != 0:
        difference /= abs(float(expected))
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
        for name in SAME + list(TOLERANCES[point[0]]):
            values = reference[point][name], found[point][name]
            difference, is_within, tolerance = compare_figure(point[0], name, values[1], values[0])
            lines.append([*point, name, *values, difference, tolerance, "ok" if is_within else "DRIFT"])
    return lines


def summary(lines, found):
    drifted = [line for line in lines if line[-1] != "ok"]
    text = ["# Nightly sweep\n"]
    verdict = f"**{len(drifted)} of {len(lines)} figures have drifted.**" if drifted else "No drift."
    text.append(f"{verdict} {len(found)} jobs, {len(lines)} figures compared with `scripts/nightly_reference.csv`.\n")
    if drifted:
        text.append("| study | ω [rpm] | μ | figure | reference | found | difference | tolerance |")
        text.append("| :--- | ---: | ---: | :--- | ---: | ---: | ---: | ---: |")
        for study, omega, mu, name, expected, value, difference, tolerance, verdict in drifted:
            what = name if name != "job" else verdict
            text.append(f"| {study} | {omega:g} | {mu:g} | {what} | {expected} | {value} | {difference} | {tolerance} |")
        text.append("")
    text.append("| study | ω [rpm] | μ | status | decided by | regime | μ\\* | f [Hz] | time [s] |")
    text.append("| :--- | ---: | ---: | :--- | :--- | :--- | ---: | ---: | ---: |")
    for (study, omega, mu), line in sorted(found.items(), key=lambda item: (item[0][0], item[0][2], item[0][1])):
        figures = [line["status"], line["decided_by"], line["regime"], rounded(line["mu_star"], 4), rounded(line["frequency_hz"], 0)]
        text.append(f"| {study} | {omega:g} | {mu:g} | {' | '.join(figures)} | {rounded(line['wall_s'], 2)} |")
    return "\n".join(text) + "\n"


def rounded(cell, digits):
    return f"{float(cell):.{digits}f}" if cell else "–"


def accept(found):
    with open(REFERENCE, "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows(found.values())


def main():
    folder, *options = sys.argv[1:] or [""]
    if not folder or options not in ([], ["--accept"]):
        broken(__doc__)
    folder = Path(folder)
    found = {point: line for study in TOLERANCES for point, line in read(folder / study / "jobs.csv").items()}
    unknown = {study for study, *_ in found} - set(TOLERANCES)
    if unknown:
        broken(f"{folder}: jobs of {', '.join(sorted(unknown))}; expected {' and '.join(TOLERANCES)}")
    if options:
        accept(found)
        return 0
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
