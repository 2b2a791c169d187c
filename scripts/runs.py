"""Shared by the documentation scripts: build the program, run studies, read their results.

Needs only Python's standard library. Results are kept in target/docs/docs.db, so a script that is
run again computes only what is new.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import evidence

ROOT = Path(__file__).resolve().parent.parent
EVIDENCE = ROOT / "docs" / "evidence"
WORK = ROOT / "target" / "docs"
PROGRAM = ROOT / "target" / "release" / "tribosweep"


def build():
    subprocess.run(["cargo", "build", "--release", "--quiet"], cwd=ROOT, check=True)
    WORK.mkdir(parents=True, exist_ok=True)


def tribosweep(*arguments, database="docs.db", check=True, timeout_s=None):
    """Runs the program in the work folder and returns what it prints. Without `check` it may fail."""
    environment = dict(os.environ, TRIBOSWEEP_DB=str(WORK / database))
    done = subprocess.run(
        [PROGRAM, *arguments], cwd=WORK, env=environment, check=check, stdout=subprocess.PIPE, text=True, timeout=timeout_s
    )
    return done.stdout


def sweep(study, database="docs.db", options=(), fails=False):
    """Runs a study (a path below the repository, or a dictionary with a name) and returns its rows. With `fails`, jobs may fail."""
    if isinstance(study, dict):
        path = WORK / f"{study['name']}.json"
        path.write_text(json.dumps(study, indent=2))
    else:
        path = ROOT / study
    # The work folder is that of the scripts, and may have the study of an earlier version of the solver.
    tribosweep("run", str(path), "--replace", *options, database=database, check=not fails)
    return exported(str(path), database)


def exported(study, database):
    """The rows of a study."""
    lines = tribosweep("export", study, "--all", "--format", "json", database=database).splitlines()
    rows = [json.loads(line) for line in lines]
    for row in rows:
        row["elements"] = [row[f"elements_{axis}"] for axis in "xyz"]
    return rows


def shipped(study, /, **changes):
    """A shipped study as a dictionary, with top-level members replaced."""
    study = json.loads((ROOT / "studies" / f"{study}.json").read_text())
    study.update(changes)
    return study


def record(study, **settings):
    """The whole record of one job."""
    return json.loads(tribosweep("solve", str(ROOT / study), *set_arguments(settings), "--json"))


def history(study, **settings):
    """The time history of one job as a dictionary of columns."""
    path = WORK / "history.csv"
    tribosweep("solve", str(ROOT / study), *set_arguments(settings), "--history", str(path))
    header, *lines = path.read_text().splitlines()
    columns = {name: [] for name in header.split(",")}
    for line in lines:
        for name, cell in zip(columns, line.split(",")):
            columns[name].append(cell if name.endswith("_state") else float(cell))
    return columns


def set_arguments(settings):
    return [argument for name, value in settings.items() for argument in ("--set", f"{name}={value}")]


def table(header, rows):
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def empty_database(name):
    """Builds the program and removes a database, so that everything in it is computed anew. Returns its name."""
    build()
    for old in WORK.glob(f"{name}*"):
        old.unlink()
    return name


def differences(where, kept, found):
    """Prints which results are not the kept ones. Both are dictionaries of texts by name. Returns how many differ."""
    differ = [name for name in kept if found[name] != kept[name]]
    for name in differ:
        print(f"{where}: {name} is {found[name] or 'unknown'}; the kept value is {kept[name] or 'unknown'}")
    return len(differ)


def end_again(part, number, count, differ):
    """Ends a script that has computed one of the `count` samples of its part again, with the code that says whether a result differs."""
    if differ:
        sys.exit(evidence.DIFFERS)
    evidence.stamp_again(part, number, count)
    evidence.write()
    sys.exit(0)


def write(part, text):
    """Puts a part into its page of docs/evidence, with its claims and what it was made with."""
    evidence.stamp(part)
    for name, content in evidence.with_part(part, text).items():
        path = EVIDENCE / name
        path.write_text(content)
        print(f"written: {path.relative_to(ROOT)}")
    evidence.write()
