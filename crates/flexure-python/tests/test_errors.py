"""What is refused, how it is said, and that nothing ends the interpreter."""

import json
import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest

from conftest import SCENARIO


class TestErrors:
    def test_text_hint_and_place(self, tmp_path: Path) -> None:
        file = tmp_path / "bad.toml"
        file.write_text('robot = "pendulum-1dof"\nduration = -1.0\ncontrol_perod = 0.001\n')
        with pytest.raises(flexure.FlexureError) as caught:
            flexure.Scenario(file)
        assert f"{file}:3:1: unknown key 'control_perod'" in str(caught.value)
        assert "did you mean 'control_period'?" in str(caught.value)
        first = next(problem for problem in caught.value.problems if problem["line"] == 3)
        assert (first["code"], first["column"], first["file"]) == ("unknown-key", 1, str(file))

    @pytest.mark.parametrize(
        "job",
        [
            lambda: flexure.Scenario("nowhere.toml"),
            lambda: flexure.Robot("nobody"),
            lambda: flexure.Scenario("two-link-tanh", set={"nonsense": 1}),
            lambda: flexure.Scenario("two-link-tanh", set=["="]),
            lambda: flexure.certify(SCENARIO, error_box=-1.0),
            lambda: flexure.certify(SCENARIO, error_box=[0.1, 0.1, 0.1]),
            lambda: flexure.certify(SCENARIO, rate=float("nan")),
            lambda: flexure.verify("{}"),
            lambda: flexure.verify("missing.json"),
            lambda: flexure.tune(SCENARIO, budget=0),
            lambda: flexure.tune(SCENARIO, spec="missing.toml"),
            lambda: flexure.compare([SCENARIO], controllers=["nothing"]),
            lambda: flexure.compare(seeds=0),
            lambda: flexure.identify("panda", []),
            lambda: flexure.identify("panda", "missing.csv"),
        ],
    )
    def test_refusals(self, job: object) -> None:
        with pytest.raises(flexure.FlexureError):
            job()

    def test_a_forged_certificate(self) -> None:
        text = flexure.certify(SCENARIO, strongest=False)["certificate"]
        report = flexure.verify(text, against=SCENARIO)
        assert report["same"] and report["differences"] == []
        assert not flexure.verify(text, against="two-link-tanh")["same"]
        document = json.loads(text)
        document["contraction_rate"] = "1000.0"
        with pytest.raises(flexure.FlexureError, match="does not hold|no certificate"):
            flexure.verify(json.dumps(document))

    def test_a_forged_tube(self, tmp_path: Path) -> None:
        scenario = flexure.Scenario("two-link-tanh-smooth", set={"duration": 0.01})
        with pytest.raises(TypeError, match="not both"):
            flexure.certify(scenario, sampled_tube=1e-5, strongest=True)
        assert flexure.certify(scenario, strongest=False)["step"] == "ideal"
        assert flexure.certify(scenario, out=tmp_path / "arm.json")["step"] == "sampled"
        file = tmp_path / "arm.tube.json"
        found = flexure.verify(file, against=scenario)
        assert found["same"] and found["periods"] == 10 and found["rate"] > 10.0
        assert flexure.verify(file, against="two-link-tanh-smooth")["differences"][0]["place"] == "periods"
        with pytest.raises(TypeError, match="against"):
            flexure.verify(file)
        document = json.loads(file.read_text())
        document["claims"]["rate"] = "100"
        file.write_text(json.dumps(document))
        with pytest.raises(flexure.FlexureError, match="rate does not hold"):
            flexure.verify(file, against=scenario)

    def test_a_forged_funnel(self, tmp_path: Path) -> None:
        scenario = flexure.Scenario("two-link-hardware", set={"duration": 0.2})
        found = flexure.certify(scenario, link_disturbance=0.01, out=tmp_path / "arm.json")["funnel"]
        file = tmp_path / "arm.funnel.json"
        again = flexure.verify(file, against=scenario)
        assert again["same"] and again["error"] == found["error"] and again["rate"] == found["rate"]
        assert flexure.verify(file, against="two-link-hardware")["differences"][0]["place"] == "duration"
        with pytest.raises(TypeError, match="a funnel is checked by following a loop"):
            flexure.verify(file)
        document = json.loads(file.read_text())
        document["claims"]["error"][0] = "1e-9"
        file.write_text(json.dumps(document))
        with pytest.raises(flexure.FlexureError, match=r"error\[0\] does not hold"):
            flexure.verify(file, against=scenario)

    def test_files_that_are_gone(self, tmp_path: Path) -> None:
        file = tmp_path / "s.toml"
        text = 'robot = "pendulum-1dof"\nduration = 1.0\ncontrol_period = 0.001\n[reference]\nkind = "sine"\namplitude = [0.5]\nfrequency = [1.0]\n[controller]\nkind = "vcbc"\n'
        file.write_text(text)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            kept = pickle.dumps(flexure.Scenario(file, set={"duration": 2.0}))
            assert pickle.loads(kept).duration == 2.0
            # It goes with what its files said.
            file.unlink()
            assert pickle.loads(kept).duration == 2.0

    def test_a_full_folder_of_nothing(self, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("mine")
        with pytest.raises(OSError, match="cannot"):
            flexure.certify(SCENARIO, out=tmp_path / "file" / "c.json")
        with pytest.raises(flexure.FlexureError, match="left as it is"):
            flexure.certify(SCENARIO, out=tmp_path / "file")
        assert (tmp_path / "file").read_text() == "mine"

    @pytest.mark.parametrize("deep", [1000, 100_000])
    def test_values_without_an_end(self, deep: int) -> None:
        value: Any = 1
        for _ in range(deep):
            value = [value]
        endless: list = []
        endless.append(endless)
        for bad in (value, endless, {"a": endless}):
            with pytest.raises(ValueError, match="inside of more than"):
                flexure.Scenario(SCENARIO, set={"controller": bad})

    @pytest.mark.parametrize("bad", [None, 1j, object(), {1, 2}, {1: 2}])
    def test_values_that_are_none_of_a_scenario(self, bad: object) -> None:
        with pytest.raises(TypeError, match="^set: "):
            flexure.Scenario(SCENARIO, set={"duration": bad})
        with pytest.raises(TypeError):
            flexure.Scenario(SCENARIO, set=[bad])

    def test_values_of_numpy_and_paths(self) -> None:
        changed = {
            "duration": np.float32(2.5),
            "controller.link.damping": np.array([10, 5]),
            "seed": np.int64(3),
            "robot": Path("quanser-2dof"),
            "plant.rotor_coupling": np.bool_(False),
        }
        scenario = flexure.Scenario(SCENARIO, set=changed)
        assert (scenario.duration, scenario.seed) == (2.5, 3)
        assert scenario != flexure.Scenario(SCENARIO) == flexure.Scenario(SCENARIO)
        assert len({flexure.Scenario(SCENARIO), flexure.Scenario(SCENARIO)}) == 1
        assert flexure.Scenario(SCENARIO, set="duration=2").duration == 2.0

    def test_every_error_has_its_parts(self) -> None:
        for job in (lambda: flexure.verify("{}"), lambda: flexure.verify({"certificate": None}), lambda: flexure.Robot("nobody")):
            with pytest.raises(flexure.FlexureError) as caught:
                job()
            assert all(problem["code"] and problem["message"] for problem in caught.value.problems)

    def test_what_speaks_against_a_loop_is_told(self) -> None:
        """Its errors are small, and yet `flexure run` says no: unstable as sampled; a reference that takes more than a limit."""
        short = flexure.Scenario(SCENARIO, set={"control_period": 0.0013, "duration": 0.195})
        with pytest.warns(flexure.FlexureWarning, match="unstable"):
            run = flexure.simulate(short)
        assert run.follows and not run.ok and not run.sampled["stable"]
        fast = flexure.Scenario("two-link-hardware", set={"reference.frequency": [0.82, 0.82], "accept": {"at_limit": 0.5}})
        with pytest.warns(flexure.FlexureWarning, match="torque"):
            run = flexure.simulate(fast)
        assert not run.ok and run.objections[0]["code"]

    def test_memory_that_is_out(self) -> None:
        code = (
            "import resource, numpy as np, flexure\n"
            "robot, q = flexure.Robot('panda'), np.zeros((2 * 10**7, 7))\n"
            "resource.setrlimit(resource.RLIMIT_AS, (6 * 2**30,) * 2)\n"
            "try: robot.mass_matrix(q)\n"
            "except MemoryError as error: print('caught', error)"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout.startswith("caught")
