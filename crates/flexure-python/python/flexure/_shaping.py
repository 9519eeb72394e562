"""Shaping functions and references written in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._flexure import Scenario
from ._jobs import Path, _scenario

if TYPE_CHECKING:
    _Array = NDArray[np.float64]

TERMS = 24
"""Terms of a series."""

FITS = [(scale, beyond) for beyond in (1e-5, 1e-3) for scale in (0.5, 0.3, 1.0)]
"""Scales that are tried, as parts of the reach, and what the function counts beyond it: the series is to be sane there, not exact."""

SANE = 2.0
"""So much larger than the function beyond its reach a series may be."""

FAR = 4.0
"""So many times its reach the function is asked."""


class Shaping:
    """A shaping function of one's own, from a function of errors in rad, (m,) → (m,), with f(-e) = -f(e): φ = Λ f, the Λ of the scenario.

    The law needs its exact derivatives, and Python is no place for them: f is asked at some hundred errors, and φ is a series close to it,
    on which the law runs at full speed. `error` says how close for errors up to `reach`, as a part of the largest value there; farther
    out φ is bounded and no longer f. A law with it has no certificate: those are about shaping functions that are registered.
    """

    def __init__(self, function: Callable[[Any], ArrayLike], *, reach: float = 1.0) -> None:
        if not 1e-6 <= reach <= 1e3:
            raise ValueError(f"reach: {reach}; expected a number from 1e-6 to 1e3, rad")
        self.reach = float(reach)
        """Up to which error it is f, rad."""
        near = np.linspace(0.0, self.reach, 2001)
        there = self._asked(function, near)
        if np.abs(self._asked(function, -near) + there).max() > 1e-9 * np.abs(there).max():
            raise ValueError("a shaping function is odd: f(-e) = -f(e)")
        if not there[1] > 0.0:
            raise ValueError("a shaping function pulls back: f(e) > 0 for small e > 0")
        self.error = np.inf
        """The largest difference from f within reach, as a part of its largest value there."""
        for part, beyond in FITS:
            scale, coefficients, error = self._fitted(function, part * self.reach, beyond, near, there)
            if error < self.error:
                self.scale, self.error = scale, error
                self.coefficients: list[float] = coefficients.tolist()
                """Of the polynomials of Chebyshev of odd degree in e / √(scale² + e²)."""

        if not np.isfinite(self.error):
            raise ValueError("the shaping function is not smooth enough for a series: it has to have derivatives")

    def _fitted(
        self, function: Callable[[Any], ArrayLike], scale: float, beyond: float, near: _Array, there: _Array
    ) -> tuple[float, _Array, float]:
        """A series, and how far it is off; infinite where it is not sane."""
        nodes = np.cos(np.pi * (np.arange(8 * TERMS) + 0.5) / (16 * TERMS))
        errors = scale * nodes / np.sqrt(1.0 - nodes**2)
        weights = np.where(errors <= self.reach, 1.0, beyond)
        wanted = self._asked(function, np.minimum(errors, FAR * self.reach))
        basis = _basis(errors, scale)
        coefficients, *_ = np.linalg.lstsq(weights[:, None] * basis, weights * wanted, rcond=None)
        far = _basis(np.geomspace(self.reach, 100.0 * self.reach, 1001), scale) @ coefficients
        is_sane = np.abs(far).max() <= SANE * np.abs(wanted).max()
        off = np.abs(_basis(near, scale) @ coefficients - there).max() / np.abs(there).max()
        return scale, np.asarray(coefficients, dtype=np.float64), float(off) if is_sane else np.inf

    @staticmethod
    def _asked(function: Callable[[Any], ArrayLike], errors: _Array) -> _Array:
        try:
            found = np.asarray(function(errors), dtype=float)
        except TypeError as error:
            raise TypeError(f"the shaping function has to take arrays, as those of NumPy do: {error}") from None
        if found.shape != errors.shape:
            raise ValueError(f"the shaping function's value: shape {found.shape}; expected {errors.shape}, a number for each error")
        if not np.isfinite(found).all():
            raise ValueError(f"the shaping function is no finite number at {errors[~np.isfinite(found)][0]:g} rad")
        return found

    def __call__(self, error: ArrayLike) -> _Array:
        """The series, where Λ is 1."""
        return np.asarray(_basis(np.asarray(error, dtype=float), self.scale) @ np.asarray(self.coefficients))

    def __repr__(self) -> str:
        return f"Shaping(reach {self.reach:g} rad, off by {self.error:.1e} of the largest value at most)"


def _basis(error: _Array, scale: float) -> _Array:
    """Polynomials of Chebyshev of odd degree in e / √(scale² + e²)."""
    angle = np.arccos(error / np.sqrt(scale**2 + error**2))
    return np.asarray(np.cos(angle[..., None] * (2 * np.arange(TERMS) + 1)))


def follow(scenario: Scenario | Path, path: Callable[[float], ArrayLike], *, period: float = 0.01, smooth_start: float | None = None) -> Scenario:
    """The scenario with a reference of one's own: `path`, a function of the time in s that gives positions of all joints, (n,), rad.

    It is asked every `period` s, for sixty periods before the beginning and after the end too, and the reference is the septic spline
    through these samples: its fourth derivative exists and is continuous, as the law needs it. Every law, proof and sweep goes on from
    there at full speed. With `smooth_start`, s, the robot joins the path from rest.
    """
    scenario = _scenario(scenario)
    if not (np.isfinite(period) and period > 0.0):
        raise ValueError(f"period: {period}; expected a positive number, s")
    joints = len(scenario.robot)
    last = int(np.ceil(scenario.duration / period)) + MARGIN
    lines = [",".join(["t", *(f"q{i + 1}" for i in range(joints))])]
    for k in range(-MARGIN, last + 1):
        position = np.asarray(path(k * period), dtype=float)
        if position.shape != (joints,):
            raise ValueError(f"the path at {k * period:g} s: shape {position.shape}; expected ({joints},), a position for each joint")
        lines.append(",".join(repr(float(x)) for x in [k * period, *position]))
    return scenario._along("\n".join(lines) + "\n", smooth_start)


MARGIN = 60
"""Samples on either side of the run: what a spline does at its ends fades by half from one to the next, below rounding."""
