"""docs/testing.md is a package of a third party: its tests pass with nothing of tests/ in reach."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "testing.md").read_text(encoding="utf-8")
FILES = dict(re.findall(r"^`([\w./]+)`(?:.(?!\n\n))*:\n\n```\w+\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE))


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """The folder of the page's package, as an installer leaves it."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (copied,) = re.findall(
        r"`(acme/robots/\w+\.toml)` is a copy of \[`(\w+\.toml)`\]\(\.\./([\w/.]+)\)", PAGE
    )
    (tmp_path / copied[0]).parent.mkdir()
    shutil.copy(ROOT / copied[2], tmp_path / copied[0])
    told = tomllib.loads(FILES["pyproject.toml"])
    project, data = told["project"], told["tool"]["setuptools"]["package-data"]
    assert copied[0] in {
        str(file.relative_to(tmp_path))
        for name, patterns in data.items()
        for pattern in patterns
        for file in (tmp_path / name.replace(".", "/")).glob(pattern)
    }, "an installer would leave the profile out"
    metadata = tmp_path / f"{project['name']}-{project['version']}.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n", encoding="utf-8"
    )
    groups = project["entry-points"].items()
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in named.items()) for group, named in groups]
    (metadata / "entry_points.txt").write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


def pytest_run(package: Path) -> subprocess.CompletedProcess[str]:
    """Run pytest there as its authors do."""
    (package / "conftest.py").write_text(
        "import importlib.util\n"
        'assert not any(map(importlib.util.find_spec, ("tests", "bench", "scripts"))), "our own tests are in reach"\n',
        encoding="utf-8",
    )
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST_", "CHATROBOT_"))}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"],
        cwd=package,
        env={**kept, "PYTHONPATH": str(package), "XDG_CONFIG_HOME": str(package / "config")},
        capture_output=True,
        text=True,
        timeout=120.0,
    )


@pytest.mark.slow
def test_a_package_with_a_robot_a_primitive_and_a_wire_is_tested_with_the_kit_alone(package: Path) -> None:
    run = pytest_run(package)
    assert run.returncode == 0, run.stdout + run.stderr
    assert re.search(r"^\d\d passed in", run.stdout, re.MULTILINE), run.stdout


WRONG = [
    ("acme/robots/acme_cart.toml", "deceleration_mps2 = { value = 0.3", "deceleration_mps2 = { value = 0.02"),
    ("acme/wiggle.py", '"wiggle {step.times}"', '"wiggle 1"'),
    ("acme/wire.py", "if wanted == topic and", "if"),
]
"""A robot that brakes too late, a line that loses its number, a wire that mixes topics."""
FAILED = (
    "TestAcmeCart::test_it_can_brake",
    "TestWiggle::test_its_examples_are_read",
    "TestAcmeWire::test_another_topic_or_type_is_not",
)


@pytest.mark.slow
def test_the_contracts_find_what_is_wrong(package: Path) -> None:
    for file, right, wrong in WRONG:
        text = (package / file).read_text(encoding="utf-8")
        assert right in text
        (package / file).write_text(text.replace(right, wrong, 1), encoding="utf-8")
    run = pytest_run(package)
    assert run.returncode == 1
    for failed in FAILED:
        assert f"FAILED test_acme.py::{failed}" in run.stdout


def test_the_plug_in_loads_nothing_of_the_robot_before_a_fixture_is_asked_for() -> None:
    code = (
        "import sys, chatrobot.testing.plugin\nprint(*(n for n in sys.modules if n.startswith('chatrobot')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == {"chatrobot", "chatrobot.testing", "chatrobot.testing.plugin"}
