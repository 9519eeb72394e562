#!/usr/bin/env bash
# One target for so many executions, from seeds in the repository: fuzz/run.sh TARGET [RUNS]
#
# Wants cargo-fuzz and a nightly toolchain. No sanitizer: the program has no unsafe code of its own. What is found stays in
# fuzz/corpus/TARGET, what crashes, takes a second or 512 MiB in fuzz/artifacts/TARGET.
set -euo pipefail
cd "$(dirname "$0")"
target=$1
runs=${2:-10000000}
corpus=corpus/$target
mkdir -p "$corpus"
case $target in
    robot) seeds=(../robots/*.toml) ;;
    scenario) seeds=(../scenarios/*.toml) ;;
    urdf) seeds=(seeds/*.urdf) ;;
    samples) seeds=(seeds/*.csv) ;;
    states) seeds=(seeds/*.jsonl) ;;
    certificate) seeds=(../crates/flexure/tests/certificates/*.json) ;;
    *) echo "no target $target" >&2; exit 2 ;;
esac
cp -n "${seeds[@]}" "$corpus"
cargo +nightly fuzz run --sanitizer none "$target" -- \
    -runs="$runs" -max_len="${MAX_LEN:-4096}" -timeout=1 -rss_limit_mb=512 -print_final_stats=1 -verbosity="${VERBOSITY:-1}"
