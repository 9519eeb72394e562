"""Stiffness against delay: where the loop of one set of gains follows, where it is stable as sampled, and where a certificate says so."""

import sys
import tempfile
from pathlib import Path

import flexure
import matplotlib.pyplot as plt
import numpy as np

here = Path(__file__).parent
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else here
plt.style.use(here / "style.mplstyle")

STIFFNESS, DELAY = "robot.joints.stiffness", "imperfection.delay.actuation"
SWEEP = f"""
scenario = "two-link-hardware"
metrics = ["rms_e_l", "sampled_rate"]
[set]
duration = 3.0
[parameters]
"{STIFFNESS}" = {{ from = 0.1, to = 10.0, scale = "log", relative = true, points = 21 }}
"{DELAY}" = {{ from = 0.0, to = 40e-3, points = 11 }}
"""

with tempfile.TemporaryDirectory() as place:
    (Path(place) / "delays.toml").write_text(SWEEP)
    rows = flexure.sweep(Path(place) / "delays.toml", Path(place) / "rows")
    columns = rows.columns()
shape = (11, 21)  # keys in alphabetical order, the last changing first
delay, stiffness = 1e3 * columns[DELAY].reshape(shape), columns[STIFFNESS].reshape(shape)
error, shrinking = 1e3 * columns["rms_e_l"].reshape(shape), columns["sampled_rate"].reshape(shape)
follows = (columns["status"] == "follows").reshape(shape)

# A certificate is about the ideal loop: continuous time, exact measurements, no delay. That is one edge of this plane, and it is
# certified for every stiffness that the law knows. Where that edge is unstable at 500 Hz the verdict says so.
proofs = [flexure.certify(flexure.Scenario("two-link-hardware", set={STIFFNESS: (k * flexure.Robot("two-link-plausible").stiffness).tolist()})) for k in stiffness[0, ::5]]
rates = [proof["contraction_rate"] for proof in proofs]
assert all(proof["verdict"].startswith("proved") for proof in proofs) and np.ptp(rates) < 1e-6
assert follows[shrinking > 0.5].mean() > follows[shrinking < -0.5].mean()

figure, panel = plt.subplots(figsize=(8.5, 5.4))
shades = panel.pcolormesh(stiffness, delay, error, norm="log", cmap="cividis_r", shading="nearest", rasterized=True)
plt.rcParams["hatch.color"] = "white"
panel.contourf(stiffness, delay, ~follows, levels=[0.5, 1.5], colors="none", hatches=["///"])
border = panel.contour(stiffness, delay, shrinking, levels=[0.0], colors="C1", linewidths=2.2)
panel.plot(stiffness[0, [0, -1]], [0.0, 0.0], "C0", linewidth=6.0, solid_capstyle="butt", clip_on=False, zorder=5)
panel.set(xscale="log", xlim=(0.1, 10.0), ylim=(0.0, 40.0), xlabel="stiffness of both joints [× that of the arm]", ylabel="delay from command to torque [ms]")
panel.set_title("One set of gains, 231 arms: encoders, filter and torque limits, 500 Hz")
panel.xaxis.set_major_formatter("{x:g}")
panel.grid(visible=False)
figure.colorbar(shades, label="rms error of the worse link [mrad]")
handles = [plt.Line2D([], [], color="C1", linewidth=2.2), plt.Line2D([], [], color="C0", linewidth=6.0), plt.Rectangle((0, 0), 1, 1, facecolor="0.55", edgecolor="white", hatch="///")]
said = ["sampled loop: small errors neither grow nor shrink", f"certified in continuous time, without delay: {np.floor(100 * min(rates)) / 100:.2f} 1/s", "does not follow its reference"]
figure.legend(handles, said, loc="outside lower left", ncols=2)
figure.savefig(folder / "delays.png")
print(f"{follows.sum()} of {follows.size} arms follow; certified on the whole edge without delay, and nowhere else")
