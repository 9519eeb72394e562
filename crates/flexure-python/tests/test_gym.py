"""The environments: by Gymnasium's own checker, many at once as one by one, and what they reward."""

import pickle
import warnings

import gymnasium
import numpy as np
import pytest

import flexure

with warnings.catch_warnings():
    # Gymnasium's own.
    warnings.simplefilter("ignore", DeprecationWarning)
    import flexure.gym
    from gymnasium.utils.env_checker import check_env

NAMES = [name for name in gymnasium.registry if name.startswith("flexure/")]


@pytest.mark.parametrize("name", NAMES)
def test_the_checker_has_nothing_to_say(name: str) -> None:
    env = gymnasium.make(name)
    assert len(NAMES) == 6
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        check_env(env.unwrapped)


def test_many_are_as_one() -> None:
    one = flexure.gym.ElasticArmEnv("planar-2r-tanh", episode=30)
    many = flexure.gym.ElasticArmVectorEnv("planar-2r-tanh", 1, episode=30)
    first, _ = one.reset(seed=3)
    firsts, _ = many.reset(seed=3)
    np.testing.assert_array_equal(first, firsts[0])
    rng = np.random.default_rng(0)
    for k in range(30):
        action = rng.uniform(-0.2, 0.2, 2)
        single, several = one.step(action), many.step(action[None])
        for ours, theirs in zip(single[:4], several[:4], strict=True):
            np.testing.assert_array_equal(ours, theirs[0])
        assert single[3] == (k == 29)
    # The next step of the vector begins again.
    _, reward, lost, truncated, _ = many.step(np.zeros((1, 2)))
    assert reward[0] == 0.0 and not lost[0] and not truncated[0]


def test_each_of_many_has_its_seed() -> None:
    """Gymnasium's convention: one seed s is s + i for the i-th, a list is one each; an arm that begins again goes on with its own."""
    many = flexure.gym.ElasticArmVectorEnv("planar-2r-tanh", 3, episode=4)
    for seed, each in ((7, (7, 8, 9)), ([5, 2, 5], (5, 2, 5))):
        firsts, _ = many.reset(seed=seed)
        ones = [flexure.gym.ElasticArmEnv("planar-2r-tanh", episode=4) for _ in each]
        for i, (one, its) in enumerate(zip(ones, each, strict=True)):
            np.testing.assert_array_equal(one.reset(seed=its)[0], firsts[i])
        for _ in range(4):
            many.step(np.zeros((3, 2)))
        again = many.step(np.zeros((3, 2)))[0]
        for i, one in enumerate(ones):
            np.testing.assert_array_equal(one.reset()[0], again[i])
    with pytest.raises(ValueError, match="one for each of 3"):
        many.reset(seed=[1])


def test_the_law_is_rewarded_and_nothing_is_not() -> None:
    law = flexure.gym.ElasticArmVectorEnv("planar-2r-tanh", 16, residual=0.1)
    still = flexure.gym.ElasticArmVectorEnv("planar-2r-tanh", 16)
    returns = []
    for envs in (law, still):
        envs.reset(seed=1)
        total = np.zeros(16)
        for _ in range(100):
            total += envs.step(np.zeros((16, 2)))[1]
        returns.append(total)
    assert (returns[0] > -50).all() and returns[1].max() < returns[0].min()


def test_steps_are_those_of_the_plant() -> None:
    """Against the loop: the law's torque on the plant, period by period, is the ideal sampled loop."""
    # A plant begins each call anew, a loop begins each step with the last one's polynomials: the same motion to the tolerance.
    scenario = flexure.Scenario("planar-2r-tanh", set={"hold": "zero-order", "integration_tolerance": 1e-12})
    plant, law, held = flexure.Plant(scenario), scenario.controller(), scenario.open()
    held.step()
    x = held.x
    for k in range(200):
        x = plant.roll(x, law.torque(x, k * plant.period)[None], first=k)[-1]
        held.step()
    np.testing.assert_allclose(x, held.x, rtol=0, atol=1e-11)


def test_a_batch_rolls_as_its_rows() -> None:
    plant = pickle.loads(pickle.dumps(flexure.Plant(flexure.Scenario("two-link-hardware"))))
    rng = np.random.default_rng(5)
    x, u_m = rng.uniform(-0.1, 0.1, (3, 2, 8)), rng.uniform(-1, 1, (3, 2, 7, 2))
    whole = plant.roll(x, u_m)
    assert whole.shape == (3, 2, 7, 8)
    for i in np.ndindex(3, 2):
        np.testing.assert_array_equal(whole[i], plant.roll(x[i], u_m[i]))
    assert plant.roll(np.zeros((0, 8)), np.zeros((0, 4, 2))).shape == (0, 4, 8)


def test_pushes_go_by_the_clock() -> None:
    push = {"imperfection.push": {"kind": "push", "torque": 1.0, "from": 0.1, "duration": 0.1}}
    plant = flexure.Plant(flexure.Scenario("planar-2r-tanh", set=push))
    x, u_m = np.zeros((3, 8)), np.zeros((3, 5, 2))
    before, during, after = plant.roll(x, u_m, first=np.array([0, 150, 300]))
    np.testing.assert_array_equal(before, after)
    assert not np.array_equal(before, during)


def test_bad_torques() -> None:
    plant = flexure.Plant(flexure.Scenario("two-link-hardware"))
    for bad in (np.zeros(2), np.zeros((3, 4, 2)), np.zeros((4, 3))):
        with pytest.raises(ValueError, match="u_m"):
            plant.roll(np.zeros(8), bad)
    for period in (0.0, -1.0, float("nan"), 2.0):
        with pytest.raises(ValueError, match="period is"):
            plant.roll(np.zeros(8), np.zeros((1, 2)), period=period)
    for first in (-1, 0.5, [1, 2], float("inf")):
        with pytest.raises(ValueError, match="first"):
            plant.roll(np.zeros(8), np.zeros((1, 2)), first=first)
    with pytest.raises(ValueError, match="residual is"):
        flexure.gym.ElasticArmEnv("two-link-hardware", residual=2.0)
    with pytest.raises(ValueError, match="frame_skip"):
        flexure.gym.ElasticArmEnv("two-link-hardware", frame_skip=0)
