"""The paper's two-link arm under v-CBC with three shaping functions: do errors decay as fast as is certified?"""

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


def error_length(run: flexure.Run, gains: dict[str, Any]) -> NDArray[np.float64]:
    """√(2W) in √J: the length of position and momentum errors that certificates are about."""
    trace, robot = run.trace, run.scenario.robot
    e_l, e_m, sigma_l, sigma_m = (trace.joints(name) for name in ("e_l", "e_m", "sigma_l", "sigma_m"))
    s_l = np.linalg.solve(robot.mass_matrix(trace.joints("q_l")), sigma_l[..., None])[..., 0]
    metric_l, metric_m = (np.array(gains[side]["metric"], float) for side in ("link", "motor"))
    squares = metric_l * e_l**2 + metric_m * e_m**2 + sigma_l * s_l + sigma_m**2 / robot.motor_inertia
    return np.asarray(np.sqrt(squares.sum(axis=-1)))


figure, axes = plt.subplot_mosaic([["length", "error"], ["length", "torque"]], figsize=(9.5, 5.4), width_ratios=[1.25, 1])
for number, phi in enumerate(["tanh", "linear", "coupled-tanh"]):
    # From rest off the reference, which moves: with a smooth start there would be no error to decay.
    ideal = flexure.Scenario(f"two-link-{phi}", set={"hold": "continuous", "duration": 1.0})
    proof = flexure.certify(ideal)
    assert proof["verdict"] == "proved" and proof["start"]["inside"]
    rate, gains = proof["convergence_rate"], json.loads(proof["certificate"])["controller"]
    shown = np.floor(100.0 * rate) / 100.0  # a bound from below: rounded down

    # Certificates are about the law in continuous time; beside it, thin, the loop whose torque is held between control instants.
    run, sampled = flexure.simulate(ideal), flexure.simulate(flexure.Scenario(f"two-link-{phi}", set={"duration": 1.0}))
    length, colour = error_length(run, gains), f"C{number}"
    envelope = length[0] * np.exp(-rate * run.trace["t"])
    assert np.all(length <= envelope + 1e-9)  # √J, rounding of the integration
    print(f"{phi}: errors stay below the bound certified, {shown:.2f} 1/s; torques up to {run.summary['max_abs_u_m'] / 1e3:.1f} kN m")

    axes["length"].plot(run.trace["t"], envelope, colour, linestyle=(0, (4, 2)), linewidth=1.1)
    for loop, line in ((run, {"label": f"{phi}, certified {shown:.2f} 1/s"}), (sampled, {"linewidth": 0.8, "alpha": 0.6})):
        t, torques = loop.trace["t"], np.linalg.norm(loop.trace.joints("u_m"), axis=-1)
        axes["length"].plot(t, error_length(loop, gains), colour, **line)
        axes["error"].plot(t, 1e3 * loop.trace["e_l1"], colour, **line)
        axes["torque"].plot(t, torques, colour, **line)

axes["length"].plot([], [], "0.3", linestyle=(0, (4, 2)), linewidth=1.1, label="certified bound of the ideal loop")
axes["length"].plot([], [], "0.3", linewidth=0.8, label="torque held for 1 ms, not certified")
axes["length"].set(title="All errors", yscale="log", ylim=(1e-7, 1e6), xlabel="time [s]", ylabel="length of the errors, √(2W) [√J]")
axes["length"].legend(loc="upper right")
axes["error"].set(title="Link error of joint 1", ylabel="error [mrad]", xlim=(-0.01, 0.5))
axes["torque"].set(title="Motor torques of both joints", ylabel="Euclidean norm [N m]", xlabel="time [s]", xlim=(-0.01, 0.5), yscale="log")
figure.savefig(folder / "paper.png")
