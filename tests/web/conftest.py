"""A web console on loopback, without a token."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.cli.running import chatrobot
from tests.web.rig import WebRig, serving

__all__ = ["chatrobot", "rig"]


@pytest.fixture
def rig() -> Iterator[WebRig]:
    with serving() as rig:
        yield rig
