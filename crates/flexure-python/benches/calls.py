"""What a call from Python costs over the law itself, and what a batch costs: `python crates/flexure-python/benches/calls.py`.

With a time for each motion, a batch is a Rust loop of single calls of the same object: what a call from Rust takes. With one time the reference
is evaluated once. The best of many short measurements counts, since machines are shared.
"""

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


def main() -> None:
    empty = best(lambda: None, 100, 400)
    print(f"{'':24}{'from Python':>14}{'from Rust':>14}{'over it':>12}{'batch, one time':>18}")
    for name in ("two-link-tanh", "panda-tanh-smooth"):
        scenario = flexure.Scenario(name)
        law, x = scenario.controller(), np.array(scenario.initial)
        many = np.tile(x, (10_000, 1))
        times = np.full(len(many), 0.5)
        calls = best(lambda: law.torque(many, times), 1, 40) / len(many)
        batch = best(lambda: law.torque(many, 0.5), 1, 40) / len(many)
        one = best(lambda: law.torque(x, 0.5), 100, 400) - empty
        print(f"{name:24}{one:11.0f} ns{calls:11.0f} ns{one - calls:9.0f} ns{batch:15.0f} ns")



if __name__ == "__main__":
    main()
