"""What a call from Python costs over the law itself, and what a batch costs.

    python crates/flexure-python/benches/calls.py [LOOP]

LOOP is the program that `cargo bench --workspace --bench loop --no-run` names: with it, batches from Python and from Rust take turns, and their
ratio is printed.

With a time for each motion, a batch is a Rust loop of single calls of the same object: what a call from Rust takes. With one time the reference
is evaluated once. The best of many short measurements counts, since machines are shared.
"""

import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable

import flexure
import numpy as np


def best(call: Callable[[], object], calls: int, times: int) -> float:
    """Shortest time of a call, ns."""
    shortest = float("inf")
    for _ in range(times):
        begin = time.perf_counter_ns()
        for _ in range(calls):
            call()
        shortest = min(shortest, (time.perf_counter_ns() - begin) / calls)
    return shortest


NAMES = ("two-link-tanh", "panda-tanh-smooth")
MOTIONS = 10_000
ROUNDS = 12
UNITS = {"ns": 1.0, "µs": 1e3, "ms": 1e6}


def motions(scenario: flexure.Scenario) -> np.ndarray:
    """A batch: its start, so many times."""
    return np.tile(np.array(scenario.initial), (MOTIONS, 1))


def from_rust(program: str, name: str) -> float:
    """Shortest time of a batch, a motion, as the program measures it, ns."""
    try:
        said = subprocess.run([program, "--bench", "law::batch"], capture_output=True, text=True, check=False).stdout
    except OSError as error:
        sys.exit(f"{program}: {error.strerror}")
    found = re.search(rf"{name}\s+([\d.]+) (ns|µs|ms)", said)
    if not found:
        sys.exit(f"{program} has no batch of {name}: it is the one that cargo bench --workspace --bench loop --no-run names")
    return float(found[1]) * UNITS[found[2]] / MOTIONS


def ratios(program: str) -> None:
    """Batches from both sides in turn."""
    for name in NAMES:
        scenario = flexure.Scenario(name)
        law, many = scenario.controller(), motions(scenario)
        rounds = [
            (best(lambda: law.torque(many, 0.5), 1, 40) / MOTIONS, from_rust(program, name))
            for _ in range(ROUNDS)
        ]
        python, rust = (min(side) for side in zip(*rounds, strict=True))
        median = statistics.median(a / b for a, b in rounds)
        print(f"{name:24}{python:9.0f} ns from Python{rust:9.0f} ns from Rust{python / rust:8.3f} (rounds: {median:.3f})")


def main() -> None:
    if len(sys.argv) > 1:
        ratios(sys.argv[1])
        return
    empty = best(lambda: None, 100, 400)
    print(f"{'':24}{'from Python':>14}{'from Rust':>14}{'over it':>12}{'batch, one time':>18}")
    for name in NAMES:
        scenario = flexure.Scenario(name)
        law, x, many = scenario.controller(), np.array(scenario.initial), motions(scenario)
        times = np.full(len(many), 0.5)
        calls = best(lambda: law.torque(many, times), 1, 40) / len(many)
        batch = best(lambda: law.torque(many, 0.5), 1, 40) / len(many)
        one = best(lambda: law.torque(x, 0.5), 100, 400) - empty
        print(f"{name:24}{one:11.0f} ns{calls:11.0f} ns{one - calls:9.0f} ns{batch:15.0f} ns")


if __name__ == "__main__":
    main()
