"""Figures of runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._run import Run

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999933"]
"""Okabe and Ito's, told apart by colour-blind readers too."""


def plot(run: Run) -> Figure:
    """Four panels: positions with their reference, errors, deflections of the springs, torques of the motors."""
    from matplotlib.figure import Figure

    trace, robot = run.trace, run.scenario.robot
    t = trace["t"]
    names = robot.joints
    colours = [COLOURS[i % len(COLOURS)] for i in range(len(names))]
    figure = Figure(figsize=(8.0, 8.5), layout="constrained")
    panels = figure.subplots(4, 1, sharex=True)
    positions, errors, deflections, torques = panels
    q_l, e_l = trace.joints("q_l"), trace.joints("e_l")
    deflection = trace.joints("q_m") - q_l
    u_m = trace.joints("u_m")
    for i, (name, colour) in enumerate(zip(names, colours, strict=True)):
        positions.plot(t, q_l[:, i], color=colour, label=name)
        positions.plot(t, q_l[:, i] - e_l[:, i], color=colour, linestyle=":", linewidth=1.0)
        errors.plot(t, 1e3 * e_l[:, i], color=colour)
        deflections.plot(t, 1e3 * deflection[:, i], color=colour)
        torques.step(t, u_m[:, i], color=colour, where="post", linewidth=0.9)
    limits = robot.limits["torque"]
    reach = np.abs(u_m).max(initial=0.0)
    for limit, colour in zip(limits, colours, strict=True):
        if np.isfinite(limit) and limit < 1.5 * reach:
            for side in (-limit, limit):
                torques.axhline(side, color=colour, linestyle="--", linewidth=0.8)
    kinds = {trace.units["q_l1"]} | {trace.units[f"q_l{i + 1}"] for i in range(len(names))}
    angle = " and ".join(sorted(kinds))
    milli = " and ".join(f"m{kind}" for kind in sorted(kinds))
    torque = " and ".join(sorted({trace.units[f"u_m{i + 1}"] for i in range(len(names))}))
    positions.set_ylabel(f"link position [{angle}]\n(dotted: reference)")
    errors.set_ylabel(f"link error [{milli}]")
    deflections.set_ylabel(f"spring deflection [{milli}]")
    torques.set_ylabel(f"motor torque [{torque}]")
    torques.set_xlabel("time [s]")
    for panel in panels:
        panel.grid(visible=True, color="#dddddd", linewidth=0.6)
        panel.spines[["top", "right"]].set_visible(False)
    figure.legend(*positions.get_legend_handles_labels(), loc="outside upper center", ncols=min(len(names), 7), frameon=False)
    figure.suptitle(run.scenario.name)
    return figure
