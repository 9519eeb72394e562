"""Your own arm from its URDF: import it, let the check say which gain its control period does not bear, change that, run it."""

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
URDF = here.parents[1] / "robots" / "panda.urdf"  # or yours

with tempfile.TemporaryDirectory() as scratch:
    # A URDF knows no springs, motors and sensors: typical strain wave gears, 1 kHz, encoders, a delay and friction are assumed.
    robot_file, scenario_file, *_ = flexure.import_urdf(URDF, assume="harmonic-drive", scenario=True, out=scratch)["files"]
    drafted = flexure.Scenario(scenario_file)
    changes: dict[str, Any] = {f"controller.{key}": gain.tolist() for key, gain in drafted.gains.items()}
    advice = drafted.sampled()
    if advice is not None and not advice["stable"]:
        print(f"unstable with starting gains at this control period: {advice['move']} {advice['gain']}, factor {advice['factor']:g}")
        changes[advice["gain"]] = [advice["factor"] * gain for gain in advice["now"]]
    run = flexure.simulate(flexure.Scenario(scenario_file, set={"controller.phi": "linear", **changes}))

trace, robot = run.trace, run.scenario.robot
share = 100.0 * trace.joints("u_m") / robot.limits["torque"]
panels = (
    ("Links, reference dotted", "position [rad]", trace.joints("q_l")),
    ("Link errors: friction where joints turn back", "error [mrad]", 1e3 * trace.joints("e_l")),
    ("Motor torques", "share of the limit [%]", share),
    ("Springs", "deflection [mrad]", 1e3 * (trace.joints("q_m") - trace.joints("q_l"))),
)
figure, axes = plt.subplots(2, 2, figsize=(9.5, 6.2), sharex=True)
for axis, (title, label, signals) in zip(axes.flat, panels, strict=True):
    lines = axis.plot(trace["t"], signals, linewidth=1.1)
    axis.set(title=title, ylabel=label)
axes[0, 0].plot(trace["t"], trace.joints("q_ld"), "k:", linewidth=1.0)
for limit in (-100.0, 100.0):
    axes[1, 0].axhline(limit, color="black", linestyle="--", linewidth=1.0)
axes[1, 0].set(xlabel="time [s]")
axes[1, 1].set(xlabel="time [s]")
figure.legend(lines, [name.removeprefix(f"{URDF.stem}_") for name in robot.joints], loc="outside lower center", ncols=7)
figure.savefig(folder / "your_robot.png")
print(f"rms error {1e3 * run.summary['rms_e_l']:.1f} mrad, at most {np.abs(share).max():.0f} % of a torque limit")
assert run.ok and np.abs(share).max() < 100.0
