#!/usr/bin/env python3
"""Kills worker processes at random, then compares the export with that of an undisturbed run.

    cargo build --release
    python3 scripts/torture.py [--kills 300] [--workers 3] [--jobs 6000] [--seed 1] [--places 20]

Several processes work on one database. Repeatedly, one of them is killed (kill -9), paused, or interrupted. Sometimes the
database's files are copied while all processes are paused, and the copy is opened. Some processes save checkpoints of their
running jobs; most do not.

After each kill, all earlier results must exist unchanged. At the end, the export must be identical to that of an
undisturbed run except for the run times; each job must have one result; and the number of repeated jobs must not exceed the
number of jobs that the killed processes held. The script ends earlier when no job is left. It prints the counts and exits
with an error if a check fails. It needs only Python's standard library.

Then the database of a second sweep is attacked in its place, `--places` times: it is moved, deleted or replaced by another one
while workers have it open, its folder becomes read-only, or its disk fills up. Each worker must end with 2 and name the file
that has the results, which must be all there; a database that took the place must keep every byte; and at the end the export
must be that of the undisturbed run. Filling the disk and working as another user need root; what is left out is said.
"""

import argparse
import csv
import io
import json
import os
import pathlib
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
LANES = 8
FILES = ["tribosweep.db", "tribosweep.db-wal", "tribosweep.db-shm"]
# A job may be killed as often as the draw wants. With the usual limit, whoever takes such a job back lets it fail.
WORK = ["work", "--max-crashes", "1000000"]
# Room for a write-ahead log and for what is small.
ROOM_BYTES = 24_000_000


def study(jobs):
    """A grid of jobs that take some milliseconds. A thread advances LANES of them together."""
    speeds = [round(1.0 + 0.5 * k, 3) for k in range(max(1, jobs // 10))]
    return {
        "name": "torture",
        "scene": {"pin": {"elements": [3, 4, 3]}, "clamp": {"width_m": 0.004}},
        "run": {"limit_s": 0.1, "stop_early": False},
        "grid": {"mu": [round(0.05 * k, 3) for k in range(1, 11)], "omega_rpm": speeds},
    }


class Sweep:
    """A folder with the study and its database."""

    def __init__(self, program, folder, jobs):
        self.program, self.folder = program, pathlib.Path(folder)
        (self.folder / "torture.json").write_text(json.dumps(study(jobs)))

    def call(self, *arguments, folder=None):
        done = subprocess.run([self.program, *arguments], cwd=folder or self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"FAILED: {' '.join(arguments)} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def worker(self, draw):
        often = draw.choice(["0", "0", "0.02"])
        return subprocess.Popen(
            [self.program, *WORK, "--threads", "1", "--checkpoint-every", often],
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def export(self, folder=None):
        return list(csv.DictReader(io.StringIO(self.call("export", "torture", folder=folder))))


def finished(rows):
    """The rows of all jobs that have ended, including the run time, which would change if a job were run again."""
    return {row["job"]: tuple(row.values()) for row in rows if row["wall_s"]}


def timeless(rows):
    return [{name: cell for name, cell in row.items() if name != "wall_s"} for row in rows]


def check(holds, text):
    if not holds:
        raise SystemExit(f"FAILED: {text}")


def pause_all(workers):
    """Pauses every process and waits until all its threads have stopped."""
    for worker in workers:
        worker.send_signal(signal.SIGSTOP)
    for worker in workers:
        while True:
            try:
                states = [
                    stat.read_text().rsplit(")", 1)[1].split()[0]
                    for stat in pathlib.Path(f"/proc/{worker.pid}/task").glob("*/stat")
                ]
            except OSError:
                states = []
            if all(state in "TZX" for state in states):
                break
            time.sleep(0.001)


def copy(sweep, workers, draw):
    """A copy of all files at one instant, in any order, must open with every finished result."""
    before = finished(sweep.export())
    pause_all(workers)
    with tempfile.TemporaryDirectory() as other:
        for name in draw.sample(FILES, 3):
            if (sweep.folder / name).exists():
                shutil.copy(sweep.folder / name, other)
        for worker in workers:
            worker.send_signal(signal.SIGCONT)
        # A paused process may hold a lock, so the database is read after the processes continue.
        then, after = finished(sweep.export(other)), finished(sweep.export())
        check(before.items() <= then.items(), "a copy lost results")
        check(then.items() <= after.items(), "a copy has results that were never finished")
        check("PROBLEM" not in sweep.call("doctor", folder=other), "a copy is damaged")


def torture(sweep, options, draw):
    sweep.call("submit", "torture.json")
    workers = [sweep.worker(draw) for _ in range(options.workers)]
    counts = dict.fromkeys(["kills", "ended before the kill", "interrupts", "stops", "copies"], 0)
    seen = {}
    while counts["kills"] < options.kills:
        time.sleep(draw.uniform(0.0, options.pause))
        index = draw.randrange(len(workers))
        victim, action = workers[index], draw.random()
        if action < 0.05:
            counts["copies"] += 1
            copy(sweep, workers, draw)
        elif action < 0.15:
            counts["stops"] += 1
            victim.send_signal(signal.SIGSTOP)
            time.sleep(draw.uniform(0.0, 0.3))
            victim.send_signal(signal.SIGCONT)
        else:
            is_kill = action >= 0.25
            victim.send_signal(signal.SIGKILL if is_kill else signal.SIGINT)
            workers[index] = sweep.worker(draw)
            code = victim.wait()
            name = ("kills" if code == -signal.SIGKILL else "ended before the kill") if is_kill else "interrupts"
            counts[name] += 1
        now = finished(sweep.export())
        lost = [job for job, line in seen.items() if now.get(job) != line]
        check(not lost, f"lost or run again: {lost}")
        seen = now
        if len(seen) == options.jobs:
            break
    for worker in workers:
        check(worker.wait() in (0, 3), f"a worker ended with {worker.returncode}")
    sweep.call(*WORK)
    return counts


NAMED = re.compile(r"Everything that was stored.* is in (.+?): move that file")


class Place:
    """A sweep on a disk of its own with this room, if this process may mount one."""

    def __init__(self, program, folder, jobs, room):
        self.room = room
        mount = ["mount", "-t", "tmpfs", "-o", f"size={room}", "tmpfs", folder]
        self.is_mounted = subprocess.run(mount, capture_output=True).returncode == 0
        self.sweep = Sweep(program, folder, jobs)
        self.folder = self.sweep.folder
        self.database = self.folder / FILES[0]
        self.sweep.call("submit", "torture.json")

    def unmount(self):
        if self.is_mounted:
            subprocess.run(["umount", "-l", str(self.folder)])

    def start(self, count, user=None):
        def worker():
            command = [self.sweep.program, *WORK, "--threads", "1"]
            return subprocess.Popen(
                command, cwd=self.folder, user=user, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
            )

        return [worker() for _ in range(count)]

    def displaced(self, workers):
        """Waits for workers whose database has left its place, and puts one database with all their results there."""
        named = set()
        for worker in workers:
            _, message = worker.communicate(timeout=120)
            if worker.returncode == 0 and "0 left" in message:
                continue
            check(worker.returncode == 2, f"a worker ended with {worker.returncode}: {message}")
            found = NAMED.search(message)
            check(found, f"no file is named: {message}")
            named.add(found[1])
        check(named, "all workers had ended before")
        first, *others = sorted(named)
        pathlib.Path(first).rename(self.database)
        if others:
            self.sweep.call("merge", *others)
        for other in others:
            pathlib.Path(other).unlink()

    def move(self, workers, draw):
        self.database.rename(self.folder / "moved.db")
        self.displaced(workers)

    def delete(self, workers, draw):
        for name in draw.sample(FILES, 3):
            (self.folder / name).unlink(missing_ok=True)
        self.displaced(workers)

    def replace(self, workers, draw):
        new, taken = self.folder / "new.db", self.folder / "taken.db"
        self.sweep.call("--db", new.name, "submit", "torture.json", "--name", "other")
        content = new.read_bytes()
        new.rename(self.database)
        for worker in workers:
            worker.wait(timeout=120)
        check(self.database.read_bytes() == content, "the new database was changed")
        check("PROBLEM" not in self.sweep.call("doctor"), "the new database is damaged")
        self.database.rename(taken)
        self.displaced(workers)
        taken.unlink()

    def make_read_only(self, workers, draw):
        modes = {path: path.stat().st_mode for path in [*self.folder.glob("tribosweep.db*"), self.folder]}
        for path in modes:
            path.chmod(0o555 if path.is_dir() else 0o444)
        (late,) = self.start(1, "nobody")
        _, message = late.communicate(timeout=120)
        check(late.returncode == 2 and "cannot" in message, f"read-only: {late.returncode} {message}")
        for path, mode in modes.items():
            if path.exists():
                path.chmod(mode)
        self.interrupt(workers)

    def fill(self, workers, draw):
        filler = self.folder / "filler"
        try:
            filler.write_bytes(bytes(self.room))
        except OSError:
            pass
        for worker in workers:
            _, message = worker.communicate(timeout=120)
            is_full = worker.returncode == 2 and "disk of the database is full" in message
            check(is_full or worker.returncode == 0, f"full disk: {worker.returncode} {message}")
        filler.unlink()

    def interrupt(self, workers):
        for worker in workers:
            worker.send_signal(signal.SIGINT)
        for worker in workers:
            check(worker.wait(timeout=120) in (0, 3), f"a worker ended with {worker.returncode}")


def attack_places(place, options, draw):
    actions = [place.move, place.delete, place.replace]
    actions += [place.make_read_only] if os.geteuid() == 0 else []
    actions += [place.fill] if place.is_mounted else []
    counts = dict.fromkeys([action.__name__ for action in actions], 0)
    for number in range(options.places):
        before = finished(place.sweep.export())
        if len(before) > options.jobs - min(200, options.jobs // 2):
            break
        workers = place.start(options.workers)
        time.sleep(draw.uniform(0.2, 1.0))
        before = finished(place.sweep.export())
        action = actions[number % len(actions)]
        counts[action.__name__] += 1
        action(workers, draw)
        now = finished(place.sweep.export())
        lost = [job for job, line in before.items() if now.get(job) != line]
        check(not lost, f"{action.__name__}: lost or run again: {lost}")
    place.sweep.call(*WORK)
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--workers", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=6000, help="a multiple of ten")
    parser.add_argument("--pause", type=float, default=0.05, help="longest time between two actions [s]")
    parser.add_argument("--places", type=int, default=20, help="how often a database is attacked in its place")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", default=str(ROOT / "target/release/tribosweep"))
    options = parser.parse_args()
    draw = random.Random(options.seed)
    os.environ.pop("TRIBOSWEEP_DB", None)
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as calm, tempfile.TemporaryDirectory() as wild:
        reference = Sweep(options.program, calm, options.jobs)
        reference.call("run", "torture.json")
        sweep = Sweep(options.program, wild, options.jobs)
        counts = torture(sweep, options, draw)
        check(timeless(sweep.export()) == timeless(reference.export()), "the export differs")
        database = sqlite3.connect(f"file:{sweep.folder / FILES[0]}?mode=ro", uri=True)
        jobs, attempts = database.execute("SELECT COUNT(*), SUM(attempt) FROM jobs WHERE state = 'done'").fetchone()
        (results,) = database.execute("SELECT COUNT(*) FROM results").fetchone()
        database.close()
        check(jobs == results == options.jobs, f"{jobs} jobs and {results} results of {options.jobs}")
        repeated = attempts - jobs
        # Jobs in lanes, jobs that wait for a lane, and jobs that have ended and are not stored yet.
        allowed = 3 * LANES * (counts["kills"] + counts["interrupts"])
        check(repeated <= allowed, f"{repeated} jobs repeated, at most {allowed} were running")
        with tempfile.TemporaryDirectory() as other:
            pathlib.Path(other).chmod(0o755)
            # Each worker may save the results of a database that has left its place in a file of its own.
            files = options.workers + 2
            room = ROOM_BYTES + files * (reference.folder / FILES[0]).stat().st_size
            place = Place(options.program, other, options.jobs, room)
            try:
                attacks = attack_places(place, options, draw)
                check(timeless(place.sweep.export()) == timeless(reference.export()), "after attacks, the export differs")
            finally:
                place.unmount()
    for name, count in (counts | attacks).items():
        print(f"{name}: {count}")
    left_out = {"make_read_only", "fill"} - attacks.keys()
    if left_out:
        print(f"left out, because they need root: {', '.join(sorted(left_out))}")
    print(f"jobs: {jobs}, results: {results}, repeated: {repeated}, lost: 0, recorded twice: 0")
    print(f"export: identical to the undisturbed run, in {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    sys.exit(main())
