"""What goes wrong in one pupil's conversation ends that one alone; a Motion that is gone ends the class."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from chatrobot.core.errors import LinkError
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.web.access import Access
from chatrobot.web.classroom import Classroom
from chatrobot.web.pupils import PupilsRobot
from tests.web.rig import NotingSession

PATIENCE_S = 10.0


class Pumped(NotingSession):
    """A session that is pumped until it raises."""

    raises: Exception | None = None

    def pump(self, longest_s: float) -> None:
        time.sleep(min(longest_s, 0.01))
        if self.raises is not None:
            raise self.raises


def robot(name: str) -> PupilsRobot:
    connection: Any = SimpleNamespace(
        session=Pumped(),
        profile=load_profile("wheeltec_mini_mec"),
        world=load_world("empty"),
        camera=None,
        close=lambda: None,
    )
    return PupilsRobot(name, connection, Path())


def opened(gone: list[Exception]) -> tuple[Classroom, list[Any]]:
    classroom = Classroom(2, Access("127.0.0.1", needs_token=True))
    robots = [robot(name) for name in classroom.rooms]
    classroom.open(robots, gone.append)
    return classroom, [one.connection.session for one in robots]


def gone_pupils(classroom: Classroom) -> list[bool]:
    return [seat.facts()["gone"] for seat in classroom.seats.values()]


def test_a_mistake_in_one_conversation_stops_that_robot_and_leaves_the_others(
    capsys: pytest.CaptureFixture[str],
) -> None:
    gone: list[Exception] = []
    classroom, (broken, other) = opened(gone)
    broken.raises = KeyError("of a program")
    broken.wait_for("stop", "the conversation has ended")
    assert gone_pupils(classroom) == [True, False]
    assert (gone, other.log) == ([], [])
    assert "KeyError" in capsys.readouterr().err, "whoever runs the class can report it"
    classroom.close()


def test_a_motion_that_is_gone_is_gone_for_all() -> None:
    gone: list[Exception] = []
    classroom, sessions = opened(gone)
    sessions[0].raises = LinkError("Motion is gone")
    ends_s = time.monotonic() + PATIENCE_S
    while not gone and time.monotonic() < ends_s:
        time.sleep(0.01)
    assert [str(error) for error in gone] == ["Motion is gone"]
    classroom.close()
