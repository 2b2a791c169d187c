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

import html
import json
import os
import tempfile
import uuid
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
# Without one it is that of TRIBOSWEEP_DB, or tribosweep.db in the working folder.
Database = Union[str, "os.PathLike[str]", None]
Names = Union[str, "os.PathLike[str]", Sequence[str]]

class Record(dict[str, Any]):
    """A dictionary of results, which a notebook shows as a table of its single values."""

    def _repr_html_(self) -> str:
        single = {name: value for name, value in self.items() if not isinstance(value, (dict, list))}
        rows = (f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(value))}</td></tr>" for name, value in single.items())
        return f"<table>{''.join(rows)}</table>"


def run(
    study: Study,
    *,
    db: Database = None,
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
        changes = _changes(preset, settings)
        plan, _ = call(["validate", path, *changes, "--json", "--replace", *_database(db)])
        options = _options(db, out, threads, replace)
        _, doubts = call(["run", path, *changes, *options], codes=WITH_RESULTS, progress_of=_path_of(db))
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


def solve(study: Study, *, db: Database = None, preset: str | None = None, **settings: Any) -> Record:
    """Solves one job and returns its record. `settings` are parameters such as mu=0.4.

    With a database `db` the result is stored there, in a study `solved-` and the beginning of the job's key, and a later call finds it. Without
    one nothing is stored.

    What the program warns of is an InputWarning.

    Raises Error if the job is refused or fails.
    """
    changes = _changes(preset, settings)
    with _file_of(study) as path:
        if db is None:
            text, doubts = call(["solve", path, *changes, "--json"])
            record = Record(json.loads(text))
        else:
            record, doubts = _stored(path, changes, db)
    _warn(doubts)
    return record


def _stored(path: str, changes: list[str], db: str | os.PathLike[str]) -> tuple[Record, list[str]]:
    """Solves the only job of a study, or finds its record in the database."""
    # No other call has this name, so that none replaces the study.
    name = "solve-" + uuid.uuid4().hex
    options = [*changes, "--name", name]
    plan, doubts = call(["validate", path, *options, "--json", *_database(db)])
    jobs = json.loads(plan)["jobs"]
    if jobs != 1:
        raise Error(f"the study has {jobs} jobs; give each parameter that varies a value", 2)
    with tempfile.TemporaryDirectory() as folder:
        call(["run", path, *options, *_options(db, folder, None, False)], codes=WITH_RESULTS, progress_of=db)
    exported, _ = call(["export", *_database(db), "--all", "--format", "json", "--", name], codes=WITH_RESULTS)
    row = json.loads(exported)
    try:
        call(["rename", *_database(db), "--", name, "solved-" + row["job"][:16]])
    except Error:
        # An earlier call has stored this job.
        call(["rm", *_database(db), "--", name])
    if row["status"] == "failed":
        raise Error(row["error"], 1)
    shown, _ = call(["show", row["job"], "--json", *_database(db)])
    record = json.loads(shown)["record"]
    if record is None:
        raise Error(f"the job {row['job']} has no result that can be read; its status is {row['status']}", 1)
    return Record(record), doubts


def stability(
    study: Study,
    *,
    db: Database = None,
    out: str | os.PathLike[str] | None = None,
    preset: str | None = None,
    modes: int = 4,
    near: float | str | None = None,
    threads: int | None = None,
    replace: bool = False,
    settings: Mapping[str, Any] | None = None,
) -> pandas.DataFrame:
    """Computes the complex modes of steady sliding at the points of a study, and returns a row for each of `modes` modes of each point.

    With `near`, a frequency in Hz or with a unit (`"11kHz"`), the rows are those of all modes that grow and of the nearest others.
    The thresholds are in `thresholds.csv` of the report.

    Raises Error if the study or the database is refused, or if the computation was interrupted.
    """
    frames = _pandas()
    options = _options(db, out, threads, replace) + [f"--modes={modes}", "--json"]
    if near is not None:
        options.append(f"--near={near}")
    with _file_of(study) as path:
        changes = _changes(preset, settings)
        text, doubts = call(["stability", path, *changes, *options], codes=WITH_RESULTS, progress_of=_path_of(db))
    found: pandas.DataFrame = frames.DataFrame([json.loads(line) for line in text.splitlines()])
    found.attrs["warnings"] = doubts
    _warn(doubts)
    return found


def calibrate(
    study: Study,
    data: str | os.PathLike[str] | pandas.DataFrame | None = None,
    *,
    free: Names = (),
    at: Mapping[str, float] | None = None,
    discrepancy: Mapping[str, float] | None = None,
    most_points: int | None = None,
    bins: int | None = None,
    db: Database = None,
    out: str | os.PathLike[str] | None = None,
    preset: str | None = None,
    threads: int | None = None,
    replace: bool = False,
    settings: Mapping[str, Any] | None = None,
) -> Record:
    """Finds the values of free parameters that measured points do not rule out.

    `data` is a CSV file or a frame with the same columns: omega_rpm, mu_star, mu_star_error, frequency_hz, frequency_error_hz, squeals. Without it
    they are those of the study. With `bins` its rows are samples, and their means in so many bins count. The answer has `best`, `region` (None if everything is ruled out), `ruled_out`, `is_known`, `points` and `jobs`; with a
    point `at`, also how implausible that is.

    Raises Error if the study, the data or the database is refused, or if the run was interrupted.
    """
    options = _options(db, out, threads, replace) + ["--json"]
    options += ["--free", ",".join(_list(free))] if free else []
    options += ["--at", ",".join(f"{name}={float(value)!r}" for name, value in at.items())] if at else []
    options += [part for name, share in (discrepancy or {}).items() for part in ("--discrepancy", f"{name}={float(share)!r}")]
    options += [] if most_points is None else [f"--most-points={most_points}"]
    with _file_of(study) as path, _data_file(data) as measured:
        options += [] if measured is None else ["--data", measured]
        options += [] if bins is None else [f"--bins={bins}"]
        changes = _changes(preset, settings)
        text, doubts = call(["calibrate", path, *changes, *options], codes=WITH_RESULTS, progress_of=_path_of(db))
    found = Record(json.loads(text))
    _warn(doubts)
    return found


def sensitivity(
    studies: Names,
    *,
    of: Names = ("mu_star", "frequency_hz"),
    db: Database = None,
    out: str | os.PathLike[str] | None = None,
) -> pandas.DataFrame:
    """Says how much each parameter of stored studies decides, and returns a row for each index of each parameter and quantity.

    The indices are those of the studies' own jobs. What the program says about them is in `attrs["notes"]`. A quantity without an index is an
    InputWarning.

    Raises Error if the database has no such study, or if `of` names something that is no quantity.
    """
    quantities = _list(of)
    command = ["sensitivity", "--of", ",".join(quantities)]
    table, said, messages = _reported(command, _list(studies), "sensitivity.csv", db, out)
    table.attrs["notes"] = [line.removeprefix("- ") for line in (said + messages).splitlines() if line.startswith("- ")]
    doubts = doubts_of(messages)
    doubts += [f"no index of {name}: see attrs['notes']" for name in quantities if name not in set(table["quantity"])]
    table.attrs["warnings"] = doubts
    _warn(doubts)
    return table


def compare(
    studies: Names,
    data: str | os.PathLike[str] | pandas.DataFrame | None = None,
    *,
    sensitivity: str | None = None,
    bins: int | None = None,
    db: Database = None,
    out: str | os.PathLike[str] | None = None,
) -> pandas.DataFrame:
    """Compares stored studies with each other and with measured points, and returns a row for each difference from the first study.

    `data` is a CSV file or a frame with the same columns, as for `calibrate`. The sentences of the verdict are in `attrs["verdict"]`. If no
    point could be compared, that is an InputWarning. `sensitivity` names a stored study that varies what could explain the differences;
    `bins` is that of `calibrate`.

    Raises ValueError if there is only one study and no data, and Error if the database has no such study, or if the data cannot be used.
    """
    names = _list(studies)
    if len(names) < 2 and data is None:
        raise ValueError("one study has nothing to be compared with; give a second study or data")
    with _data_file(data) as path:
        measured = [] if path is None else ["--data", path]
        further = [] if sensitivity is None else ["--sensitivity", sensitivity]
        further += [] if bins is None else [f"--bins={bins}"]
        table, _, messages = _reported(["report", *measured, *further], names, "differences.csv", db, out)
    others = ("warning: ", "  ", "report written to ")
    table.attrs["verdict"] = [line for line in messages.splitlines() if line and not line.startswith(others)]
    doubts = doubts_of(messages) + ([] if len(table) else ["no point of the first study could be compared"])
    table.attrs["warnings"] = doubts
    _warn(doubts)
    return table


def inspect(
    study: Study,
    *,
    job: str | None = None,
    preset: str | None = None,
    nodes: Names = (),
    cycles: int | None = None,
    frames: int | None = None,
    fields: bool = False,
    db: Database = None,
    out: str | os.PathLike[str] | None = None,
    **settings: Any,
) -> dict[str, xarray.Dataset]:
    """Runs one job again and returns its motion: `totals` over the time, `nodes` over node and time, and `face` over time and node of the
    contact face. With `fields`, the answer also has those of all nodes of the pin at the times of `frames`.

    The study may also be the name of a stored one. `job` is a key of one of its jobs; otherwise a parameter that `settings` does not give has the
    value of the scene, which is an InputWarning if the study has no such job. `nodes` are names such as "front_centre", or "X,Y" in mm. The
    attributes of `totals` have the key of the job, and the period of its cycle if it has one.

    Raises Error if the job is refused or fails.
    """
    _pandas()
    from tribosweep import _inspection

    options = [part for node in _list(nodes) for part in ("--node", node)]
    options += [] if cycles is None else [f"--cycles={cycles}"]
    options += [] if frames is None else [f"--frames={frames}"]
    options += _changes(preset, None)
    values = _assignments(settings) + ([] if job is None else [job])
    with _file_of(study) as path, _folder(out) as folder:
        _, messages = output_of(["inspect", *options, *_database(db), "--out", folder, "--", path, *values])
        found = _inspection.read(Path(folder), with_fields=fields)
    doubts = doubts_of(messages)
    doubts += [line for line in messages.splitlines() if line.startswith("this job is none of the points of ")]
    _warn(doubts)
    return found


def _reported(
    command: list[str], names: list[str], file: str, db: Database, out: str | os.PathLike[str] | None
) -> tuple[pandas.DataFrame, str, str]:
    """Reads a table of the report that a command writes. Also returns what the command prints, and its messages."""
    frames = _pandas()
    with _folder(out) as folder:
        said, messages = output_of([*command, *_database(db), "--out", folder, "--", *names], codes=WITH_RESULTS)
        table: pandas.DataFrame = frames.read_csv(Path(folder) / file, **_AS_WRITTEN)
    return table, said, messages


# Names stay texts, and only an empty cell is no value.
_AS_WRITTEN: dict[str, Any] = {
    "dtype": {name: str for name in ("study", "job", "source", "reference")},
    "keep_default_na": False,
    "na_values": [""],
}


def _list(names: Names) -> list[str]:
    """Makes a list of several names, or of one."""
    return [os.fspath(names)] if isinstance(names, (str, os.PathLike)) else list(names)


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


def validate(
    study: Study, *, db: Database = None, preset: str | None = None, settings: Mapping[str, Any] | None = None
) -> Record:
    """Checks a study without running it, and returns what its jobs take.

    What the program warns of is an InputWarning. Raises Error with all mistakes if the study is refused.
    """
    with _file_of(study) as path:
        changes = _changes(preset, settings)
        text, doubts = call(["validate", path, *changes, "--json", "--replace", *_database(db)])
    found = Record(json.loads(text))
    _warn(doubts)
    return found


def grid(jobs: pandas.DataFrame, values: Names, over: Names | None = None) -> xarray.Dataset:
    """Columns of jobs as arrays over their parameters; missing where the grid has no job.

    `over` are the parameters; by default ω and μ, as far as they vary. Raises ValueError if two jobs have the same values of them.
    """
    if over is None:
        over = [name for name in ("omega_rpm", "mu") if jobs[name].nunique() > 1] or ["omega_rpm"]
    axes = _list(over)
    if jobs.duplicated(axes).any():
        raise ValueError(f"several jobs have the same {', '.join(axes)}; name all parameters that vary in `over`")
    cube: xarray.Dataset = jobs.set_index(axes)[_list(values)].to_xarray()
    return cube


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError("frames need pandas: pip install 'tribosweep[xarray]', or pandas and xarray alone") from error
    return pandas


def _database(db: Database) -> list[str]:
    return [] if db is None else ["--db", os.fspath(db)]


def _path_of(db: Database) -> str:
    return os.environ.get("TRIBOSWEEP_DB", "tribosweep.db") if db is None else os.fspath(db)


def _options(db: Database, out: str | os.PathLike[str] | None, threads: int | None, replace: bool) -> list[str]:
    options = _database(db)
    options += [] if out is None else ["--out", os.fspath(out)]
    options += [] if threads is None else [f"--threads={threads}"]
    return options + (["--replace"] if replace else [])


def _plain(value: Any) -> Any:
    """Makes numbers, arrays and paths those of JSON."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, range):
        return list(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "__array__"):
        return value.__array__().tolist()
    raise TypeError(f"{value!r} is no number, text, list or dictionary")


def _assignments(settings: Mapping[str, Any] | None) -> list[str]:
    """Writes each setting as NAME=VALUE."""

    def text(value: Any) -> str:
        return value if isinstance(value, str) else json.dumps(value, default=_plain)

    return [f"{name}={text(value)}" for name, value in (settings or {}).items()]


def _changes(preset: str | None, settings: Mapping[str, Any] | None) -> list[str]:
    """The options that change a study."""
    options = [part for assignment in _assignments(settings) for part in ("--set", assignment)]
    return options + ([] if preset is None else ["--preset", preset])


# Where a study may name a file.
_FILES = ("scene/pin/mesh/file", "scene/pin/base/height_map/file", "scene/contact/mu_of_speed", "samples/file")


def _with_whole_paths(study: Mapping[str, Any]) -> dict[str, Any]:
    """The study with whole paths of the files that it names: in a dictionary they are relative to the working folder."""

    def changed(value: Any, steps: list[str]) -> Any:
        if not steps:
            is_file = isinstance(value, (str, os.PathLike)) and os.fspath(value) != ""
            return str(Path(value).resolve()) if is_file else value
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
        text = json.dumps(_with_whole_paths({"name": "study", **study}), default=_plain, indent=1)
        path.write_text(text, encoding="utf-8")
        try:
            yield str(path)
        except Error as error:
            # The file is gone when somebody reads this.
            raise Error(str(error).replace(str(path), "study"), error.code) from None


def _read(db: Database, study: str) -> tuple[pandas.DataFrame, list[str]]:
    text, doubts = call(["export", "--all", *_database(db), "--", study], codes=WITH_RESULTS)
    jobs: pandas.DataFrame = _pandas().read_csv(StringIO(text), **_AS_WRITTEN)
    return jobs, doubts


def _warn(doubts: Sequence[str]) -> None:
    # At the line that has called a function of this module.
    for doubt in doubts:
        warnings.warn(doubt, InputWarning, stacklevel=3)
