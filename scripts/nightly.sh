#!/usr/bin/env bash
# The nightly check: runs the mini sweep on two threads, twice, and compares it with stored reference values: in double precision from
# rest, and in the way of the presets (single precision, a start from a coarser mesh, stable jobs decided by eigenvalues).
#
#     scripts/nightly.sh [FOLDER]
#
# Writes into FOLDER (default target/nightly) summary.md, nightly.csv with one line per value, and below `mini` and `mini-standard` the
# studies' reports. Ends with 0 if all values are within their tolerances, with 1 if a value has drifted or a job has failed, and with
# another code if a sweep or the comparison could not be made.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/nightly}"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
# Without this, the program would reuse the results of last night.
rm -rf "$folder"/tribosweep.db* "$folder"/{summary.md,nightly.csv,mini,mini-standard}
# Code 1 means that a value has drifted.
cargo build --release --quiet --locked || exit 2
program="${CARGO_TARGET_DIR:-$root/target}/release/tribosweep"
export TRIBOSWEEP_DB="$folder/tribosweep.db"

# Runs the mini study with some options, and writes FOLDER/NAME/jobs.csv. Code 1 means that some jobs have failed; the comparison reports them.
sweep() {
    local name=$1 code=0
    shift
    mkdir -p "$folder/$name"
    "$program" run studies/mini.json --threads 2 --out "$folder/$name/report" "$@" > /dev/null || code=$?
    if [ "$code" -gt 1 ]; then exit "$code"; fi
    "$program" export "$name" --all --csv "$folder/$name/jobs.csv"
}
sweep mini
# The coarser mesh has half as many elements in each direction, and at least six.
sweep mini-standard --preset standard --set 'elements=[[12,16,12]]'
python3 scripts/nightly.py "$folder"
