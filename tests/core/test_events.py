"""Events survive the joint: JSON and back."""

from __future__ import annotations

import json

import pytest

from chatrobot.core.events import (
    EXIT_CODES,
    Event,
    FindingSeen,
    Finished,
    Limited,
    ProgramLog,
    ProgramRehearsed,
    ProgramWritten,
    Rehearsed,
    event_from_json,
)
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason

EVENTS: list[Event] = [
    Rehearsed(
        1,
        True,
        2.5,
        1.0,
        Pose(1.0, 0.0, 0.5),
        (FindingSeen(1, "note", Reason("limited", {"asked_mps": 2.0}), (1, 2), 0.5),),
        ((0.0, 0.0, 0.0), (1.0, 0.0, 0.5)),
    ),
    ProgramWritten(
        1,
        "square",
        "model",
        "pass\n",
        version=2,
        diff="-x",
        marks=(FindingSeen(1, "warn", Reason("no_init"), (3,)),),
    ),
    ProgramRehearsed(1, "square", "raised", 0.2, 1.0, False, "ValueError", 7, ("[INFO] hello",)),
    ProgramLog(1, 0.5, "INFO", "hello"),
    Limited(2, "speed", Twist(99.0, 0.0, 0.0), Twist(1.0, 0.0, 0.0)),
    Finished(3, "stopped", Reason("stopped"), Pose(), Pose(0.5, 0.0, 0.0), 0.0, 0.5, 2.0, 0.0),
    Finished(3, "completed", None, Pose(), Pose(0.5, 0.0, 0.0), 0.0, 0.5, 2.0, 0.0),
]


@pytest.mark.parametrize("event", EVENTS, ids=lambda event: f"{event.name}-{event.turn}")
def test_an_event_survives_the_joint(event: Event) -> None:
    assert event_from_json(json.loads(json.dumps(event.to_json()))) == event


def test_numbers_carry_their_units_in_their_keys() -> None:
    assert EVENTS[4].to_json()["sent"] == {"vx_mps": 1.0, "vy_mps": 0.0, "wz_radps": 0.0}


@pytest.mark.parametrize(
    "data", [{}, {"event": "nonsense"}, {"event": "limited"}, {"event": "said", "what": 1}]
)
def test_what_is_no_event_of_ours_is_a_value_error(data: dict[str, object]) -> None:
    with pytest.raises(ValueError):
        event_from_json(data)


def test_every_outcome_has_the_exit_code_of_the_design() -> None:
    assert dict(EXIT_CODES) == {
        "completed": 0, "answered": 0, "failed": 1, "unclear": 3, "refused": 4, "stopped": 5,
    }  # fmt: skip


def test_no_value_of_a_reason_hides_its_code() -> None:
    with pytest.raises(ValueError, match="code"):
        Reason("program_exit_code", {"code": 3})
