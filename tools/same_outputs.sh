#!/usr/bin/env bash
# same_outputs.sh OLD NEW: do two builds of `flexure` give the same bytes for every built-in scenario and robot?
#
# Compares traces, certificates, JSON, messages and exit codes of run, check, certify, list and reproduce; not wall-clock times,
# nor figures and the report that holds them. Prints what differs; exit code 1 if anything does.
set -euo pipefail
cd "$(dirname "$0")/.."
old=$(realpath "$1") new=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

outputs() {
    local program=$1 name
    mkdir "$2" && cd "$2"
    said() { # said NAME COMMAND...: what a command prints and its exit code
        local file=$1 code=0
        shift
        "$program" "$@" > "$file.out" 2> "$file.err" || code=$?
        sed -E -i 's/"(wall_seconds|seconds)": *[0-9.e+-]+/"\1": 0/g' "$file.out"
        echo "exit $code" >> "$file.out"
    }
    for name in "${scenarios[@]}"; do
        said "run-$name" run "$name" --json --out "traces"
        said "check-$name" check "$name"
        said "certify-$name" certify "$name" --json --out "certificate-$name.json"
    done
    for name in "${robots[@]}"; do said "robot-$name" check "$name"; done
    for name in robots scenarios shaping references controllers imperfections; do said "list-$name" list "$name"; done
    said reproduce reproduce --json --out reproduce
    find . \( -name '*.png' -o -name '*.svg' -o -name 'report.html' \) -delete
    cd - > /dev/null
}

mapfile -t scenarios < <(basename -s .toml scenarios/*.toml)
mapfile -t robots < <(basename -s .toml robots/*.toml)
outputs "$old" "$folder/old"
outputs "$new" "$folder/new"
echo "$(find "$folder/old" -type f | wc -l) files"
diff -r "$folder/old" "$folder/new"
