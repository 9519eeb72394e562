"""The same answers as the command line, to the bit, and pages whose programs run."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest

from conftest import SCENARIO

Command = Callable[..., Any]


def timeless(document: dict) -> dict:
    left_out = ("wall_seconds", "files", "file", "funnel_file", "certificate")
    return {key: value for key, value in document.items() if key not in left_out}


class TestSameAsTheCommandLine:
    def test_run(self, run: flexure.Run, tmp_path: Path, command: Command) -> None:
        answer = command("run", SCENARIO, "--out", str(tmp_path))
        ours = timeless(run.summary)
        # The command certifies as well.
        assert ours.pop("rate_certified") is None and len(ours) > 15
        assert ours == {key: answer[key] for key in ours}
        with open(tmp_path / f"{SCENARIO}.csv") as file:
            names = file.readline().strip().split(",")
        rows = np.loadtxt(tmp_path / f"{SCENARIO}.csv", delimiter=",", skiprows=1)
        assert names == list(run.trace)
        for column, name in zip(rows.T, names, strict=True):
            np.testing.assert_array_equal(column, run.trace[name], err_msg=name)

    def test_proof(self, tmp_path: Path, command: Command) -> None:
        options = ("--error-box", "0.5", "--disturbance", "0.05")
        answer = command("certify", SCENARIO, *options, "--out", str(tmp_path / "c.json"))
        found = flexure.certify(SCENARIO, error_box=0.5, disturbance=[0.05, 0.05], out=tmp_path / "p.json")
        assert timeless(found) == timeless(answer)
        for kind in ("json", "funnel.json"):
            assert (tmp_path / f"c.{kind}").read_text() == (tmp_path / f"p.{kind}").read_text()

    def test_check(self, command: Command) -> None:
        for name in (SCENARIO, "two-link-hardware", "panda"):
            answer = timeless(command("check", name)[0])
            assert timeless(flexure.check(name)) == answer
        scenario = flexure.Scenario("two-link-tanh", set={"control_period": 0.01})
        found = flexure.check(scenario)
        assert not found["ok"] and found["errors"] and not found["sampled"]["stable"]
        assert flexure.check(scenario.robot)["kind"] == "robot"

    def test_margins(self, command: Command) -> None:
        name = "two-link-hardware"
        short = flexure.Scenario(name, set={"duration": 5.0})
        assert timeless(flexure.margins(short)) == timeless(command("margins", name, "--set", "duration=5.0")["loops"][0])

    def test_states(self, scenario: flexure.Scenario, command: Command) -> None:
        rng = np.random.default_rng(1)
        x = rng.uniform(-0.3, 0.3, (4, 8))
        law = scenario.controller()
        for row in x:
            parts = {key: part.tolist() for key, part in flexure.views(row)._asdict().items()}
            text = json.dumps({"t": 0.5, **parts})
            done = subprocess.run(
                [os.environ["FLEXURE"], "eval", SCENARIO, "--states", "-"], input=text, capture_output=True, text=True, check=True
            )
            answer = json.loads(done.stdout)
            assert law.torque(row, 0.5).tolist() == answer["u_m"]
            assert law.command(row, 0.5)["u_m"].tolist() == answer["u_m"]


    def test_the_road_from_a_motion_to_numbers(self, tmp_path: Path, command: Command) -> None:
        out = tmp_path / "excite.toml"
        motion = flexure.excite("planar-2r", out, budget=5, duration=8.0)
        assert motion["toml"] == out.read_text() and motion["objections"] == []
        assert command("run", str(out), "--out", str(tmp_path))["follows"]
        log = tmp_path / "excite.csv"
        found = flexure.identify("planar-2r", log)
        assert timeless({**found, "toml": None}) == timeless({**command("identify", "planar-2r", "--log", str(log)), "toml": None})
        assert "identified: " in found["toml"]
        laid = flexure.replay(out, log)
        answer = command("replay", str(out), "--log", str(log), "--out", str(tmp_path / "replay"))
        assert laid["joints"] == answer["joints"] and len(laid["trace"]["t"]) > 1000

    def test_usage(self, scenario: flexure.Scenario, command: Command) -> None:
        (answer,) = command("check", SCENARIO)
        assert scenario.usage() == answer["reference"]["usage"]
        assert scenario.sampled() == answer["sampled"]
        assert flexure.Robot("panda").table() == command("check", "panda")[0]["robot"]


class TestPages:
    @pytest.mark.parametrize("page", ["docs/python.md", "docs/sweeps.md", "README.md"])
    def test_what_is_shown_runs(self, page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        text = (Path(__file__).parents[3] / page).read_text()
        blocks = [block.split("```")[0] for block in text.split("```python\n")[1:]]
        blocks = [block for block in blocks if "pandas.read_csv" not in block]
        assert blocks
        monkeypatch.chdir(tmp_path)
        if "```toml" in text and page == "docs/sweeps.md":
            # Fewer and shorter runs.
            sweep = text.split("```toml\n")[1].split("```")[0]
            Path("soft.toml").write_text(sweep.replace("points = 1024", "points = 8").replace("duration = 4.0", "duration = 0.2"))
            blocks = [block.replace("817", "3") for block in blocks]
        names: dict = {}
        for block in blocks:
            exec(block, names)
