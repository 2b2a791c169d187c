#!/usr/bin/env python3
"""Writes docs/fields.md, docs/options.md, docs/columns.md and docs/tables.md from what the program itself prints: its schema, parameters, help and columns.

    scripts/reference.py PROGRAM [--check]

With --check it writes nothing and ends with 1 if a page is not what the program prints. Needs only Python's standard library.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

DOCS = pathlib.Path(__file__).resolve().parent.parent / "docs"


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
    return ", ".join(kind for kind in kinds if kind != "null")


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
        "# Fields of a study\n\nWritten by `scripts/reference.py` from `tribosweep schema` and `tribosweep parameters`; do not edit. [Studies](studies.md) explains the fields. The unit is in the end of "
        "a name: `_m` is metres, `_pa` pascals, `_s` seconds. A field without a default may be absent; what then holds is in its meaning.\n",
        "## The file\n\n" + table({"properties": top}, definitions),
    ]
    for name, definition in definitions.items():
        text = cell(definition.get("description", ""))
        if is_section(definition):
            parts.append(f"## {name}\n\n{text}\n\n{table(definition, definitions)}")
        elif choices(definition):
            parts.append(f"## {name}\n\n{text}\n\n" + "\n".join(choices(definition)) + "\n")
    rows = ["| parameter | unit | meaning | field |", "|---|---|---|---|"]
    for parameter in json.loads(output(program, "parameters", "--json")):
        rows.append("| `{name}` | {} | {meaning} | `{field}` |".format(parameter["unit"] or "", **parameter))
    parts.append(
        "## grid\n\nEach parameter has a list of values or a [Range](#range). `--set` takes the same names. A parameter takes the place of its field.\n\n"
        + "\n".join(rows) + "\n"
    )
    return "\n".join(parts)


def options(program):
    overview = output(program, "--help")
    commands = re.findall(r"^  ([a-z]+)  ", overview.split("Commands:")[1].split("Options:")[0], flags=re.M)
    parts = ["# Options of the commands\n\nWritten by `scripts/reference.py` from `tribosweep help`; do not edit. [Commands](commands.md) explains them.\n",
             f"```text\n{overview.rstrip()}\n```\n"]
    for command in commands:
        if command != "help":
            parts.append(f"## {command}\n\n```text\n{output(program, 'help', command).rstrip()}\n```\n")
    lines = "\n".join(parts).splitlines()
    return "\n".join(line.rstrip() for line in lines) + "\n"


COLUMNS = """# Columns

Written by `scripts/reference.py` from `tribosweep columns`; do not edit. `jobs.csv` of a report and `tribosweep export` have one line per job. `tribosweep columns` prints the columns of the plain
export, `tribosweep columns --all` those of `export --all`. With `--json` it prints them for other programs.

A cell without a value is empty in CSV and null in JSON. Numbers are exact: each is the shortest text that reads back as the
same number. [The report and its data](report.md#averages-and-residuals) says what the averaging window, the regimes and the
residuals are.

## Every export

{plain}
The parameters of the grid other than ω and μ follow, one column each. If several studies are exported, the parameters of all
of them are columns. If a parameter has the name of a column above, its column is called `parameter_NAME`: `cycles` is the
number of cycles in the window, and `parameter_cycles` the number that has to repeat.

## The rest of the record

`export --all` has these columns too:

{record}
## The inputs

`export --all` also has every input of the job, whether the study gives it or not. An input that has no effect is empty: the
disk's material if the disk is rigid, for example.

{inputs}
An input has the name of the parameter that sets it in a grid or with `--set`, with one exception: the numbers of elements are
`elements_x`, `elements_y` and `elements_z`, beside `size_x_m`. A grid sets them with `nx`, `ny` and `nz`, or all three with
`elements`; the plain export names its column like the parameter. Parameters of a grid that are not fields of a job, such as a
preset, follow as the last columns.
"""


def columns(program):
    every = json.loads(output(program, "columns", "--all", "--json"))
    plain = {column["name"] for column in json.loads(output(program, "columns", "--json"))}

    others = [column for column in every if column["name"] not in plain]
    return COLUMNS.format(
        plain=heads(column for column in every if column["name"] in plain),
        record=heads(column for column in others if column["group"] != "input"),
        inputs=heads(column for column in others if column["group"] == "input"),
    )


TABLES = """# Columns of the other tables

Written by `scripts/reference.py` from `tribosweep columns --tables`; do not edit. [Columns](columns.md) has those of `jobs.csv` and of the export. The tables of this page also
have a column for each parameter that the study varies, with the name of the [parameter](fields.md#grid). A cell without a value is empty.

"""

# The tables of an inspection.
INSPECTION = """
## `run.csv`

| column | unit | meaning |
|---|---|---|
| `start_s` | s | beginning of a part of the run |
| `normal_min_n` | N | smallest normal contact force N in it, smoothed |
| `normal_max_n` | N | largest N, smoothed |
| `clamp_tangential_min_n` | N | smallest tangential force T of the clamp |
| `clamp_tangential_max_n` | N | largest T |

## `cycles.csv`

| column | unit | meaning |
|---|---|---|
| `passage` |  | number of the cycle, from 0 |
| `start_s` | s | its beginning |
| `end_s` | s | its end |

## `totals.csv`

| column | unit | meaning |
|---|---|---|
| `time_s` | s | simulated time |
| `load_n` | N | load F |
| `normal_n` | N | total normal contact force N |
| `smooth_normal_n` | N | N after the low-pass filter |
| `clamp_tangential_n` | N | tangential force T of the clamp |
| `contact_tangential_n` | N | tangential force of the contact, in y |
| `contact_sideways_n` | N | the same in x |
| `mu_eq` |  | tangential force of the contact over N |
| `stick_nodes` |  | nodes that stick |
| `slip_nodes` |  | nodes that slip |
| `separated_nodes` |  | nodes without contact |

## `node_NODE.csv`, `face.csv`, `figure8_NODE.csv`

| column | unit | meaning |
|---|---|---|
| `time_s` | s | simulated time |
| `since_cycle_begin_s` | s | time since the beginning of the cycle |
| `node` |  | number of the node of the contact face |
| `x_m` | m | its place in x |
| `y_m` | m | its place in y |
| `ux_m` | m | displacement in x |
| `uy_m` | m | displacement in y |
| `uz_m` | m | displacement in z |
| `y_velocity_m_s` | m/s | velocity in y |
| `gap_m` | m | gap to the disk |
| `friction_x_n` | N | friction force in x |
| `friction_y_n` | N | friction force in y |
| `normal_n` | N | normal force |
| `slip_speed_m_s` | m/s | slip speed |
| `mu_eq` |  | friction force over normal force |
| `state` |  | `stick`, `slip` or `separated` |
| `tau_x_pa` | Pa | shear stress in x, smoothed |
| `tau_y_pa` | Pa | shear stress in y, smoothed |
| `sigma_n_pa` | Pa | normal stress, smoothed |
| `sigma_n_delayed_pa` | Pa | normal stress after the filter of the record, which delays it |

## `phases.csv`, `instants.csv`

| column | unit | meaning |
|---|---|---|
| `node` |  | name of the observed node |
| `state` |  | contact state of the phase |
| `start_s` | s | beginning of the phase |
| `end_s` | s | its end |
| `instant` |  | letter of the instant, as in `figure4.svg` |
| `time_s` | s | its time |

## `wave.csv`

| column | unit | meaning |
|---|---|---|
| `y_m` | m | place of a node on the middle line of the contact face |
| `contact_s` | s | time at which it touches |
| `stick_s` | s | time at which it begins to stick |
| `peak_s` | s | time of its largest normal stress |
| `slip_s` | s | time at which it begins to slip |
| `separation_s` | s | time at which it lifts off |

## `loops.csv`

| column | unit | meaning |
|---|---|---|
| `place` |  | name of an observed node, or `face` |
| `time_s` | s | simulated time |
| `slip_y_m` | m | slip in y since the cycle began |
| `displacement_y_m` | m | displacement in y |
| `friction_y_n` | N | friction force in y |
| `clamp_tangential_n` | N | tangential force T of the clamp, for the face |
| `state` |  | contact state, for a node |

## `spectrum.csv`

| column | unit | meaning |
|---|---|---|
| `frequency_hz` | Hz | frequency of a line |
| `normal_amplitude_n` | N | amplitude of N at it |
"""


def heads(columns):
    rows = ["| column | unit | meaning |", "|---|---|---|"]
    rows += [f"| `{column['name']}` | {column['unit'] or ''} | {cell(column['meaning'])} |" for column in columns]
    return "\n".join(rows) + "\n"


def tables(program):
    parts = []
    for own in json.loads(output(program, "columns", "--tables", "--json")):
        title = ", ".join(f"`{name}`" for name in own["files"])
        text = f"## {title}\n\n{own['lines']}\n"
        parts.append(f"{text}\n{heads(own['columns'])}" if own["columns"] else text)
    return TABLES + "\n".join(parts) + INSPECTION


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    program = sys.argv[1]
    wrong = []
    for name, text in [("fields.md", fields(program)), ("options.md", options(program)), ("columns.md", columns(program)), ("tables.md", tables(program))]:
        page = DOCS / name
        if "--check" not in sys.argv:
            page.write_text(text)
            print(f"written: docs/{name}")
        elif not page.exists() or page.read_text() != text:
            wrong.append(name)
    if wrong:
        raise SystemExit(f"docs differ from the program: {', '.join(wrong)}; run scripts/reference.py {program}")


if __name__ == "__main__":
    main()
