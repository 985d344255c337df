"""Writes requirements.lock: the versions that continuous integration installs, for every Python we support.

pip resolves the same requirements once for each Python; where the answers differ, lines carry a marker. The file
constrains (`pip install -c`), it requires nothing.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parent.parent
PYTHONS = ("3.10", "3.11", "3.12", "3.13", "3.14")
BACKPORTS = ("exceptiongroup", "tomli", "anthropic<2")
"""Needed before 3.11 only: pip judges markers by the Python it runs on, and would leave them out."""
HEADER = """\
# What continuous integration installs (pip install -c). Written by `make lock`; do not edit.
"""


def main() -> int:
    pins: dict[str, dict[str, str]] = {}
    for python in PYTHONS:
        backports = BACKPORTS if python == "3.10" else ()
        for name, version in _resolve([*_requirements(python), *backports], python).items():
            pins.setdefault(name, {})[python] = version
    lines = [line for name in sorted(pins) for line in _lines(name, pins[name])]
    (ROOT / "requirements.lock").write_text(HEADER + "\n".join(lines) + "\n", encoding="utf-8")
    print(f"requirements.lock: {len(pins)} packages for Python {PYTHONS[0]} to {PYTHONS[-1]}")
    return 0


def _requirements(python: str) -> list[str]:
    """All that `.[dev]` and the build ask for on that Python, without markers: pip judges them by its own Python."""
    data = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project: dict[str, Any] = data["project"]
    asked = [*project["dependencies"], *_extra(project, "dev"), *data["build-system"]["requires"]]
    wanted = []
    for requirement in map(Requirement, asked):
        if requirement.marker is None or requirement.marker.evaluate({"python_version": python}):
            requirement.marker = None
            wanted.append(str(requirement))
    return wanted


def _extra(project: dict[str, Any], name: str) -> list[str]:
    """What an extra asks for; an extra of ours within it is what that one asks for."""
    asked: list[str] = []
    for line in project["optional-dependencies"][name]:
        requirement = Requirement(line)
        ours = requirement.name == project["name"]
        asked += (
            [inner for extra in requirement.extras for inner in _extra(project, extra)] if ours else [line]
        )
    return asked


def _resolve(requirements: list[str], python: str) -> dict[str, str]:
    """Name to version of everything that would be installed for that Python."""
    with tempfile.TemporaryDirectory() as target:
        done = subprocess.run(
            [
                *(sys.executable, "-m", "pip", "install", "--dry-run", "--ignore-installed", "--quiet"),
                *("--report", "-", "--python-version", python, "--only-binary=:all:", "--target", target),
                *requirements,
            ],
            check=True,
            capture_output=True,
            text=True,
        )
    installed = json.loads(done.stdout)["install"]
    return {
        item["metadata"]["name"].lower().replace("_", "-"): item["metadata"]["version"] for item in installed
    }


def _lines(name: str, versions: dict[str, str]) -> list[str]:
    """One line where one version serves all Pythons that need the package, else one a Python."""
    if len(set(versions.values())) == 1:
        return [f"{name}=={next(iter(versions.values()))}"]
    return [f'{name}=={version} ; python_version == "{python}"' for python, version in versions.items()]


if __name__ == "__main__":
    sys.exit(main())
