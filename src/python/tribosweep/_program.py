"""Calls of the program `tribosweep`."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

# Exit codes of the program with which results are there: all jobs are done, or some have failed.
WITH_RESULTS = (0, 1)


class Error(Exception):
    """The program refused something. The text is its message; `code` is its exit code."""

    def __init__(self, message: str, code: int) -> None:
        # With both, an error can be sent from one process to another.
        super().__init__(message, code)
        self.code = code

    def __str__(self) -> str:
        return str(self.args[0])


class InputWarning(UserWarning):
    """The program doubts something: an input in another unit, a strain that no material bears, a column that it left out."""


def program() -> str:
    """The path of the program: TRIBOSWEEP_PROGRAM, the one that was installed with this module, or the one on the PATH.

    Raises FileNotFoundError if there is none.
    """
    given = os.environ.get("TRIBOSWEEP_PROGRAM")
    beside = shutil.which("tribosweep", path=str(Path(sys.executable).parent))
    found = given or beside or shutil.which("tribosweep")
    if found is None:
        raise FileNotFoundError("no program `tribosweep` on the PATH; set TRIBOSWEEP_PROGRAM to its path")
    return found


def doubts_of(messages: str) -> list[str]:
    """The warnings among the messages of the program, each with the lines of help below it."""
    doubts: list[str] = []
    is_inside = False
    for line in messages.splitlines():
        if line.startswith("warning: "):
            doubts.append(line.removeprefix("warning: "))
            is_inside = True
        elif is_inside and line.startswith("  "):
            doubts[-1] += "\n" + line
        else:
            is_inside = False
    return doubts


# Seconds between two looks at the jobs.
_LOOK_S = 2.0


def call(
    arguments: Sequence[str], codes: Sequence[int] = (0,), progress_of: str | os.PathLike[str] | None = None
) -> tuple[str, list[str]]:
    """The output of the program and its warnings, as `output_of`."""
    out, messages = output_of(arguments, codes, progress_of)
    return out, doubts_of(messages)


def output_of(
    arguments: Sequence[str], codes: Sequence[int] = (0,), progress_of: str | os.PathLike[str] | None = None
) -> tuple[str, str]:
    """The output of the program and its messages.

    The jobs of the database `progress_of` are counted on standard error meanwhile. An interrupt of Python stops the program as Ctrl-C in a
    terminal does: running jobs keep their state.
    """
    counts = None if progress_of is None or not _is_watched() else _Counts(progress_of)
    # The terminal's Ctrl-C would reach both processes; so it reaches this one alone, which passes it on.
    process = subprocess.Popen(
        [program(), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        start_new_session=True,
    )
    is_interrupted = False
    try:
        while True:
            try:
                try:
                    out, messages = process.communicate(timeout=_LOOK_S if counts else None)
                    break
                except subprocess.TimeoutExpired:
                    if counts:
                        counts.show()
            except KeyboardInterrupt:
                is_interrupted = True
                process.send_signal(signal.SIGINT)
    except BaseException:
        _stop(process)
        raise
    finally:
        if counts:
            counts.clear()
    if is_interrupted and process.returncode in codes:
        raise KeyboardInterrupt
    if process.returncode not in codes:
        message = "\n".join(line for line in messages.splitlines() if line)
        code = 3 if is_interrupted else process.returncode
        raise Error(message or ("interrupted" if is_interrupted else f"the program ended with code {code}"), code)
    return out, messages


def _stop(process: subprocess.Popen[str]) -> None:
    """Ends the program in order, and at once if that takes long."""
    process.send_signal(signal.SIGINT)
    try:
        process.wait(timeout=10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _is_watched() -> bool:
    """Whether somebody sees standard error: in a terminal or a notebook."""
    return sys.stderr is not None and (sys.stderr.isatty() or "ipykernel" in sys.modules)


class _Counts:
    """A line with the jobs that are done."""

    def __init__(self, db: str | os.PathLike[str]) -> None:
        self.db = os.fspath(db)
        self.begun = time.monotonic()
        self.width = 0

    def show(self) -> None:
        done = subprocess.run(
            [program(), "status", "--json", "--db", self.db],
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
            start_new_session=True,
        )
        # The database may not be there yet.
        if done.returncode != 0:
            return
        studies = [study["jobs"] for study in json.loads(done.stdout)]
        open_ones = [jobs for jobs in studies if jobs["pending"] + jobs["running"] > 0]
        ended = sum(jobs["total"] - jobs["pending"] - jobs["running"] for jobs in open_ones)
        total = sum(jobs["total"] for jobs in open_ones)
        if total > 0:
            self.write(f"{ended} of {total} jobs of the open studies, {time.monotonic() - self.begun:.0f} s")

    def write(self, text: str) -> None:
        print("\r" + text.ljust(self.width), end="", file=sys.stderr, flush=True)
        self.width = len(text)

    def clear(self) -> None:
        if self.width > 0:
            self.write("")
            print("\r", end="", file=sys.stderr, flush=True)
