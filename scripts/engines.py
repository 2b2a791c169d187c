#!/usr/bin/env python3
"""Runs a study with a SQLite file and with PostgreSQL and compares the results.

    cargo build --release
    python3 scripts/engines.py [--study studies/figure7.json] [--program FILE]

The exports must be identical except for the run times, and the figures must be identical. Then the study is copied from
PostgreSQL to a file and back to an empty database of the server: both exports must be identical, including the run times.
The script starts its own PostgreSQL server (scripts/postgres.sh). It needs only Python's standard library.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from comparing import check, timeless

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "target/release/tribosweep"))
    parser.add_argument("--study", default=str(ROOT / "studies/figure7.json"))
    options = parser.parse_args()
    # The commands run in a temporary folder, so the paths must be absolute.
    options.study, options.program = (str(pathlib.Path(path).resolve()) for path in (options.study, options.program))
    os.environ.pop("TRIBOSWEEP_DB", None)
    name = json.loads(pathlib.Path(options.study).read_text())["name"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        # PostgreSQL's user must be able to access its data.
        folder.chmod(0o755)

        def call(*arguments):
            done = subprocess.run([options.program, *arguments], cwd=folder, capture_output=True, text=True)
            check(done.returncode == 0, f"{' '.join(arguments)} ended with {done.returncode}: {done.stderr}")
            return done.stdout

        def swept(database, out):
            begun = time.monotonic()
            call("run", options.study, "--db", database, "--out", out)
            print(f"{out}: {time.monotonic() - begun:.1f} s")
            return call("export", name, "--db", database)

        postgres = str(ROOT / "scripts/postgres.sh")
        server = str(folder / "server")
        url = subprocess.run([postgres, "start", server], check=True, capture_output=True, text=True).stdout.strip()
        try:
            subprocess.run(["psql", url, "-qc", "CREATE DATABASE again"], check=True)
            again = url.rsplit("/", 1)[0] + "/again"
            in_a_file, on_a_server = swept("study.db", "file"), swept(url, "server")
            jobs = len(timeless(in_a_file)) - 1
            check(timeless(in_a_file) == timeless(on_a_server), "the exports differ")
            figures = sorted(path.name for path in (folder / "file").glob("*.svg") if "time" not in path.name)
            for figure in figures:
                same = (folder / "file" / figure).read_bytes() == (folder / "server" / figure).read_bytes()
                check(same, f"{figure} differs")
            print(f"{jobs} jobs: the exports are identical except for the run times, and so are {', '.join(figures)}")
            call("copy", "--from", url, "--to", "copied.db")
            call("copy", "--from", "copied.db", "--to", again)
            for database in ["copied.db", again]:
                check(call("export", name, "--db", database) == on_a_server, f"the copy in {database} differs")
            print("copied to a file and back to a server: identical")
        finally:
            subprocess.run([postgres, "stop", server], check=True)
    print("all held")


if __name__ == "__main__":
    sys.exit(main())
