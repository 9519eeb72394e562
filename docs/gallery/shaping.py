"""Your own shaping function: one that bends early takes less torque from far off than the linear one, and is as fast."""

import sys
from pathlib import Path
from typing import Any

import flexure
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

here = Path(__file__).parent
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else here
plt.style.use(here / "style.mplstyle")


def root(error: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope 1 near the reference, hardly more than 0.1 far from it."""
    return error / np.sqrt(1.0 + (error / 0.1) ** 2)


own = flexure.Shaping(root, reach=0.5)  # rad
assert own.error < 1e-6  # the series that the law runs on is the function
SETTING: dict[str, Any] = {
    "initial": {"q_l": [0.2, -0.2], "q_m": [0.2, -0.2]},  # rad
    "reference": {"kind": "sine", "amplitude": 0.5, "frequency": 0.6},  # begins at 0: the robot is off by 0.2 rad
    "duration": 2.0,  # s
}
linear, tanh = (flexure.Scenario("task-ideal-tracking", set={**SETTING, "controller": {"kind": "vcbc", "phi": phi}}) for phi in ("linear", "tanh"))
runs = {"linear": flexure.simulate(linear), "tanh": flexure.simulate(tanh), "your own": flexure.simulate(linear, shaping=own)}

figure, (shapes, errors, torques) = plt.subplots(1, 3, figsize=(11.0, 4.2))
e = np.linspace(-0.5, 0.5, 401)
for (name, run), values, line in zip(runs.items(), (e, np.tanh(e), own(e)), ("-", ":", "-"), strict=True):
    t, shown = run.trace["t"], {"label": name, "linestyle": line, "linewidth": 2.4 if line == ":" else 1.6}
    shapes.plot(e, values, **shown)
    errors.plot(t, 1e3 * np.abs(run.trace.joints("e_l")).max(axis=-1), **shown)
    torques.step(1e3 * t, run.trace["u_m1"], where="post", **shown)
peaks = {name: np.abs(run.trace["u_m1"]).max() for name, run in runs.items()}
assert peaks["your own"] < 0.6 * peaks["linear"]
limit = linear.robot.limits["torque"][0]
torques.axhline(-limit, color="0.4", linestyle="--", linewidth=1.0, label="limit")
shapes.set(xlabel="position error e [rad]", ylabel="φ / Λ [rad]", title="Shaping functions")
errors.set(xlabel="time [s]", ylabel="error of the worse link [mrad]", title="Errors")
torques.set(xlabel="time [ms]", ylabel="torque of motor 1 [N m]", xlim=(-5.0, 200.0), ylim=(-9.0, 1.0), title="Torques at the start")
shapes.legend()
torques.legend(loc="center right")
figure.savefig(folder / "shaping.png")
print("largest torques of motor 1:", ", ".join(f"{name} {peak:.2f} N m" for name, peak in peaks.items()))
