"""One warm server for all tests of programs."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from chatrobot.programs.sandboxed import warm_server
from chatrobot.sandbox.warm_server import WarmServer


@pytest.fixture(scope="session")
def server() -> Iterator[WarmServer]:
    with warm_server() as warm:
        warm.start()
        yield warm
