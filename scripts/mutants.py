#!/usr/bin/env python3
"""Shows that wrong programs are caught by named tests.

scripts/mutants.toml lists the mutants. A mutant is an error that is made on purpose in one place of the sources, and it
names the test that must fail. The script copies the tracked files to target/mutants/source and runs the named tests on
the unchanged copy, where they must pass. Then it makes one error at a time and runs the test of that mutant. A mutant is
killed if its test fails, and it survives if its test passes. It is an error if the mutant does not compile, or if its
test gives no result within the time limit. The builds in target/mutants/target are kept for the next run.

The exit code is 0 if all mutants are killed, or if --check finds nothing wrong. Otherwise it is 1. The script needs git,
cargo and Python 3.11.
"""

import argparse
import contextlib
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "target/mutants/source"
BUILDS = ROOT / "target/mutants/target"
# The tests of the unchanged copy run together, and their first build compiles all dependencies.
UNCHANGED_LIMIT_S, MUTANT_LIMIT_S = 60 * 60, 15 * 60
KILLED = "killed"
# The tests inside the sources, as the target of a mutant.
UNITS = "--test *_units"


class Mutant(NamedTuple):
    """One entry of the list, whose head describes the fields."""

    area: str
    name: str
    file: str
    old: str
    new: str
    target: str
    test: str


def has_test(mutant):
    """Whether the module of the test has a function of that name."""
    *modules, function = mutant.test.split("::")
    if function == "in_a_file":
        # A test that runs on both databases is a module, in which each database has a function.
        function = modules.pop()
    if mutant.target == UNITS:
        # The queue is a folder of src, and it is one room.
        crates = [ROOT / folder / "lib.rs" for folder in ("src", "src/application", "src/mechanics", "src/output")]
    else:
        program = ROOT / "tests" / mutant.target[7:]
        crates = [program.with_suffix(".rs"), program / "main.rs"]
    # The first modules are files, and the others are inside the last of these files.
    for depth in range(len(modules), -1, -1):
        for crate in crates:
            path = crate.parent.joinpath(*modules[:depth])
            for file in [path.with_suffix(".rs"), path / "mod.rs"] if depth else [crate]:
                if file.is_file():
                    names = [rf"\bmod {module}\b" for module in modules[depth:]] + [rf"\bfn {function}\b"]
                    return all(re.search(name, file.read_text()) for name in names)
    return False


def problems(mutant, names):
    """What is wrong with an entry of the list. `names` are the names of all entries."""
    file = ROOT / mutant.file
    count = file.read_text().count(mutant.old) if file.is_file() else 0
    if count != 1:
        yield f"{mutant.file}: the text to change occurs {count} times"
    if mutant.old == mutant.new:
        yield "the replacement is the text itself"
    if names.count(mutant.name) != 1:
        yield "another mutant has this name"
    if mutant.target != UNITS and not re.fullmatch(r"--test \w+", mutant.target):
        yield f"{mutant.target}: expected {UNITS}, or --test and a name"
    elif not has_test(mutant):
        yield f"{mutant.target}: there is no test {mutant.test}"


def copy_sources():
    """Copies the tracked files. They get new times, so that cargo does not take the build of a mutant for theirs."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    for name in filter(None, listed.split("\0")):
        # Files, and links to folders.
        if (ROOT / name).exists():
            (SOURCE / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, SOURCE / name, follow_symlinks=False)


def run_tests(target, tests, limit_s):
    """Runs tests in the copy. Returns the output of the tests and that of cargo, or none after the time limit."""
    # These variables name tools and folders. Without them, the tests need nothing but this machine.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("TRIBOSWEEP_")}
    environment["CARGO_TARGET_DIR"] = str(BUILDS)
    # A mutant may name another compiler, which must not be used.
    environment["RUSTUP_TOOLCHAIN"] = tomllib.loads((ROOT / "rust-toolchain.toml").read_text())["toolchain"]["channel"]
    command = ["cargo", "test", "--locked", *target.split(), "--", "--color=never", "--exact", *tests]
    # A test that fails may leave processes behind. They would hold a pipe open, and the script would wait for them.
    with (
        tempfile.TemporaryFile("w+", errors="replace") as output,
        tempfile.TemporaryFile("w+", errors="replace") as messages,
    ):
        # cargo and its tests have a group of their own, so that they end together.
        process = subprocess.Popen(
            command, cwd=SOURCE, env=environment, stdout=output, stderr=messages, start_new_session=True
        )
        try:
            process.wait(timeout=limit_s)
        except subprocess.TimeoutExpired:
            return None
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        texts = []
        for file in (output, messages):
            file.seek(0)
            texts.append(file.read())
        return tuple(texts)


def result_of(test, output):
    """The word that the output has for the result of a test, or none."""
    found = re.search(rf"^test {re.escape(test)} \.\.\. (\w+)", output, re.MULTILINE)
    return found and found[1]


def reason_alive(test, done):
    """Why a mutant is alive. The text is empty if it is killed."""
    if done is None:
        return f"error: no result after {MUTANT_LIMIT_S // 60} min"
    output, messages = done
    result = result_of(test, output)
    if not re.search(r"^running \d+ tests?$", output, re.MULTILINE):
        first = re.search(r"^error.*\n?.*", messages, re.MULTILINE)
        return "error: does not compile: " + " ".join(first[0].split() if first else [])
    # The other programs of a package run no test. Their output has no result of this one.
    return {"FAILED": "", "ok": "survived: no test fails"}.get(result, "error: its test gave no result")


def passes_unchanged(mutants):
    """Runs the tests of the mutants on the unchanged copy. Returns whether all of them pass."""
    for target in dict.fromkeys(mutant.target for mutant in mutants):
        tests = list(dict.fromkeys(mutant.test for mutant in mutants if mutant.target == target))
        begun = time.monotonic()
        output, messages = run_tests(target, tests, UNCHANGED_LIMIT_S) or ("", "the time limit is over")
        wrong = [test for test in tests if result_of(test, output) != "ok"]
        print(f"{time.monotonic() - begun:6.1f} s  unchanged, {target}: {len(tests)} tests", flush=True)
        if wrong:
            print(f"{output}\n{messages}\nThese tests do not pass: {', '.join(wrong)}", flush=True)
            return False
    return True


def try_out(mutant):
    """Makes the error, runs the test, takes the error back, and prints the result. Returns why the mutant is alive."""
    begun, file = time.monotonic(), SOURCE / mutant.file
    text = file.read_text()
    file.write_text(text.replace(mutant.old, mutant.new))
    try:
        reason = reason_alive(mutant.test, run_tests(mutant.target, [mutant.test], MUTANT_LIMIT_S))
    finally:
        file.write_text(text)
    print(f"{time.monotonic() - begun:6.1f} s  {mutant.area}: {mutant.name}: {reason or KILLED}", flush=True)
    return reason


def cells(mutant):
    """The first cells of a mutant's row in the page. They change with its entry in the list, whose texts have a digest."""
    change = hashlib.sha256(f"{mutant.old}\0{mutant.new}".encode()).hexdigest()[:8]
    return f"| {mutant.area} | {mutant.name} | `{mutant.file}` | {change} | `{mutant.target}`: `{mutant.test}` |"


def earlier_results(mutants, page_file):
    """The results that a page has of mutants whose entries are as they were. The keys are the names of the mutants."""
    lines = page_file.read_text().splitlines() if page_file.is_file() else []
    rows = [(mutant, line) for mutant in mutants for line in lines if line.startswith(cells(mutant))]
    return {mutant.name: line.removeprefix(cells(mutant)).strip(" |") for mutant, line in rows}


def page(mutants, results):
    """The results as a Markdown page. `mutants` is the whole list, and `results` has the results by the names."""
    rows = [f"{cells(mutant)} {results[mutant.name]} |\n" for mutant in mutants if mutant.name in results]
    alive = [f"* {name}\n" for name, result in results.items() if result != KILLED]
    return f"""# Deliberately wrong programs

`scripts/mutants.py` writes this page. It makes one error at a time in the sources and runs one test. The error is caught
if this test fails. `scripts/mutants.toml` has the exact changes, and a digest stands for them here.
{len(rows)} of its {len(mutants)} errors were tried, and {len(rows) - len(alive)} of these were caught.

A row says what came out when its error was tried for the last time. It goes if the error or the name of its test has
changed since then. Other changes of the sources do not remove it.

| area | error | file | change | test that must fail | result |
|---|---|---|---|---|---|
{"".join(rows)}
## Survivors

{"".join(alive) or f"There are none."}
""".rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="a mutant to run; without names, all of them run")
    parser.add_argument("--check", action="store_true", help="compare the list with the sources, and build nothing")
    help_of_table = "write the results to a Markdown page, which keeps those of the mutants that do not run"
    parser.add_argument("--table", type=Path, metavar="FILE", help=help_of_table)
    options = parser.parse_args()
    mutants = [Mutant(**entry) for entry in tomllib.loads((ROOT / "scripts/mutants.toml").read_text())["mutant"]]
    names = [mutant.name for mutant in mutants]
    wrong = [f"{mutant.name}: {problem}" for mutant in mutants for problem in problems(mutant, names)]
    wrong += [f"{name}: there is no such mutant" for name in options.names if name not in names]
    if wrong or options.check:
        print("\n".join(wrong) or f"{len(mutants)} mutants, nothing wrong")
        return 1 if wrong else 0
    chosen = [mutant for mutant in mutants if not options.names or mutant.name in options.names]
    copy_sources()
    if not passes_unchanged(chosen):
        return 1
    results = earlier_results(mutants, options.table) if options.table else {}
    alive = 0
    for mutant in chosen:
        reason = try_out(mutant)
        results[mutant.name] = reason or KILLED
        alive += bool(reason)
        # The page has all results so far, if the script is stopped.
        if options.table:
            options.table.parent.mkdir(parents=True, exist_ok=True)
            options.table.write_text(page(mutants, results))
    print(f"{len(chosen) - alive} of {len(chosen)} mutants are killed")
    return 1 if alive else 0


if __name__ == "__main__":
    sys.exit(main())
