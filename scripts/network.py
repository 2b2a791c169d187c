#!/usr/bin/env python3
"""Cuts the network links of workers on several hosts. No result may be lost, and none may be recorded twice.

    cargo build --release
    sudo python3 scripts/network.py [--program FILE] [--jobs 160] [--keep]

Makes four hosts as network namespaces with their own host names, connected by a switch: one host with PostgreSQL, and
three with one worker each. While the workers run a study,

  * the link of the first worker is cut for longer than a lease: its jobs are taken back and run by other workers. When the
    link is back, the worker continues, and each result that it finished meanwhile is either stored or refused.
  * the link of the second worker is cut repeatedly for short times, and its sessions are ended on the server at random
    moments.
  * the link of the third worker is cut for less than a lease: no job is taken back from it.
  * the server is stopped immediately, as in a crash, and started again.

Afterwards, every job must be done with one result, and the export must be identical to that of an undisturbed run except
for the run times.

Needs root, iproute2 and PostgreSQL; without them, the exit code is 77. Needs only Python's standard library.
"""

import argparse
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from comparing import check, tell, timeless

ROOT = pathlib.Path(__file__).resolve().parent.parent
SKIPPED = 77
LEASE_S = 8
PORT = 5432
SERVER = "10.77.0.1"
PATIENCE_S = 600.0


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    check(done.returncode == 0, f"{' '.join(map(str, command))} ended with {done.returncode}: {done.stderr}")
    return done.stdout


class Network:
    """Hosts that are connected by a switch."""

    def __init__(self):
        self.prefix = f"tribo{os.getpid()}"
        self.switch = f"{self.prefix}-switch"
        self.hosts = {}

    def __enter__(self):
        run("ip", "netns", "add", self.switch)
        run("ip", "-n", self.switch, "link", "add", "switch", "type", "bridge")
        run("ip", "-n", self.switch, "link", "set", "switch", "up")
        return self

    def __exit__(self, *_):
        for space in [*self.hosts.values(), self.switch]:
            subprocess.run(["ip", "netns", "delete", space], check=False)

    def add(self, host, address):
        space = self.hosts[host] = f"{self.prefix}-{host}"
        run("ip", "netns", "add", space)
        run("ip", "-n", space, "link", "set", "lo", "up")
        run("ip", "-n", space, "link", "add", "eth0", "type", "veth", "peer", "name", host, "netns", self.switch)
        run("ip", "-n", space, "address", "add", f"{address}/24", "dev", "eth0")
        run("ip", "-n", space, "link", "set", "eth0", "up")
        run("ip", "-n", self.switch, "link", "set", host, "master", "switch", "up")

    def on(self, host, *command):
        """A command that runs on a host: in its network and with its host name."""
        name = 'printf %s "$0" > /proc/sys/kernel/hostname && exec "$@"'
        return ["ip", "netns", "exec", self.hosts[host], "unshare", "--uts", "sh", "-c", name, host, *command]

    def cut(self, host):
        # The link is cut at the switch, so that the host does not notice it and packets are lost.
        run("ip", "-n", self.switch, "link", "set", host, "nomaster")

    def mend(self, host):
        run("ip", "-n", self.switch, "link", "set", host, "master", "switch")


class Sweep:
    def __init__(self, network, folder, options):
        self.network, self.folder = network, folder
        self.program = str(pathlib.Path(options.program).resolve())
        self.workers = {}
        self.url = f"postgres://tribosweep@{SERVER}:{PORT}/postgres"
        speeds = [round(2.0 + 0.5 * k, 3) for k in range(max(1, options.jobs // 4))]
        study = {
            "name": "apart",
            "scene": {"pin": {"elements": [8, 10, 6]}, "clamp": {"width_m": 0.002}},
            "run": {"limit_s": 0.5, "stop_early": False},
            "grid": {"mu": [0.1, 0.2, 0.3, 0.4], "omega_rpm": speeds},
        }
        (folder / "study.json").write_text(json.dumps(study))

    def call(self, *arguments):
        """Runs a command of the program on the server's host."""
        return run(*self.network.on("server", self.program, *arguments, "--db", self.url), cwd=self.folder)

    def undisturbed(self):
        run(self.program, "run", "study.json", "--db", "reference.db", cwd=self.folder)
        return timeless(run(self.program, "export", "apart", "--db", "reference.db", cwd=self.folder))

    def start(self, host):
        log = open(self.folder / f"{host}.log", "w")
        command = [self.program, "work", "--db", self.url, "--threads", "1", "--checkpoint-every", "1"]
        # A short idle time, so that no worker waits after the end of the study.
        command += ["--lease", f"{LEASE_S}s", "--idle-exit", "1s"]
        self.workers[host] = subprocess.Popen(
            self.network.on(host, *command), cwd=self.folder, stdout=log, stderr=subprocess.STDOUT
        )

    def status(self):
        return json.loads(self.call("status", "apart", "--json"))

    def worker(self, host):
        return next(worker for worker in self.status()["workers"] if worker["host"] == host)

    def until(self, what, holds, patience_s=PATIENCE_S):
        begun = time.monotonic()
        while not holds():
            check(time.monotonic() - begun < patience_s, f"waited too long for {what}")
            time.sleep(0.2)

    def sql(self, statement):
        command = ["psql", "--no-psqlrc", "--tuples-only", "--no-align", self.url, "--command", statement]
        return run(*self.network.on("server", *command)).strip()


def disturb(sweep, server):
    network = sweep.network
    sweep.until("all workers to have finished something", lambda: all(
        sweep.worker(host)["finished"] > 0 for host in sweep.workers
    ))  # fmt: skip

    network.cut("first")
    network.cut("third")
    tell("the links of the first and the third worker are cut")
    time.sleep(LEASE_S / 2)
    network.mend("third")
    tell(f"the link of the third worker is back after {LEASE_S / 2} s")
    sweep.until("jobs of the first worker to be taken back", lambda: sweep.worker("first")["taken_back"] > 0, 60)
    tell(f"{sweep.worker('first')['taken_back']} jobs of the first worker are taken back")
    before = sweep.worker("first")["finished"]

    random.seed(7)
    sessions = "FROM pg_stat_activity WHERE client_addr = '10.77.0.12'"
    ended = 0
    for _ in range(12):
        # Longer cuts without pauses would add up, because TCP doubles its retransmission timeout with each lost packet.
        time.sleep(random.uniform(1.0, 1.5))
        network.cut("second")
        time.sleep(random.uniform(0.1, 0.5))
        network.mend("second")
        time.sleep(random.uniform(0.0, 1.0))
        ended += int(sweep.sql(f"SELECT COUNT(pg_terminate_backend(pid)) {sessions}"))
    tell(f"the link of the second worker was cut twelve times for short times, and {ended} of its sessions were ended")
    network.mend("first")
    sweep.until("the first worker to continue", lambda: sweep.worker("first")["finished"] > before, 120)
    check(sweep.worker("first")["presence"] == "working", "the first worker continues but is not counted as working")
    tell("the link of the first worker is back, and the worker continues")
    for host in ["second", "third"]:
        check(sweep.worker(host)["taken_back"] == 0, f"jobs were taken back from the {host} worker, which was never disconnected for long")

    # An immediate stop looks like a crash to the clients.
    postgres = ["setpriv", "--reuid", "postgres", "--regid", "postgres", "--init-groups", "--"]
    tool = shutil.which("pg_ctl") or str(max(pathlib.Path("/usr/lib/postgresql").glob("*/bin/pg_ctl")))
    control = [*postgres, tool, "--pgdata", str(server / "data"), "--wait"]
    run(*network.on("server", *control, "--mode", "immediate", "stop"), cwd=server)
    time.sleep(3)
    run(*network.on("server", *control, "--log", str(server / "server.log"), "start"), cwd=server)
    tell("the server crashed and is back")


def compare(sweep, reference):
    for host, worker in sweep.workers.items():
        worker.wait(PATIENCE_S)
        log = (sweep.folder / f"{host}.log").read_text()
        check(worker.returncode == 0, f"the worker on {host} ended with {worker.returncode}: {log}")
    jobs = len(reference) - 1
    exported = timeless(sweep.call("export", "apart"))
    check(exported == reference, "the export differs from that of an undisturbed run")
    results = int(sweep.sql("SELECT COUNT(*) FROM tribosweep.results"))
    attempts, running = sweep.sql(
        "SELECT SUM(attempt), COUNT(*) FILTER (WHERE state <> 'done') FROM tribosweep.jobs"
    ).split("|")
    check((results, int(running)) == (jobs, 0), f"{results} results of {jobs} jobs, {running} not done")
    left = sweep.sql("SELECT COUNT(*) FROM tribosweep.checkpoints")
    check(left == "0", f"{left} checkpoints are left")
    tell(f"{jobs} jobs done in {attempts} attempts, one result each, identical to the undisturbed run")
    for host in sweep.workers:
        log = (sweep.folder / f"{host}.log").read_text()
        tell(f"{host}: {log.count('does not answer')} times without the server")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "target/release/tribosweep"))
    parser.add_argument("--jobs", type=int, default=160, help="a multiple of four")
    parser.add_argument("--keep", action="store_true", help="keep the folder with all logs")
    options = parser.parse_args()
    os.environ.pop("TRIBOSWEEP_DB", None)
    missing = [tool for tool in ["ip", "unshare", "setpriv", "psql"] if shutil.which(tool) is None]
    if missing or os.geteuid() != 0:
        why = f"no {', '.join(missing)}: apt-get install iproute2 postgresql" if missing else "it needs root"
        print(f"skipped: {why}", file=sys.stderr)
        return SKIPPED
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    folder = pathlib.Path(tempfile.mkdtemp(prefix="tribosweep-network-"))
    os.chmod(folder, 0o755)
    server = folder / "server"
    try:
        with Network() as network:
            network.add("server", SERVER)
            for number, host in enumerate(["first", "second", "third"]):
                network.add(host, f"10.77.0.{11 + number}")
            postgres = str(ROOT / "scripts/postgres.sh")
            start = [postgres, "start", str(server), str(PORT), SERVER, "10.77.0.0/24"]
            run(*network.on("server", *start))
            sweep = Sweep(network, folder, options)
            try:
                reference = sweep.undisturbed()
                tell(f"undisturbed run: {len(reference) - 1} jobs")
                sweep.call("submit", "study.json")
                for host in ["first", "second", "third"]:
                    sweep.start(host)
                disturb(sweep, server)
                compare(sweep, reference)
            finally:
                for worker in sweep.workers.values():
                    if worker.poll() is None:
                        worker.kill()
                run(*network.on("server", postgres, "stop", str(server)))
    finally:
        if options.keep:
            print(f"kept: {folder}")
        else:
            shutil.rmtree(folder, ignore_errors=True)
    print("all held")
    return 0


if __name__ == "__main__":
    sys.exit(main())
