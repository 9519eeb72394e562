"""The package: the same numbers as the command line, shapes, errors, pickles, Ctrl-C."""

import json
import os
import copy
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path
from typing import Any

import flexure
import numpy as np
import pytest

SCENARIO = "two-link-tanh-smooth"


def command(*arguments: str) -> Any:
    """What the command line answers."""
    done = subprocess.run([os.environ["FLEXURE"], *arguments, "--json"], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1, 3), done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def scenario() -> flexure.Scenario:
    return flexure.Scenario(SCENARIO)


@pytest.fixture(scope="module")
def run(scenario: flexure.Scenario) -> flexure.Run:
    return flexure.simulate(scenario)


def timeless(document: dict) -> dict:
    return {key: value for key, value in document.items() if key not in ("wall_seconds", "files", "file", "certificate")}


class TestSameAsTheCommandLine:
    def test_run(self, run: flexure.Run, tmp_path: Path) -> None:
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

    def test_proof(self, tmp_path: Path) -> None:
        options = ("--error-box", "0.5", "--disturbance", "0.05")
        answer = command("certify", SCENARIO, *options, "--out", str(tmp_path / "c.json"))
        found = flexure.certify(SCENARIO, error_box=0.5, disturbance=[0.05, 0.05], out=tmp_path / "p.json")
        assert timeless(found) == timeless(answer)
        assert (tmp_path / "c.json").read_text() == (tmp_path / "p.json").read_text()

    def test_margins(self) -> None:
        name = "two-link-hardware"
        assert timeless(flexure.margins(name)) == timeless(command("margins", name)["loops"][0])

    def test_states(self, scenario: flexure.Scenario) -> None:
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


    def test_the_road_from_a_motion_to_numbers(self, tmp_path: Path) -> None:
        out = tmp_path / "excite.toml"
        motion = flexure.excite("planar-2r", out, budget=5)
        assert motion["toml"] == out.read_text() and motion["objections"] == []
        assert command("run", str(out), "--out", str(tmp_path))["follows"]
        log = tmp_path / "excite.csv"
        found = flexure.identify("planar-2r", log)
        assert timeless({**found, "toml": None}) == timeless({**command("identify", "planar-2r", "--log", str(log)), "toml": None})
        assert "identified: " in found["toml"]
        laid = flexure.replay(out, log)
        answer = command("replay", str(out), "--log", str(log), "--out", str(tmp_path / "replay"))
        assert laid["joints"] == answer["joints"] and len(laid["trace"]["t"]) > 1000

    def test_usage(self, scenario: flexure.Scenario) -> None:
        (answer,) = command("check", SCENARIO)
        assert scenario.usage() == answer["reference"]["usage"]
        assert scenario.sampled() == answer["sampled"]
        assert flexure.Robot("panda").table() == command("check", "panda")[0]["robot"]


class TestPages:
    @pytest.mark.parametrize("page", ["docs/python.md", "README.md"])
    def test_what_is_shown_runs(self, page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        text = (Path(__file__).parents[3] / page).read_text()
        blocks = [block.split("```")[0] for block in text.split("```python\n")[1:]]
        blocks = [block for block in blocks if "pandas.read_csv" not in block]
        assert blocks
        monkeypatch.chdir(tmp_path)
        names: dict = {}
        for block in blocks:
            exec(block, names)


class TestArrays:
    def test_a_batch_is_its_rows(self, scenario: flexure.Scenario) -> None:
        law, robot, held = scenario.controller(), scenario.robot, scenario.open()
        x = np.random.default_rng(2).uniform(-1, 1, (2, 3, 8))
        u = law.torque(x, 0.1)
        assert u.shape == (2, 3, 2)
        q_l, _, dq_l, _ = flexure.views(x)
        for i in np.ndindex(2, 3):
            for all_, one in [
                (u, law.torque(x[i], 0.1)),
                (robot.mass_matrix(q_l), robot.mass_matrix(q_l[i])),
                (robot.inverse_dynamics(q_l, dq_l, dq_l), robot.inverse_dynamics(q_l[i], dq_l[i], dq_l[i])),
                (robot.forward_dynamics(x, u), robot.forward_dynamics(x[i], u[i])),
                (robot.energy(x), robot.energy(x[i])),
                (robot.matrices(q_l, dq_l)["dM"], robot.matrices(q_l[i], dq_l[i])["dM"]),
                (held.derivative(0.0, x, u), held.derivative(0.0, x[i], u[i])),
            ]:
                np.testing.assert_array_equal(all_[i], one)
        np.testing.assert_array_equal(robot.forward_dynamics(x, u[0, 0]), robot.forward_dynamics(x, np.broadcast_to(u[0, 0], (2, 3, 2))))
        np.testing.assert_array_equal(held.derivative(0.0, x[0, 0], u), held.derivative(0.0, np.broadcast_to(x[0, 0], x.shape), u))
        assert isinstance(robot.energy(x[0, 0]), float) and robot.energy(x).shape == (2, 3)
        assert law.torque(np.zeros((0, 8)), 0.0).shape == (0, 2)
        times = np.linspace(0.0, 1.0, 6).reshape(2, 3)
        for i in np.ndindex(2, 3):
            np.testing.assert_array_equal(law.torque(x, times)[i], law.torque(x[i], times[i]))
            np.testing.assert_array_equal(law.reference(times)[i], law.reference(times[i]))
        with pytest.raises(ValueError, match=r"t: shape \(3,\); expected one time, or \(2, 3\)"):
            law.torque(x, np.zeros(3))

    def test_whatever_numpy_makes_numbers_of(self, scenario: flexure.Scenario) -> None:
        law = scenario.controller()
        x = np.arange(8) / 16
        u = law.torque(x, 0.0)
        wide = np.zeros((8, 2))
        wide[:, 0] = x
        read_only = x.copy()
        read_only.flags.writeable = False
        for same in [x.tolist(), tuple(x), x.astype(np.float32), wide[:, 0], x[::-1].copy()[::-1], read_only, np.asfortranarray([x])[0]]:
            np.testing.assert_array_equal(law.torque(same, 0.0), u)
        np.testing.assert_array_equal(law.torque(np.asfortranarray([x, x]), 0.0), [u, u])
        np.testing.assert_array_equal(law.torque([1, 0, 1, 0, 0, 0, 0, 0], 0), law.torque([1.0, 0, 1, 0, 0, 0, 0, 0], 0.0))

    def test_exact_slopes(self, scenario: flexure.Scenario) -> None:
        """Against central differences: they are off by h² and by rounding over h, 1e-6 of the largest slope together."""
        law, held, h = scenario.controller(), scenario.open(), 1e-5
        x = np.array([0.3, -0.2, 0.31, -0.22, 0.5, 0.1, 0.4, 0.2])
        u = np.array([1.0, -0.5])
        moved = x + h * np.array([[1], [-1]])[..., None] * np.eye(8)
        quotient = np.subtract(*law.torque(moved, 0.4)).T / (2 * h)
        slopes = law.jacobian(x, 0.4)
        assert np.abs(slopes - quotient).max() < 1e-6 * np.abs(slopes).max()
        A, B = law.linearise(x, u)
        rates = np.subtract(*held.derivative(0.0, moved, np.broadcast_to(u, (2, 8, 2)))).T / (2 * h)
        assert np.abs(A - rates).max() < 1e-6 * np.abs(A).max()
        # Torques act on motors alone, over their inertia.
        np.testing.assert_allclose(B, np.vstack([np.zeros((6, 2)), np.diag(1 / scenario.robot.motor_inertia)]), rtol=1e-14)

    def test_torque_derivatives(self) -> None:
        """Along a polynomial of which the torques' own differences are known to 1e-5 of their size."""
        robot, h = flexure.Robot("planar-2r"), 1e-4
        coefficients = np.random.default_rng(3).uniform(-1, 1, (5, 2))

        def motion(t: float) -> np.ndarray:
            polynomials = [np.polynomial.Polynomial(c) for c in coefficients.T]
            return np.array([[p.deriv(k)(t) if k else p(t) for p in polynomials] for k in range(5)])

        exact = robot.torque_derivatives(motion(0.3))
        q_l = np.array([motion(0.3 + k * h) for k in (-1, 0, 1)])
        tau = robot.inverse_dynamics(q_l[:, 0], q_l[:, 1], q_l[:, 2])
        np.testing.assert_allclose(exact[0], tau[1], rtol=1e-13)
        np.testing.assert_allclose(exact[1], (tau[2] - tau[0]) / (2 * h), rtol=1e-5)
        np.testing.assert_allclose(exact[2], (tau[2] - 2 * tau[1] + tau[0]) / h**2, rtol=1e-4)

    @pytest.mark.parametrize(
        ("bad", "error", "words"),
        [
            (np.zeros(7), ValueError, r"x: shape \(7,\); expected \(…, 8\) = \(q_l, q_m, dq_l, dq_m\)"),
            (np.zeros((8, 3)), ValueError, r"x: shape \(8, 3\)"),
            (0.5, ValueError, r"x: shape \(\)"),
            (["a"] * 8, TypeError, "x: numbers of type <U1; expected real numbers"),
            (np.zeros(8, complex), TypeError, "complex128"),
            ([[1.0], [1.0, 2.0]], TypeError, "x: list is no array of real numbers"),
            (object(), TypeError, "x: numbers of type object"),
            (None, TypeError, "x: numbers of type object"),
        ],
    )
    def test_bad_arrays(self, scenario: flexure.Scenario, bad: object, error: type[Exception], words: str) -> None:
        with pytest.raises(error, match=words):
            scenario.controller().torque(bad, 0.0)

    def test_bad_pairs(self, scenario: flexure.Scenario) -> None:
        robot, law = scenario.robot, scenario.controller()
        with pytest.raises(ValueError, match=r"shapes do not fit: x \(3, 8\), u_m \(2, 2\)"):
            robot.forward_dynamics(np.zeros((3, 8)), np.zeros((2, 2)))
        with pytest.raises(ValueError, match="one motion"):
            law.jacobian(np.zeros((1, 8)), 0.0)
        with pytest.raises(ValueError, match=r"expected \(…, 5, 2\)"):
            robot.torque_derivatives(np.zeros((3, 2)))
        with pytest.raises(ValueError, match="numbers"):
            scenario.open().restore([1.0, 2.0])

    def test_nan_stays_nan(self, scenario: flexure.Scenario) -> None:
        assert np.isnan(scenario.controller().torque(np.full(8, np.nan), 0.0)).all()

    def test_motions(self) -> None:
        x = flexure.motion([0.1, 0.2], dq_m=[1.0, 2.0])
        assert x.tolist() == [0.1, 0.2, 0.1, 0.2, 0.0, 0.0, 1.0, 2.0]
        flexure.views(x).q_m[:] = 5.0
        assert x[2:4].tolist() == [5.0, 5.0]
        with pytest.raises(ValueError, match="4n"):
            flexure.views(np.zeros(7))


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
        text = flexure.certify(SCENARIO)["certificate"]
        report = flexure.verify(text, against=SCENARIO)
        assert report["same"] and report["differences"] == []
        assert not flexure.verify(text, against="two-link-tanh")["same"]
        document = json.loads(text)
        document["contraction_rate"] = "1000.0"
        with pytest.raises(flexure.FlexureError, match="does not hold|no certificate"):
            flexure.verify(json.dumps(document))

    def test_files_that_changed(self, tmp_path: Path) -> None:
        file = tmp_path / "s.toml"
        text = 'robot = "pendulum-1dof"\nduration = 1.0\ncontrol_period = 0.001\n[reference]\nkind = "sine"\namplitude = [0.5]\nfrequency = [1.0]\n[controller]\nkind = "vcbc"\n'
        file.write_text(text)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            kept = pickle.dumps(flexure.Scenario(file, set={"duration": 2.0}))
            assert pickle.loads(kept).duration == 2.0
            file.write_text("# a comment\n" + text)
            assert pickle.loads(kept).duration == 2.0
            file.write_text(text.replace("0.5", "0.6"))
            with pytest.raises(flexure.FlexureError, match="something else"):
                pickle.loads(kept)

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


class TestLongJobs:
    def test_progress_is_told_and_raises(self) -> None:
        told: list[float] = []
        flexure.simulate("panda-tanh-smooth", progress=told.append)
        assert told and told == sorted(told) and 0.0 <= told[0] <= told[-1] <= 1.0

        def refuse(fraction: float) -> None:
            raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            flexure.simulate("panda-tanh-smooth", progress=refuse)

    @pytest.mark.parametrize("job", [lambda: flexure.compare(), lambda: flexure.tune("panda-tanh-smooth")])
    def test_ctrl_c(self, job: Any) -> None:
        """Within 0.2 s on a free machine; 2 s here, where others work, too."""
        asked: list[float] = []
        # A shell that puts the tests into the background has it ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)

        def ask() -> None:
            asked.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(1.0, ask)
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            job()
        assert time.monotonic() - asked[0] < 2.0
        timer.join()
        signal.signal(signal.SIGINT, before)

    def test_a_panic_is_an_exception(self, capfd: pytest.CaptureFixture) -> None:
        from flexure import _flexure

        with pytest.raises(BaseException, match="asked for") as caught:
            _flexure._panic()
        assert caught.type.__name__ == "PanicException"
        assert flexure.simulate("pendulum-tanh").follows
        capfd.readouterr()

    def test_other_threads_run(self, scenario: flexure.Scenario) -> None:
        counted = 0
        done = threading.Event()

        def count() -> None:
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        flexure.simulate("panda-tanh-smooth")
        done.set()
        thread.join()
        assert counted > 50


class TestTables:
    def test_pandas(self, run: flexure.Run) -> None:
        pandas = pytest.importorskip("pandas")
        table = run.trace.to_pandas()
        assert table.index.name == "t" and list(table) == [name for name in run.trace if name != "t"]
        assert isinstance(table, pandas.DataFrame)
        np.testing.assert_array_equal(pandas.DataFrame(run.trace)["u_m1"], run.trace["u_m1"])

    def test_arrow(self, run: flexure.Run) -> None:
        pyarrow = pytest.importorskip("pyarrow")
        table = pyarrow.RecordBatchReader.from_stream(run.trace).read_all()
        assert table.column_names == list(run.trace)
        assert table.schema.field("u_m1").metadata == {b"unit": b"N m"}
        np.testing.assert_array_equal(table["u_m1"].to_numpy(), run.trace["u_m1"])

    def test_plot(self, run: flexure.Run, tmp_path: Path) -> None:
        pytest.importorskip("matplotlib")
        run.plot().savefig(tmp_path / "run.png")
        assert (tmp_path / "run.png").stat().st_size > 20_000

    def test_names(self, run: flexure.Run) -> None:
        with pytest.raises(KeyError, match="columns are t, q_l1"):
            run.trace["q"]
        again = pickle.loads(pickle.dumps(run))
        np.testing.assert_array_equal(again.trace["u_m1"], run.trace["u_m1"])
        assert again.trace.units == run.trace.units and again.summary == run.summary and again != run
        assert run.trace.joints("q_l").shape == (len(run.trace["t"]), 2)
        assert "follows" in repr(run) and "two-link" in repr(run.scenario)
