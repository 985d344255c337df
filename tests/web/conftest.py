"""A web console on loopback, without a token."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.web.rig import WebRig, serving


@pytest.fixture
def rig() -> Iterator[WebRig]:
    with serving() as rig:
        yield rig
