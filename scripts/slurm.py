#!/usr/bin/env python3
"""Runs the job array of `tribosweep slurm` on a real Slurm cluster and disturbs it in the ways that occur on clusters.

    cargo build --release
    sudo python3 scripts/slurm.py [--program FILE] [--db URL] [--jobs 128] [--keep]

Starts a cluster with one node and two slots (scripts/slurm_cluster.py) and submits a study with four workers. While the
workers run, the script kills a worker (kill -9), requeues a task, lets a job of a higher priority preempt all tasks, lets a
task reach its time limit, cancels a task, and kills another task with its shell. Afterwards, every job must be done with
exactly one result, the export must be identical to that of an undisturbed run except for the run times, the report must
have been written after the last task, and no process may remain.

With --db, the URL of an empty PostgreSQL database, the workers share that database. Without it, every worker has its shard.
Then the last two tasks leave their shards unfinished: the first report must say so, and a second run of submit.sh must
complete the study. A second, smaller study then loses its node with its disk: it must continue from the last saved copy.

Needs root and Debian's packages slurm-wlm and munge; without them, the exit code is 77. Needs only Python's standard library.
"""

import argparse
import json
import os
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

import slurm_cluster
from comparing import check, tell, timeless

ROOT = pathlib.Path(__file__).resolve().parent.parent
SKIPPED = 77
WORKERS = 4
# Long enough for two slots to run all jobs with all disturbances, even while a compiler uses the same machine.
PATIENCE_S = 900.0
ENDED = {"COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED"}

# For the study that loses its node: how often a shard is saved, and the length of its jobs relative to those of the first
# study. Several groups of eight jobs finish between two saves.
KEEP_EVERY_S = 8
PART = 0.3


def study(jobs, part):
    """A grid of jobs that take some seconds. A thread advances eight of them together."""
    speeds = [round(2.0 + 0.5 * k, 3) for k in range(max(1, jobs // 4))]
    return {
        "name": "drain",
        "scene": {"pin": {"elements": [8, 10, 6]}, "clamp": {"width_m": 0.002}},
        "run": {"limit_s": 0.5 * part, "stop_early": False},
        "grid": {"mu": [0.1, 0.2, 0.3, 0.4], "omega_rpm": speeds},
    }


class Sweep:
    """A study, its scripts and its job array."""

    def __init__(self, cluster, folder, options, jobs, workers=WORKERS, part=1.0):
        self.cluster, self.folder, self.options = cluster, pathlib.Path(folder), options
        self.tasks = workers
        self.program = str(pathlib.Path(options.program).resolve())
        # A path with spaces and a quote, as users may have it.
        self.out = self.folder / "a user's folder" / "drain.slurm"
        self.out.parent.mkdir()
        (self.folder / "drain.json").write_text(json.dumps(study(jobs, part)))
        self.array = self.report = None
        # For each task, how often its log has said that the worker ended.
        self.ends = {}

    def call(self, *arguments, code=0):
        done = subprocess.run(
            [self.program, *arguments], cwd=self.folder, env=self.cluster.environment, capture_output=True, text=True
        )
        check(done.returncode == code, f"{' '.join(arguments)} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def undisturbed(self):
        self.call("run", "drain.json", "--db", "reference.db", "--threads", "2")
        return timeless(self.call("export", "drain", "--db", "reference.db"))

    def generate(self):
        self.call(
            "slurm", "drain.json", "--workers", str(self.tasks), "--partition", "low", "--time", "1-0",
            "--out", str(self.out), "--db", self.options.db or "drain.db",
        )  # fmt: skip

    def submit(self):
        done = subprocess.run(
            ["bash", str(self.out / "submit.sh")],
            cwd=self.folder,
            env=self.cluster.environment,
            capture_output=True,
            text=True,
        )
        check(done.returncode == 0, f"submit.sh ended with {done.returncode}: {done.stderr}")
        self.array, self.report = (self.out / "jobs").read_text().split()
        self.ends = {}
        tell(f"submitted: array {self.array}, report {self.report}")

    def workers(self):
        """The process numbers of this array's workers by task, from /proc."""
        found = {}
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                arguments = (process / "cmdline").read_bytes().split(b"\0")
                if os.path.realpath(process / "exe") != self.program or b"work" not in arguments[:2]:
                    continue
                environment = dict(
                    line.split(b"=", 1) for line in (process / "environ").read_bytes().split(b"\0") if b"=" in line
                )
            except OSError:
                continue
            if environment.get(b"SLURM_ARRAY_JOB_ID") == self.array.encode():
                found[int(environment[b"SLURM_ARRAY_TASK_ID"])] = int(process.name)
        return found

    def working(self, count):
        """Waits until `count` workers have run for long enough to have claimed jobs."""
        since = {}

        def is_so():
            now, workers = time.monotonic(), self.workers()
            for task, process in workers.items():
                since.setdefault((task, process), now)
            return sum(now - since[item] > 1.5 for item in workers.items()) >= count

        self.cluster.until(f"{count} workers to run", is_so, 120)
        return self.workers()

    def log(self, task):
        path = self.out / f"{self.array}_{task}.log"
        return path.read_text(errors="replace") if path.exists() else ""

    def state(self, task):
        return self.cluster.tasks(self.array).get(f"{self.array}_{task}", {})

    def is_over(self):
        """Whether the array and the report have ended."""
        tasks = {**self.cluster.tasks(self.array), **self.cluster.tasks(self.report)}
        return all(values["JobState"] in ENDED for values in tasks.values())

    def until_over(self):
        self.cluster.until("array and report to end", self.is_over, PATIENCE_S)
        tasks = self.cluster.tasks(self.array)
        (report,) = self.cluster.tasks(self.report).values()
        check(
            len(tasks) == self.tasks and all(values["EndTime"] <= report["StartTime"] for values in tasks.values()),
            "the report did not wait for all tasks",
        )
        for name, values in sorted(tasks.items()):
            tell(f"task {name}: {values['JobState']}, exit {values['ExitCode']}, restarts {values['Restarts']}")
        tell(f"report: {report['JobState']}, exit {report['ExitCode']}")
        check(not self.workers(), "worker processes remain")
        return report["ExitCode"]


def kill(sweep):
    task, process = sorted(sweep.working(1).items())[0]
    os.kill(process, signal.SIGKILL)
    sweep.cluster.until("another worker", lambda: sweep.workers().get(task, process) != process, 60)
    check("is started again" in sweep.log(task), "the log does not mention the killed worker")
    tell(f"kill -9 of the worker of task {task}: its task has started another one")


def stopped(sweep, task, process, how):
    """Waits until a worker has ended in order and the log says so. Returns its exit code."""
    sweep.cluster.until(f"the worker to end ({how})", lambda: sweep.workers().get(task) != process, 60)
    said = "the worker ended with"
    sweep.ends[task] = sweep.ends.get(task, 0) + 1
    sweep.cluster.until("the task to say so", lambda: sweep.log(task).count(said) >= sweep.ends[task], 60)
    code = sweep.log(task).split(said)[sweep.ends[task]].split()[0]
    # 0: it may have finished its jobs at that moment.
    check(code in ("0", "3"), f"{how}: the worker of task {task} ended with {code}")
    return code


def requeue(sweep):
    task, process = sorted(sweep.working(1).items())[-1]
    before = int(sweep.state(task)["Restarts"])
    sweep.cluster.ask("scontrol", "requeue", f"{sweep.array}_{task}")
    code = stopped(sweep, task, process, "requeue")
    check(int(sweep.state(task)["Restarts"]) > before, "the task was not requeued")
    tell(f"scontrol requeue of task {task}: worker ended with {code}")


def preempt(sweep):
    workers = sweep.working(2)
    before = {task: int(sweep.state(task)["Restarts"]) for task in workers}
    command = ["--parsable", "--partition=urgent", "--cpus-per-task=2", "--output=/dev/null", "--wrap=sleep 2"]
    urgent = sweep.cluster.ask("sbatch", *command).strip()
    codes = [stopped(sweep, task, process, "preemption") for task, process in workers.items()]
    sweep.cluster.until(
        "the urgent job to end", lambda: sweep.cluster.tasks(urgent)[urgent]["JobState"] in ENDED, 120
    )
    after = {task: int(sweep.state(task)["Restarts"]) for task in workers}
    # A worker that finished its jobs within the grace time (code 0) is not requeued.
    hit = [task for task, code in zip(workers, codes) if code == "3"]
    check(hit and all(after[task] > before[task] for task in hit), f"not requeued: {before} {after}, {codes}")
    tell(f"preemption of tasks {sorted(workers)}: workers ended with {', '.join(codes)}")


def time_limit(sweep):
    # Preferably the task whose job number is that of the array: requeueing it by that number would requeue all tasks.
    workers = sorted(sweep.working(1).items())
    task, process = next((item for item in workers if sweep.state(item[0])["JobId"] == sweep.array), workers[0])
    before = int(sweep.state(task)["Restarts"])
    name = f"{sweep.array}_{task}"
    # Slurm sends its signal two minutes before the limit. With a limit of two minutes, it sends it at its next check, and
    # it checks every half minute.
    sweep.cluster.ask("scontrol", "update", f"JobId={name}", "TimeLimit=2")
    code = stopped(sweep, task, process, "time limit")
    sweep.cluster.until("the task to be requeued", lambda: int(sweep.state(task)["Restarts"]) > before, 60)
    sweep.cluster.ask("scontrol", "update", f"JobId={name}", "TimeLimit=1-0")
    others = [int(values["Restarts"]) for key, values in sweep.cluster.tasks(sweep.array).items() if key != name]
    check("going on in another time slot" in sweep.log(task), "the task did not requeue itself")
    tell(f"time limit of task {task}: worker ended with {code}, restarts {before + 1}, of the others {others}")


def cancel(sweep):
    task, process = sorted(sweep.working(1).items())[-1]
    sweep.cluster.ask("scancel", f"{sweep.array}_{task}")
    code = stopped(sweep, task, process, "scancel")
    sweep.cluster.until("the task to be gone", lambda: sweep.state(task)["JobState"] == "CANCELLED", 60)
    tell(f"scancel of task {task}: worker ended with {code}")


def destroy(sweep):
    """Kills the shell and the worker of a task at once, as if the node had lost its power."""
    task, process = sorted(sweep.working(1).items())[0]
    # The processes are killed directly: even scancel --signal=KILL would send other signals first.
    family, parent = [], process
    while (stat := pathlib.Path(f"/proc/{parent}/stat").read_text()) and "(slurmstepd)" not in stat:
        family.insert(0, parent)
        parent = int(stat.rsplit(")", 1)[1].split()[1])
    for each in family:
        os.kill(each, signal.SIGKILL)
    sweep.cluster.until("the worker to be gone", lambda: sweep.workers().get(task) != process, 60)
    sweep.cluster.until("the task to be gone", lambda: sweep.state(task)["JobState"] in ENDED, 60)
    tell(f"kill -9 of all processes of task {task}: {sweep.state(task)['JobState']}")
    return task


def finished(sweep, reference):
    """Compares the results of the array with those of the undisturbed run."""
    for name in ["jobs.csv", "report/report.html"]:
        check((sweep.out / name).exists(), f"the report job has written no {name}")
    rows = timeless((sweep.out / "jobs.csv").read_text())
    check(len({row[1] for row in rows}) == len(rows) == len(reference), f"{len(rows)} rows of {len(reference)}")
    check(rows == reference, "the export differs from that of an undisturbed run")
    tell(f"{len(rows) - 1} jobs done, one row each, identical to the undisturbed run")
    merged = sweep.out / "drain.db"
    if not sweep.options.db:
        database = sqlite3.connect(f"file:{merged}?mode=ro&immutable=1", uri=True)
        query = "SELECT COUNT(*), SUM(attempt) FROM jobs WHERE state = 'done'"
        jobs, attempts = database.execute(query).fetchone()
        (results,) = database.execute("SELECT COUNT(*) FROM results WHERE record IS NOT NULL").fetchone()
        database.close()
        check(jobs == results == len(rows) - 1, f"{jobs} jobs done and {results} results")
        tell(f"merged database: {results} results, {attempts} attempts")


def drain(sweep):
    reference = sweep.undisturbed()
    tell(f"undisturbed run: {len(reference) - 1} jobs")
    sweep.generate()
    sweep.submit()
    kill(sweep)
    time_limit(sweep)
    requeue(sweep)
    preempt(sweep)
    cancel(sweep)
    destroyed = destroy(sweep)
    exit_code = sweep.until_over()
    if not sweep.options.db:
        check(exit_code == "3:0", f"the first report ended with {exit_code}, not with unfinished jobs")
        page = (sweep.out / "report" / "report.md").read_text()
        check("incomplete" in page, "the report of an unfinished study does not say so")
        left = [row for row in timeless((sweep.out / "jobs.csv").read_text()) if row[4] in ("pending", "running")]
        tell(f"the report says that {len(left)} jobs are left; submitting again")
        sweep.submit()
        exit_code = sweep.until_over()
        check("left on this node" in sweep.log(destroyed), "the task did not continue with the file on the node")
    check(exit_code == "0:0", f"the report ended with {exit_code}")
    finished(sweep, reference)


def kept_jobs(database):
    """The number of done jobs in a saved shard."""
    connection = sqlite3.connect(f"file:{database}?mode=ro&immutable=1", uri=True)
    (jobs,) = connection.execute("SELECT COUNT(*) FROM jobs WHERE state = 'done'").fetchone()
    connection.close()
    return jobs


def lose_node(sweep, node_folder):
    """If a node is lost with its disk, only the work since the last saved copy is lost."""
    reference = sweep.undisturbed()
    sweep.generate()
    script = sweep.out / "workers.sbatch"
    text = script.read_text()
    setting = next(line for line in text.splitlines() if line.startswith("keep_every="))
    script.write_text(text.replace(setting, f"keep_every={KEEP_EVERY_S}"))
    sweep.submit()
    shard = sweep.out / "shards" / "shard-0.db"
    sweep.cluster.until("finished jobs to be saved", lambda: shard.exists() and kept_jobs(shard) > 0, 300)
    sweep.working(1)
    check("the worker ended" not in sweep.log(0), "the shard was saved at the end, not before")
    destroy(sweep)
    for path in node_folder.rglob("*"):
        if path.is_file():
            path.unlink()
    kept = kept_jobs(shard)
    tell(f"the node is lost with its disk; {kept} jobs were saved")
    check(0 < kept < len(reference) - 1, f"{kept} jobs were saved")
    check(sweep.until_over() == "3:0", "the report of an unfinished study does not say so")
    sweep.submit()
    check(sweep.until_over() == "0:0", "the unfinished jobs were not completed")
    check(f"going on with {shard}" in sweep.log(0), "the task did not continue with the saved copy")
    finished(sweep, reference)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "target/release/tribosweep"))
    parser.add_argument("--db", metavar="URL", help="an empty PostgreSQL database; without it, every worker has its shard")
    parser.add_argument("--jobs", type=int, default=128, help="a multiple of four")
    parser.add_argument("--keep", action="store_true", help="keep the folder with all logs")
    options = parser.parse_args()
    os.environ.pop("TRIBOSWEEP_DB", None)
    missing = slurm_cluster.missing()
    if missing or os.geteuid() != 0:
        why = f"no {', '.join(missing)}: apt-get install slurm-wlm munge" if missing else "it needs root"
        print(f"skipped: {why}", file=sys.stderr)
        return SKIPPED
    # SIGTERM must not leave the cluster running.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    folder = tempfile.mkdtemp(prefix="tribosweep-slurm-")
    # All users must be able to reach munge's socket.
    os.chmod(folder, 0o755)
    try:
        cluster_folder, work_folder = pathlib.Path(folder, "cluster"), pathlib.Path(folder, "work")
        node_folder = pathlib.Path(folder, "node")
        for each in [cluster_folder, work_folder, node_folder]:
            each.mkdir()
        os.environ["TMPDIR"] = str(node_folder)
        with slurm_cluster.Cluster(cluster_folder) as cluster:
            drain(Sweep(cluster, work_folder, options, options.jobs))
            if not options.db:
                work_folder = pathlib.Path(folder, "lost")
                work_folder.mkdir()
                lose_node(Sweep(cluster, work_folder, options, jobs=96, workers=1, part=PART), node_folder)
            left = [str(path) for path in node_folder.rglob("*") if path.is_file()]
            check(not left, f"left on the node: {left}")
    finally:
        if options.keep:
            print(f"kept: {folder}")
        else:
            shutil.rmtree(folder)
    print("all held")
    return 0


if __name__ == "__main__":
    sys.exit(main())
