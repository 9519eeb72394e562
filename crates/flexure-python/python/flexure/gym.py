"""Gymnasium environments of elastic arms: follow a reference by torques, or by what a law's torques lack. Needs gymnasium.

    >>> import gymnasium, flexure.gym
    >>> env = gymnasium.make("flexure/TwoLink-v0")
    >>> envs = flexure.gym.ElasticArmVectorEnv("two-link-hardware", num_envs=64)

An observation is (q_l, q_m, dq_l, dq_m, reference, its rate), 6n numbers in rad and rad/s. An action is n numbers from -1 to 1: parts of the
largest torque that the arm may be given, or with `residual` of a part of it that is added to the law of the scenario. The reward is
minus the mean over the joints of (error / scale)² + effort · action², each at most 10; an episode ends early where a position leaves its
limits or errors leave 1 rad, with a reward of minus what the rest of it could cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, SupportsFloat

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils.seeding import np_random
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from . import Controller, Plant, Scenario

__all__ = ["ElasticArmEnv", "ElasticArmVectorEnv"]

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

LOST = 1.0
"""Error at which an episode ends, rad."""

MOST = 1e3
"""Largest number of an observation."""

WORST = 10.0
"""Largest cost of an instant."""


class _Arms:
    """Arms side by side, (count, …): what both kinds of environments are made of."""

    def __init__(
        self,
        scenario: Scenario | str,
        *,
        residual: float | None,
        frame_skip: int,
        episode: int,
        start: float,
        scale: float,
        effort: float,
    ) -> None:
        self.scenario = scenario if isinstance(scenario, Scenario) else Scenario(scenario)
        if frame_skip < 1 or episode < 1:
            raise ValueError(f"frame_skip is {frame_skip} and episode {episode}: at least 1 each")
        if residual is not None and not 0.0 < residual <= 1.0:
            raise ValueError(f"residual is {residual}: a part of the largest torque, > 0 and at most 1")
        self.plant, self.law = Plant(self.scenario), Controller(self.scenario)
        self.residual, self.frame_skip, self.episode = residual, frame_skip, episode
        self.start, self.scale, self.effort = start, scale, effort
        limits = self.scenario.robot.limits
        self.n = len(self.scenario.robot)
        self.limit = np.where(np.isfinite(limits["torque"]), limits["torque"], self._largest())
        self.lower, self.upper = limits["lower"], limits["upper"]
        self.observation = spaces.Box(-MOST, MOST, (6 * self.n,), np.float64)
        self.action = spaces.Box(-1.0, 1.0, (self.n,), np.float64)

    def _largest(self) -> Array:
        """Of arms whose motors have no limit: three times what their weight and springs take along the reference, at least 1 N m."""
        robot, law = self.scenario.robot, self.law
        references = law.reference(np.linspace(0.0, self.scenario.duration, 200))
        taken = robot.inverse_dynamics(references[:, 0], references[:, 1], references[:, 2])
        inertia = self.scenario.robot.motor_inertia * np.abs(references[:, 2]).max(axis=0)
        return np.asarray(np.maximum(3.0 * (np.abs(taken).max(axis=0) + inertia), 1.0))

    def begin(self, rngs: Sequence[np.random.Generator]) -> tuple[Array, NDArray[np.int64]]:
        """Motions at an instant of the reference, the springs as at the scenario's start, off by `start`; and the instants. Each arm draws
        from a generator of its own."""
        last = max(1, round(self.scenario.duration / self.plant.period))
        draws = [(rng.integers(0, last), rng.uniform(-self.start, self.start, self.n)) for rng in rngs]
        instants, off = np.array([instant for instant, _ in draws]), np.array([off for _, off in draws])
        references = self.law.reference(instants * self.plant.period)
        q_l = references[:, 0] + off
        sag = self.scenario.robot.inverse_dynamics(q_l, references[:, 1], references[:, 2]) / self.scenario.robot.stiffness
        return np.concatenate([q_l, q_l + sag, references[:, 1], references[:, 1]], axis=-1), instants

    def observe(self, x: Array, instants: NDArray[np.int64]) -> Array:
        references = self.law.reference(instants * self.plant.period)[:, :2]
        observed: Array = np.concatenate([x, references.reshape(len(x), -1)], axis=-1)
        return np.clip(np.nan_to_num(observed), -MOST, MOST)

    def step(self, x: Array, instants: NDArray[np.int64], action: Array) -> tuple[Array, Array, Array, Bools]:
        """Motions, observations, rewards and who is lost after `frame_skip` control periods."""
        asked = np.clip(action, -1.0, 1.0) * self.limit
        for k in range(self.frame_skip):
            torque = asked
            if self.residual is not None:
                law = self.law.torque(x, (instants + k) * self.plant.period)
                torque = np.clip(law + self.residual * asked, -self.limit, self.limit)
            x = self.plant.roll(x, torque[:, None, :], first=instants + k)[:, -1]
        observed = self.observe(x, instants + self.frame_skip)
        error = x[:, : self.n] - observed[:, 4 * self.n : 5 * self.n]
        # What cannot be integrated on is lost, too.
        beyond = (x[:, : self.n] < self.lower) | (x[:, : self.n] > self.upper) | ~(np.abs(error) < LOST)
        lost: Bools = np.any(beyond, axis=-1)
        cost = ((error / self.scale) ** 2 + self.effort * action**2).mean(axis=-1)
        return x, observed, -np.minimum(np.nan_to_num(cost, nan=WORST), WORST), lost


class ElasticArmEnv(gymnasium.Env[Array, Array]):
    """An elastic arm that shall follow the reference of a scenario."""

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scenario: Scenario | str,
        *,
        residual: float | None = None,
        frame_skip: int = 5,
        episode: int = 200,
        start: float = 0.05,
        scale: float = 0.05,
        effort: float = 0.01,
        render_mode: str | None = None,
    ) -> None:
        """`residual`: actions are that part of the largest torque and are added to the law's; `frame_skip`: control periods that an action is
        held; `episode`: steps; `start`: largest error of a link at the start, rad; `scale`: an error that costs 1, rad; `effort`: what
        the largest torque costs."""
        self.arms = _Arms(
            scenario, residual=residual, frame_skip=frame_skip, episode=episode, start=start, scale=scale, effort=effort
        )
        self.observation_space, self.action_space = self.arms.observation, self.arms.action
        self.render_mode = render_mode

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        super().reset(seed=seed)
        self._x, self._instants = self.arms.begin([self.np_random])
        self._steps = 0
        return self.arms.observe(self._x, self._instants)[0], {}

    def step(self, action: Array) -> tuple[Array, SupportsFloat, bool, bool, dict[str, Any]]:
        self._x, observed, reward, lost = self.arms.step(self._x, self._instants, np.asarray(action)[None])
        self._instants = self._instants + self.arms.frame_skip
        self._steps += 1
        cost = WORST * (self.arms.episode - self._steps) * bool(lost[0])
        truncated = not lost[0] and self._steps >= self.arms.episode
        return observed[0], float(reward[0]) - cost, bool(lost[0]), truncated, {}


class ElasticArmVectorEnv(gymnasium.vector.VectorEnv[Array, Array, NDArray[Any]]):
    """The same many times, moved in one call on all cores; an arm whose episode has ended begins again at the next step.

    `reset(seed=s)` seeds arm i with s + i, `reset(seed=[...])` each with its own: arm i does what `ElasticArmEnv` does with that seed.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        scenario: Scenario | str,
        num_envs: int,
        *,
        residual: float | None = None,
        frame_skip: int = 5,
        episode: int = 200,
        start: float = 0.05,
        scale: float = 0.05,
        effort: float = 0.01,
    ) -> None:
        """As `ElasticArmEnv`."""
        self.arms = _Arms(
            scenario, residual=residual, frame_skip=frame_skip, episode=episode, start=start, scale=scale, effort=effort
        )
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = self.arms.observation, self.arms.action
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._rngs: list[np.random.Generator] = []

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        seeds = [None] * self.num_envs if seed is None else seed if isinstance(seed, list) else [seed + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed has {len(seeds)} entries: one for each of {self.num_envs} environments")
        super().reset(seed=seeds[0])
        before: Sequence[np.random.Generator | None] = self._rngs or [None] * self.num_envs
        self._rngs = [np_random(seed)[0] if rng is None or seed is not None else rng for rng, seed in zip(before, seeds, strict=True)]
        self._x, self._instants = self.arms.begin(self._rngs)
        self._steps = np.zeros(self.num_envs, np.int64)
        self._ended = np.zeros(self.num_envs, np.bool_)
        return self.arms.observe(self._x, self._instants), {}

    def step(
        self, actions: Array
    ) -> tuple[Array, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        again = self._ended
        x, observed, reward, lost = self.arms.step(self._x, self._instants, np.asarray(actions))
        self._x, self._instants, self._steps = x, self._instants + self.arms.frame_skip, self._steps + 1
        if again.any():
            self._x[again], self._instants[again] = self.arms.begin([self._rngs[i] for i in np.flatnonzero(again)])
            self._steps[again], reward[again], lost[again] = 0, 0.0, False
            observed[again] = self.arms.observe(self._x[again], self._instants[again])
        reward -= np.where(lost, WORST * (self.arms.episode - self._steps), 0.0)
        truncated = ~lost & (self._steps >= self.arms.episode)
        self._ended = lost | truncated
        return observed, reward, lost, truncated, {}


for _name, _scenario in (("TwoLink", "two-link-hardware"), ("Planar2R", "planar-2r-tanh"), ("Panda", "panda-tanh-smooth")):
    gymnasium.register(f"flexure/{_name}-v0", entry_point="flexure.gym:ElasticArmEnv", kwargs={"scenario": _scenario})
    gymnasium.register(
        f"flexure/{_name}Residual-v0",
        entry_point="flexure.gym:ElasticArmEnv",
        kwargs={"scenario": _scenario, "residual": 0.2},
    )
