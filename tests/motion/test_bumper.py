"""A robot that bumps into something stops, says so, and moves no more while it touches."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.link.link_rigs import PROFILE, SimulatedRig, finished, moving, send_plan

from chatrobot.link.in_process import InProcessLink
from chatrobot.robots.load import load_profile
from chatrobot.wire.messages import Flag


@pytest.fixture
def rig(tmp_path: Path) -> SimulatedRig:
    profile = load_profile(PROFILE)
    return SimulatedRig(
        tmp_path, profile=replace(profile, wiring=replace(profile.wiring, bumper_topic="bump"))
    )


def test_a_robot_that_bumps_into_something_stops_and_says_so(rig: SimulatedRig) -> None:
    send_plan(rig, 1, "drive 5 m")
    send_plan(rig, 2, "drive 1 m")
    moving(rig, 1)
    rig.hub.connect().publish("bump", Flag(True))
    assert isinstance(rig.link, InProcessLink)
    rig.link.step()
    assert not any(rig.velocities[-1]), "the very next tick sends a zero"
    ended = finished(rig, 1)
    assert ended.outcome == "failed"
    assert ended.reason is not None
    assert ended.reason.code == "bumped"
    assert finished(rig, 2).outcome == "stopped", "what waited is not begun against the wall"


def test_nothing_begins_to_move_while_it_touches(rig: SimulatedRig) -> None:
    bumper = rig.hub.connect()
    bumper.publish("bump", Flag(True))
    send_plan(rig, 1, "drive 1 m")
    assert finished(rig, 1).outcome == "failed"
    assert not any(any(velocity) for velocity in rig.velocities)
    bumper.publish("bump", Flag(False))
    send_plan(rig, 2, "drive 0.1 m")
    assert finished(rig, 2).outcome == "completed"
