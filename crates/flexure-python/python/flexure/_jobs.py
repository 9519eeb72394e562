"""What the command line does, under the same names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _flexure
from ._flexure import FlexureError, Robot, Scenario
from ._progress import Bar, Progress
from ._run import Run, Trace

if TYPE_CHECKING:
    from ._shaping import Shaping

Path = str | PathLike[str]
Numbers = ArrayLike
Found = TypeVar("Found")
Law = Callable[[float, NDArray[np.float64], NDArray[np.float64]], ArrayLike]


def _scenario(given: Scenario | Path) -> Scenario:
    return given if isinstance(given, Scenario) else Scenario(given)


def _watched(name: str, progress: Progress, job: Callable[[Callable[[float], object] | None], Found]) -> Found:
    if progress is True:
        with Bar(name) as bar:
            return job(bar)
    return job(progress or None)


def simulate(
    scenario: Scenario | Path, *, law: Law | None = None, shaping: Shaping | None = None, progress: Progress = None
) -> Run:
    """Simulates a scenario from beginning to end, as `flexure run`: its trace and what it is judged by.

    With `law`, a function of the time in s, the motion that the controller sees, (4n,), and the reference with its first four derivatives,
    (5, n), which returns motor torques, (n,), N m, that is the law instead of the scenario's; sensors, delays, guard and drive stay. It
    is called at every control instant from Python: some microseconds each, and what it raises comes out here. With `shaping`, that is
    the shaping function of the scenario's v-CBC law.

    A loop that does not follow its reference, diverges, or is unstable as sampled is a result and no error: see `Run.ok`.
    """
    scenario = _scenario(scenario)
    found = _watched(scenario.name, progress, lambda told: _flexure.simulate(scenario, law=law, shaping=shaping, progress=told))
    return Run(
        scenario=scenario,
        summary=found["summary"],
        trace=Trace(found["trace"], found["units"]),
        diverged_at=found["diverged_at"],
        divergence=found["divergence"],
        sampled=found["sampled"],
        objections=found["objections"],
        faults=found["faults"],
    )


def check(given: Scenario | Robot | Path, *, allow_outside: bool = False) -> dict[str, Any]:
    """Looks at a scenario, a robot, or the file of one, as `flexure check`: joints, assumed numbers, what the reference uses of the limits,
    whether the loop is stable that holds its torque for a control period.

    `ok` tells whether it is, and no limit is exceeded: `errors` says what. Raises FlexureError for a file that cannot be used.
    """
    return _flexure.check(given, allow_outside=allow_outside)


def certify(
    scenario: Scenario | Path,
    *,
    error_box: Numbers | None = None,
    initial_error: Numbers | None = None,
    rate: float | None = None,
    disturbance: Numbers | None = None,
    link_disturbance: Numbers | None = None,
    up_to_limits: bool = False,
    slabs: int | None = None,
    velocity_error: Numbers | None = None,
    sampled_tube: Numbers | None = None,
    strongest: bool | None = None,
    direct: bool = False,
    budget: int = 10_000,
    out: Path | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """Proves how fast the closed loop contracts, and where, as `flexure certify`.

    The dict has the keys of `--json`, with `verdict` ("proved", "proved (ideal loop)", "refuted", "undecided", …), and `certificate`,
    the text that `verify` checks, None if nothing was proved. Errors in rad, links then motors; rate in 1/s; disturbance in N m, on
    the motors, link_disturbance on the links, with up_to_limits multiplied until a limit may act; a funnel may have so many slabs of
    time; velocity errors in rad/s, links then motors. A sampled_tube says how far links reach in a tube around the run of the sampled loop, in rad;
    strongest = True looks for the widest by itself, however long that takes, False does not; None does where nothing else is asked for and it takes a minute or
    two at most. `step` is the highest step of the ladder of docs/proofs.md that is proved. Certificates go into `out`, the files of funnel and tube beside it.
    """
    scenario = _scenario(scenario)
    return _watched(
        scenario.name,
        progress,
        lambda told: _flexure.certify(
            scenario,
            error_box=error_box,
            initial_error=initial_error,
            rate=rate,
            disturbance=disturbance,
            link_disturbance=link_disturbance,
            up_to_limits=up_to_limits,
            slabs=slabs,
            velocity_error=velocity_error,
            sampled_tube=sampled_tube,
            strongest=strongest,
            direct=direct,
            budget=budget,
            out=out,
            progress=told,
        ),
    )


def verify(certificate: Path | Mapping[str, Any], *, against: Scenario | Path | None = None) -> dict[str, Any]:
    """Checks the claims of a certificate, without what made it, as `flexure verify`: its text, its file, or what `certify` found.

    With `against`, `same` tells whether it is about that scenario, and `differences` what it has differently. Of the path of a tube's
    file, which `certify` writes beside `out`, it follows every ellipsoid for a period, of a funnel's along its slab; that needs `against`.
    Raises FlexureError for a claim that does not hold.
    """
    if isinstance(certificate, Mapping):
        text = certificate.get("certificate")
        if not isinstance(text, str):
            raise FlexureError("there is no certificate: nothing was proved")
        certificate = text
    return _flexure.verify(certificate, against=None if against is None else _scenario(against))


def margins(
    scenario: Scenario | Path, *, sampled_tube: Numbers | None = None, progress: Progress = None
) -> dict[str, Any]:
    """How much delay, torque gain, stiffness error and noise the loop bears, by bisection in simulation, as `flexure margins`: its only loop.

    With a sampled_tube, as for `certify`, `delay_proved` says up to which delay there is one.
    """
    scenario = _scenario(scenario)
    return _watched(
        scenario.name,
        progress,
        lambda told: _flexure.margins(scenario, sampled_tube=sampled_tube, progress=told),
    )


def tune(
    scenario: Scenario | Path,
    *,
    spec: Path | None = None,
    budget: int = 40,
    seed: int = 0,
    out: Path | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """Finds gains, as `flexure tune`: constraints with their slack, evidence, trades.

    `toml` is the complete scenario with the gains, None if no gains keep every constraint (`feasible`); `out` writes it.
    """
    scenario = _scenario(scenario)
    return _watched(
        scenario.name,
        progress,
        lambda told: _flexure.tune(scenario, spec=spec, budget=budget, seed=seed, out=out, progress=told),
    )


def compare(
    scenarios: Scenario | Path | Sequence[Scenario | Path] = (),
    *,
    controllers: str | Sequence[str] = (),
    budget: int = 40,
    seed: int = 0,
    seeds: int = 5,
    progress: Progress = None,
) -> dict[str, Any]:
    """Compares laws on tasks, each with gains from the same search, as `flexure compare`.

    Without scenarios the built-in tasks, without controllers all laws.
    """
    given = [scenarios] if isinstance(scenarios, Scenario | str | PathLike) else scenarios
    tasks = [_scenario(scenario) for scenario in given]
    laws = [controllers] if isinstance(controllers, str) else list(controllers)
    return _watched(
        "compare",
        progress,
        lambda told: _flexure.compare(tasks, controllers=laws, budget=budget, seed=seed, seeds=seeds, progress=told),
    )


def identify(
    robot: Path,
    logs: Path | Sequence[Path],
    *,
    columns: str | None = None,
    motor_only: bool = False,
    hold_out: float = 0.2,
    accuracy: float = 0.2,
    out: Path | None = None,
    allow_outside: bool = False,
    progress: Progress = None,
) -> dict[str, Any]:
    """Stiffness, motor inertia, damping and friction of a robot's joints from logs, with error bars, as `flexure identify`.

    `toml` is the robot file with the numbers that the logs know, None if they know none; `out` writes it.
    """
    files = [logs] if isinstance(logs, str | PathLike) else list(logs)
    return _watched(
        str(robot),
        progress,
        lambda told: _flexure.identify(
            robot,
            files,
            columns=columns,
            motor_only=motor_only,
            hold_out=hold_out,
            accuracy=accuracy,
            out=out,
            allow_outside=allow_outside,
            progress=told,
        ),
    )


def excite(
    robot: Path,
    out: Path,
    *,
    duration: float = 20.0,
    control_period: float = 0.001,
    posture: Sequence[float] | None = None,
    link_resolution: float | None = None,
    motor_resolution: float | None = None,
    motor_only: bool = False,
    budget: int = 200,
    seed: int = 0,
    allow_outside: bool = False,
    progress: Progress = None,
) -> dict[str, Any]:
    """Designs the motion that tells most about a robot's joints, inside all limits, as `flexure excite`; `out` is the scenario file.

    Durations in s, posture in rad, resolutions of encoders in rad on the link side of the gear, 17 bits unless said otherwise.
    `objections` is not empty if the simulated loop exceeds limits or does not follow.
    """
    resolutions = {"link_resolution": link_resolution, "motor_resolution": motor_resolution}
    given = {name: value for name, value in resolutions.items() if value is not None}
    return _watched(
        str(robot),
        progress,
        lambda told: _flexure.excite(
            robot,
            out,
            duration=duration,
            control_period=control_period,
            posture=posture,
            motor_only=motor_only,
            budget=budget,
            seed=seed,
            allow_outside=allow_outside,
            progress=told,
            **given,
        ),
    )


def replay(
    scenario: Scenario | Path,
    log: Path,
    *,
    columns: str | None = None,
    horizon: float = 0.1,
    progress: Progress = None,
) -> dict[str, Any]:
    """Lays a log over the simulation, as `flexure replay`: residuals joint by joint, and in `trace` what its CSV file has.

    `horizon` is how far predictions run from the log's own motion on, s.
    """
    scenario = _scenario(scenario)
    found = _watched(
        scenario.name,
        progress,
        lambda told: _flexure.replay(scenario, log, columns=columns, horizon=horizon, progress=told),
    )
    found["trace"] = Trace(found["trace"], found.pop("units"))
    return found


def registered() -> dict[str, dict[str, str]]:
    """Built-in robots and scenarios, and the kinds that files choose from, as `flexure list`: sections, names, a line on each."""
    return _flexure.registered()


def import_urdf(
    urdf: Path,
    *,
    lock: Mapping[str, float] | None = None,
    assume: str | None = None,
    unknown_limits: bool = False,
    scenario: bool = False,
    out: Path | None = None,
    force: bool = False,
) -> dict[str, Any]:
    """A robot file from a URDF, and with `scenario` one to start with, as `flexure import`.

    `lock` holds joints still at positions in rad or m; `assume` is a class of drives, of `registered()["drives"]`, for what a URDF does not
    say. Files go to `out`, a folder or PATH.toml; without it a robot alone is only a text, `toml`. The dict has the keys of `--json`;
    `missing` tells what is still to be supplied, and `files` what was written: the robot, the scenario, a copy of the URDF where one is
    needed.
    """
    return _flexure.import_urdf(
        urdf, lock=list((lock or {}).items()), assume=assume, unknown_limits=unknown_limits, scenario=scenario, out=out, force=force
    )


def reproduce(out: Path = "out", *, progress: Progress = None) -> dict[str, Any]:
    """The experiments of the paper, as `flexure reproduce`: traces, figures, certificates and report.html in `out`."""
    return _watched("reproduce", progress, lambda told: _flexure.reproduce(out, progress=told))
