"""Control laws on the same arm with the same sensors, each with gains from the same short search: error against chatter."""

import sys
from pathlib import Path
from typing import Any

import flexure
import matplotlib.pyplot as plt
import numpy as np

here = Path(__file__).parent
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else here
plt.style.use(here / "style.mplstyle")

SPRINGS = ["vcbc", "passivity", "backstepping", "cascade", "feedforward-pd", "esp", "feedback-linearization", "integral-manifold"]
RIGID = ["rigid-vcbc", "singular-perturbation"]  # as if links were where their motors are; the second damps the springs
GOAL = ["pd"]  # made for a goal that stays; the other regulators differ from it under gravity, which this arm does not feel
LABELS = {"backstepping": (4, -15), "cascade": (-20, 9), "feedforward-pd": (-45, 9)}  # points; where others are in the way

arm: dict[str, Any] = {"duration": 12.0}  # s
found = flexure.compare(flexure.Scenario("two-link-hardware", set=arm), controllers=SPRINGS + RIGID + GOAL, budget=10, seeds=1)
scores = {score["law"]: score for score in found["tasks"][0]["scores"]}

figure, (plane, course) = plt.subplots(1, 2, figsize=(9.5, 4.9), width_ratios=[1.3, 1.0])
for label, laws, marker in (("knows the springs", SPRINGS, "o"), ("takes joints as rigid", RIGID, "s"), ("holds a goal", GOAL, "^")):
    points = [(100.0 * scores[law]["chatter"], 1e3 * scores[law]["rms_error"]) for law in laws]
    plane.scatter(*zip(*points, strict=True), s=45, marker=marker, label=label, zorder=3)
    for law, point in zip(laws, points, strict=True):
        plane.annotate(law, point, xytext=LABELS.get(law, (6, 4)), textcoords="offset points")
plane.axvline(5.0, ymax=0.84, color="0.4", linestyle=":", linewidth=1.2, label="right of it laws pay for chatter")
plane.set(xscale="log", yscale="log", xlim=(0.7, 70.0), ylim=(0.07, 200.0), title="Same search, same sensors")
plane.set(xlabel="chatter: change of torque in 2 ms [% of rms torque]", ylabel="rms error of the worse link [mrad]")
plane.xaxis.set_major_formatter("{x:g}")
plane.yaxis.set_major_formatter("{x:g}")
plane.legend(loc="upper left", ncols=2, columnspacing=1.0)

# The gains that were found are keys of a scenario; all keys of a law are there, so that they take the place of the scenario's.
for law, phi, colour in (("vcbc", {"phi": "linear"}, "black"), ("passivity", {}, "C3"), ("esp", {}, "C4")):
    gains = {f"controller.{gain['key']}": gain["values"] for gain in scores[law]["gains"]}
    run = flexure.simulate(flexure.Scenario("two-link-hardware", set={**arm, "controller": {"kind": law, **phi}, **gains}))
    worse = 1e3 * np.abs(run.trace.joints("e_l")).max(axis=-1)
    course.plot(run.trace["t"], worse, colour, linewidth=1.1, label=law)
course.axhline(1e3 * np.pi / 4096, color="0.4", linestyle="--", linewidth=1.2, label="half an encoder step")
course.set(xlabel="time [s]", ylabel="error of the worse link [mrad]", title="Three of them", ylim=(0.0, 1.45))
course.legend()
figure.savefig(folder / "laws.png")

best = min(scores.values(), key=lambda score: score["penalised_error"])
ours, rigid = 1e3 * scores["vcbc"]["rms_error"], 1e3 * scores["rigid-vcbc"]["rms_error"]
print(f"knowing the springs: rms error of v-CBC {ours:.2f} mrad, as if joints were rigid {rigid:.0f} mrad; best law here: {best['law']}")
assert ours < 0.1 * rigid
