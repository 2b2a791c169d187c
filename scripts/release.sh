#!/usr/bin/env bash
# Makes a statically linked program for any Linux on x86-64, which needs no other file.
#
#     scripts/release.sh [FOLDER]
#
# Writes into FOLDER (default target/dist) an archive with the program, its licences, and those of its packages, the completions of shells, manual
# pages, the studies and the changes, and a file of checksums. Needs the target of rustup (`rustup target add x86_64-unknown-linux-musl`) and a C compiler for musl
# (Debian: musl-tools). Ends with an error if the static program gives other results than the ordinary one in the mini study.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
folder="${1:-$root/target/dist}"
mkdir -p "$folder"
folder="$(cd "$folder" && pwd)"
cd "$root"
target=x86_64-unknown-linux-musl
built="${CARGO_TARGET_DIR:-$root/target}"
cargo build --release --locked --quiet
cargo build --release --locked --quiet --target "$target"
static="$built/$target/release/tribosweep"
if ! file -b "$static" | grep -q -e "statically linked" -e "static-pie linked"; then
    echo "$static is not linked statically: $(file -b "$static")"
    exit 1
fi

# The results of the mini study. Times of threads are left out. The Fourier transform has other instructions on other processors, so the last
# digits of a measured growth rate may differ, and six decimals of it are kept. All else must be the same to the last bit.
results() {
    "$1" export mini --all --format json --db "$2" |
        sed -E 's/"wall_s":[^,}]*//; s/("growth_rate_per_s":-?[0-9]+\.[0-9]{6})[0-9]*/\1/'
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for way in ordinary static; do
    program="$built/release/tribosweep"
    [ "$way" = ordinary ] || program="$static"
    "$program" run studies/mini.json --db "$scratch/$way.db" --out "$scratch/$way" > /dev/null
    results "$program" "$scratch/$way.db" > "$scratch/$way.json"
done
if ! cmp -s "$scratch/ordinary.json" "$scratch/static.json"; then
    echo "the static program gives other results than the ordinary one:"
    diff "$scratch/ordinary.json" "$scratch/static.json" | cut -c1-400
    exit 1
fi

# An emulator gives the static program processors with fewer vector instructions.
for processor in Nehalem Haswell; do
    if command -v qemu-x86_64 > /dev/null; then
        qemu-x86_64 -cpu "$processor" "$static" run studies/mini.json --db "$scratch/$processor.db" --out "$scratch/$processor" > /dev/null
        results "$static" "$scratch/$processor.db" > "$scratch/$processor.json"
        if ! cmp -s "$scratch/static.json" "$scratch/$processor.json"; then
            echo "the static program gives other results on a processor like $processor:"
            diff "$scratch/static.json" "$scratch/$processor.json" | cut -c1-400
            exit 1
        fi
    else
        echo "other processors were not tried: qemu-x86_64 (Debian: qemu-user) is not there"
    fi
done

version=$("$static" --version | cut -d' ' -f2)
name="tribosweep-$version-$target"
package="$scratch/$name"
mkdir -p "$package/completions"
cp "$static" LICENSE-MIT LICENSE-APACHE README.md CHANGELOG.md CITATION.cff "$package"
strip "$package/tribosweep"
cp -r studies "$package"
for shell in bash fish zsh; do
    "$static" completions "$shell" > "$package/completions/tribosweep.$shell"
done
"$static" man "$package/man"
python3 scripts/licences.py "$target" > "$package/THIRDPARTY.txt"
bytes=$(stat -c %s "$package/tribosweep")
if [ "$bytes" -gt 25000000 ]; then
    echo "the program has $bytes bytes; at most 25 MB are wanted"
    exit 1
fi
tar -C "$scratch" --sort=name --owner=0 --group=0 -czf "$folder/$name.tar.gz" "$name"
(cd "$folder" && sha256sum "$name.tar.gz" > "$name.sha256")
echo "$folder/$name.tar.gz: program of $((bytes / 1000000)) MB, the same results as the ordinary one"
