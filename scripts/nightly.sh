#!/usr/bin/env bash
# The nightly check: runs the mini sweep on two threads and compares it with stored reference values.
#
#     scripts/nightly.sh [FOLDER]
#
# Writes into FOLDER (default target/nightly) summary.md, nightly.csv with a line a figure, and the study's report.
# Ends with 0 if all figures are within their tolerances, 1 if one has drifted, something else if the sweep failed.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/nightly}"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
cargo build --release --quiet
program="${CARGO_TARGET_DIR:-$root/target}/release/tribosweep"
# Last night's results are not tonight's.
rm -f "$folder"/tribosweep.db* "$folder/summary.md" "$folder/nightly.csv"
export TRIBOSWEEP_DB="$folder/tribosweep.db"
"$program" run studies/mini.json --threads 2 --out "$folder/report" > /dev/null
"$program" export mini --csv "$folder/jobs.csv"
python3 scripts/nightly.py "$folder/jobs.csv" "$folder"
