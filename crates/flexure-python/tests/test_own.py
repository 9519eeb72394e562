"""Shaping functions and references of one's own: the registered ones written once more are the registered ones."""

import pickle
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest
from numpy.typing import NDArray

SCENARIO = "two-link-hardware"


class TestShaping:
    def test_a_registered_one_written_once_more(self) -> None:
        for phi, function in (("tanh", np.tanh), ("linear", lambda e: e)):
            scenario = flexure.Scenario(SCENARIO, set={"controller.phi": phi, "duration": 3.0})
            shaping = flexure.Shaping(function)
            assert shaping.error < 1e-6
            theirs, ours = flexure.simulate(scenario), flexure.simulate(scenario, shaping=shaping)
            assert ours.summary["phi"] == "own" and ours.sampled is None
            assert np.abs(theirs.trace["q_l1"] - ours.trace["q_l1"]).max() < 1e-7
            law = scenario.controller()
            held = scenario.open(shaping=shaping)
            held.step()
            assert np.allclose(held.u_m, law.torque(scenario.initial, 0.0), rtol=1e-4, atol=1e-4) or phi == "linear"

    def test_it_matters_and_is_kept(self) -> None:
        scenario = flexure.Scenario(SCENARIO, set={"duration": 1.0})
        slow = flexure.Shaping(lambda e: 0.5 * e)
        held = scenario.open(shaping=slow)
        held.step(200)
        again = pickle.loads(pickle.dumps(held))
        held.step(50)
        again.step(50)
        assert np.array_equal(held.x, again.x)
        other = scenario.open()
        other.step(250)
        assert not np.array_equal(held.x, other.x)

    def test_the_error_is_told(self) -> None:
        kink = flexure.Shaping(lambda e: np.clip(e, -0.3, 0.3))
        assert 1e-3 < kink.error < 0.1
        assert "off by" in repr(kink)

    def test_what_is_wrong(self) -> None:
        shape: Any = flexure.Shaping
        for function, message in (
            (lambda e: e**2, "is odd"),
            (lambda e: e[:2], "shape .2,.; expected"),
            (lambda e: np.log(e), "no finite number at|is odd"),
            (lambda e: -e, "pulls back"),
        ):
            with pytest.raises(ValueError, match=message), np.errstate(all="ignore"):
                shape(function)
        with pytest.raises(ValueError, match="reach: -1"):
            shape(np.tanh, reach=-1)
        with pytest.raises(TypeError, match="law and shaping"):
            flexure.Scenario(SCENARIO).open(law=lambda t, x, r: x[:2], shaping=shape(np.tanh))
        with pytest.raises(flexure.FlexureError, match="certificates are for 'vcbc'"):
            flexure.Scenario(SCENARIO, set={"controller": {"kind": "pd"}}).open(shaping=shape(np.tanh))


class TestPaths:
    def test_a_registered_one_written_once_more(self) -> None:
        sine = {"kind": "sine", "amplitude": [0.3, 0.2], "frequency": [2.0, 3.0], "phase": [0.1, 0.2]}
        theirs = flexure.Scenario(SCENARIO, set={"reference": sine, "duration": 2.0, "initial": {"q_l": [0.03, 0.04], "q_m": [0.03, 0.04]}})
        ours = flexure.follow(theirs, lambda t: [0.3 * np.sin(2 * t + 0.1), 0.2 * np.sin(3 * t + 0.2)])
        t = np.linspace(0.0, 2.0, 301)
        expected, found = theirs.controller().reference(t), ours.controller().reference(t)
        # O(h^8) in position; the fourth derivative suffers h^4 and the rounding of the samples, some 1e-14 / h^4.
        for derivative, tolerance in enumerate((1e-13, 1e-11, 1e-9, 1e-7, 1e-4)):
            assert np.abs(found[:, derivative] - expected[:, derivative]).max() < tolerance, derivative

    def test_it_is_a_scenario_like_others(self, tmp_path: Path) -> None:
        def path(t: float) -> NDArray[np.float64]:
            return np.array([0.3 * np.sin(t), 0.2 * np.sin(2 * t)])

        scenario = flexure.follow(SCENARIO, path, smooth_start=1.0)
        run = flexure.simulate(scenario)
        assert run.follows
        assert flexure.certify(scenario, strongest=False)["verdict"].startswith("proved")
        again = pickle.loads(pickle.dumps(scenario))
        assert again == scenario and again != flexure.follow(SCENARIO, path)

    def test_what_is_wrong(self) -> None:
        with pytest.raises(ValueError, match=r"the path at -0.6 s: shape \(3,\); expected \(2,\)"):
            flexure.follow(SCENARIO, lambda t: [0.0, 0.0, 0.0])
        with pytest.raises(ValueError, match="period: 0"):
            flexure.follow(SCENARIO, lambda t: [0.0, 0.0], period=0.0)
        with pytest.raises(flexure.FlexureError, match="q1 is nan rad, must be a number"):
            flexure.follow(SCENARIO, lambda t: [np.nan if t > 1 else 0.0, 0.0])


class TestDrafts:
    def test_a_urdf_becomes_a_robot(self, tmp_path: Path) -> None:
        urdf = Path(__file__).parents[3] / "robots" / "panda.urdf"
        with pytest.warns(flexure.FlexureWarning, match="still"):
            draft = flexure.import_urdf(urdf)
        assert draft["files"] == [] and draft["scenario"] is None and len(draft["joints"]) == 7 and draft["missing"]
        made = flexure.import_urdf(urdf, assume="harmonic-drive", scenario=True, out=tmp_path)
        assert [Path(file).name for file in made["files"]][:2] == ["panda.toml", "panda-scenario.toml"]
        scenario = flexure.Scenario(made["files"][1])
        assert scenario.gains["motor.metric"].shape == (7,)
        with pytest.raises(OSError, match="exists"):
            flexure.import_urdf(urdf, assume="harmonic-drive", scenario=True, out=tmp_path)
        with pytest.raises(flexure.FlexureError, match="harmonic"):
            flexure.import_urdf(urdf, assume="harmonic")

    def test_the_list(self, command: Any) -> None:
        assert flexure.registered() == command("list")

    def test_the_paper(self, tmp_path: Path) -> None:
        found = flexure.reproduce(tmp_path)
        assert len(found["scenarios"]) == 8 and len(found["practical"]) == 2 and (tmp_path / "report.html").stat().st_size > 100_000
