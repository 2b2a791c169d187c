#!/usr/bin/env bash
# Regenerates the picture in the README, docs/evidence/figure7.svg, from studies/figure7.json.
set -euo pipefail
cd "$(dirname "$0")/.."
work=target/docs
mkdir -p "$work"
cargo run --release --quiet -- --db "$work/docs.db" run studies/figure7.json --out "$work/figure7" > /dev/null
cp "$work/figure7/mu_star.svg" docs/evidence/figure7.svg
echo "written: docs/evidence/figure7.svg"
