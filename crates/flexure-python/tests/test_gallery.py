"""The gallery: every script runs, claims what it asserts, and makes the picture that the page shows."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

GALLERY = Path(__file__).parents[3] / "docs" / "gallery"
SCRIPTS = sorted(path.stem for path in GALLERY.glob("*.py"))
SECONDS = "3"
"""Of training: the page's picture is of a minute."""


def test_there_are_eight_and_the_page_has_them() -> None:
    page = (GALLERY / "README.md").read_text()
    assert len(SCRIPTS) == 8
    for script in SCRIPTS:
        assert f"]({script}.py)" in page and f"]({script}.png)" in page, script


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_makes_its_picture(script: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    arguments = [SECONDS] if script == "residual" else []
    done = subprocess.run(
        [sys.executable, str(GALLERY / f"{script}.py"), str(tmp_path), *arguments],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MPLBACKEND": "agg"},
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip(), "it says what it found"
    # A picture has something in it.
    assert (tmp_path / f"{script}.png").stat().st_size > 20_000
