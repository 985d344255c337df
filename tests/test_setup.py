"""scripts/setup.sh installs what a target needs once, and makes anew what was left half made. pip is not asked here."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PYTHON = """\
#!/bin/sh
case "$*" in
    "-m venv --clear .venv") rm -rf .venv; mkdir -p .venv/bin; cp python .venv/bin/python; echo venv >>log ;;
    *"pip install"*) shift 2; echo "$*" >>log; touch .venv/bin/chatrobot; chmod +x .venv/bin/chatrobot; eval "$PIP" ;;
esac
"""
"""Stands for Python: it notes which environments it made and what pip was to install, then does `$PIP`."""
QUIETLY = "install --quiet --disable-pip-version-check"
RUN, ALL = f"{QUIETLY} -e .[web,record]", f"{QUIETLY} -e .[dev]"


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    (tmp_path / "scripts").mkdir()
    for name in ("pyproject.toml", "requirements.lock", "scripts/setup.sh"):
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "python").write_text(PYTHON)
    (tmp_path / "python").chmod(0o755)
    return tmp_path


def set_up(checkout: Path, *extras: str, pip: str = "true", ci: str = "") -> tuple[int, list[str]]:
    """How the script ended, and what it let Python do."""
    (checkout / "log").write_text("")
    environment = {**os.environ, "PYTHON": str(checkout / "python"), "PIP": pip, "CI": ci}
    done = subprocess.run(
        [checkout / "scripts/setup.sh", *extras],
        cwd=checkout,
        env=environment,
        capture_output=True,
        timeout=60,
    )
    return done.returncode, (checkout / "log").read_text().splitlines()


def test_a_target_installs_what_is_missing_once_and_keeps_what_is_there(checkout: Path) -> None:
    assert set_up(checkout, "web,record") == (0, ["venv", RUN])
    assert set_up(checkout, "web,record") == (0, [])
    assert set_up(checkout) == (0, [ALL])
    assert set_up(checkout) == set_up(checkout, "web,record") == (0, [])


def test_what_changed_is_installed_and_where_it_is_ci_the_lock_file_rules(checkout: Path) -> None:
    set_up(checkout)
    with (checkout / "pyproject.toml").open("a") as file:
        file.write("\n")
    assert set_up(checkout, "web,record") == (0, [RUN])
    assert set_up(checkout) == (0, [ALL])
    assert set_up(checkout, ci="true") == (0, [ALL.replace("-e", "-c requirements.lock -e")])


def test_an_environment_that_was_left_half_made_is_made_anew(checkout: Path) -> None:
    set_up(checkout, "web,record")
    # Ctrl-C reaches both: pip ends with an error, the script hears of it.
    assert set_up(checkout, pip="kill -INT $PPID; false") == (130, [ALL])
    assert set_up(checkout, "web,record") == (0, ["venv", RUN])


def test_where_pip_could_install_nothing_what_was_there_still_serves(checkout: Path) -> None:
    assert set_up(checkout, pip="false")[0] == 1
    assert set_up(checkout, "web,record") == (0, ["venv", RUN])
    assert set_up(checkout, pip="false") == (1, [ALL])
    assert set_up(checkout, "web,record") == (0, [])
