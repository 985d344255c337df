"""One recorded session for all tests of reports."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.report.recorded import session


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return session(tmp_path_factory.mktemp("recorded") / "run.mcap")
