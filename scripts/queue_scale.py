#!/usr/bin/env python3
"""Measures the run time and the peak memory of the commands for a study with many jobs.

    cargo build --release
    python3 scripts/queue_scale.py [--jobs 100000]
    cargo test --release --test sweeps -- --ignored --nocapture throughput

Submits a grid of small jobs and gives every job one of two solved records, and then measures the commands that read them.
The records are written directly to the database, so that no simulation is needed; the jobs in one corner of the grid are not
periodic. The second command measures claiming and finishing without a solver. The times depend on the machine and its other
load. The script needs only Python's standard library.
"""

import argparse
import json
import os
import pathlib
import sqlite3
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def study(jobs):
    rows = max(1, round(jobs**0.5))
    columns = -(-jobs // rows)
    return {
        "name": "scale",
        "scene": {"pin": {"elements": [6, 8, 5]}, "clamp": {"width_m": 0.002}, "load": {"ramp_s": 5e-4}},
        "grid": {
            "mu": {"from": 0.05, "to": 0.8, "count": rows},
            "omega_rpm": {"from": 1, "to": 100, "count": columns, "spacing": "log"},
        },
    }


def measured(program, folder, *arguments):
    """Standard output, wall time [s] and peak memory [MB] of a command."""
    begun = time.monotonic()
    with open(folder / "stdout", "w+") as out:
        process = subprocess.Popen([program, *arguments], cwd=folder, stdout=out, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begun
        if status != 0:
            raise SystemExit(f"{' '.join(arguments)} ended with {status}")
        out.seek(0)
        return out.read(), seconds, usage.ru_maxrss / 1000


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=100_000)
    parser.add_argument("--program", default=str(ROOT / "target/release/tribosweep"))
    options = parser.parse_args()
    os.environ.pop("TRIBOSWEEP_DB", None)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "scale.json").write_text(json.dumps(study(options.jobs)))
        settings = ["--set", "mu=0.4", "--set", "omega_rpm=7", "--json"]
        records = [
            measured(options.program, folder, "solve", "scale.json", *settings, "--set", f"limit_s={limit}")[0].strip()
            for limit in (0.02, 0.003)
        ]
        labels = [json.loads(record)["status"] for record in records]

        def tell(name, *arguments):
            _, seconds, megabytes = measured(options.program, folder, *arguments)
            print(f"{name:32} {seconds:8.2f} s {megabytes:8.0f} MB", flush=True)

        tell("validate", "validate", "scale.json")
        tell("submit (plan)", "submit", "scale.json")
        tell("submit again", "submit", "scale.json")
        tell("status, all pending", "status", "scale")
        database = sqlite3.connect(folder / "tribosweep.db")
        with database:
            database.execute("CREATE TEMP TABLE choice AS SELECT id, id % 317 > 300 AND id / 317 > 290 AS k FROM jobs")
            for k in (0, 1):
                database.execute(
                    "UPDATE jobs SET state = 'done', attempt = 1, label = ? WHERE id IN (SELECT id FROM choice WHERE k = ?)",
                    [labels[k], k],
                )
                database.execute(
                    "INSERT INTO results (job_id, attempt, record, wall_s, finished_ms)"
                    " SELECT id, 1, ?, 0.01, 0 FROM choice WHERE k = ?",
                    [records[k], k],
                )
        (jobs,) = database.execute("SELECT COUNT(*) FROM jobs").fetchone()
        database.close()
        tell("status of all studies", "status")
        tell("status of the study", "status", "scale")
        tell("export", "export", "scale", "--csv", "out.csv")
        tell("report", "report", "scale")
        tell("doctor", "doctor")
        tell("run, nothing left", "run", "scale.json")
        size = (folder / "tribosweep.db").stat().st_size / 1e6
        print(f"{jobs} jobs, database {size:.0f} MB")


if __name__ == "__main__":
    main()
