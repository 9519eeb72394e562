#!/usr/bin/env bash
# package.sh [FOLDER]: one program for every x86-64 processor: `flexure` runs anywhere, and hands over to the build beside it for the most
# instructions that the processor has. FOLDER is target/package if not given. Three builds: a quarter of an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-target/package}
sets=(x86-64 x86-64-v3 x86-64-v4)
for set in "${sets[@]}"; do
    # As .cargo/config.toml, which RUSTFLAGS takes the place of.
    RUSTFLAGS="-C target-cpu=$set -C llvm-args=-slp-max-reg-size=128" \
        cargo build --quiet --locked --profile dist --workspace --bin flexure --target-dir "target/package-$set"
done
# All or none, and the one that hands over last: none goes on in the place of a program of another version.
rm -f "$folder"/flexure "$folder"/flexure-x86-64*
mkdir -p "$folder"
for set in x86-64-v4 x86-64-v3; do install "target/package-$set/dist/flexure" "$folder/flexure-$set"; done
install target/package-x86-64/dist/flexure "$folder/flexure"
ls -l "$folder"
