"""Progress of long jobs."""

import sys
from collections.abc import Callable

Progress = Callable[[float], object] | bool | None
"""What is told the fraction done about twenty times a second; True writes it to stderr, in a terminal and in a notebook, not into files."""


class Bar:
    """A line on stderr that tells how far a job is, and is gone when it ends."""

    WIDTH = 30

    def __init__(self, name: str) -> None:
        self.name = name
        self.shown = ""

    def __call__(self, fraction: float) -> None:
        if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
            return
        done = round(self.WIDTH * min(max(fraction, 0.0), 1.0))
        self.write(f"{self.name} {'█' * done}{'·' * (self.WIDTH - done)} {100 * fraction:3.0f} %")

    def write(self, line: str) -> None:
        if line != self.shown:
            sys.stderr.write("\r" + line.ljust(len(self.shown)))
            sys.stderr.flush()
            self.shown = line

    def __enter__(self) -> "Bar":
        return self

    def __exit__(self, *_: object) -> None:
        if self.shown:
            self.write("")
            sys.stderr.write("\r")
            sys.stderr.flush()
