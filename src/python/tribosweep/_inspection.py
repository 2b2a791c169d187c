"""The tables and fields of an inspection as arrays."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy
import pandas
import xarray

# Number types of VTK.
_TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "Int8": "i1", "UInt8": "u1"}


def read(folder: Path, *, with_fields: bool) -> dict[str, xarray.Dataset]:
    """The histories, the contact face and, if asked for, the fields of an inspection in a folder."""
    inspection = json.loads((folder / "inspection.json").read_text(encoding="utf-8"))
    totals = pandas.read_csv(folder / "totals.csv").set_index("time_s").to_xarray()
    totals.attrs = {"job": inspection["key"]}
    if inspection["cycles"]:
        totals.attrs["period_s"] = inspection["period_s"]
    names = [node["name"] for node in inspection["nodes"]]
    histories = [pandas.read_csv(folder / f"node_{name}.csv").set_index("time_s").to_xarray() for name in names]
    face = pandas.read_csv(folder / "face.csv").set_index(["time_s", "node"]).to_xarray()
    # The place of a node does not change.
    for name in ("x_m", "y_m"):
        face = face.assign_coords({name: face[name].isel(time_s=0, drop=True)})
    nodes = xarray.concat(histories, pandas.Index(names, name="node"))
    for axis, name in enumerate(("x_m", "y_m")):
        nodes = nodes.assign_coords({name: ("node", [node["at_m"][axis] for node in inspection["nodes"]])})
    found = {"totals": totals, "nodes": nodes, "face": face}
    if with_fields:
        found["fields"] = _fields(folder)
    return found


def _fields(folder: Path) -> xarray.Dataset:
    """The fields of all nodes of the pin: over the times of a cycle, nodes and components."""
    sets = ElementTree.parse(folder / "fields.pvd").getroot().iter("DataSet")
    frames = [(float(entry.attrib["timestep"]), _frame(folder / entry.attrib["file"])) for entry in sets]
    times = pandas.Index([time for time, _ in frames], name="time_s")
    return xarray.concat([frame for _, frame in frames], times)


def _frame(path: Path) -> xarray.Dataset:
    """One file of VTK with appended raw data."""
    content = path.read_bytes()
    head, _, rest = content.partition(b"<AppendedData")
    raw = rest[rest.index(b"_") + 1 :]
    root = ElementTree.fromstring(head + b"</VTKFile>")
    arrays: dict[str, Any] = {}
    for entry in root.findall(".//PointData/DataArray") + root.findall(".//Points/DataArray"):
        start = int(entry.attrib["offset"])
        length = int(numpy.frombuffer(raw, "<u8", 1, start)[0])
        kind = numpy.dtype(_TYPES[entry.attrib["type"]])
        numbers = numpy.frombuffer(raw, kind, length // kind.itemsize, start + 8)
        components = int(entry.attrib.get("NumberOfComponents", "1"))
        name = entry.attrib["Name"].replace("points", "position_m")
        if components == 1:
            arrays[name] = ("point", numbers)
        else:
            arrays[name] = (("point", f"component_{components}"), numbers.reshape(-1, components))
    return xarray.Dataset(arrays)
