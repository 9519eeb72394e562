"""Figures of runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._run import Run

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999933"]
"""Okabe and Ito's, told apart by colour-blind readers too."""

NEAR = 0.7
"""A joint that gives this part of its torque limit has the limit drawn."""


def plot(run: Run) -> Figure:
    """Four panels: positions with their reference, errors, deflections of the springs, torques of the motors."""
    from matplotlib.figure import Figure

    trace, robot = run.trace, run.scenario.robot
    t, names = trace["t"], robot.joints
    colours = [COLOURS[i % len(COLOURS)] for i in range(len(names))]
    figure = Figure(figsize=(9.5, 8.5), layout="constrained")
    panels = figure.subplots(4, 1, sharex=True)
    positions, errors, deflections, torques = panels
    q_l, e_l, u_m = trace.joints("q_l"), trace.joints("e_l"), trace.joints("u_m")
    (small_error, error_prefix), (bend, bend_prefix) = scaled(e_l), scaled(trace.joints("q_m") - q_l)
    limits = robot.limits["torque"]
    for i, (name, colour) in enumerate(zip(names, colours, strict=True)):
        positions.plot(t, q_l[:, i], color=colour, label=plain(name))
        positions.plot(t, q_l[:, i] - e_l[:, i], color="black", linestyle=":", linewidth=0.8)
        errors.plot(t, small_error[:, i], color=colour, linewidth=1.0)
        deflections.plot(t, bend[:, i], color=colour, linewidth=1.0)
        torques.step(t, u_m[:, i], color=colour, where="post", linewidth=1.0)
        if np.abs(u_m[:, i]).max(initial=0.0) > NEAR * limits[i]:
            for side in (-limits[i], limits[i]):
                torques.axhline(side, color=colour, linestyle="--", linewidth=0.8)
    angle, torque = (units(run, signal) for signal in ("q_l", "u_m"))
    positions.set_ylabel(f"link position [{angle}]")
    errors.set_ylabel(f"link error [{error_prefix}{angle}]")
    deflections.set_ylabel(f"spring deflection [{bend_prefix}{angle}]")
    torques.set_ylabel(f"motor torque [{torque}]")
    torques.set_xlabel("time [s]")
    positions.set_title(plain(run.scenario.name), loc="left")
    for panel in panels:
        panel.grid(visible=True, color="#dddddd", linewidth=0.6)
        panel.spines[["top", "right"]].set_visible(False)
        panel.margins(x=0.01)
    figure.align_ylabels(panels)
    handles, labels = positions.get_legend_handles_labels()
    reference = positions.get_lines()[1]
    figure.legend([*handles, reference], [*labels, "reference"], loc="outside right upper", frameon=False)
    return figure


def plain(name: str) -> str:
    """A name as it is: no formula, and in the legend whatever it begins with."""
    return "\u200a" + name.replace("$", r"\$")


def scaled(x: NDArray[np.float64]) -> tuple[NDArray[np.float64], str]:
    """Numbers so that the largest has one to three digits before the point, and the SI prefix of their unit."""
    largest = np.abs(x[np.isfinite(x)]).max(initial=0.0)
    for factor, prefix in ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n")):
        if factor * largest >= 1.0:
            return factor * x, prefix
    return 1e12 * x, "p"


def units(run: Run, signal: str) -> str:
    """The unit of a signal of all joints; of robots that turn and slide both."""
    return " or ".join(sorted({run.trace.units[f"{signal}{i + 1}"] for i in range(len(run.scenario.robot))}))
