"""`/limit` at the console: the motion budget is shown and changed by the person who types it there."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.cli.console.commands import read_limits
from chatrobot.core.events import Notice
from chatrobot.core.reason import Reason
from tests.console.fakes import shown, told


def pumped(controller):
    while not controller.pump._jobs.empty():
        controller.pump._jobs.get()()


@pytest.mark.parametrize(
    ("typed", "limits"),
    [
        ("", {}),
        ("200 m", {"max_distance_m": 200.0}),
        ("50 cm", {"max_distance_m": 0.5}),
        ("200m", {"max_distance_m": 200.0}),
        ("1.5 km", {"max_distance_m": 1500.0}),
        ("20 min", {"max_time_s": 1200.0}),
        ("2h 500 M", {"max_time_s": 7200.0, "max_distance_m": 500.0}),
        ("500 m, 900 s", {"max_distance_m": 500.0, "max_time_s": 900.0}),
        ("none", {"max_distance_m": "none", "max_time_s": "none"}),
        ("none m", {"max_distance_m": "none"}),
        ("none s 30 m", {"max_time_s": "none", "max_distance_m": 30.0}),
    ],
)
def test_amounts_are_read_by_their_unit(typed, limits):
    assert read_limits(typed) == limits


@pytest.mark.parametrize(
    "typed",
    ["200", "0 m", "-5 m", "5 m 6 m", "none none", "none 5 m", "5 miles", "m", "all", "5 m or so", "5m6s"],
)
def test_what_is_not_clear_changes_nothing(typed, controller, log):
    assert read_limits(typed) is None
    controller.enter(f"/limit {typed}")
    pumped(controller)
    assert told(log) == []
    assert "nothing is changed" in shown(log)


@given(st.text())
def test_no_text_breaks_the_reader(text):
    limits = read_limits(text)
    assert limits is None or all(limit == "none" or limit > 0.0 for limit in limits.values())


def test_what_is_typed_goes_to_motion_and_its_answer_is_shown(controller, log):
    controller.enter("/limit 200 m")
    pumped(controller)
    assert ("limit", {"max_distance_m": 200.0}) in log
    controller.hear(Notice(0, Reason("limit_distance", {"max_m": 200.0})))
    assert "may drive 200 m at most" in shown(log)


@pytest.mark.parametrize("pasted", ["/limit none", "/LIMIT none", "/ limit 900 m"])
def test_a_pasted_limit_changes_nothing_and_what_follows_is_not_done(controller, log, pasted):
    controller.enter(f"{pasted}\nforward 500 m")
    pumped(controller)
    assert told(log) == []
    assert "type /limit by itself" in shown(log)
