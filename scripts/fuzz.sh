#!/usr/bin/env bash
# Fuzzes the study parser and the overrides, and writes what was measured to tests/fuzz/record.json, which
# scripts/stability.py quotes. Needs a nightly toolchain and cargo-fuzz (`cargo install cargo-fuzz`).
#
#   scripts/fuzz.sh [SECONDS]      time per target, 1200 by default
#
# The seeds in tests/fuzz/seeds stay as they are; what libFuzzer finds goes to target/fuzz. A text that makes a
# target fail is kept in target/fuzz/artifacts and counted in the record.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-1200}
work=target/fuzz
mkdir -p "$work/artifacts" "$work/corpus"
cargo +nightly fuzz build --fuzz-dir tests/fuzz --target-dir "$work" --sanitizer address
programs=$(dirname "$(find "$work" -path '*/release/study' -type f -perm -u+x | head -n 1)")
# As cargo-fuzz does: SQLite's C sources are in the program twice.
export ASAN_OPTIONS=detect_odr_violation=0
for target in study overrides; do
    mkdir -p "$work/corpus/$target" "$work/artifacts/$target"
    # A failing text ends the run; the record says so. 20 s is a hang.
    "$programs/$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=4096 \
        -dict=tests/fuzz/study.dict -artifact_prefix="$work/artifacts/$target/" -print_final_stats=1 \
        "$work/corpus/$target" "tests/fuzz/seeds/$target" > "$work/$target.log" 2>&1 || true
    grep -q 'stat::number_of_executed_units' "$work/$target.log" || { tail -n 20 "$work/$target.log"; exit 1; }
    grep '^Done' "$work/$target.log"
done
python3 scripts/fuzz_record.py
