"""Stiffness, inertia, damping and friction from a log: excite an arm that is not what its file says, and find out what it is."""

import sys
import tempfile
from pathlib import Path
from typing import Any

import flexure
import matplotlib.pyplot as plt
import numpy as np

here = Path(__file__).parent
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else here
plt.style.use(here / "style.mplstyle")

# The arm that makes the log. Its file, planar-2r, has 20 kN m/rad and 37.5 kg m² in both joints and neither damping nor friction.
ROBOT, JOINTS = "planar-2r", ("shoulder", "elbow")
TRUTH = {
    "stiffness": [26e3, 17e3],  # N m/rad
    "motor_inertia": [30.0, 42.0],  # kg m²
    "link_damping": [15.0, 6.0],  # N m s/rad
    "motor_damping": [80.0, 50.0],
    "link_friction": [2.0, 1.0],  # N m
    "motor_friction": [6.0, 4.0],
}
truth: dict[str, Any] = {f"robot.joints.{key}": value for key, value in TRUTH.items() if "friction" not in key}
truth["initial"] = "at rest"  # on the springs that it has
truth["imperfection"] = [
    {"kind": "encoder", "placement": "link", "resolution": 2.0 * np.pi / 2**17},
    {"kind": "encoder", "placement": "motor", "resolution": 2.0 * np.pi / 4096 / 50},  # behind the gear
    {"kind": "friction", "side": "link", "coulomb": TRUTH["link_friction"]},
    {"kind": "friction", "side": "motor", "coulomb": TRUTH["motor_friction"]},
]

with tempfile.TemporaryDirectory() as scratch:
    motion, log = Path(scratch) / "motion.toml", Path(scratch) / "log.csv"
    flexure.excite(ROBOT, motion, duration=10.0)
    trace = flexure.simulate(flexure.Scenario(motion, set=truth)).trace
    np.savetxt(log, np.stack(list(trace.values()), axis=-1), delimiter=",", header=",".join(trace), comments="")
    found = flexure.identify(ROBOT, log)

figure, axes = plt.subplot_mosaic([["bend", "found"], ["torque", "found"]], figsize=(9.5, 5.4), width_ratios=[1.0, 1.25])
for number, (name, joint) in enumerate(zip(JOINTS, found["joints"], strict=True)):
    colour, rows = f"C{number}", np.arange(len(TRUTH)) + 0.3 * number - 0.15
    numbers = {parameter["key"]: parameter for parameter in joint["parameters"]}
    true = np.array([TRUTH[key][number] for key in TRUTH])
    values, bars, before = (np.array([numbers[key][what] or 0.0 for key in TRUTH]) for what in ("value", "error", "before"))
    assert found["converged"] and all(numbers[key]["known"] for key in TRUTH) and np.all(np.abs(values - true) <= bars)
    stiffness = f"{values[0] / 1e3:.2f} ± {bars[0] / 1e3:.2f} kN m/rad, truth {true[0] / 1e3:g}, file {before[0] / 1e3:g}"
    print(f"{name}: stiffness {stiffness}; the truth is inside all six error bars of 3 σ")
    off, bar = 100.0 * (values / true - 1.0), 100.0 * bars / true
    axes["found"].errorbar(off, rows, xerr=bar, fmt="o", color=colour, markersize=5, capsize=3, label=f"{name}, ± 3 σ")
    axes["found"].plot(100.0 * (before / true - 1.0), rows, "x", color=colour, markersize=6, label=f"{name}, its file")
    bend = trace[f"q_m_measured{number + 1}"] - trace[f"q_l_measured{number + 1}"]
    axes["bend"].plot(trace["t"], 1e3 * bend, colour, linewidth=0.8, label=name)
    axes["torque"].plot(trace["t"], trace[f"u_m{number + 1}"], colour, linewidth=0.8)
axes["bend"].set(title="Half a second of the log", ylabel="measured deflection [mrad]", xlim=(4.0, 4.5))
axes["torque"].set(xlabel="time [s]", ylabel="motor torque [N m]", xlim=(4.0, 4.5))
axes["found"].axvline(0.0, ymax=0.86, color="black", linewidth=1.0)
axes["found"].set_xscale("symlog", linthresh=0.1)
axes["found"].set(title="What it tells", xlabel="difference from the truth [%]", xlim=(-150.0, 60.0), ylim=(5.6, -1.5))
axes["found"].set_xticks(ticks := [-100, -10, -1, -0.1, 0, 0.1, 1, 10], [f"{tick:g}" for tick in ticks])
axes["found"].set_yticks(range(len(TRUTH)), [key.replace("_", "\n") for key in TRUTH])
axes["found"].legend(loc="upper center", ncols=2)
figure.savefig(folder / "identification.png")
