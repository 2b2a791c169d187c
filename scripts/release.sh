#!/usr/bin/env bash
# Makes programs for any Linux, which need no other file, and wheels with them.
#
#     scripts/release.sh [FOLDER [TARGET ...]]
#
# Writes into FOLDER (default target/archives), for each target (default x86_64-unknown-linux-musl and aarch64-unknown-linux-musl):
# * a wheel for Python, with the module, the program, its licences and those of its packages. The program is linked statically, so pip installs
#   it on every Linux.
# * an archive with the same program and licences, the book, the completions of shells, manual pages, the studies and the changes,
# * checksums of both.
# Needs rustup, Python 3 with venv, and Debian's packages file, qemu-user and postgresql; the compiler for C comes from PyPI (ziglang). Ends with an error if a
# program gives other results in the mini study than the ordinary one (growth rates to 12 digits), or other bits on an emulated processor than on this one, if it has more than 25 MB,
# or if a page of the book cannot be followed word for word with the archive and the wheel for this processor. Says how long both programs take for the study `clamps`.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/archives}"
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(x86_64-unknown-linux-musl aarch64-unknown-linux-musl)
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
for tool in file qemu-x86_64 qemu-aarch64; do
    command -v "$tool" > /dev/null || { echo "$tool is not there (Debian: apt-get install file qemu-user)"; exit 1; }
done
command -v initdb > /dev/null || ls /usr/lib/postgresql/*/bin/initdb > /dev/null || { echo "PostgreSQL is not there (Debian: apt-get install postgresql)"; exit 1; }
rustup --quiet target add "${targets[@]}"
tools="$root/target/tools/python"
[ -x "$tools/bin/maturin" ] || { python3 -m venv "$tools" && "$tools/bin/pip" install --quiet maturin ziglang wheel; }
export PATH="$tools/bin:$PATH"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cargo build --release --locked --quiet
ordinary="${CARGO_TARGET_DIR:-$root/target}/release/tribosweep"

# Runs the mini study with a program, and writes its results without times.
results() {
    local name=$1
    shift
    "$@" run studies/mini.json --db "$scratch/$name.db" --out "$scratch/$name" > /dev/null 2> "$scratch/$name.log" \
        || { echo "$name: the mini study cannot be run"; cat "$scratch/$name.log"; exit 1; }
    "$ordinary" export mini --all --format json --db "$scratch/$name.db" | sed -E 's/"wall_s":[^,}]*//' > "$scratch/$name.exact"
    # The last digits of a measured growth rate are those of the C library's sines (docs/developers/design.md).
    sed -E 's/("growth_rate_per_s":-?[0-9.]{13})[0-9]*/\1/' "$scratch/$name.exact" > "$scratch/$name.json"
}

# Ends the script if two files of results differ.
same() {
    cmp -s "$1" "$2" && return
    echo "$3:"
    diff "$1" "$2" | cut -c1-400
    exit 1
}
results ordinary "$ordinary"

# The vector instructions with which a program had its results.
vectors() { "$ordinary" show "$(sed -n '1s/.*"job":"\([0-9a-f]*\)".*/\1/p' "$scratch/$1.json")" --db "$scratch/$1.db" | awk '$1 == "vectors" { print $2 }'; }
[ "$(vectors ordinary)" = Avx512 ] || echo "this processor has no AVX-512 ($(vectors ordinary)), which is not compared"

seconds() {
    local start
    rm -f "$scratch"/time.db*
    start=$(date +%s.%N)
    "$1" run studies/clamps.json --db "$scratch/time.db" --out "$scratch/time" > /dev/null 2>&1
    date +%s.%N | awk -v start="$start" '{ printf "%.2f\n", $1 - start }'
}

too_large=()
for target in "${targets[@]}"; do
    machine=${target%%-*}
    rm -rf "$scratch/wheel" "$scratch/unpacked"
    maturin build --quiet --profile dist --locked --zig --target "$target" --out "$scratch/wheel"
    wheel unpack --dest "$scratch/unpacked" "$scratch"/wheel/*.whl > /dev/null
    program=$(echo "$scratch"/unpacked/*/*.data/scripts/tribosweep)
    python3 scripts/licences.py "$target" > "$(echo "$scratch"/unpacked/*/*.dist-info/licenses)/THIRDPARTY.txt"
    rm "$scratch"/wheel/*.whl
    wheel pack --dest-dir "$scratch/wheel" "$scratch"/unpacked/* > /dev/null
    wheel tags --remove --platform-tag "manylinux_2_17_$machine.manylinux2014_$machine.musllinux_1_1_$machine" "$scratch"/wheel/*.whl > /dev/null
    if ! file -b "$program" | grep -q -e "statically linked" -e "static-pie linked"; then
        echo "the program for $target is not linked statically: $(file -b "$program")"
        exit 1
    fi
    # Processors with SSE2 alone, and with AVX2. The emulator has no AVX-512.
    case "$machine" in
        x86_64) ways=("" "qemu-x86_64 -cpu Opteron_G1" "qemu-x86_64 -cpu Haswell") ;;
        *) ways=("qemu-$machine") ;;
    esac
    [ "$machine" = x86_64 ] || [ "$machine" != "$(uname -m)" ] || ways=("")
    first=
    for way in "${ways[@]}"; do
        name="$machine${way// /_}"
        # shellcheck disable=SC2086 # the words of the emulator
        results "$name" $way "$program"
        same "$scratch/ordinary.json" "$scratch/$name.json" "the program for $target gives other results than the ordinary one (${way:-on this processor})"
        # One program has the same bits on all processors.
        first=${first:-$name}
        same "$scratch/$first.exact" "$scratch/$name.exact" "the program for $target gives other results with $way than with ${ways[0]:-this processor}"
        echo "$target, ${way:-this processor}, $(vectors "$name"): the same results"
    done
    if [ "$machine" = "$(uname -m)" ]; then
        echo "seconds for clamps, ordinary and static in turn: $(for _ in 1 2 3; do seconds "$ordinary"; seconds "$program"; done | xargs)"
    fi
    bytes=$(stat -c %s "$program")
    [ "$bytes" -le 25000000 ] || too_large+=("$target ($bytes bytes)")

    version=$("$ordinary" --version | cut -d' ' -f2)
    name="tribosweep-$version-$target"
    package="$scratch/$name"
    mkdir -p "$package/completions"
    cp "$program" LICENSE-MIT LICENSE-APACHE CHANGELOG.md CITATION.cff "$package"
    cp SECURITY.md "$package"
    # The README of the sources, without what only they have.
    sed -e '/^\[ARCHITECTURE\.md\]/d' -e '/^Nothing is published yet/d' -e '/^cargo test/d' -e '/^The first build takes/d' -e '/^`scripts\//d' \
        -e 's/^In the sources, with .*:$/In this folder:/' -e 's/^cargo run --release -- run/.\/tribosweep run/' -e 's/^## Two commands/## The first command/' \
        README.md > "$package/README.md"
    if grep -n -e cargo -e 'scripts/' -e 'src/' -e ARCHITECTURE "$package/README.md"; then
        echo "the README of the archive names what it does not have"
        exit 1
    fi
    cp -r docs "$package/docs"
    cp -r studies "$package"
    for shell in bash fish zsh; do
        "$ordinary" completions "$shell" > "$package/completions/tribosweep.$shell"
    done
    "$ordinary" man "$package/man"
    cp "$scratch"/unpacked/*/*.dist-info/licenses/THIRDPARTY.txt "$package"
    tar -C "$scratch" --sort=name --owner=0 --group=0 -czf "$folder/$name.tar.gz" "$name"
    wheel=$(basename "$scratch"/wheel/*.whl)
    cp "$scratch/wheel/$wheel" "$folder"
    (cd "$folder" && sha256sum "$name.tar.gz" "$wheel" > "$name.sha256")
    echo "$folder/$name.tar.gz and $wheel: a program of $((bytes / 1000000)) MB"
done

# Follows the book with what somebody has who has no toolchain: an archive, and a Python with the wheel.
follow_book() {
    local name=$1 wheel=$2
    mkdir "$scratch/reader"
    tar -C "$scratch/reader" -xzf "$folder/$name.tar.gz"
    python3 -m venv "$scratch/reader/python"
    "$scratch/reader/python/bin/pip" install --quiet "$wheel" pandas xarray matplotlib
    # The trap is run when this function has ended.
    server=$(mktemp -d)
    trap 'scripts/postgres.sh stop "$server"; rm -rf "$scratch"' EXIT
    TRIBOSWEEP_TEST_POSTGRES=$(scripts/postgres.sh start "$server") TRIBOSWEEP_REQUIRE_TOOLS=1 TRIBOSWEEP_ARCHIVE="$scratch/reader/$name" \
        TRIBOSWEEP_PYTHON="$scratch/reader/python/bin/python" cargo test --release --locked --quiet --test sweeps every_page_can_be_followed -- --nocapture
    echo "every page can be followed with $name.tar.gz and $(basename "$wheel")"
}
for target in "${targets[@]}"; do
    [ "${target%%-*}" != "$(uname -m)" ] || follow_book "tribosweep-$version-$target" "$(echo "$folder"/*"$(uname -m)"*.whl)"
done
# The archives are there, but more than is wanted.
if [ ${#too_large[@]} -gt 0 ]; then
    echo "programs of more than 25 MB: ${too_large[*]}"
    exit 1
fi
