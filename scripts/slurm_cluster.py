"""A Slurm cluster with one node and two slots on loopback. It runs while a `with` block runs.

It uses Debian's packages without systemd and independently of any Slurm of the machine: keys, sockets, ports, logs and
states are in a separate folder. It needs root, because slurmd does, and only Python's standard library.
"""

import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import time

SLOTS = 2
PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo"]

# Slurm finds the processes of a job by their parents and not by control groups, which a container may not have. The waiting
# times are short: GraceTime, how long a preempted job continues; KillWait, the time between SIGTERM and SIGKILL; and
# cred_expire, which is also how long a requeued task waits.
CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldDebug=verbose
SlurmdDebug=verbose
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_interval=2,batch_sched_delay=0
PriorityType=priority/basic
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
JobRequeue=1
KillWait={kill_wait}
MinJobAge=600
ReturnToService=2
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs={slots} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP PriorityTier=10
PartitionName=low Nodes={host} MaxTime=INFINITE State=UP PriorityTier=1 PreemptMode=REQUEUE GraceTime={grace}
PartitionName=urgent Nodes={host} MaxTime=INFINITE State=UP PriorityTier=20
"""


def missing():
    """The names of the programs that are missing for a cluster."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    return [name for name in PROGRAMS if shutil.which(name, path=path) is None]


def free_ports(count):
    """Ports that no process listens on."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()


class Cluster:
    """Starts and stops the daemons. Commands and scripts need `environment` to reach them."""

    def __init__(self, folder, kill_wait_s=10, grace_s=3):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        self.kill_wait_s, self.grace_s = kill_wait_s, grace_s
        self.environment = dict(
            os.environ,
            SLURM_CONF=str(self.folder / "slurm.conf"),
            PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin",
        )

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        folder = self.folder
        folder.chmod(0o755)
        for name in ["state", "spool"]:
            (folder / name).mkdir()
        key = folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(secrets.token_bytes(128))
        controller, daemon = free_ports(2)
        host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(
            CONFIGURATION.format(
                host=host,
                folder=folder,
                controller=controller,
                daemon=daemon,
                slots=SLOTS,
                kill_wait=self.kill_wait_s,
                grace=self.grace_s,
            )
        )
        # This file must exist and may be empty.
        (folder / "cgroup.conf").touch()
        self.daemon(
            "munged",
            "--foreground",
            "--force",
            f"--socket={folder}/munge.socket",
            f"--key-file={key}",
            f"--pid-file={folder}/munged.pid",
            f"--seed-file={folder}/munged.seed",
            f"--log-file={folder}/munged.log",
        )
        self.until("munged to listen", lambda: (folder / "munge.socket").exists())
        self.daemon("slurmctld", "-D", "-i")
        self.until("slurmctld to answer", lambda: "UP" in self.ask("scontrol", "ping", check=False))
        self.daemon("slurmd", "-D", "-N", host)
        self.until("the node to be idle", lambda: "idle" in self.ask("sinfo", "--noheader", "--format=%t"))

    def daemon(self, *command):
        log = open(self.folder / f"{command[0]}.out", "wb")
        self.daemons.append(
            subprocess.Popen(
                command,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        )
        log.close()

    def until(self, what, is_so, patience_s=60.0):
        """Waits until `is_so` returns true."""
        begun = time.monotonic()
        while not is_so():
            dead = [process.args[0] for process in self.daemons if process.poll() is not None]
            if dead or time.monotonic() - begun > patience_s:
                logs = "".join(f"--- {log.name}\n{log.read_text()[-3000:]}" for log in self.folder.glob("*.out"))
                raise RuntimeError(f"waited too long for {what} (ended: {dead})\n{logs}")
            time.sleep(0.1)

    def ask(self, *command, check=True):
        """The output of a Slurm command."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def tasks(self, job=None):
        """The properties of every task that the controller knows, by the task's name (`12_3`, `13`)."""
        tasks = {}
        for line in self.ask("scontrol", "show", "job", *([str(job)] if job else []), "--oneliner").splitlines():
            values = dict(word.split("=", 1) for word in line.split() if "=" in word)
            if "JobId" not in values:
                continue
            name = values["JobId"]
            if "ArrayJobId" in values:
                name = f"{values['ArrayJobId']}_{values['ArrayTaskId']}"
            tasks[name] = values
        return tasks

    def stop(self):
        """Ends all jobs and daemons, each before the daemons that it needs."""
        if len(self.daemons) > 1:
            self.ask("scancel", "--user=root", "--signal=KILL", "--full", check=False)
            self.ask("scancel", "--user=root", check=False)
            # The processes of a job would outlive slurmd.
            give_up = time.monotonic() + 20
            while self.ask("squeue", "--noheader", check=False).strip() and time.monotonic() < give_up:
                time.sleep(0.1)
        for process in reversed(self.daemons):
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.daemons = []
