"""The pytest plug-in (entry point `pytest11`): its fixtures. It loads nothing of ChatRobot before one is asked for."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from chatrobot.api import Robot
    from chatrobot.testing.rig import RecordingWire

pytest.register_assert_rewrite("chatrobot.testing.contracts", "chatrobot.testing.wire_contract")


@pytest.fixture
def simulated_robot() -> Iterator[Callable[..., Robot]]:
    """Connect to a simulated robot on simulated time, by default in the empty world; it is closed after the test.

    Takes the options of `chatrobot.connect`: `simulated_robot(robot="my_robot").do("forward 1 m")`.
    """
    from chatrobot.api import connect

    with contextlib.ExitStack() as robots:
        yield lambda **options: robots.enter_context(connect(**{"fast": True, "world": "empty", **options}))


@pytest.fixture
def recording_wire() -> RecordingWire:
    """One end of a wire within this process that keeps what is published through it."""
    from chatrobot.testing.rig import RecordingWire
    from chatrobot.wire.memory import MemoryHub

    return RecordingWire(MemoryHub().connect())
