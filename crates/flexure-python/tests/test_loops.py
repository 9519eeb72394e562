"""Loops in the hand, laws written in Python."""

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest


class TestLoops:
    def test_steps_are_the_run(self, scenario: flexure.Scenario, run: flexure.Run) -> None:
        held = scenario.open()
        assert held.signals == list(run.trace) and np.isnan(held.read()["t"])
        held.step(251)
        read = held.read()
        for name, column in run.trace.items():
            assert read[name] == column[250] or np.isnan(column[250]), name
        np.testing.assert_array_equal(held.x, run.trace.x[250])
        np.testing.assert_array_equal(held.u_m, run.trace.joints("u_m")[250])
        assert held.t == run.trace["t"][250]

    def test_back_in_time_and_pickled(self) -> None:
        held = flexure.Scenario("two-link-hardware").open()
        held.step(40)
        saved, copy = held.state(), pickle.loads(pickle.dumps(held))
        held.step(60)
        copy.step(60)
        np.testing.assert_array_equal(held.state(), copy.state())
        held.restore(saved)
        held.step(60)
        np.testing.assert_array_equal(held.state(), copy.state())
        held.reset(7)
        assert held.t == 0.0

    def test_divergence(self) -> None:
        scenario = flexure.Scenario("two-link-tanh", set={"control_period": 0.05})
        with pytest.raises(flexure.FlexureError):
            scenario.open().step(1000)
        with pytest.warns(flexure.FlexureWarning):
            run = flexure.simulate(scenario)
        assert not run.follows and not run.ok and run.diverged_at is not None and run.divergence


    def test_copies_and_pickles_of_parts(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        (tmp_path / "s.toml").write_text(
            'robot = "pendulum-1dof"\nduration = 1.0\ncontrol_period = 0.001\n[reference]\nkind = "sine"\namplitude = [0.5]\n'
            'frequency = [1.0]\n[controller]\nkind = "vcbc"\n'
        )
        monkeypatch.chdir(tmp_path)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", flexure.FlexureWarning)
            scenario = flexure.Scenario("s.toml")
            (tmp_path / "there").mkdir()
            monkeypatch.chdir(tmp_path / "there")
            for what in (scenario, scenario.robot, flexure.Robot("panda"), scenario.controller(), flexure.Plant(scenario)):
                again = pickle.loads(pickle.dumps(what))
                assert repr(again) == repr(what)
            assert copy.copy(scenario) is scenario and copy.deepcopy(scenario) is scenario
            assert pickle.loads(pickle.dumps(scenario)) == scenario

    def test_states_that_are_none(self, scenario: flexure.Scenario) -> None:
        held = scenario.open()
        for bad in ([[1.0]], 1.0, held.state()[None], held.state()[:-1]):
            with pytest.raises(ValueError):
                held.restore(bad)


class TestOwnLaws:
    def test_a_law_in_python_is_the_one_in_rust(self) -> None:
        """With every device on: what the law sees goes out to Python and its torque comes back, bit for bit."""
        scenario = flexure.Scenario("two-link-hardware", set={"duration": 1.0})
        law = scenario.controller()
        ours = flexure.simulate(scenario, law=lambda t, x, reference: law.torque(x, t))
        theirs = flexure.simulate(scenario)
        assert (ours.summary["controller"], ours.summary["phi"]) == ("own", None)
        for name in ours.trace:
            np.testing.assert_array_equal(ours.trace[name], theirs.trace[name], err_msg=name)
        held = scenario.open(law=lambda t, x, reference: law.torque(x, t))
        held.step(100)
        np.testing.assert_array_equal(held.x, ours.trace.x[99])

    def test_the_reference_is_the_scenario_s(self) -> None:
        scenario = flexure.Scenario("planar-2r-tanh", set={"duration": 0.01, "hold": "zero-order"})
        seen = []

        def law(t: float, x: np.ndarray, reference: np.ndarray) -> list[float]:
            seen.append((t, x, reference))
            return [0.0, 0.0]

        run = flexure.simulate(scenario, law=law)
        assert len(seen) == len(run.trace["t"])
        for k, (t, x, reference) in enumerate(seen):
            assert t == run.trace["t"][k] and x.shape == (8,)
            np.testing.assert_array_equal(reference, scenario.controller().reference(t))
            np.testing.assert_array_equal(x, run.trace.x[k])

    @pytest.mark.parametrize(
        ("law", "error", "words"),
        [
            (lambda t, x, reference: 1 / 0, ZeroDivisionError, "division"),
            (lambda t, x, reference: [1.0], ValueError, r"the law's torque: shape \(1,\)"),
            (lambda t, x, reference: np.zeros((1, 2)), ValueError, r"shape \(1, 2\); expected \(2,\)"),
            (lambda t, x, reference: "much", TypeError, "numbers of type"),
            (lambda: None, TypeError, "positional argument"),
            (7, TypeError, "not callable"),
        ],
    )
    def test_what_it_raises_comes_out(self, law: Any, error: type[Exception], words: str) -> None:
        scenario = flexure.Scenario("planar-2r-tanh", set={"duration": 0.01})
        with pytest.raises(error, match=words):
            flexure.simulate(scenario, law=law)
        held = scenario.open(law=law)
        with pytest.raises(error, match=words):
            held.step()

    def test_it_is_not_pickled(self, scenario: flexure.Scenario) -> None:
        with pytest.raises(TypeError, match="law in Python"):
            pickle.dumps(scenario.open(law=lambda t, x, reference: [0.0, 0.0]))

    def test_it_must_not_use_the_loop_that_asks_it(self) -> None:
        """It would wait for itself for ever; another loop is free to use."""
        scenario = flexure.Scenario("planar-2r-tanh")
        other = scenario.open()
        held = scenario.open(law=lambda t, x, reference: held.u_m)
        with pytest.raises(RuntimeError, match="a law uses the loop that asks it"):
            held.step()
        free = scenario.open(law=lambda t, x, reference: other.u_m)
        free.step(3)
        assert held.joints == 2
