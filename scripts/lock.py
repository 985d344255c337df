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
    requirements = _requirements()
    pins: dict[str, dict[str, str]] = {}
    for python in PYTHONS:
        backports = BACKPORTS if python == "3.10" else ()
        for name, version in _resolve([*requirements, *backports], python).items():
            pins.setdefault(name, {})[python] = version
    lines = [line for name in sorted(pins) for line in _lines(name, pins[name])]
    (ROOT / "requirements.lock").write_text(HEADER + "\n".join(lines) + "\n", encoding="utf-8")
    print(f"requirements.lock: {len(pins)} packages for Python {PYTHONS[0]} to {PYTHONS[-1]}")
    return 0


def _requirements() -> list[str]:
    """All that `.[dev]` and the build ask for."""
    data = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project: dict[str, Any] = data["project"]
    asked = [
        *project["dependencies"],
        *project["optional-dependencies"]["dev"],
        *data["build-system"]["requires"],
    ]
    return [requirement for requirement in asked if "python_version" not in requirement]


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
