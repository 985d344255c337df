"""One warm server for all tests of programs."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from chatrobot.box.warm_server import WarmServer
from chatrobot.programs.boxed import warm_server


@pytest.fixture(scope="session")
def server() -> Iterator[WarmServer]:
    with warm_server() as warm:
        warm.start()
        yield warm
