"""Shared by the scripts that compare a disturbed sweep with an undisturbed one."""

import csv
import io
import time


def tell(text):
    print(f"{time.strftime('%H:%M:%S')} {text}", flush=True)


def check(holds, text):
    if not holds:
        raise SystemExit(f"FAILED: {text}")


def timeless(text):
    """An export without run times."""
    rows = list(csv.reader(io.StringIO(text)))
    column = rows[0].index("wall_s")
    return [row[:column] + row[column + 1 :] for row in rows]
