"""Figures of sweeps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._plot import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    from ._sweep import Rows

DECADES = 1.5
"""Values that span more are drawn on logarithmic scales."""

NOTHING = "#bbbbbb"
"""Where a run has no value."""


def heatmap(rows: Rows, x: str, y: str, value: str) -> Figure:
    """A metric over two parameters of a grid."""
    data = _numbers(rows, x, y, value)
    if data[x].size == 0:
        raise ValueError("there are no rows yet")
    across, columns = np.unique(data[x], return_inverse=True)
    up, lines = np.unique(data[y], return_inverse=True)
    if across.size * up.size > data[x].size:
        raise ValueError(f"{x} and {y} form no grid: {across.size} and {up.size} values on {data[x].size} rows; see scatter")
    known = np.isfinite(data[value])
    cells: NDArray[np.float64] = np.full((up.size, across.size), np.nan)
    sums, counts = np.zeros_like(cells), np.zeros_like(cells)
    np.add.at(sums, (lines[known], columns[known]), data[value][known])
    np.add.at(counts, (lines, columns), 1.0)
    every = np.zeros_like(cells)
    np.add.at(every, (lines, columns), known.astype(float))
    # A cell has a value where all its runs have one: a mean over those that did not diverge would flatter it.
    whole = (every == counts) & (counts > 0)
    cells[whole] = sums[whole] / counts[whole]
    figure, panel = _frame(rows, x, y)
    panel.set_facecolor(NOTHING)
    edges = [_edges(axis, _is_logarithmic(rows, key)) for axis, key in ((across, x), (up, y))]
    drawn = panel.pcolormesh(*edges, cells, norm=_norm(cells), cmap="viridis", rasterized=True)
    lost = np.zeros_like(cells)
    np.maximum.at(lost, (lines, columns), (data["status"] != "follows").astype(float))
    if lost.any():
        _hatch(panel, edges, lost)
    _bar(figure, panel, drawn, rows, value, bool(np.isnan(cells).any()), bool(lost.any()))
    return figure


def scatter(rows: Rows, x: str, y: str, value: str) -> Figure:
    """Every row at two of its parameters or metrics, coloured by a metric."""
    data = _numbers(rows, x, y, value)
    figure, panel = _frame(rows, x, y)
    known = np.isfinite(data[value])
    panel.scatter(data[x][~known], data[y][~known], s=12, color=NOTHING, marker="x", linewidths=0.8)
    drawn = panel.scatter(data[x][known], data[y][known], c=data[value][known], s=14, norm=_norm(data[value][known]), cmap="viridis", linewidths=0)
    _bar(figure, panel, drawn, rows, value, bool((~known).any()), False)
    return figure


def _numbers(rows: Rows, *names: str) -> dict[str, NDArray[Any]]:
    """Columns that can be drawn, and the status."""
    data = rows.columns(*dict.fromkeys([*names, "status"]))
    for name in names:
        if data[name].dtype.kind not in "if":
            raise ValueError(f"{name} is text; expected a column of numbers")
    return data


def _frame(rows: Rows, x: str, y: str) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 5.6), layout="constrained")
    panel = figure.subplots()
    for key, axis, scale in ((x, panel.set_xlabel, panel.set_xscale), (y, panel.set_ylabel, panel.set_yscale)):
        axis(_label(rows, key))
        if _is_logarithmic(rows, key):
            scale("log")
            _plain_ticks(panel.xaxis if key == x else panel.yaxis)
    panel.set_title(plain(rows.sweep.name), loc="left")
    return figure, panel


def _hatch(panel: Axes, edges: list[NDArray[np.float64]], marked: NDArray[np.float64]) -> None:
    """Cells that are marked."""
    from matplotlib.collections import PolyCollection

    x, y = edges
    cells = [[(x[j], y[i]), (x[j + 1], y[i]), (x[j + 1], y[i + 1]), (x[j], y[i + 1])] for i, j in zip(*np.nonzero(marked), strict=True)]
    panel.add_collection(PolyCollection(cells, facecolors="none", edgecolors="white", hatch="///", linewidths=0.0), autolim=False)


def _plain_ticks(axis: Axis) -> None:
    """1, 2, 5, 10 as they are, not as powers."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _bar(figure: Figure, panel: Axes, drawn: Any, rows: Rows, value: str, some_have_none: bool, some_are_lost: bool) -> None:
    bar = figure.colorbar(drawn, ax=panel)
    bar.set_label(_label(rows, value))
    words = ["hatched: a run that does not follow its reference"] if some_are_lost else []
    if some_have_none:
        words.append(f"grey: a run without {plain(value)}, as one that diverged")
    figure.supxlabel("; ".join(words), fontsize=9, x=0.02, ha="left")


def _label(rows: Rows, key: str) -> str:
    for metric in rows.sweep.metrics:
        if metric["name"] == key:
            return f"{plain(key)} [{metric['unit']}]"
    for parameter in rows.sweep.parameters:
        if parameter["key"] == key:
            unit = "× that of the file" if parameter["relative"] else parameter["unit"]
            return f"{plain(key)} [{unit}]" if unit else plain(key)
    return plain(key)


def _is_logarithmic(rows: Rows, key: str) -> bool:
    return any(parameter["key"] == key and parameter.get("scale") == "log" for parameter in rows.sweep.parameters)


def _norm(values: NDArray[np.float64]) -> Normalize:
    from matplotlib.colors import LogNorm, Normalize

    known = values[np.isfinite(values)]
    if known.size and known.min() > 0 and np.log10(known.max() / known.min()) > DECADES:
        return LogNorm()
    return Normalize()


def _edges(middles: NDArray[np.float64], is_logarithmic: bool) -> NDArray[np.float64]:
    """Of the cells around these values."""
    if middles.size == 1:
        width = abs(middles[0]) or 1.0
        return np.array([middles[0] - 0.5 * width, middles[0] + 0.5 * width])
    at = np.log(middles) if is_logarithmic else middles
    inner = 0.5 * (at[1:] + at[:-1])
    edges = np.concatenate([[2 * at[0] - inner[0]], inner, [2 * at[-1] - inner[-1]]])
    return np.exp(edges) if is_logarithmic else edges
