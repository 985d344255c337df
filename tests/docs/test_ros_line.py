"""The line of docs/ros.md that tests on real ROS works beside ROS's plug-ins, and with nothing but pytest installed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PLUGINS = ("launch_testing", "launch_ros", "launch_pytest")
"""Entry points of ROS's packages launch_testing, launch_testing_ros and launch_pytest."""
OLD_HOOK = "def pytest_pycollect_makemodule(path, parent):\n    return None\n"
"""As ROS 2 Jazzy's launch_testing has it: pytest 9 knows no `path` there."""


@pytest.fixture
def ros(tmp_path: Path) -> Path:
    """A folder for PYTHONPATH with ROS's plug-ins of pytest, and without hypothesis."""
    (tmp_path / "hypothesis.py").write_text("raise ImportError('it is not installed')\n")
    for plugin in PLUGINS:
        (tmp_path / f"{plugin}_hooks.py").write_text(OLD_HOOK)
        about = tmp_path / f"{plugin}-3.4.6.dist-info"
        about.mkdir()
        (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {plugin}\nVersion: 3.4.6\n")
        (about / "entry_points.txt").write_text(f"[pytest11]\n{plugin} = {plugin}_hooks\n")
    return tmp_path


def collect(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    paths = os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH", ""))))
    return subprocess.run(
        # Where there is no ROS its tests are left out; the other file has some that need nothing.
        [sys.executable, "-m", "pytest", *options, "tests/ros", "tests/test_layers.py", "--collect-only"],
        cwd=ROOT,
        env={**kept, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_the_line_works_beside_ros_s_plug_ins(ros: Path) -> None:
    done = collect(ros, "-p", "no:hypothesispytest")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.skipif(pytest.version_tuple < (9,), reason="older ones take these hooks")
def test_without_our_options_they_would_stop_every_test(ros: Path) -> None:
    done = collect(ros, "-p", "no:hypothesispytest", "-o", "addopts=")
    assert done.returncode != 0
    assert "pytest_pycollect_makemodule" in done.stdout + done.stderr


def test_the_page_tells_that_line() -> None:
    page = (ROOT / "docs" / "ros.md").read_text(encoding="utf-8")
    assert "python -m pytest tests/ros" in page
