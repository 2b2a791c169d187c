#!/usr/bin/env bash
# The nightly check: runs the mini sweep on two threads and compares it with stored reference values.
#
#     scripts/nightly.sh [FOLDER]
#
# Writes into FOLDER (default target/nightly) summary.md, nightly.csv with one line per value, and the study's report.
# Ends with 0 if all values are within their tolerances, with 1 if a value has drifted or a job has failed, and with
# another code if the sweep or the comparison could not be made.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/nightly}"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
# Without this, the program would reuse the results of last night.
rm -rf "$folder"/tribosweep.db* "$folder"/{summary.md,nightly.csv,jobs.csv,report}
# Code 1 means that a value has drifted.
cargo build --release --quiet --locked || exit 2
program="${CARGO_TARGET_DIR:-$root/target}/release/tribosweep"
export TRIBOSWEEP_DB="$folder/tribosweep.db"
code=0
"$program" run studies/mini.json --threads 2 --out "$folder/report" > /dev/null || code=$?
# Code 1 means that some jobs have failed; the comparison reports them.
if [ "$code" -gt 1 ]; then exit "$code"; fi
"$program" export mini --csv "$folder/jobs.csv"
python3 scripts/nightly.py "$folder/jobs.csv" "$folder"
