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
        "# Fields of a study\n\nWritten by `scripts/reference.py` from `tribosweep schema` and `tribosweep parameters`; do not edit. [Studies](studies.md) explains the fields. The unit is in the end of "
        "a name: `_m` is metres, `_pa` pascals, `_s` seconds. Such a number may be a [text with another unit](studies.md#units). A field without a default may be absent; what then holds is in its meaning.\n",
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
    return TABLES + "\n".join(parts)


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
