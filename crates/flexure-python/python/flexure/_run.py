"""Runs and their traces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._flexure import Scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame as _DataFrame


class Trace(dict[str, NDArray[np.float64]]):
    """What a run recorded: an array for each column, by name, `t` in s first."""

    def __init__(self, columns: dict[str, NDArray[np.float64]], units: dict[str, str]) -> None:
        super().__init__(columns)
        self.units = units
        """SI units of the columns; empty for none."""

    def __missing__(self, name: str) -> NDArray[np.float64]:
        raise KeyError(f"{name}; columns are {', '.join(self)}")

    # Arrays have no one answer to being equal.
    __eq__ = object.__eq__
    __hash__ = object.__hash__  # type: ignore[assignment]

    def joints(self, name: str) -> NDArray[np.float64]:
        """A signal of all joints, (instants, n), as "q_l" for the columns q_l1, q_l2, …"""
        columns: list[NDArray[np.float64]] = []
        while (column := self.get(f"{name}{len(columns) + 1}")) is not None:
            columns.append(column)
        if not columns:
            raise KeyError(f"{name}1; columns are {', '.join(self)}")
        return np.stack(columns, axis=-1)

    @property
    def x(self) -> NDArray[np.float64]:
        """The motions, (instants, 4n): q_l, q_m, dq_l, dq_m."""
        return np.concatenate([self.joints(name) for name in ("q_l", "q_m", "dq_l", "dq_m")], axis=-1)

    def to_pandas(self) -> _DataFrame:
        """A DataFrame with the time as index. Needs pandas."""
        import pandas

        columns = {name: column for name, column in self.items() if name != "t"}
        return pandas.DataFrame(columns, index=pandas.Index(self["t"], name="t"))

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Arrow's PyCapsule interface, which Polars, DuckDB and others read; units are in the metadata of the fields. Needs pyarrow."""
        import pyarrow

        fields = [pyarrow.field(name, pyarrow.float64(), metadata={"unit": self.units[name]}) for name in self]
        arrays = [pyarrow.array(column) for column in self.values()]
        table = pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields))
        return table.__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return f"Trace({len(self['t'])} instants to {self['t'][-1]:g} s: {', '.join(self)})"


@dataclass(frozen=True, eq=False)
class Run:
    """A simulated run."""

    scenario: Scenario
    summary: dict[str, Any]
    """Errors, torques and rates, and what they were held to, with the keys of `flexure run --json`; `rate_certified` is None: ask `certify`."""
    trace: Trace
    diverged_at: float | None
    """When it diverged, s; trace and summary end there. None if it ran to its end."""
    divergence: str | None
    """Why, in words."""
    sampled: dict[str, Any] | None
    """Whether the loop is stable that holds its torque for a control period (`stable`); None for laws in continuous time and of one's own."""
    objections: list[dict[str, Any]]
    """What speaks against the loop beside its errors: limits that the reference exceeds, and that it is unstable as sampled."""
    faults: dict[str, Any] | None
    """What the guard kept of its stops; None without a guard."""

    @property
    def follows(self) -> bool:
        """Whether it follows its reference; `summary["reasons"]` tells why not."""
        return bool(self.summary["follows"])

    @property
    def ok(self) -> bool:
        """Whether it follows and nothing speaks against it: where `flexure run` ends with 0."""
        return self.follows and not self.objections

    def plot(self) -> Figure:
        """Positions, errors, spring deflections and torques over time, a line for each joint. Needs matplotlib."""
        from ._plot import plot

        return plot(self)

    def __repr__(self) -> str:
        answer = f"diverged at {self.diverged_at:g} s" if self.diverged_at is not None else "follows" if self.ok else "follows, but see objections" if self.follows else "does not follow"
        return f"Run({self.scenario.name}: {answer}, rms error {1e3 * (self.summary['rms_e_l'] or float('nan')):.3g} mrad)"
