"""The floats nearest to values of the elementary functions, for the tests of flexure-core-math.

Needs mpmath. Writes crates/core-math/tests/nearest.csv, which is committed: function, x, nearest float. Half of the arguments
of each function are drawn over its range, the other half are those of 10,000 whose values are the hardest to round.
"""

import math
import pathlib
import random

from mpmath import mp, mpf

mp.dps = 400  # tells tanh 1e-100 from 1e-100, a relative 1e-200 apart
TABLE = pathlib.Path(__file__).parent.parent / "crates/core-math/tests/nearest.csv"
# Function, smallest and largest magnitude of the argument.
FUNCTIONS = {
    "exp": (mp.exp, 1e-20, 700),
    "log": (mp.log, 1e-300, 1e300),
    "log1p": (mp.log1p, 1e-30, 1e300),
    "sin": (mp.sin, 1e-12, 2**30),
    "cos": (mp.cos, 1e-9, 2**30),
    "tanh": (mp.tanh, 1e-12, 19),
    "sinh": (mp.sinh, 1e-12, 700),
    "atan": (mp.atan, 1e-12, 1e30),
}


def draw(name, rng, low, high):
    if rng.random() < 0.5:
        low, high = 1e-3, min(30.0, high)
    x = math.exp(rng.uniform(math.log(low), math.log(high)))
    positive = name in ("log", "log1p") and (name == "log" or x >= 1)
    return x if positive or rng.random() < 0.5 else -x


def nearest(y):
    with mp.workprec(53):
        float_ = float(+y)
    distance = abs(mpf(float_) - y)
    assert all(distance <= abs(mpf(math.nextafter(float_, end)) - y) for end in (-math.inf, math.inf))
    return float_


def hardness(f, x):
    """Distance from the middle between two floats, in ulp."""
    with mp.workdps(60):
        y = abs(f(mpf(x)))
        scaled = y / mpf(math.ulp(float(y)))
        return abs(scaled - mp.floor(scaled) - mpf(1) / 2)


def main():
    rng = random.Random(1)
    with open(TABLE, "w") as out:
        for name, (f, low, high) in FUNCTIONS.items():
            plain = [draw(name, rng, low, high) for _ in range(100)]
            # Moderate arguments: where a value is as good as x, 1 or x + ln 2, it is easy.
            many = [draw(name, rng, 1e-3, min(30.0, high)) for _ in range(10_000)]
            for x in plain + sorted(many, key=lambda x: hardness(f, x))[:100]:
                print(name, repr(x), repr(nearest(f(mpf(x)))), sep=",", file=out)


if __name__ == "__main__":
    main()
