"""What the tests share: the command line's answers, a scenario and its run."""

import json
import os
import subprocess
from collections.abc import Callable
from typing import Any

import flexure
import pytest

SCENARIO = "two-link-tanh-smooth"


@pytest.fixture(scope="session")
def command() -> Callable[..., Any]:
    """What the command line answers to these arguments."""

    def answer(*arguments: str) -> Any:
        done = subprocess.run([os.environ["FLEXURE"], *arguments, "--json"], capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1, 3), done.stderr
        return json.loads(done.stdout)

    return answer


@pytest.fixture(scope="session")
def scenario() -> flexure.Scenario:
    return flexure.Scenario(SCENARIO)


@pytest.fixture(scope="session")
def run(scenario: flexure.Scenario) -> flexure.Run:
    return flexure.simulate(scenario)
