#!/usr/bin/env python3
"""Writes tests/fuzz/record.json from the logs that scripts/fuzz.sh leaves in target/fuzz."""

import json
import re

import runs

WORK = runs.ROOT / "target" / "fuzz"


def last(pattern, log):
    found = re.findall(pattern, log)
    return int(found[-1]) if found else None


def main():
    record = {}
    for target in ("study", "overrides"):
        log = (WORK / f"{target}.log").read_text(errors="replace")
        record[target] = {
            "executions": last(r"stat::number_of_executed_units:\s*(\d+)", log),
            "seconds": last(r"Done \d+ runs in (\d+) second", log),
            "edges": last(r"cov: (\d+)", log),
            "features": last(r"ft: (\d+)", log),
            "corpus": last(r"corp: (\d+)/", log),
            "failing_texts": len(list((WORK / "artifacts" / target).iterdir())),
        }
    path = runs.ROOT / "tests" / "fuzz" / "record.json"
    path.write_text(json.dumps(record, indent=2) + "\n")
    print(f"written: {path.relative_to(runs.ROOT)}")


if __name__ == "__main__":
    main()
