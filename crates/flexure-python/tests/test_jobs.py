"""Long jobs: progress, Ctrl-C, panics, threads."""

import os
import signal
import threading
import time
from typing import Any

import flexure
import numpy as np
import pytest


class TestLongJobs:
    def test_progress_is_told_and_raises(self) -> None:
        told: list[float] = []
        flexure.simulate("panda-tanh-smooth", progress=told.append)
        assert told and told == sorted(told) and 0.0 <= told[0] <= told[-1] <= 1.0

        def refuse(fraction: float) -> None:
            raise RuntimeError("enough")

        with pytest.raises(RuntimeError, match="enough"):
            flexure.simulate("panda-tanh-smooth", progress=refuse)

    @pytest.mark.parametrize(
        "job",
        [
            lambda: flexure.compare(),
            lambda: flexure.tune("panda-tanh-smooth"),
            lambda: flexure.Scenario("panda-tanh-smooth").controller().torque(np.zeros((1_000_000, 28)), 0.5),
            lambda: flexure.Plant("panda-tanh-smooth").roll(np.zeros((2000, 28)), np.zeros((2000, 300, 7))),
        ],
    )
    def test_ctrl_c(self, job: Any) -> None:
        """Within 0.2 s on a free machine; 2 s here, where others work, too."""
        asked: list[float] = []
        # A shell that puts the tests into the background has it ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)

        def ask() -> None:
            asked.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        # The shortest of the jobs takes a second on two cores.
        timer = threading.Timer(0.3, ask)
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
