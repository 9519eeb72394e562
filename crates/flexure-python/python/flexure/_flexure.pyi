"""The compiled half of the package."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Protocol, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Controller",
    "FlexureError",
    "FlexureWarning",
    "Loop",
    "Plant",
    "Robot",
    "Scenario",
    "Sweep",
    "__version__",
    "_panic",
    "certify",
    "check",
    "compare",
    "excite",
    "identify",
    "import_urdf",
    "margins",
    "registered",
    "replay",
    "reproduce",
    "simulate",
    "tune",
    "verify",
]

_Array = NDArray[np.float64]
_Path = str | PathLike[str]
_Numbers = ArrayLike
_Told = Callable[[float], object] | None
_Law = Callable[[float, _Array, _Array], ArrayLike]

class _Shaping(Protocol):
    scale: float
    coefficients: list[float]

__version__: str

class _Problem(TypedDict):
    code: str
    message: str
    hint: str
    file: str | None
    line: int | None
    column: int | None

class FlexureError(Exception):
    """What the command line says with exit code 1 or 2: the text is the message, with file, line and hint."""

    problems: Sequence[_Problem]
    """Each problem by itself."""

class FlexureWarning(UserWarning):
    """What is suspicious in a file, a log or a run."""

@final
class Robot:
    """A flexible-joint robot: links, and a motor and a spring for each of its n joints; for joints that slide read m for rad and N for N m."""

    def __new__(cls, path_or_name: _Path, *, allow_outside: bool = False) -> Robot: ...
    def __len__(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def joints(self) -> list[str]: ...
    @property
    def stiffness(self) -> _Array:
        """(n,), N m/rad"""
    @property
    def motor_inertia(self) -> _Array:
        """(n,), kg m², on the link side of the gear"""
    @property
    def link_damping(self) -> _Array:
        """(n,), N m s/rad"""
    @property
    def motor_damping(self) -> _Array:
        """(n,), N m s/rad"""
    @property
    def limits(self) -> dict[str, _Array]:
        """torque (N m), velocity (rad/s), lower and upper (rad), (n,) each, infinite for no limit"""
    @property
    def warnings(self) -> list[_Problem]: ...
    def __copy__(self) -> Robot: ...
    def __deepcopy__(self, _memo: object) -> Robot: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def table(self) -> list[dict[str, Any]]: ...
    def mass_matrix(self, q_l: ArrayLike) -> _Array:
        """(…, n) → (…, n, n), kg m²"""
    def inverse_dynamics(self, q_l: ArrayLike, dq_l: ArrayLike, ddq_l: ArrayLike) -> _Array:
        """(…, n) each → (…, n), N m"""
    def forward_dynamics(self, x: ArrayLike, u_m: ArrayLike) -> _Array:
        """(…, 4n), (…, n) → (…, 2n), rad/s²: links, then motors"""
    def energy(self, x: ArrayLike) -> Any:
        """(…, 4n) → (…), J"""
    def matrices(self, q_l: ArrayLike, dq_l: ArrayLike) -> dict[str, _Array]:
        """(…, n) each → S, E and dM, (…, n, n) each"""
    def torque_derivatives(self, q_l: ArrayLike) -> _Array:
        """(…, 5, n), positions and four derivatives → (…, 3, n), N m, N m/s, N m/s²"""

@final
class Scenario:
    """A robot, what it shall do, a law, and everything between law and robot."""

    def __new__(
        cls, path_or_name: _Path, *, set: dict[str, Any] | Sequence[str] | None = None, allow_outside: bool = False
    ) -> Scenario: ...
    @property
    def name(self) -> str: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def duration(self) -> float:
        """s"""
    @property
    def control_period(self) -> float:
        """s"""
    @property
    def seed(self) -> int: ...
    @property
    def initial(self) -> _Array:
        """(4n,)"""
    @property
    def assumptions(self) -> list[dict[str, str]]: ...
    @property
    def warnings(self) -> list[_Problem]: ...
    def __copy__(self) -> Scenario: ...
    def __deepcopy__(self, _memo: object) -> Scenario: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    @property
    def gains(self) -> dict[str, _Array]:
        """(n,) each, by the keys below [controller]"""
    def controller(self) -> Controller: ...
    def open(self, *, law: _Law | None = None, shaping: _Shaping | None = None) -> Loop: ...
    def _along(self, samples: str, smooth_start: float | None) -> Scenario: ...
    def sampled(self) -> dict[str, Any] | None: ...
    def usage(self) -> list[dict[str, Any]]: ...

@final
class Controller:
    """The law of a scenario by itself; it sees motions as they are and remembers nothing."""

    def __new__(cls, scenario: Scenario | _Path) -> Controller: ...
    @property
    def joints(self) -> int: ...
    @property
    def scenario(self) -> Scenario: ...
    def torque(self, x: ArrayLike, t: ArrayLike) -> _Array:
        """(…, 4n), one time or (…), s → (…, n), N m; many at one time in SIMD lanes, equal to one by one but for rounding"""
    def command(self, x: ArrayLike, t: float) -> dict[str, Any]:
        """(4n,), s → what the law computes on the way, (n,) each, and energy, J"""
    def reference(self, t: ArrayLike) -> _Array:
        """(…), s → (…, 5, n): positions, rad, and four derivatives"""
    def jacobian(self, x: ArrayLike, t: float) -> _Array:
        """(4n,), s → (n, 4n): ∂u_m/∂x, exact"""
    def linearise(self, x: ArrayLike, u_m: ArrayLike) -> tuple[_Array, _Array]:
        """(4n,), (n,) → A (4n, 4n) and B (4n, n) of the simulated robot, exact"""

@final
class Loop:
    """The closed loop of a scenario, moved from one control instant to the next."""

    def __new__(cls, scenario: Scenario | _Path, *, law: _Law | None = None, shaping: _Shaping | None = None) -> Loop: ...
    @property
    def scenario(self) -> Scenario: ...
    @property
    def joints(self) -> int: ...
    @property
    def period(self) -> float:
        """s"""
    @property
    def signals(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def t(self) -> float:
        """s"""
    @property
    def x(self) -> _Array:
        """(4n,)"""
    @property
    def u_m(self) -> _Array:
        """(n,), N m"""
    def step(self, count: int = 1) -> None: ...
    def read(self) -> dict[str, float]: ...
    def derivative(self, t: float, x: ArrayLike, u_m: ArrayLike) -> _Array:
        """s, (…, 4n), (…, n) → (…, 4n)"""
    def state(self) -> _Array: ...
    def restore(self, state: ArrayLike) -> None: ...
    def reset(self, seed: int) -> None: ...

@final
class Plant:
    """The robot that a scenario simulates, driven by torques of the caller; no sensors, no controller, no torque limit."""

    def __new__(cls, scenario: Scenario | _Path) -> Plant: ...
    @property
    def joints(self) -> int: ...
    @property
    def period(self) -> float:
        """s"""
    @property
    def scenario(self) -> Scenario: ...
    def roll(self, x: ArrayLike, u_m: ArrayLike, *, first: ArrayLike | None = None, period: float | None = None) -> _Array:
        """(…, 4n), (…, T, n), N m, each held for a period → (…, T, 4n)"""

@final
class Sweep:
    """Many runs of a scenario whose numbers change, by their indices: each row is a function of its index alone."""

    def __new__(cls, path: _Path, *, set: dict[str, Any] | Sequence[str] | None = None, allow_outside: bool = False) -> Sweep: ...
    @staticmethod
    def of(
        scenario: Scenario,
        parameters: dict[str, Any],
        *,
        name: str | None = None,
        design: str | None = None,
        points: int | None = None,
        seed: int | None = None,
        seeds: int | Sequence[int] | None = None,
        metrics: Sequence[str] | None = None,
        shard: int | None = None,
    ) -> Sweep:
        """Of a scenario in hand: what stands in a sweep file, as arguments."""

    @staticmethod
    def from_document(text: str) -> Sweep: ...
    def document(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def identity(self) -> str: ...
    @property
    def rows(self) -> int: ...
    @property
    def shards(self) -> int: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def parameters(self) -> list[dict[str, Any]]: ...
    @property
    def metrics(self) -> list[dict[str, str]]: ...
    def part_name(self, shard: int) -> str: ...
    def scenario(self, row: int) -> Scenario: ...
    def row(self, row: int) -> dict[str, Any]: ...
    def shard(self, shard: int, *, threads: int | None = None, progress: _Told = None) -> bytes:
        """A file of rows: Parquet"""
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _complete(self, folder: _Path, first: int, end: int, *, threads: int | None = None, progress: _Told = None) -> int: ...
    def _statistics(self, ends: Sequence[tuple[int, bytes]]) -> dict[str, Any]: ...
    def _table(self, files: Sequence[tuple[int, bytes]], names: Sequence[str]) -> dict[str, Any]: ...

def simulate(scenario: Scenario, *, law: _Law | None = None, shaping: _Shaping | None = None, progress: _Told = None) -> dict[str, Any]: ...
def certify(
    scenario: Scenario,
    *,
    error_box: _Numbers | None = None,
    initial_error: _Numbers | None = None,
    rate: float | None = None,
    disturbance: _Numbers | None = None,
    link_disturbance: _Numbers | None = None,
    up_to_limits: bool = False,
    slabs: int | None = None,
    velocity_error: _Numbers | None = None,
    sampled_tube: _Numbers | None = None,
    strongest: bool | None = None,
    direct: bool = False,
    budget: int = 10_000,
    out: _Path | None = None,
    progress: _Told = None,
) -> dict[str, Any]: ...
def verify(certificate: _Path, *, against: Scenario | None = None) -> dict[str, Any]: ...
def margins(
    scenario: Scenario, *, sampled_tube: _Numbers | None = None, progress: _Told = None
) -> dict[str, Any]: ...
def tune(
    scenario: Scenario,
    *,
    spec: _Path | None = None,
    budget: int = 40,
    seed: int = 0,
    out: _Path | None = None,
    progress: _Told = None,
) -> dict[str, Any]: ...
def compare(
    scenarios: Sequence[Scenario] = ...,
    *,
    controllers: Sequence[str] = ...,
    budget: int = 40,
    seed: int = 0,
    seeds: int = 5,
    progress: _Told = None,
) -> dict[str, Any]: ...
def identify(
    robot: _Path,
    logs: Sequence[_Path],
    *,
    columns: str | None = None,
    motor_only: bool = False,
    hold_out: float = 0.2,
    accuracy: float = 0.2,
    out: _Path | None = None,
    allow_outside: bool = False,
    progress: _Told = None,
) -> dict[str, Any]: ...
def excite(
    robot: _Path,
    out: _Path,
    *,
    duration: float = 20.0,
    control_period: float = 0.001,
    posture: Sequence[float] | None = None,
    link_resolution: float = ...,
    motor_resolution: float = ...,
    motor_only: bool = False,
    budget: int = ...,
    seed: int = 0,
    allow_outside: bool = False,
    progress: _Told = None,
) -> dict[str, Any]: ...
def replay(
    scenario: Scenario,
    log: _Path,
    *,
    columns: str | None = None,
    horizon: float = ...,
    progress: _Told = None,
) -> dict[str, Any]: ...
def check(given: Scenario | Robot | _Path, *, allow_outside: bool = False) -> dict[str, Any]: ...
def registered() -> dict[str, dict[str, str]]: ...
def import_urdf(
    urdf: _Path,
    *,
    lock: Sequence[tuple[str, float]] = ...,
    assume: str | None = None,
    unknown_limits: bool = False,
    scenario: bool = False,
    out: _Path | None = None,
    force: bool = False,
) -> dict[str, Any]: ...
def reproduce(out: _Path, *, progress: _Told = None) -> dict[str, Any]: ...
def _panic() -> None:
    """Panics, for the tests."""
