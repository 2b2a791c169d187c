"""Friction-induced vibration of a pin on a disk: runs the program `tribosweep` and reads its results.

    import tribosweep
    jobs = tribosweep.run("studies/mini.json")              # a DataFrame, a row for each job
    record = tribosweep.solve("studies/mini.json", mu=0.4, omega_rpm=7)
    grid = tribosweep.grid(jobs, ["mu_star"])               # an xarray.Dataset over the parameters
    modes = tribosweep.stability("studies/mini.json")       # a DataFrame, a row for each mode of steady sliding
    found = tribosweep.calibrate("pin.json", "rig.csv")     # what measured points leave of the ranges of parameters
    apart = tribosweep.compare("mini", "rig.csv")           # a DataFrame, a row for each difference from measured points
    motion = tribosweep.inspect("studies/mini.json", mu=0.4, omega_rpm=7)["totals"]     # an xarray.Dataset over the time

Frames need pandas; `grid` and `inspect` also need xarray. A study is the path of its file, or a dictionary with the same content.
"""

from __future__ import annotations

import hashlib
import html
import json
import os
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from tribosweep._program import WITH_RESULTS, Error, InputWarning, call, doubts_of, output_of, program

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = [
    "Error",
    "InputWarning",
    "Record",
    "calibrate",
    "compare",
    "grid",
    "inspect",
    "program",
    "read",
    "run",
    "sensitivity",
    "solve",
    "stability",
    "validate",
]

Study = Union[str, "os.PathLike[str]", Mapping[str, Any]]

class Record(dict[str, Any]):
    """A dictionary of results, which a notebook shows as a table of its single values."""

    def _repr_html_(self) -> str:
        single = {name: value for name, value in self.items() if not isinstance(value, (dict, list))}
        rows = (f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(value))}</td></tr>" for name, value in single.items())
        return f"<table>{''.join(rows)}</table>"


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
        options = _options(db, out, threads, replace)
        _, doubts = call(["run", path, *changes, *options], codes=WITH_RESULTS, progress_of=db)
        # It repeats the warnings of the run.
        plan, _ = call(["validate", path, *changes, "--json", "--replace", "--db", os.fspath(db)])
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


def solve(
    study: Study, *, db: str | os.PathLike[str] | None = None, preset: str | None = None, **settings: Any
) -> Record:
    """Solves one job and returns its record. `settings` are parameters such as mu=0.4.

    With a database `db` the result is stored there, in a study of its own, and found again by a later call. Otherwise nothing is stored.

    What the program warns of is an InputWarning.

    Raises Error if the job is refused or fails.
    """
    changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
    with _file_of(study) as path:
        if db is None:
            text, doubts = call(["solve", path, *changes, "--json"])
        else:
            text, doubts = _stored(path, changes, db)
    record = Record(json.loads(text))
    _warn(doubts)
    return record


def _stored(path: str, changes: list[str], db: str | os.PathLike[str]) -> tuple[str, list[str]]:
    """The record of the only job of a study, from a database or else solved and stored there."""
    given = Path(path).read_text(encoding="utf-8") + "\n".join(changes)
    name = "solved-" + hashlib.sha256(given.encode()).hexdigest()[:8]
    options = [*changes, "--name", name]
    plan, doubts = call(["validate", path, *options, "--json", "--replace", "--db", os.fspath(db)])
    jobs = json.loads(plan)["jobs"]
    if jobs != 1:
        raise Error(f"the study has {jobs} jobs; give each parameter that varies a value", 2)
    with tempfile.TemporaryDirectory() as folder:
        call(["run", path, *options, *_options(db, folder, None, True)], codes=WITH_RESULTS, progress_of=db)
    exported, _ = call(["export", name, "--all", "--format", "json", "--db", os.fspath(db)], codes=WITH_RESULTS)
    row = json.loads(exported)
    if row["status"] == "failed":
        raise Error(row["error"], 1)
    shown, _ = call(["show", row["job"], "--json", "--db", os.fspath(db)])
    return json.dumps(json.loads(shown)["record"]), doubts


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
        text, doubts = call(["stability", path, *changes, *options], codes=WITH_RESULTS, progress_of=db)
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
) -> Record:
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
    with _file_of(study) as path, _data_file(data) as measured:
        options += [] if measured is None else ["--data", measured]
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        text, doubts = call(["calibrate", path, *changes, *options], codes=WITH_RESULTS, progress_of=db)
    found = Record(json.loads(text))
    _warn(doubts)
    return found


def sensitivity(
    studies: str | Sequence[str],
    *,
    of: Sequence[str] = ("mu_star", "frequency_hz"),
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
) -> pandas.DataFrame:
    """How much each parameter of stored studies decides, from their own jobs: a row for each index of each parameter and quantity.

    Raises Error if the database has no such study, or if a quantity is none.
    """
    names = [studies] if isinstance(studies, str) else list(studies)
    table, messages = _reported(["sensitivity", *names, "--of", ",".join(of)], "sensitivity.csv", db, out)
    _warn(doubts_of(messages))
    return table


def compare(
    studies: str | Sequence[str],
    data: str | os.PathLike[str] | pandas.DataFrame | None = None,
    *,
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
) -> pandas.DataFrame:
    """Compares stored studies with each other and with measured points: a row for each difference from the first study.

    `data` is a CSV file or a frame with the same columns, as for `calibrate`. The sentences of the verdict are in `attrs["verdict"]`.

    Raises Error if the database has no such study, or if the data cannot be used.
    """
    names = [studies] if isinstance(studies, str) else list(studies)
    with _data_file(data) as path:
        measured = [] if path is None else ["--data", path]
        table, messages = _reported(["report", *names, *measured], "differences.csv", db, out)
    others = ("warning: ", "  ", "report written to ")
    table.attrs["verdict"] = [line for line in messages.splitlines() if line and not line.startswith(others)]
    _warn(doubts_of(messages))
    return table


def inspect(
    study: Study,
    *,
    preset: str | None = None,
    nodes: Sequence[str] = (),
    cycles: int | None = None,
    fields: bool = False,
    db: str | os.PathLike[str] = "tribosweep.db",
    out: str | os.PathLike[str] | None = None,
    **settings: Any,
) -> dict[str, xarray.Dataset]:
    """Runs one job again and returns what its motion is like: `totals` over the time, `nodes` over node and time, and `face` over time and
    node of the contact face. With `fields`, also those of all nodes of the pin over one cycle.

    `nodes` are names such as "front_centre", or "X,Y" in mm. The attributes of `totals` have the key of the job and the period of its cycle.

    Raises Error if the job is refused or fails.
    """
    from tribosweep import _inspection

    options = [part for node in nodes for part in ("--node", node)]
    options += [] if cycles is None else ["--cycles", str(cycles)]
    options += [] if preset is None else ["--preset", preset]
    values = [part for part in _settings(settings) if part != "--set"]
    with _file_of(study) as path, _folder(out) as folder:
        _, doubts = call(["inspect", path, *values, *options, "--db", os.fspath(db), "--out", folder])
        found = _inspection.read(Path(folder), with_fields=fields)
    _warn(doubts)
    return found


def _reported(
    command: list[str], file: str, db: str | os.PathLike[str], out: str | os.PathLike[str] | None
) -> tuple[pandas.DataFrame, str]:
    """A table of the report that a command writes, and its messages."""
    frames = _pandas()
    with _folder(out) as folder:
        _, messages = output_of([*command, "--db", os.fspath(db), "--out", folder])
        table: pandas.DataFrame = frames.read_csv(Path(folder) / file)
    return table, messages


@contextmanager
def _folder(out: str | os.PathLike[str] | None) -> Iterator[str]:
    """A folder for a report: that one, or one that exists as long as it is needed."""
    if out is not None:
        yield os.fspath(out)
        return
    with tempfile.TemporaryDirectory() as folder:
        yield str(Path(folder) / "report")


@contextmanager
def _data_file(data: str | os.PathLike[str] | pandas.DataFrame | None) -> Iterator[str | None]:
    """The path of a file of measured points; that of a frame exists as long as it is needed."""
    if data is None or isinstance(data, (str, os.PathLike)):
        yield None if data is None else os.fspath(data)
        return
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "data.csv"
        data.to_csv(table, index=False)
        yield str(table)


def validate(study: Study, *, preset: str | None = None, settings: Mapping[str, Any] | None = None) -> Record:
    """Checks a study without running it, and returns what its jobs take.

    What the program warns of is an InputWarning. Raises Error with all mistakes if the study is refused.
    """
    with _file_of(study) as path:
        changes = _settings(settings) + ([] if preset is None else ["--preset", preset])
        text, doubts = call(["validate", path, *changes, "--json"])
    found = Record(json.loads(text))
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


# Where a study may name a file.
_FILES = ("scene/pin/mesh/file", "scene/pin/base/height_map/file", "scene/contact/mu_of_speed", "samples/file")


def _with_whole_paths(study: Mapping[str, Any]) -> dict[str, Any]:
    """The study with whole paths of the files that it names: in a dictionary they are relative to the working folder."""

    def changed(value: Any, steps: list[str]) -> Any:
        if not steps:
            return str(Path(value).resolve()) if isinstance(value, str) else value
        if not isinstance(value, Mapping) or steps[0] not in value:
            return value
        return {**value, steps[0]: changed(value[steps[0]], steps[1:])}

    for file in _FILES:
        study = changed(study, file.split("/"))
    return dict(study)


@contextmanager
def _file_of(study: Study) -> Iterator[str]:
    """The path of the study's file; that of a dictionary exists as long as it is needed."""
    if not isinstance(study, Mapping):
        yield os.fspath(study)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.json"
        path.write_text(json.dumps(_with_whole_paths({"name": "study", **study}), default=_plain), encoding="utf-8")
        yield str(path)


def _read(db: str | os.PathLike[str], study: str) -> tuple[pandas.DataFrame, list[str]]:
    text, doubts = call(["export", study, "--all", "--db", os.fspath(db)], codes=WITH_RESULTS)
    jobs: pandas.DataFrame = _pandas().read_csv(StringIO(text))
    return jobs, doubts


def _warn(doubts: Sequence[str]) -> None:
    # At the line that has called a function of this module.
    for doubt in doubts:
        warnings.warn(doubt, InputWarning, stacklevel=3)
