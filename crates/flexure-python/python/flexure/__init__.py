"""Model, design, prove and simulate controllers for robots with elastic joints.

A motion is (q_l, q_m, dq_l, dq_m): positions of links and motors in rad, then their rates in rad/s, 4n numbers for n joints, the order
of the traces. Motors are seen from the link side of the gear. Arrays may have a batch of any shape before their last axis.

    >>> import flexure
    >>> scenario = flexure.Scenario("two-link-tanh-smooth")
    >>> run = flexure.simulate(scenario)
    >>> run.summary["follows"]
    True
    >>> flexure.certify(scenario, strongest=False)["verdict"]
    'proved'
"""

from ._flexure import Controller, FlexureError, FlexureWarning, Loop, Plant, Robot, Scenario, Sweep, __version__
from ._jobs import certify, check, compare, excite, identify, import_urdf, margins, registered, replay, reproduce, simulate, tune, verify
from ._motion import Motion, motion, views
from ._run import Run, Trace
from ._shaping import Shaping, follow
from ._sweep import Rows, sweep

__all__ = [
    "Controller",
    "FlexureError",
    "FlexureWarning",
    "Loop",
    "Motion",
    "Plant",
    "Robot",
    "Rows",
    "Run",
    "Scenario",
    "Shaping",
    "Sweep",
    "Trace",
    "__version__",
    "certify",
    "check",
    "compare",
    "excite",
    "follow",
    "identify",
    "import_urdf",
    "margins",
    "motion",
    "registered",
    "replay",
    "reproduce",
    "simulate",
    "sweep",
    "tune",
    "verify",
    "views",
]

# Those that the library raises have their own.
FlexureError.problems = ()
