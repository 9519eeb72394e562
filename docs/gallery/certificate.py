"""A certificate and its region: what starts at the edge stays inside and decays at least as fast as is certified."""

import json
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

NAME = "task-ideal-tracking"
IDEAL: dict[str, Any] = {
    "hold": "continuous",  # the law in continuous time, exact measurements, no limits: what certificates are about
    "duration": 1.0,  # s
    "controller": {"kind": "vcbc", "phi": "tanh"},  # with starting gains
    "reference": {"kind": "sine", "amplitude": 1.0, "frequency": 0.6},  # no smooth start: it would start where the arm is
}
scenario = flexure.Scenario(NAME, set=IDEAL)
proof = flexure.certify(scenario, error_box=0.3)  # rad
assert proof["verdict"] == "proved"
rate, level = proof["convergence_rate"], proof["region"]["level"]
shown = np.floor(100.0 * rate) / 100.0  # a bound from below: rounded down
gains = json.loads(proof["certificate"])["controller"]
metric_l, metric_m = (np.array(gains[side]["metric"], float) for side in ("link", "motor"))
law, robot = scenario.controller(), scenario.robot


def at_edge(z: NDArray[np.float64]) -> NDArray[np.float64]:
    """The motion at t = 0 with W = c and errors in the direction z, (4, n): positions and velocities of links, then of motors."""
    x = flexure.motion(law.reference(0.0)[0] + np.sqrt(2.0 * level / metric_l) * z[0])
    q_l, q_m, dq_l, dq_m = flexure.views(x)
    # Errors of the motors are from where the law wants them for these links: one after the other.
    root = np.linalg.cholesky(robot.mass_matrix(q_l)).T
    dq_l += np.sqrt(2.0 * level) * np.linalg.solve(root, z[1]) - law.command(x, 0.0)["s_l"]
    q_m += np.sqrt(2.0 * level / metric_m) * z[2] - law.command(x, 0.0)["e_m"]
    dq_m += np.sqrt(2.0 * level / robot.motor_inertia) * z[3] - law.command(x, 0.0)["s_m"]
    return x


def storage(trace: flexure.Trace) -> NDArray[np.float64]:
    """W in J, the storage of position and momentum errors."""
    e_l, e_m, sigma_l, sigma_m = (trace.joints(name) for name in ("e_l", "e_m", "sigma_l", "sigma_m"))
    s_l = np.linalg.solve(robot.mass_matrix(trace.joints("q_l")), sigma_l[..., None])[..., 0]
    squares = metric_l * e_l**2 + metric_m * e_m**2 + sigma_l * s_l + sigma_m**2 / robot.motor_inertia
    return np.asarray(0.5 * squares.sum(axis=-1))


figure, (plane, decay) = plt.subplots(1, 2, figsize=(9.5, 4.9))
circle = np.linspace(0.0, 2.0 * np.pi, 241)
circle = np.stack([np.cos(circle), np.sin(circle)], axis=-1)
plane.fill(*(1e3 * np.sqrt(2.0 * level / metric_l) * circle).T, color="C5", alpha=0.25, linewidth=0.0, label="certified region, W ≤ c")
anywhere = np.random.default_rng(1).normal(size=(24, 4, 2))
links = np.zeros((12, 4, 2))
links[:, 0] = circle[10::20]
for colour, starts, label in (("C1", anywhere, "from errors of all kinds"), ("C0", links, "from errors of the links alone")):
    for z in starts / np.linalg.norm(starts, axis=(1, 2), keepdims=True):
        initial = {name: part.tolist() for name, part in flexure.views(at_edge(z))._asdict().items()}
        run = flexure.simulate(flexure.Scenario(NAME, set={**IDEAL, "initial": initial}))
        t, length, e_l = run.trace["t"], np.sqrt(storage(run.trace) / level), 1e3 * run.trace.joints("e_l")
        assert np.all(length <= np.exp(-rate * t) + 1e-6)
        plane.plot(*e_l.T, colour, linewidth=1.2, marker="o", markevery=[0], markersize=3.5, label=label)
        decay.plot(t, length, colour, linewidth=1.0)
        label = ""
decay.plot(t, np.exp(-rate * t), "k--", label=f"certified of the ideal loop: {shown:.2f} 1/s")
plane.set(xlabel="error of link 1 [mrad]", ylabel="error of link 2 [mrad]", title="The region, seen from the links", ylim=(-320, 430))
plane.legend(loc="upper right")
decay.set(xlabel="time [s]", ylabel="length of all errors, √(W/c)", title="Decay", yscale="log")
decay.legend()
figure.savefig(folder / "certificate.png")
print(f"36 runs from the edge, W = {1e3 * level:.1f} mJ, stay below e^(-{shown:.2f} t): proved of every start inside, seen of these")
