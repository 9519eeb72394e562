"""Sweeps: the same rows whatever computes them, read by others, on storage elsewhere, and by Ray."""

import hashlib
import os
import pickle
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest

SWEEP = """
scenario = "pendulum-tanh"
design = "uniform"
points = 24
shard = 5
metrics = ["rms_e_l", "diverged_at"]
set.duration = 0.05
[parameters]
"robot.joints.stiffness" = { from = 0.5, to = 2.0, relative = true }
"controller.phi" = { values = ["tanh", "linear"] }
"""

GRID = """
scenario = "pendulum-tanh"
seeds = 2
set.duration = 0.05
[parameters]
"robot.joints.stiffness" = { from = 0.5, to = 2.0, scale = "log", relative = true, points = 4 }
"imperfection.noise.motor" = { from = 0.0, to = 1e-4, points = 3 }
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "soft.toml"
    path.write_text(SWEEP)
    return path


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def bits(purpose: str, index: int, column: int) -> int:
    """As docs/sweeps.md has them, computed by another program."""
    hashed = hashlib.sha256(purpose.encode() + b"\0" + struct.pack("<3Q", 0, index, column)).digest()
    return int(struct.unpack("<Q", hashed[:8])[0])


class TestRows:
    def test_designs_are_what_the_page_says(self, file: Path) -> None:
        sweep = flexure.Sweep(file)
        for row in (0, 7, 23):
            found = sweep.row(row)
            part = [(bits("uniform", row, column) >> 11) / 2**53 for column in range(2)]
            # Keys in alphabetical order.
            assert found["controller.phi"] == ["tanh", "linear"][int(2 * part[0])]
            assert found["robot.joints.stiffness"] == pytest.approx(0.5 + 1.5 * part[1], rel=1e-15)
            assert found["seed"] == bits("seed", row, 0) >> 11

    def test_the_command_writes_the_same_bytes(self, file: Path, tmp_path: Path, command: Callable[..., Any]) -> None:
        told = command("sweep", str(file), "--out", str(tmp_path / "a"))
        rows = flexure.sweep(file, tmp_path / "b", shards=range(3, 5), threads=1)
        assert not rows.complete
        rows = flexure.sweep(file, tmp_path / "b")
        assert rows.complete
        assert content(tmp_path / "a") == content(tmp_path / "b")
        assert {key: told[key] for key in ("metrics", "statuses", "rows_there")} == rows.summary()

    def test_rows_are_runs(self, file: Path, tmp_path: Path) -> None:
        rows = flexure.sweep(file, tmp_path / "a")
        columns = rows.columns()
        assert list(columns) == rows.sweep.columns
        assert columns["row"].tolist() == list(range(24))
        assert np.isnan(columns["diverged_at"]).all()
        run = rows.replay(13)
        # Rows run side by side: sines and tanh in lanes have other last digits than those of a loop alone.
        assert run.summary["rms_e_l"] == pytest.approx(columns["rms_e_l"][13], rel=1e-8)
        assert columns["rms_e_l"][13] == rows.sweep.row(13)["rms_e_l"]
        assert run.scenario.robot.stiffness == columns["robot.joints.stiffness"][13] * flexure.Robot("pendulum-1dof").stiffness
        assert rows.to_pandas()["status"].isin(["follows", "strays"]).all()

    def test_others_read_them(self, file: Path, tmp_path: Path) -> None:
        parquet = pytest.importorskip("pyarrow.parquet")
        rows = flexure.sweep(file, tmp_path / "a")
        table = parquet.read_table([tmp_path / "a" / name for name in rows.parts])
        for name, column in rows.columns().items():
            theirs = table[name].to_numpy()
            assert np.array_equal(np.asarray(theirs, dtype=column.dtype), column, equal_nan=column.dtype.kind == "f"), name

    def test_a_sweep_goes_anywhere(self, file: Path, tmp_path: Path) -> None:
        sweep = flexure.Sweep(file)
        again = pickle.loads(pickle.dumps(sweep))
        file.unlink()
        assert again == sweep and again.shard(2) == sweep.shard(2, threads=2)
        row = pickle.loads(pickle.dumps(again.scenario(3)))
        assert row == sweep.scenario(3)


    def test_damaged_and_foreign_files_are_told(self, file: Path, tmp_path: Path) -> None:
        rows = flexure.sweep(file, tmp_path / "a")
        part = tmp_path / "a" / "part-00001.parquet"
        whole = part.read_bytes()
        told, columns = rows.summary(), rows.columns()
        rng = np.random.default_rng(1)
        for place in [*rng.integers(4, len(whole), 200), 4, len(whole) - 9]:
            part.write_bytes(whole[:place] + bytes([whole[place] ^ (1 << int(rng.integers(8)))]) + whole[place + 1 :])
            # Told by its name, or what was flipped says nothing: never other numbers.
            try:
                found, summary = rows.columns(), rows.summary()
            except flexure.FlexureError as error:
                assert "part-00001.parquet" in str(error)
            else:
                assert summary == told and all(np.array_equal(found[name], columns[name], equal_nan=name in ("rms_e_l", "diverged_at")) for name in columns)
        for other in ("part-00000.parquet", "part-00002.parquet"):
            part.write_bytes((tmp_path / "a" / other).read_bytes())
            for read in (rows.columns, rows.summary, rows.to_pandas):
                with pytest.raises(flexure.FlexureError, match="part-00001.parquet: it has the rows of shard"):
                    read()
        elsewhere = flexure.sweep(flexure.Sweep(file, set={"control_period": 0.002}), tmp_path / "b")
        part.write_bytes(elsewhere.store.read("part-00001.parquet"))
        with pytest.raises(flexure.FlexureError, match="another sweep"):
            rows.columns()

    def test_of_a_scenario_in_hand(self, file: Path, tmp_path: Path) -> None:
        """With arguments for keys it is the sweep of the file, to the bytes of its shards."""
        scenario = flexure.Scenario("pendulum-tanh", set={"duration": 0.05})
        parameters = {
            "robot.joints.stiffness": {"from": 0.5, "to": 2.0, "relative": True},
            "controller.phi": {"values": ["tanh", "linear"]},
        }
        sweep = flexure.Sweep.of(scenario, parameters, design="uniform", points=24, shard=5, metrics=["rms_e_l", "diverged_at"])
        theirs = flexure.Sweep(file)
        assert sweep.name == "pendulum-tanh" and sweep.columns == theirs.columns
        for row in (0, 23):
            assert sweep.row(row) == theirs.row(row)
        again = pickle.loads(pickle.dumps(sweep))
        assert again == sweep and again.scenario(1).duration == 0.05 and again.shard(1) == sweep.shard(1)
        rows = flexure.sweep(sweep, tmp_path / "a")
        assert flexure.Rows(tmp_path / "a").sweep == rows.sweep == sweep

    def test_of_a_path_of_ones_own(self, tmp_path: Path) -> None:
        scenario = flexure.follow("pendulum-tanh", lambda t: [0.2 * np.sin(3 * t)])
        sweep = flexure.Sweep.of(scenario, {"robot.joints.stiffness": {"values": [0.5, 2.0], "relative": True}}, name="soft")
        rows = flexure.sweep(sweep, tmp_path / "a")
        assert rows.replay(0).summary["rms_e_l"] == pytest.approx(rows.columns("rms_e_l")["rms_e_l"][0], rel=1e-8)
        assert (tmp_path / "a" / "sweep.json").read_text().count("Python.csv") >= 1

    def test_what_is_wrong_in_arguments(self) -> None:
        scenario = flexure.Scenario("pendulum-tanh")
        good = {"robot.joints.stiffness": {"values": [0.5, 2.0], "relative": True}}
        of: Any = flexure.Sweep.of
        for parameters, keywords, fragment in (
            ({}, {}, "parameters"),
            ({"controller.phi": {}}, {}, "0 keys"),
            ({1: {"values": [1.0]}}, {}, "int is no text"),
            (good, {"design": "sobel"}, "sobol"),
            (good, {"design": "sobol"}, "points"),
            (good, {"points": 3}, "grid"),
            (good, {"seeds": []}, "seeds"),
            (good, {"metrics": ["rms"]}, "rms"),
            (good, {"name": ""}, "no name of a sweep"),
            (good, {"name": "../elsewhere"}, "no name of a sweep"),
            (good, {"shard": object()}, "shard: a value of type object"),
            (good | {"scenario": {"values": ["two-link-tanh"]}}, {}, "scenario"),
        ):
            with pytest.raises((flexure.FlexureError, TypeError), match=fragment):
                of(scenario, parameters, **keywords)
        with pytest.raises(TypeError, match="Scenario"):
            of("pendulum-tanh", good)

    def test_factors_on_what_joints_have_by_themselves(self, tmp_path: Path) -> None:
        urdf = Path(__file__).parents[3] / "robots" / "panda.urdf"
        scenario = flexure.import_urdf(urdf, assume="harmonic-drive", scenario=True, out=tmp_path)["files"][1]
        text = 'scenario = "panda-scenario.toml"\n[parameters]\n"robot.joints.stiffness" = { values = [0.5, 2.0], relative = true }\n'
        (tmp_path / "soft.toml").write_text(text)
        sweep = flexure.Sweep(tmp_path / "soft.toml")
        own = flexure.Scenario(scenario).robot.stiffness
        for row, factor in ((0, 0.5), (1, 2.0)):
            np.testing.assert_allclose(sweep.scenario(row).robot.stiffness, factor * own, rtol=1e-15)


class TestElsewhere:
    def test_a_url(self, file: Path, tmp_path: Path) -> None:
        pytest.importorskip("fsspec")
        rows = flexure.sweep(file, "memory://studies/soft")
        assert rows.complete and rows.summary() == flexure.sweep(file, tmp_path / "a").summary()
        other = flexure.Sweep(file, set={"control_period": 0.002})
        with pytest.raises(flexure.FlexureError, match="of another sweep"):
            flexure.sweep(other, "memory://studies/soft")
        # A file system without one-step writes.
        local = flexure.sweep(file, f"file://{tmp_path}/b")
        assert local.complete and content(tmp_path / "a") == content(tmp_path / "b")

    def test_what_is_wrong(self, file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        sweep: Any = flexure.sweep
        with pytest.raises(ValueError, match="shards: range"):
            sweep(file, tmp_path / "a", shards=range(2, 9))
        with pytest.raises(ValueError, match="engine: 'dask'"):
            sweep(file, tmp_path / "a", engine="dask")
        with pytest.raises(TypeError, match=r"shards: \[1\]; expected a range"):
            sweep(file, tmp_path / "a", shards=[1])
        with pytest.raises(ValueError, match="threads: 1000000000"):
            sweep(file, tmp_path / "a", threads=10**9)
        with pytest.raises(ValueError, match="threads: 0"):
            sweep(file, tmp_path / "a", threads=0)
        with pytest.raises(flexure.FlexureError, match="it is no folder of a sweep"):
            flexure.Rows(tmp_path)
        with pytest.raises(flexure.FlexureError, match="cannot read"):
            sweep(tmp_path / "none.toml", tmp_path / "a")
        (tmp_path / "taken").write_text("")
        with pytest.raises(OSError, match="taken"):
            sweep(file, tmp_path / "taken")
        rows = sweep(file, tmp_path / "a")
        with pytest.raises(flexure.FlexureError, match="there is no column 'rms'"):
            rows.columns("rms")
        with pytest.raises(flexure.FlexureError, match="row 24"):
            rows.replay(24)
        with pytest.raises(IndexError, match="shard 5"):
            rows.sweep.shard(5)
        with pytest.raises(IndexError, match="row -1: rows are counted from 0"):
            rows.sweep.row(-1)
        monkeypatch.setitem(sys.modules, "fsspec", None)
        with pytest.raises(ImportError, match="pip install fsspec"):
            sweep(file, "s3://bucket/a")
        monkeypatch.setitem(sys.modules, "ray", None)
        with pytest.raises(ImportError, match="pip install ray"):
            sweep(file, tmp_path / "b", engine="ray")


class TestFigures:
    def test_a_grid_and_points(self, tmp_path: Path) -> None:
        pytest.importorskip("matplotlib")
        (tmp_path / "grid.toml").write_text(GRID)
        rows = flexure.sweep(tmp_path / "grid.toml", tmp_path / "a")
        figure = rows.heatmap("imperfection.noise.motor", "robot.joints.stiffness")
        panel = figure.axes[0]
        assert panel.get_ylabel().strip() == "robot.joints.stiffness [× that of the file]"
        cells = panel.collections[0].get_array()
        assert cells.shape == (4, 3)
        columns = rows.columns()
        here = (columns["imperfection.noise.motor"] == 5e-5) & (columns["robot.joints.stiffness"] == 2.0)
        assert here.sum() == 2 and cells[3, 1] == pytest.approx(columns["rms_e_l"][here].mean())
        rows.scatter("rms_e_l", "max_abs_u_m", "settling_time").savefig(tmp_path / "a.png")
        with pytest.raises(ValueError, match="status is text"):
            rows.scatter("rms_e_l", "max_abs_u_m", "status")
        with pytest.raises(ValueError, match="form no grid"):
            rows.heatmap("rms_e_l", "max_abs_u_m")


RAY = """
import sys
import flexure
import ray
ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, object_store_memory=100_000_000)
print("started", flush=True)
rows = flexure.sweep(sys.argv[1], sys.argv[2], engine="ray")
assert rows.complete
print("complete", flush=True)
"""


class TestRay:
    """Ray's start needs minutes on a busy machine: once more if it does not come, then said loudly."""

    ENVIRONMENT = {"RAY_AUTH_MODE": "disabled", "RAY_USAGE_STATS_ENABLED": "0", "RAY_raylet_start_wait_time_s": "300"}

    def started(self, file: Path, out: Path) -> "subprocess.Popen[str]":
        pytest.importorskip("ray")
        for _ in range(2):
            driver = subprocess.Popen(
                [sys.executable, "-c", RAY, str(file), str(out)],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                env={**os.environ, **self.ENVIRONMENT},
                start_new_session=True,
            )
            assert driver.stdout is not None
            if driver.stdout.readline() == "started\n":
                return driver
            driver.kill()
            said = driver.communicate()[1]
        pytest.skip(f"RAY DID NOT START, nothing of it was tested: {said[-500:]}")

    @staticmethod
    def end(driver: "subprocess.Popen[str]") -> None:
        """The driver, with all that it started."""
        os.killpg(driver.pid, signal.SIGKILL)
        driver.communicate()

    def test_workers_and_drivers_that_die_lose_nothing(self, file: Path, tmp_path: Path) -> None:
        text = SWEEP.replace("points = 24", "points = 400").replace("duration = 0.05", "duration = 2.0")
        file.write_text(text)
        out = tmp_path / "ray"
        driver = self.started(file, out)
        try:
            while len(list(out.glob("*.parquet"))) < 4:
                time.sleep(0.01)
            # A worker in the middle of its work.
            subprocess.run(["pkill", "-KILL", "-n", "-f", "ray::_shard"], check=False)
            while len(list(out.glob("*.parquet"))) < 12:
                assert driver.poll() is None, "the driver goes on without that worker"
                time.sleep(0.01)
        finally:
            self.end(driver)
        there = content(out)
        assert 12 <= len(there) < 80
        driver = self.started(file, out)
        said, errors = driver.communicate(timeout=300)
        assert said == "complete\n", errors
        after = content(out)
        assert all(after[name] == bytes_ for name, bytes_ in there.items() if name.startswith(("part", "sweep")))
        flexure.sweep(file, tmp_path / "local")
        assert {name: bytes_ for name, bytes_ in after.items() if not name.startswith(".")} == content(tmp_path / "local")
