"""Friction-induced vibration of a pin on a disk: runs the program `tribosweep` and reads its results.

    import tribosweep
    jobs = tribosweep.run("studies/mini.json")              # a DataFrame, a row for each job
    record = tribosweep.solve("studies/mini.json", mu=0.4, omega_rpm=7)
    grid = tribosweep.grid(jobs, ["mu_star"])               # an xarray.Dataset over the parameters
    modes = tribosweep.stability("studies/mini.json")       # a DataFrame, a row for each mode of steady sliding
    found = tribosweep.calibrate("pin.json", "rig.csv")     # what measured points leave of the ranges of parameters

`run`, `read` and `stability` need pandas; `grid` also needs xarray. A study is the path of its file, or a dictionary with the same content.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["Error", "InputWarning", "calibrate", "grid", "program", "read", "run", "solve", "stability", "validate"]

Study = Union[str, "os.PathLike[str]", Mapping[str, Any]]

# Exit codes of the program with which results are there: all jobs are done, or some have failed.
_WITH_RESULTS = (0, 1)


class Error(Exception):
    """The program refused something. The text is its message; `code` is its exit code."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


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


def run(
    study: Study,
    *,
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
    preset: str | None = None,
    threads: int | None = None,
    replace: bool = False,
    settings: Mapping[str, Any] | None = None,
) -> pandas.DataFrame:
    """Solves the jobs of a study, writes its report, and returns a row for each job with all columns of the export.

    Jobs that the database has are not solved again. Failed jobs have a status `failed` and a text in `error`. `settings` are
    parameters with other values: a number, a name, or a list that becomes an axis.

    What the program warns of is an InputWarning, and in `attrs["warnings"]` of the frame, a list of texts.

    Raises Error if the study or the database is refused, or if the run was interrupted.
    """
    _pandas()  # Without it nothing is begun.
    with _file_of(study) as path:
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        _, doubts = _call(["run", path, *changes, *_options(db, out, threads, replace)], codes=_WITH_RESULTS)
        # It repeats the warnings of the run.
        plan, _ = _call(["validate", path, *changes, "--json", "--replace", "--db", os.fspath(db)])
    jobs, further = _read(db, json.loads(plan)["study"])
    jobs.attrs["warnings"] = doubts + further
    _warn(doubts + further)
    return jobs


def read(db: str | os.PathLike[str], study: str) -> pandas.DataFrame:
    """The jobs of a study in a database: a row for each job with all columns of the export.

    What the program warns of is an InputWarning, and in `attrs["warnings"]` of the frame, a list of texts.

    Raises Error if there is no such database or study.
    """
    jobs, doubts = _read(db, study)
    jobs.attrs["warnings"] = doubts
    _warn(doubts)
    return jobs


def solve(study: Study, *, preset: str | None = None, **settings: Any) -> dict[str, Any]:
    """Solves one job and returns its record. Nothing is stored. `settings` are parameters such as mu=0.4.

    What the program warns of is an InputWarning.

    Raises Error if the job is refused or fails.
    """
    changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
    with _file_of(study) as path:
        text, doubts = _call(["solve", path, *changes, "--json"])
    record: dict[str, Any] = json.loads(text)
    _warn(doubts)
    return record


def stability(
    study: Study,
    *,
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
    preset: str | None = None,
    modes: int = 4,
    threads: int | None = None,
    replace: bool = False,
    settings: Mapping[str, Any] | None = None,
) -> pandas.DataFrame:
    """Computes the complex modes of steady sliding at the points of a study, and returns a row for each of `modes` modes of each point.

    The thresholds are in `thresholds.csv` of the report.

    Raises Error if the study or the database is refused, or if the computation was interrupted.
    """
    frames = _pandas()
    options = _options(db, out, threads, replace) + ["--modes", str(modes), "--json"]
    with _file_of(study) as path:
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        text, doubts = _call(["stability", path, *changes, *options], codes=_WITH_RESULTS)
    found: pandas.DataFrame = frames.DataFrame([json.loads(line) for line in text.splitlines()])
    found.attrs["warnings"] = doubts
    _warn(doubts)
    return found


def calibrate(
    study: Study,
    data: str | os.PathLike[str] | pandas.DataFrame | None = None,
    *,
    free: Sequence[str] = (),
    at: Mapping[str, float] | None = None,
    discrepancy: Mapping[str, float] | None = None,
    most_points: int | None = None,
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
    preset: str | None = None,
    threads: int | None = None,
    replace: bool = False,
    settings: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Finds the values of free parameters that measured points do not rule out.

    `data` is a CSV file or a frame with the same columns: omega_rpm, mu_star, mu_star_error, frequency_hz, frequency_error_hz, squeals. Without it
    they are those of the study. The answer has `best`, `region` (None if everything is ruled out), `ruled_out`, `is_known`, `points` and `jobs`; with a
    point `at`, also how implausible that is.

    Raises Error if the study, the data or the database is refused, or if the run was interrupted.
    """
    options = _options(db, out, threads, replace) + ["--json"]
    options += ["--free", ",".join(free)] if free else []
    options += ["--at", ",".join(f"{name}={float(value)!r}" for name, value in at.items())] if at else []
    options += [part for name, share in (discrepancy or {}).items() for part in ("--discrepancy", f"{name}={float(share)!r}")]
    options += [] if most_points is None else ["--most-points", str(most_points)]
    with _file_of(study) as path, tempfile.TemporaryDirectory() as folder:
        if data is not None and not isinstance(data, (str, os.PathLike)):
            table = Path(folder) / "data.csv"
            data.to_csv(table, index=False)
            data = table
        options += [] if data is None else ["--data", os.fspath(data)]
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        text, doubts = _call(["calibrate", path, *changes, *options], codes=_WITH_RESULTS)
    found: dict[str, Any] = json.loads(text)
    _warn(doubts)
    return found


def validate(study: Study, *, preset: str | None = None, settings: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Checks a study without running it, and returns what its jobs take.

    What the program warns of is an InputWarning. Raises Error with all mistakes if the study is refused.
    """
    with _file_of(study) as path:
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        text, doubts = _call(["validate", path, *changes, "--json"])
    found: dict[str, Any] = json.loads(text)
    _warn(doubts)
    return found


def grid(jobs: pandas.DataFrame, values: Sequence[str], over: Sequence[str] | None = None) -> xarray.Dataset:
    """Columns of jobs as arrays over their parameters; missing where the grid has no job.

    `over` are the parameters; by default ω and μ, as far as they vary. Raises ValueError if two jobs have the same values of them.
    """
    if over is None:
        over = [name for name in ("omega_rpm", "mu") if jobs[name].nunique() > 1] or ["omega_rpm"]
    if jobs.duplicated(list(over)).any():
        raise ValueError(f"several jobs have the same {', '.join(over)}; name all parameters that vary in `over`")
    return jobs.set_index(list(over))[list(values)].to_xarray()


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError("frames need pandas: pip install 'tribosweep[xarray]', or pandas and xarray alone") from error
    return pandas


def _options(
    db: str | os.PathLike[str], out: str | os.PathLike[str] | None, threads: int | None, replace: bool
) -> list[str]:
    options = ["--db", os.fspath(db)]
    options += [] if out is None else ["--out", os.fspath(out)]
    options += [] if threads is None else ["--threads", str(threads)]
    return options + (["--replace"] if replace else [])


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy and pandas as those of JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} is no number, text, list or dictionary")


def _settings(settings: Mapping[str, Any] | None) -> list[str]:
    def text(value: Any) -> str:
        return value if isinstance(value, str) else json.dumps(value, default=_plain)

    return [part for name, value in (settings or {}).items() for part in ("--set", f"{name}={text(value)}")]


@contextmanager
def _file_of(study: Study) -> Iterator[str]:
    """The path of the study's file; that of a dictionary exists as long as it is needed."""
    if not isinstance(study, Mapping):
        yield os.fspath(study)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.json"
        path.write_text(json.dumps({"name": "study", **study}, default=_plain), encoding="utf-8")
        yield str(path)


def _read(db: str | os.PathLike[str], study: str) -> tuple[pandas.DataFrame, list[str]]:
    text, doubts = _call(["export", study, "--all", "--db", os.fspath(db)], codes=_WITH_RESULTS)
    jobs: pandas.DataFrame = _pandas().read_csv(StringIO(text))
    return jobs, doubts


def _warn(doubts: Sequence[str]) -> None:
    # At the line that has called a function of this module.
    for doubt in doubts:
        warnings.warn(doubt, InputWarning, stacklevel=3)


def _doubts(messages: str) -> list[str]:
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


def _call(arguments: Sequence[str], codes: Sequence[int] = (0,)) -> tuple[str, list[str]]:
    """The output of the program and its warnings."""
    done = subprocess.run([program(), *arguments], capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode not in codes:
        message = "\n".join(line for line in done.stderr.splitlines() if line)
        raise Error(message or f"the program ended with code {done.returncode}", done.returncode)
    return done.stdout, _doubts(done.stderr)
