"""High-precision values of the elementary functions, for the tests of flexure-core's number types.

Needs mpmath. Writes crates/flexure-core/tests/data/{elementary,enclosures}.csv, which are committed: the tests need no Python.

elementary.csv   function, x, derivatives of order 0 to 6 at x
enclosures.csv   function, x, the neighbouring floats below < f(x) < above
"""

import math
import pathlib
import random

from mpmath import mp, mpf

mp.dps = 120  # Cauchy's rule below loses some: 50 good digits remain
DATA = pathlib.Path(__file__).parent.parent / "crates/flexure-core/tests/data"


def ln_cosh(x):
    return mp.log1p(2 * mp.sinh(x / 2) ** 2)


FUNCTIONS = {
    "sqrt": (mp.sqrt, [0.01, 0.3, 1.0, 2.0, 1e6]),
    "exp": (mp.exp, [-20.0, -0.7, 0.0, 0.1, 3.0]),
    "ln": (mp.log, [0.01, 0.3, 1.0, 2.0, 1e6]),
    "sin": (mp.sin, [-3.0, -0.1, 0.0, 1.0, 5.0, 100.0]),
    "cos": (mp.cos, [-3.0, -0.1, 0.0, 1.0, 5.0, 100.0]),
    "tanh": (mp.tanh, [-3.0, -0.6, 0.0, 0.01, 0.2, 1.0, 18.0]),
    "ln_cosh": (ln_cosh, [-3.0, -0.6, 0.0, 0.001, 0.2, 1.0, 18.0]),
    "atan": (mp.atan, [-30.0, -0.6, 0.0, 0.01, 1.0, 3.0]),
    "recip": (lambda x: 1 / x, [-3.0, -0.01, 0.3, 1.0, 1e3]),
}


def derivatives(f, x):
    """Orders 0 to 6 by Cauchy's integral on a circle inside the domain: the trapezoidal rule converges geometrically."""
    x = mpf(x)
    # sqrt, ln, 1/x: singular at 0. tanh, ln cosh, atan: at distance ≥ 1 from the real axis.
    radius = min(mpf(1), abs(x)) / 2 if x != 0 else mpf(1) / 2
    points = 256  # 2^-256 = 1e-77
    nodes = [mp.expjpi(mpf(2 * i) / points) for i in range(points)]
    values = [f(x + radius * z) for z in nodes]
    return [
        mp.re(mp.fsum(v * z**-k for v, z in zip(values, nodes))) / points / radius**k * mp.factorial(k) for k in range(7)
    ]


def neighbours(y):
    """The floats around a real number that is not one."""
    nearest = float(y)
    below = nearest if mpf(nearest) < y else math.nextafter(nearest, -math.inf)
    return below, math.nextafter(below, math.inf)


def arguments(name, rng):
    """Many magnitudes, both signs where allowed, and the hard cases near multiples of π/2."""
    positive = name in ("sqrt", "ln")
    largest = {"exp": 700, "sin": 2**29, "cos": 2**29, "tanh": 18, "ln_cosh": 1e6}.get(name, 1e200)
    smallest = 1e-100
    for i in range(60):
        low, high = (1e-3, min(30.0, largest)) if i % 2 else (smallest, largest)
        x = math.exp(rng.uniform(math.log(low), math.log(high)))
        yield x if positive or rng.random() < 0.5 else -x
    if name == "ln_cosh":
        # No correctly rounded library function checks this one.
        for _ in range(400):
            yield rng.uniform(0.0, 3.0)
    if name in ("sin", "cos"):
        for k in [1, 2, 3, 4, 5, 11, 22, 355, 710, 1000003]:
            yield float(k * mp.pi / 2)


def main():
    rng = random.Random(1)
    with open(DATA / "elementary.csv", "w") as out:
        for name, (f, points) in FUNCTIONS.items():
            for x in points:
                row = derivatives(f, x)
                assert abs(row[0] - f(mpf(x))) < mpf(10) ** -40 * (1 + abs(row[0]))
                # Cauchy's rule leaves 1e-70 where a derivative is zero.
                row = [mp.mpf(0) if abs(d) < mpf(10) ** -60 else d for d in row]
                print(name, repr(x), *(mp.nstr(d, 20) for d in row), sep=",", file=out)
    with open(DATA / "enclosures.csv", "w") as out:
        for name, (f, _) in FUNCTIONS.items():
            for x in arguments(name, rng):
                # Precision enough to tell tanh 1e-100 from 1e-100, a relative 1e-200 apart.
                with mp.workdps(400):
                    y = f(mpf(x))
                    below, above = neighbours(y)
                    assert below < y < above
                print(name, repr(x), repr(below), repr(above), sep=",", file=out)


if __name__ == "__main__":
    main()
