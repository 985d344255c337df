"""What a model is told of the robot is what the robot has said, and never a default."""

from __future__ import annotations

import math

from chatrobot.core.geometry import Pose
from chatrobot.dialogue.llm.prompt import request
from chatrobot.dialogue.observations import observation

PLACES = {"dock": Pose(1.0, 2.0, math.pi)}


def test_a_model_is_told_where_the_robot_is_and_what_places_there_are() -> None:
    said = request("go on", Pose(0.5, -1.25, math.pi / 2), PLACES)
    assert said.splitlines() == [
        'data: places, X Y heading: "dock" 1.00 2.00 180 deg',
        "data: the robot is at 0.50 -1.25, heading 90 deg",
        "The person says: go on",
    ]


def test_where_the_robot_has_not_said_where_it_is_no_model_is_told_zeros() -> None:
    unknown = "data: where the robot is, is not known"
    assert unknown in request("go on", None, {}).splitlines()
    looked = observation(("pose",), pose=None, places={}, looked=None, finished=None, take=lambda: None)
    assert looked.text.splitlines()[0] == unknown
