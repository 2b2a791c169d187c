#!/usr/bin/env bash
# The nightly check: runs the mini sweep on two threads and compares it with stored reference values.
#
#     scripts/nightly.sh [FOLDER]
#
# Writes into FOLDER (default target/nightly) summary.md, nightly.csv with a line a figure, and the study's report.
# Ends with 0 if all figures are within their tolerances, with 1 if one has drifted (a job that fails has), and with
# something else if the sweep or the comparison could not be made.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/nightly}"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
# Last night's results are not tonight's.
rm -rf "$folder"/tribosweep.db* "$folder"/{summary.md,nightly.csv,jobs.csv,report}
# 1 is taken.
cargo build --release --quiet --locked || exit 2
program="${CARGO_TARGET_DIR:-$root/target}/release/tribosweep"
export TRIBOSWEEP_DB="$folder/tribosweep.db"
code=0
"$program" run studies/mini.json --threads 2 --out "$folder/report" > /dev/null || code=$?
# With 1 some jobs have failed, which the comparison tells.
if [ "$code" -gt 1 ]; then exit "$code"; fi
"$program" export mini --csv "$folder/jobs.csv"
python3 scripts/nightly.py "$folder/jobs.csv" "$folder"
