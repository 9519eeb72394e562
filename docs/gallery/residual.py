"""A residual policy: what an arm has and its law does not know, friction, soft springs and a payload, learnt on top of the law."""

import sys
import time
from pathlib import Path
from typing import Any

import flexure
import flexure.gym
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

here = Path(__file__).parent
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else here
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 60.0
plt.style.use(here / "style.mplstyle")

NAME, PART = "task-ideal-tracking", 0.3  # of the torque limits is the policy's
SINE: dict[str, Any] = {"kind": "sine", "amplitude": 0.25, "frequency": 2.0, "phase": [0.0, 1.0]}
UNKNOWN: list[dict[str, Any]] = [
    {"kind": "friction", "side": "motor", "coulomb": [0.4, 0.08]},  # N m
    {"kind": "model-error", "stiffness": 0.7, "payload": {"mass": 0.3, "position": [0.267, 0.0, 0.0]}},
]
# Environments show true motions and act at once. What is learnt there is tried with these.
SENSORS: list[dict[str, Any]] = [
    {"kind": "encoder", "resolution": 2.0 * np.pi / 4096},
    {"kind": "velocity-filter", "order": 2, "cutoff": 40.0, "damping": 0.9},
    {"kind": "delay", "computation": 0.001},
]


def policy(q_d: NDArray[Any], dq_d: NDArray[Any], weights: NDArray[Any]) -> NDArray[Any]:
    """Actions from the reference and its rate alone: feed-forward, so that it cannot just learn higher gains."""
    seen = np.concatenate([q_d / 0.25, dq_d / 0.5, np.tanh(dq_d / 0.02), np.ones_like(q_d[..., :1])], axis=-1)
    return np.asarray(np.clip(np.einsum("...i,...ij->...j", seen, weights), -1.0, 1.0))


# Augmented random search (Mania, Guy and Recht 2018): 8 mirrored trials on 4 arms each, and the policy itself on 16 for the curve.
training = flexure.Scenario(NAME, set={"duration": 3.142, "reference": SINE, "initial": "at rest", "imperfection": UNKNOWN})
envs = flexure.gym.ElasticArmVectorEnv(training, 80, residual=PART, frame_skip=10, start=0.0, scale=0.01, effort=0.0)
rng, weights = np.random.default_rng(1), np.zeros((7, 2))
curve: list[float] = []
began = time.monotonic()
while time.monotonic() - began < seconds:
    trials = rng.normal(size=(8, *weights.shape))
    tried = weights + 0.05 * np.concatenate([trials.repeat(4, axis=0), -trials.repeat(4, axis=0), np.zeros((16, *weights.shape))])
    seen, _ = envs.reset(seed=len(curve))  # anywhere along the reference
    rewards = np.zeros((100, 80))
    for step in range(100):
        seen, rewards[step], *ended = envs.step(policy(seen[:, 8:10], seen[:, 10:], tried))
    found = rewards[33:].mean(axis=0)  # springs are not in balance where an arm starts
    curve.append(10.0 * np.sqrt(-found[64:].mean()))  # mrad: a reward is minus the mean of (error / 10 mrad)²
    plus, minus = found[:64].reshape(2, 8, 4).mean(axis=-1)
    slope = np.einsum("d,dij->ij", plus - minus, trials) / 8.0 / np.std([plus, minus])
    weights += 0.05 * min(1.0, 30.0 / len(curve)) * slope

reference = {**SINE, "smooth_start": {"duration": 1.0}}
loop = flexure.Scenario(NAME, set={"duration": 8.0, "reference": reference, "imperfection": UNKNOWN + SENSORS})
law, part = loop.controller(), PART * loop.robot.limits["torque"]
before = flexure.simulate(loop).trace
after = flexure.simulate(loop, law=lambda t, x, r: law.torque(x, t) + part * policy(r[0], r[1], weights)).trace
rms = [1e3 * np.sqrt((trace.joints("e_l")[trace["t"] >= 2.0] ** 2).mean()) for trace in (before, after)]
print(f"{len(curve)} generations: rms error of the links from 2 s on, with sensors and delay, {rms[0]:.1f} → {rms[1]:.1f} mrad")

figure, axes = plt.subplot_mosaic([["curve", "e_l1"], ["curve", "e_l2"]], figsize=(9.5, 4.9), width_ratios=[1.0, 1.35])
axes["curve"].plot(curve, "C2", linewidth=1.2)
axes["curve"].set(title="Training, on true motions", xlabel="generation", ylabel="rms error of 16 arms [mrad]", ylim=(0.0, None))
for name in ("e_l1", "e_l2"):
    axes[name].plot(before["t"], 1e3 * before[name], "C1", linewidth=1.2, label="law alone")
    axes[name].plot(after["t"], 1e3 * after[name], "C0", linewidth=1.2, label="with what was learnt")
    axes[name].set(ylabel=f"error of link {name[-1]} [mrad]")
axes["e_l1"].set(title="Tried with encoders, velocity filter and delay")
axes["e_l2"].set(xlabel="time [s]")
figure.legend(*axes["e_l1"].get_legend_handles_labels(), loc="outside lower right", ncols=2)
figure.savefig(folder / "residual.png")
assert seconds < 30.0 or rms[1] < 0.4 * rms[0]
