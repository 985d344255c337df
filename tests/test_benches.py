"""The measurements and tools that the suite does not run can at least be started."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MODULES = sorted(
    f"{folder}.{file.stem}" for folder in ("bench", "scripts") for file in (ROOT / folder).glob("*.py")
)
NEEDS = {"gguf"}
"""Packages that only a tool needs which is not run here (`make try-llamacpp`)."""


@pytest.mark.parametrize("name", MODULES)
def test_what_it_imports_is_there(name: str) -> None:
    try:
        importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name not in NEEDS:
            raise
