#!/usr/bin/env python3
"""Prints the licences of all packages that are part of the program, with their texts: THIRDPARTY.txt of a release.

    scripts/licences.py TARGET

Ends with 1 if a package states no licence. Needs cargo, and Python's standard library.
"""

import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What is in the program and is no package: its name, its licence, where it is from, and the file with the licence's text.
OTHERS = [
    ("Apache ECharts 6.1.0", "Apache-2.0", "https://echarts.apache.org", ROOT / "src/output/report/explore/echarts-NOTICE.txt"),
]
# A package brings its licences in files of these names.
NAMES = ("license", "licence", "copying", "copyright", "unlicense", "notice")


def packages(target):
    """The packages that are linked into the program, without those of this repository, of builds and those of tests."""
    arguments = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", target]
    data = json.loads(subprocess.run(arguments, stdout=subprocess.PIPE, check=True).stdout)
    nodes = {node["id"]: node for node in data["resolve"]["nodes"]}
    root = data["resolve"]["root"]
    found, next_ones = set(), [root]
    while next_ones:
        node = nodes[next_ones.pop()]
        for dependency in node["deps"]:
            is_linked = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            if is_linked and dependency["pkg"] not in found:
                found.add(dependency["pkg"])
                next_ones.append(dependency["pkg"])
    own = set(data["workspace_members"])
    return sorted((p for p in data["packages"] if p["id"] in found - own), key=lambda p: (p["name"], p["version"]))


def texts(package):
    folder = pathlib.Path(package["manifest_path"]).parent
    files = [path for path in sorted(folder.iterdir()) if path.is_file() and path.name.lower().startswith(NAMES)]
    return [path.read_text(errors="replace").strip() for path in files]


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    own = packages(sys.argv[1])
    unknown = [p["name"] for p in own if not p["license"] and not texts(p)]
    if unknown:
        raise SystemExit(f"no licence: {', '.join(unknown)}")
    users = {}
    print("The program contains these packages.\n")
    for package in own:
        name = f"{package['name']} {package['version']}"
        print(f"{name}: {package['license'] or 'see below'}, {package['repository'] or 'https://crates.io/crates/' + package['name']}")
        for text in texts(package):
            users.setdefault(text, []).append(name)
    for name, licence, address, notice in OTHERS:
        print(f"{name}: {licence}, {address}")
        for file in [notice, ROOT / "LICENSE-APACHE"]:
            users.setdefault(file.read_text().strip(), []).append(name)
    for text, names in sorted(users.items(), key=lambda pair: pair[1]):
        print(f"\n{'=' * 80}\n{', '.join(names)}\n{'=' * 80}\n\n{text}")


if __name__ == "__main__":
    main()
