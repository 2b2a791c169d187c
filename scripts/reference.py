#!/usr/bin/env python3
"""Writes docs/reference.md from what the program itself prints: its help, schema, parameters and columns.

    scripts/reference.py PROGRAM [--check]

With --check it writes nothing and ends with 1 if the page is not what the program prints. Needs only Python's standard library.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "reference.md"


def output(program, *arguments):
    # The width of the help must not depend on the terminal, and defaults not on the environment.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("TRIBOSWEEP")}
    environment.update(COLUMNS="100", NO_COLOR="1")
    return subprocess.run([program, *arguments], env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout


def cell(text):
    return " ".join(text.split()).replace("|", "\\|")


def referred(schema):
    """The name of the definition that a field has, if it has one."""
    for choice in [schema, *schema.get("anyOf", [])]:
        if "$ref" in choice:
            return choice["$ref"].rsplit("/", 1)[1]
    return None


def values(schema, definitions):
    """What may stand in a field."""
    name = referred(schema)
    if name:
        definition = definitions[name]
        return f"[{name}](#{name.lower()})" if is_section(definition) else values(definition, definitions)
    choices = schema.get("oneOf", []) + schema.get("anyOf", [])
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if len(schema.get("enum", [])) > 20:
        return "a parameter of the [grid](#grid)"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"] if value is not None)
    if choices:
        parts = [values(choice, definitions) for choice in choices if choice.get("type") != "null"]
        return ", ".join(part for part in dict.fromkeys(parts) if part)
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if "array" in kinds and isinstance(schema.get("items"), dict):
        least, most = schema.get("minItems"), schema.get("maxItems")
        count = f" of {least}" if least and least == most else ""
        inner = values(schema["items"], definitions)
        return f"list{count}: {inner}" if inner else f"list{count}"
    # The head of the page says which numbers may be texts with units.
    hidden = ["null", "string"] if "number" in kinds else ["null"]
    return ", ".join(kind for kind in kinds if kind not in hidden)


def is_section(definition):
    return "properties" in definition


def default(schema, definitions):
    """The default of a field. Those of an object are in its own section."""
    name = referred(schema)
    if "default" not in schema or (name and is_section(definitions[name])) or schema["default"] is None:
        return ""
    return f"`{json.dumps(schema['default'])}`"


def table(schema, definitions):
    rows = ["| field | content | default | meaning |", "|---|---|---|---|"]
    for name, field in schema["properties"].items():
        target = referred(field)
        description = field.get("description") or (definitions[target].get("description", "") if target else "")
        own = [values(field, definitions), default(field, definitions), description]
        rows.append(f"| `{name}` | " + " | ".join(map(cell, own)) + " |")
    return "\n".join(rows) + "\n"


def choices(definition):
    """The values of a choice, where the program describes each of them."""
    described = [choice for choice in definition.get("oneOf", []) if "const" in choice and choice.get("description")]
    return [f"* `{json.dumps(choice['const'])}`: {cell(choice['description'])}" for choice in described]


def fields(program):
    schema = json.loads(output(program, "schema"))
    definitions = schema["$defs"]
    top = {name: field for name, field in schema["properties"].items() if name != "grid"}
    parts = [
        "## Fields\n\n[The study and the scene](study.md) explains them. The unit is in the end of a name: `_m` is metres, `_pa` pascals, `_s` seconds. Such a number may be a "
        "[text with another unit](study.md#units). A field without a default may be absent; what then holds is in its meaning.\n",
        "### The file\n\n" + table({"properties": top}, definitions),
    ]
    for name, definition in definitions.items():
        text = cell(definition.get("description", ""))
        if is_section(definition):
            parts.append(f"### {name}\n\n{text}\n\n{table(definition, definitions)}")
        elif choices(definition):
            parts.append(f"### {name}\n\n{text}\n\n" + "\n".join(choices(definition)) + "\n")
    rows = ["| parameter | unit | meaning | field |", "|---|---|---|---|"]
    for parameter in json.loads(output(program, "parameters", "--json")):
        rows.append("| `{name}` | {} | {meaning} | `{field}` |".format(parameter["unit"] or "", **parameter))
    parts.append(
        "### grid\n\nEach parameter has a list of values or a [Range](#range). `--set` takes the same names. A parameter takes the place of its field.\n\n"
        + "\n".join(rows) + "\n"
    )
    return "\n".join(parts)


def entries(lines):
    """The arguments or options in a section of the help, each with its meaning."""
    found = []
    for line in lines:
        head = re.match(r"^ {2,6}(\S.*?)(?: {2,}(\S.*))?$", line)
        if head and len(line) - len(line.lstrip()) <= 6 and line.lstrip()[0] in "-<[":
            found.append([head[1], head[2] or ""])
        elif found:
            found[-1][1] += " " + line.strip()
    return [(name, cell(meaning)) for name, meaning in found]


def sections(text):
    """The sections of a help: its first words, and the lines below `Arguments:`, `Options:` and so on."""
    found, name = {"": []}, ""
    for line in text.splitlines():
        head = re.match(r"^([A-Z][a-z]+( [a-z]+)?):(.*)$", line)
        if head:
            name = head[1]
            found[name] = [head[3].strip()] if head[3].strip() else []
        else:
            found[name].append(line)
    return found


# An option that so many commands have in the same words is described once.
SHARED = 3


def commands(program):
    overview = output(program, "--help")
    names = re.findall(r"^  ([a-z]+)  ", overview.split("Commands:")[1].split("Options:")[0], flags=re.M)
    helps = {name: sections(output(program, "help", name)) for name in names if name != "help"}
    users = {}
    for name, own in helps.items():
        for option in entries(own["Options"]):
            users.setdefault(option, []).append(name)
    is_shared = lambda option: len(users[option]) >= SHARED
    parts = ["## Commands\n\n`tribosweep help COMMAND` prints the same.\n"]
    rows = ["| command | what it does |", "|---|---|"]
    rows += [f"| [`{name}`](#tribosweep-{name}) | {cell(' '.join(own['']))} |" for name, own in helps.items()]
    parts.append("\n".join(rows) + "\n")
    rows = ["| option | meaning | commands |", "|---|---|---|"]
    rows += [f"| `{cell(option[0])}` | {option[1]} | {', '.join(of)} |" for option, of in users.items() if is_shared(option) and "--help" not in option[0]]
    parts.append("### Options of several commands\n\n" + "\n".join(rows) + "\n")
    for name, own in helps.items():
        rows = [f"| `{cell(argument)}` | {meaning} |" for argument, meaning in entries(own.get("Arguments", []))]
        rows += [f"| `{cell(option[0])}` | {option[1]} |" for option in entries(own["Options"]) if not is_shared(option) and "--help" not in option[0]]
        parts.append(f"### `tribosweep {name}`\n\n`{own['Usage'][0]}`\n")
        if rows:
            parts.append("\n".join(["| argument or option | meaning |", "|---|---|", *rows]) + "\n")
    return "\n".join(parts)


COLUMNS = """## Columns

`jobs.csv` of a report and `tribosweep export` have one line per job. `tribosweep columns` prints the columns of the plain export, `tribosweep columns --all` those of `export --all`, with `--json` for other programs.

A cell without a value is empty in CSV and null in JSON. Numbers are exact: each is the shortest text that reads back as the
same number. [The report](report.md#averages-and-residuals) explains the averaging window and the residuals.

### Every export

{plain}
The parameters of the grid other than ω and μ follow, one column each. If several studies are exported, the parameters of all
of them are columns. If a parameter has the name of a column above, its column is called `parameter_NAME`: `cycles` is the
number of cycles in the window, and `parameter_cycles` the number that has to repeat.

### The rest of the record

`export --all` has these columns too:

{record}
### The inputs

`export --all` also has every input of the job, whether the study gives it or not. An input that has no effect is empty: the
disk's material if the disk is rigid, for example.

{inputs}
An input has the name of the parameter that sets it in a grid or with `--set`, with one exception: the numbers of elements are
`elements_x`, `elements_y` and `elements_z`, beside `size_x_m`. A grid sets them with `nx`, `ny` and `nz`, or all three with
`elements`; the plain export names its column like the parameter. Parameters of a grid that are not fields of a job, such as a
preset, follow as the last columns.
"""


def heads(columns):
    rows = ["| column | unit | meaning |", "|---|---|---|"]
    rows += [f"| `{column['name']}` | {column['unit'] or ''} | {cell(column['meaning'])} |" for column in columns]
    return "\n".join(rows) + "\n"


def columns(program):
    every = json.loads(output(program, "columns", "--all", "--json"))
    plain = {column["name"] for column in json.loads(output(program, "columns", "--json"))}

    others = [column for column in every if column["name"] not in plain]
    return COLUMNS.format(
        plain=heads(column for column in every if column["name"] in plain),
        record=heads(column for column in others if column["group"] != "input"),
        inputs=heads(column for column in others if column["group"] == "input"),
    )


TABLES = """## Other tables

The tables below also have a column for each parameter that the study varies, with the name of the [parameter](#grid). A cell without a value is empty.

"""


def tables(program):
    parts = []
    for own in json.loads(output(program, "columns", "--tables", "--json")):
        title = ", ".join(f"`{name}`" for name in own["files"])
        text = f"### {title}\n\n{own['lines']}\n"
        parts.append(f"{text}\n{heads(own['columns'])}" if own["columns"] else text)
    return TABLES + "\n".join(parts)


# The tests compare this list with the files that the examples of the book write.
FILES = """## Files

Every file is replaced as a whole, so an interrupted command leaves no half-written one. Words in capitals stand for names.

### The current folder

| file | content |
|---|---|
| `tribosweep.db` | studies, jobs and results (SQLite); `--db` or `TRIBOSWEEP_DB` names another file or a server |
| `reports/` | one folder for each report |
| `STUDY.slurm/` | the scripts and results of [`slurm`](long_sweeps.md#slurm) |

While a process has the database open, two files beside it (`-wal`, `-shm`) are parts of it; `tribosweep.db.lock` says which file they belong to, and stays. `tribosweep.db.rescued-1` is a copy of a database that was [deleted or replaced](long_sweeps.md#several-workers) while a worker had it open. Copy it with `copy`, or when no process works on it.

### A report

`reports/STUDY/`, or `reports/A-vs-B/` for [several sources](calibrate.md#compare). `report --out` names another folder.

| file | content |
|---|---|
| `report.html` | the report as one page, which needs no other file |
| `explore.html` | all jobs, for [charts and tables of your own](report.md) |
| `report.md` | the same report as Markdown |
| `jobs.csv` | all jobs, one line per job, with these [columns](#columns) |
| `mu_star.svg`, `mu_star_points.csv` | μ\* as curves, and the data behind them |
| `mu_star.csv` | μ\* as a table |
| `frequency.svg`, `frequency.csv` | the same for the frequency |
| `frequency_map.svg`, `frequency_map.csv` | the frequencies, a cell for each job |
| `regime.csv` | a table of the regimes |
| `regime_map.svg`, `regime_map.csv` | the regimes, a cell for each job |
| `regime_plane.svg` | the regimes [on true axes](report.md#the-page) |
| `growth_rate.svg`, `growth_rate.csv` | growth rates of jobs that end in steady sliding |
| `bifurcation.svg`, `bifurcation.csv` | the [bifurcation diagram](report.md#the-page) |
| `shares.svg`, `shares.csv` | the shares of stick, slip and separation |
| `residuals.svg`, `residuals.csv` | the [residuals](report.md#averages-and-residuals) |
| `run_times.csv` | the times of the jobs |
| `scene.svg`, `track.svg` | drawings of the pin and of the disk |
| `QUANTITY.svg`, `QUANTITY.csv`, `QUANTITY_points.csv` | the same for a quantity of [`--y`](report.md#axes) |
| `FIGURE-2.svg`, `FIGURE-over-NAME.svg` | further figures of the same kind, where one is not enough |
| `differences.csv`, `differences.svg` | the [differences](calibrate.md#compare) between several sources |
| `windows.csv`, `program.svg` | windows of jobs [whose speed or load changes](study.md#speed-and-load-in-time) |
| `stability_map.svg`, `lock_in.svg`, `thresholds.svg`, `modes.csv`, `thresholds.csv` | the [linear stability](report.md#linear-stability), if it is known |
| `waterfall.svg`, `waterfall.csv` | the [waterfall](report.md#waterfall), if spectra are stored |
| `waves.csv`, `boundaries.csv`, `minima.csv`, `branches.csv`, `basins.csv` | what a [plan that learns](points.md#plans-that-learn) has found |
| `calibration.csv`, `calibration_data.csv`, `calibration.svg` | the free parameters, the measured values and the region of a [calibration](calibrate.md) |
| `sensitivity.html`, `sensitivity.md`, `sensitivity.csv`, `sensitivity_points.csv` | written by [`sensitivity`](report.md#which-parameter-decides) |
| `pareto.html`, `pareto.svg`, `pareto.md`, `pareto.csv`, `refinement.csv` | written by [`pareto`](report.md#error-against-run-time) |
| `.tribosweep-KIND` | the list of these files. A later report removes those that it does not have any more, and leaves all others alone. Other folders have such a list, too |

### Linear stability

`reports/STUDY-stability/` of the command [`stability`](squeal.md):

| file | content |
|---|---|
| `stability.html` | the page |
| `modes/POINT_mode-N.pvd`, `modes/POINT_mode-N/phase_N.vtu`, `modes/.tribosweep-KIND` | [mode shapes](report.md#fields-for-paraview) for ParaView, with `--shapes` |

Its figures and CSV files are those of the linear stability in a report.

### An inspection

`reports/STUDY/inspect/JOB/` of the command [`inspect`](report.md#inside-a-job):

| file | content |
|---|---|
| `index.html` | the page |
| `inspection.json` | all numbers, with the job's key, specification and record |
| `run.csv` | N, T and the contact states over the whole run |
| `totals.csv`, `totals.svg` | forces and shares over the last cycles |
| `cycles.csv` | a line for each cycle of the run |
| `node_NODE.csv` | the history of an observed node |
| `phases.csv`, `figure2a.svg`, `figure2b.svg`, `figure3a.svg`, `figure3b.svg` | stick, slip and separation of the observed nodes, trajectories and phase planes |
| `instants.csv`, `figure4.svg` | the instants at which a node's contact state changes |
| `face.csv`, `figure5.svg` | every contact node at every step of a cycle; snapshots of the pin |
| `wave.csv`, `wave.svg` | the waves in the contact |
| `loops.csv`, `loops.svg` | [hysteresis loops](report.md#inside-a-job) |
| `spectrum.csv`, `spectrum.svg` | the spectrum of the normal force |
| `fields.pvd`, `fields/pin_N.vtu` | [fields for ParaView](report.md#fields-for-paraview) |
| `scene.svg`, `track.svg` | drawings of the pin and of the disk |
| `figure8_NODE.svg`, `figure8_NODE.csv` | several jobs over each other, with `--overlay`, in a folder of their own beside those of jobs |
| `.tribosweep-KIND` | the list of these files |

The figures are numbered as in [the paper](evidence/paper.md).

### A job array

`STUDY.slurm/` of the command [`slurm`](long_sweeps.md#slurm):

| file | content |
|---|---|
| `workers.sbatch`, `report.sbatch`, `submit.sh` | the scripts |
| `ARRAY_TASK.log`, `report-JOB.log` | the messages of the tasks over all their time slots |
| `jobs` | the numbers of the last array and of the last report job |
| `shards/shard-N.db`, `tribosweep.db` | without a server: what each task saved, and the merged database |
| `report/`, `jobs.csv` | the report and the table |

If the study comes from standard input, or if `--set`, `--preset` or `--name` changes it, it is in `study.json`.
"""

TITLE = """# Reference

The program wrote this page (`scripts/reference.py`); do not edit. It has the [commands](#commands), the [fields](#fields) of a study and the [parameters](#grid) of a grid, the [columns](#columns) of the export, those of
[other tables](#other-tables), and the [files](#files) that the commands write.
"""


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    program = sys.argv[1]
    text = "\n".join([TITLE, commands(program), fields(program), columns(program), tables(program), FILES])
    if "--check" not in sys.argv:
        PAGE.write_text(text)
        print("written: docs/reference.md")
    elif not PAGE.exists() or PAGE.read_text() != text:
        raise SystemExit(f"docs/reference.md differs from the program: run scripts/reference.py {program}")


if __name__ == "__main__":
    main()
