#!/usr/bin/env python3
"""Writes docs/evidence/verification.md, docs/evidence/verification_cases.csv and docs/evidence/verification_rows.csv: runs the whole verification suite
and tabulates the evidence that it leaves."""

import collections
import csv
import json
import os
import re
import shutil
import statistics
import subprocess

import runs

EVIDENCE = runs.WORK / "verification"

# The benchmarks in order, with what they are; cases outside of the list are an error.
BENCHMARKS = {
    "B1": "Free block: eigenfrequencies",
    "B2": "Bar and confined column: discrete and continuous spectrum",
    "B3": "β₂ integrator: damping, frequency, limit",
    "B4a": "Bar on a rigid wall (Saint-Venant)",
    "B4b": "Two elastic bodies hit each other (Runcie)",
    "B5": "Bouncing bar, two impacts (Doyen)",
    "B6": "Clamped–free bar, periodic impact",
    "B7": "Rigid block and wedge under friction",
    "B8": "Oscillator on a belt",
    "B9": "Mode coupling with two degrees of freedom",
    "B10": "Dynamic friction bar (stick–slip front)",
    "B11": "Quasi-static friction bar (hysteresis loop)",
    "B12": "Shear column on a moving plane",
    "B13": "Constant-stress patch",
    "B14": "Partial slip",
    "B15": "Invariances and identities",
    "B16": "Frequency estimators",
    "B17": "Friction laws: a mass on a belt",
    "B18": "Hertz: a crowned base",
    "B19": "A holder between pin and frame",
    "B20": "A rough base",
    "B21": "A disk with run-out and waviness",
    "B22": "A compliant contact layer",
    "B23": "General meshes: cylinders, tilt, regions",
    "B24": "Elements that bend: Cook's membrane",
    "B35": "Large strains: cantilever",
    "B36": "Plasticity: tube under pressure, Taylor's bar",
    "Flutter": "Linear flutter of the pin",
    "R1": "Ring: eigenfrequencies",
    "R2": "Ring: static deflection",
    "R3": "Ring: rigid motions and linear fields",
    "R4": "Elastic disk: two clocks",
    "R5": "Elastic disk: contact",
}

NOT_VERIFIED = """\
## What is not verified

* **Curved bodies**: the top of the disk is plane before it deforms. The base of the pin may be curved (B18, B20), as a gap;
  there is no Cattaneo–Mindlin partial slip between identical bodies.
* **The patch test of non-matching meshes** is failed, as it is by any one-pass node-to-surface contact: nodal forces are
  off by up to a fifth beside the interface, whatever the mesh; the displacements converge.
* **The limit cycle itself** has no exact answer. Its balance laws are checked here, its agreement with an independent
  solver in [paper.md](paper.md), its dependence on mesh and step in [accuracy.md](accuracy.md).
* **The singular stress at the edges of the base**: no exact answer is asserted for a fixed mesh, and it does not
  converge with the mesh.
"""


def number(value):
    if value is None:
        return ""
    if value == 0 or 1e-3 <= abs(value) < 1e6:
        return f"{value:.7g}"
    return f"{value:.5e}"


def observed(case):
    convergence = case["convergence"]
    if "orders" in convergence:
        orders = ", ".join(f"{order:.2f}" for order in convergence["orders"])
        return f"{orders}; limit off by {abs(convergence['limit_error']):.1e} ({convergence['limit_allowed']:.1e} allowed)"
    if "overall_order" in convergence:
        return f"{convergence['overall_order']:.2f} overall"
    return ""


def kind(case):
    """The criterion of a case without its reason."""
    words = case["criterion"].split(":")[0].split()
    return " ".join(f"{float(word):.3g}" if "." in word else word for word in words)


def finest_or_largest(case):
    """The error of the finest resolution, where a case converges; otherwise the largest error of its rows."""
    rows = case["rows"]
    return rows[-1]["error"] if case["convergence"] else max(row["error"] for row in rows)


def summary(cases):
    """A line for each benchmark."""
    lines = []
    for benchmark, title in BENCHMARKS.items():
        own = [case for name, case in cases if name == benchmark]
        if not own:
            lines.append([benchmark, title, 0, 0, "see *What is not verified*", ""])
            continue
        counts = collections.Counter(map(kind, own))
        criteria = ", ".join(f"{count} {criterion}" for criterion, count in sorted(counts.items()))
        median = statistics.median(finest_or_largest(case) for case in own)
        lines.append([benchmark, title, len(own), sum(len(case["rows"]) for case in own), criteria, f"{median:.1e}"])
    return runs.table(["benchmark", "problem", "cases", "rows", "criteria", "median error"], lines)


def write_cases(cases):
    """A line for each case."""
    with open(runs.EVIDENCE / "verification_cases.csv", "w", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(["benchmark", "quantity", "criterion", "source", "rows", "error", "observed_order"])
        for benchmark, case in cases:
            error = f"{finest_or_largest(case):.2e}"
            lines.writerow([benchmark, case["quantity"], case["criterion"], case["source"], len(case["rows"]), error, observed(case)])


def write_rows(cases):
    """A line for each resolution of each case."""
    with open(runs.EVIDENCE / "verification_rows.csv", "w", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(["benchmark", "quantity", "resolution", "found", "exact", "error", "bound"])
        for benchmark, case in cases:
            for row in case["rows"]:
                bound = "" if row["bound"] is None else f"{row['bound']:.1e}"
                found, exact = number(row["found"]), number(row["exact"])
                lines.writerow([benchmark, case["quantity"], row["resolution"], found, exact, f"{row['error']:.2e}", bound])


def run_suite():
    shutil.rmtree(EVIDENCE, ignore_errors=True)
    EVIDENCE.mkdir(parents=True)
    done = subprocess.run(
        ["cargo", "test", "--release", "--test", "mechanics", "--test", "references", "--no-fail-fast", "--", "--include-ignored", "verification::"],
        cwd=runs.ROOT, env=dict(os.environ, TRIBOSWEEP_VERIFICATION=str(EVIDENCE)), stdout=subprocess.PIPE, text=True,
    )
    results = re.findall(r"(\d+) passed; (\d+) failed", done.stdout)
    if len(results) != 2:
        raise SystemExit(f"{done.stdout}\ncargo test has {len(results)} results instead of those of two programs")
    passed, failed = (sum(int(counts[at]) for counts in results) for at in (0, 1))
    if failed:
        print(done.stdout)
    return passed, failed


def gather():
    """The cases in the order of the benchmarks."""
    order = list(BENCHMARKS)
    cases = [json.loads(path.read_text()) for path in EVIDENCE.glob("*.json")]
    unknown = {case["benchmark"] for case in cases} - set(order)
    if unknown:
        raise SystemExit(f"benchmarks without a title in this script: {sorted(unknown)}")
    return sorted(((case["benchmark"], case) for case in cases), key=lambda pair: (order.index(pair[0]), pair[1]["quantity"]))


def main():
    runs.build()
    passed, failed = run_suite()
    cases = gather()
    write_cases(cases)
    write_rows(cases)
    runs.write(
        "verification",
        "# Verification against exact answers\n\n"
        "Written by `scripts/verification.py`; do not edit. It runs `cargo test --release --test mechanics --test\n"
        "references -- --include-ignored verification::`; every case below is asserted there, under one of the criteria that\n"
        "`tests/verification/evidence.rs` defines: *exact* (only rounding, with a count of operations), *order* (the\n"
        "observed order within 0.25 of that of the analysis, and the extrapolated limit as close to the exact answer as\n"
        "two extrapolations are to each other), *order overall* (slope from the coarsest to the finest), *bounded* (a\n"
        "bound derived for that resolution). The problem, its derivation and source are in the head comment of each file\n"
        "under `tests/verification/`.\n\n"
        f"{passed} tests passed, {failed} failed; {len(cases)} cases with {sum(len(c['rows']) for _, c in cases)} rows. Errors are relative.\n"
        "[verification_cases.csv](verification_cases.csv) has a line for each case: its criterion, the source of the exact\n"
        "answer, the error of its finest resolution (where it does not converge, the largest error) and the observed order.\n"
        "[verification_rows.csv](verification_rows.csv) has each resolution: found, exact, error, and the bound if there is one.\n"
        "The median error below is the median over the cases of a benchmark. Criteria with *order* shrink with the mesh or the\n"
        "step, so their error says how fine the test is, and not how wrong the program.\n\n"
        + summary(cases) + "\n" + NOT_VERIFIED,
    )
    raise SystemExit(1 if failed else 0)


if __name__ == "__main__":
    main()
