"""Motions as flat arrays, and their parts by name."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Motion(NamedTuple):
    """Parts of motions (…, 4n): views of (…, n), so that writing to a part writes to the motion."""

    q_l: NDArray[np.float64]
    """Link positions, rad."""
    q_m: NDArray[np.float64]
    """Motor positions, rad."""
    dq_l: NDArray[np.float64]
    """Link velocities, rad/s."""
    dq_m: NDArray[np.float64]
    """Motor velocities, rad/s."""


def views(x: NDArray[np.float64]) -> Motion:
    """The parts of motions x, (…, 4n), by name."""
    x = np.asarray(x, dtype=np.float64)
    if x.ndim == 0 or x.shape[-1] % 4:
        raise ValueError(f"x: shape {x.shape}; expected (…, 4n) = (q_l, q_m, dq_l, dq_m)")
    n = x.shape[-1] // 4
    return Motion(*(x[..., k * n : (k + 1) * n] for k in range(4)))


def motion(q_l: ArrayLike, q_m: ArrayLike | None = None, dq_l: ArrayLike = 0.0, dq_m: ArrayLike | None = None) -> NDArray[np.float64]:
    """Motions (…, 4n) of links at q_l, (…, n), rad; motors are where their links are, and everything is at rest, unless it is said."""
    q_l = np.asarray(q_l, dtype=np.float64)
    if q_l.ndim == 0:
        raise ValueError("q_l: shape (); expected (…, n), a number per joint")
    parts = (q_l, q_l if q_m is None else q_m, dq_l, dq_l if dq_m is None else dq_m)
    return np.concatenate(np.broadcast_arrays(*(np.asarray(part, dtype=np.float64) for part in parts)), axis=-1)
