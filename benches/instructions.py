"""Instructions of the works that matter, counted by callgrind, beside those of benches/instructions.toml: more than 3 % above is an error.

    python3 benches/instructions.py [--write] [--no-build]

Counts repeat to a few instructions, whatever else the machine does. They belong to a compiler: with another one nothing is compared.
The program is the example `peers` in the profile release; `cargo test --release --workspace` has built it too, so `--no-build` after that.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "benches" / "instructions.toml"
ALLOWED = 0.03

# Works, as `peers` names them, and how often they are done: the difference of the two counts has no start-up in it. References of loops together are
# evaluated for eight periods at once: multiples of that.
WORKS = {
    "law2": (16, 144),
    "law7": (16, 80),
    "law2-lanes": (16, 144),
    "law7-lanes": (16, 80),
    "rnea7": (16, 144),
    "fd7": (16, 144),
    "rates7": (16, 80),
    "plant2": (5, 25),
    "plant7": (2, 6),
    "loop2": (5, 25),
    "batch2": (8, 72),
    "batch2-midpoint": (8, 72),
}
TITLES = {
    "law2": "v-CBC law, two joints",
    "law7": "v-CBC law, seven joints with gravity",
    "law2-lanes": "v-CBC law, two joints, four states in lanes",
    "law7-lanes": "v-CBC law, seven joints with gravity, four states in lanes",
    "rnea7": "inverse dynamics, seven joints",
    "fd7": "forward dynamics, seven joints",
    "rates7": "torque with two rates, seven joints",
    "plant2": "a millisecond of the elastic two-link arm",
    "plant7": "a millisecond of the elastic seven-joint arm",
    "loop2": "a period of the whole loop, two-link arm",
    "batch2": "a period of 16 such loops together",
    "batch2-midpoint": "the same by steps of the midpoint rule",
}


def program(build):
    if build:
        command = ["cargo", "build", "--quiet", "--release", "--workspace", "--locked", "--example", "peers"]
        subprocess.run(command, cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return ROOT / target / "release" / "examples" / "peers"


def count(path, work, times):
    """Instructions of the program that does `work` so often."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", path, "repeat", work, str(times)]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "RAYON_NUM_THREADS": "1"})
    found = re.search(r"Collected *: *(\d+)", done.stderr)
    if done.returncode or not found:
        raise SystemExit(f"{work}: {done.stderr}")
    return int(found[1])


def measured(build):
    path = program(build)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        ends = {work: [pool.submit(count, path, work, n) for n in times] for work, times in WORKS.items()}
    return {
        work: round((ends[work][1].result() - ends[work][0].result()) / (times[1] - times[0]))
        for work, times in WORKS.items()
    }


def write(rustc, counts):
    lines = [f"{work} = {n} # {TITLES[work]}" for work, n in counts.items()]
    head = "# Written by `python3 benches/instructions.py --write`: instructions of one work each, profile release.\n"
    TABLE.write_text(f'{head}rustc = "{rustc}"\n\n[instructions]\n' + "\n".join(lines) + "\n")


def main(to_write, build):
    if not shutil.which("valgrind"):
        print("instructions: skipped, there is no valgrind")
        return 0
    rustc = subprocess.run(["rustc", "--version"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    table = tomllib.loads(TABLE.read_text()) if TABLE.exists() else {"rustc": rustc, "instructions": {}}
    if table["rustc"] != rustc and not to_write:
        print(f"instructions: skipped, the table is of {table['rustc']}, this is {rustc}")
        return 0
    counts, grown = measured(build), 0
    for work, n in counts.items():
        before = table["instructions"].get(work)
        change = n / before - 1 if before else 0.0
        too_much = change > ALLOWED or not before
        grown += too_much
        note = "  FAILED: more than 3 % above the table" if too_much else "  write the table" if change < -ALLOWED else ""
        print(f"{TITLES[work]:46} {n:9,} {change:+8.1%}{note}")
    if to_write:
        write(rustc, counts)
    elif grown:
        print("What was meant to cost more is written with `python3 benches/instructions.py --write`.")
        return 1
    return 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="writes the table anew")
    parser.add_argument("--no-build", action="store_true", help="counts the program that is there")
    options = parser.parse_args()
    sys.exit(main(options.write, not options.no_build))
