#!/usr/bin/env python3
"""Shows that the nightly check catches physics that is deliberately wrong.

    python3 scripts/nightly_mutants.py [--keep]

Copies the sources into target/mutants and runs scripts/nightly.sh there: on the unchanged copy, which must pass, and on
each mutant, which must be reported as a drift. Compiles the library once per mutant, which takes some minutes. Needs only
Python's standard library. Removes the copy unless --keep is given.
"""

import argparse
import csv
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COPY = ROOT / "target" / "mutants"
COPIED = ["Cargo.toml", "Cargo.lock", "build.rs", "src", "benches", "tests", "migrations", "studies", "scripts"]

# Name, file, text that must occur exactly once in the file, and its replacement.
MUTANTS = [
    ("friction cone 1 % too wide", "src/solver/contact/coulomb.rs",
     "    let limit = mu * normal_n;\n    let trial =",
     "    let limit = f64x8::splat(mu.simd, 1.01) * mu * normal_n;\n    let trial ="),
    ("friction cone a square instead of a circle", "src/solver/contact/coulomb.rs",
     "let trial = (trial_n[0] * trial_n[0] + trial_n[1] * trial_n[1]).sqrt();",
     "let (x, y) = (trial_n[0].abs(), trial_n[1].abs());\n    let trial = x.simd_gt(y).select(x, y);"),
    ("damping 5 % too strong", "src/solver/step.rs",
     "beta_r_s: model.beta_r_s(),", "beta_r_s: 1.05 * model.beta_r_s(),"),
    ("damping left out", "src/solver/step.rs",
     "beta_r_s: model.beta_r_s(),", "beta_r_s: 0.0 * model.beta_r_s(),"),
    ("time step 1 % shorter", "src/solver/model.rs",
     "TimeStep::FractionOfLimit(fraction) => fraction * limit,",
     "TimeStep::FractionOfLimit(fraction) => 0.99 * fraction * limit,"),
    ("load 0.5 % too high", "src/solver/state.rs",
     "if time_s >= self.ramp_s { self.force_n }", "if time_s >= self.ramp_s { 1.005 * self.force_n }"),
]


def copy():
    shutil.rmtree(COPY, ignore_errors=True)
    COPY.mkdir(parents=True)
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, COPY / name)
        elif source.exists():
            shutil.copy(source, COPY / name)


def nightly():
    """The exit code, and how often each figure drifted."""
    environment = dict(os.environ, CARGO_TARGET_DIR=str(COPY / "target"))
    done = subprocess.run(["scripts/nightly.sh"], cwd=COPY, env=environment, capture_output=True, text=True)
    table = COPY / "target" / "nightly" / "nightly.csv"
    if done.returncode not in (0, 1) or not table.exists():
        raise SystemExit(f"the nightly check itself failed ({done.returncode}): {done.stderr}")
    drifted = {}
    with open(table, newline="") as file:
        for line in csv.DictReader(file):
            if line["verdict"] != "ok":
                drifted[line["figure"]] = drifted.get(line["figure"], 0) + 1
    return done.returncode, drifted


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="leave the copy in target/mutants")
    options = parser.parse_args()
    copy()
    code, drifted = nightly()
    print(f"unchanged: exit code {code}, {drifted or 'no drift'}", flush=True)
    wrong = [] if code == 0 else ["unchanged"]
    for name, file, old, new in MUTANTS:
        path = COPY / file
        source = path.read_text()
        if source.count(old) != 1:
            raise SystemExit(f"{file}: the text to change for “{name}” occurs {source.count(old)} times")
        path.write_text(source.replace(old, new))
        code, drifted = nightly()
        path.write_text(source)
        print(f"{name}: exit code {code}, {drifted or 'no drift'}", flush=True)
        if code != 1:
            wrong.append(name)
    if not options.keep:
        shutil.rmtree(COPY)
    if wrong:
        raise SystemExit(f"FAILED: {', '.join(wrong)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
