"""What is said of orders and steps that have not begun, while the robot drives, changes those alone."""

from __future__ import annotations

import math

import pytest
from tests.dialogue.undo_rig import UndoRig

from chatrobot.dialogue.options import Options
from chatrobot.dialogue.resuming import UnderWay

DRIVE_AND_TURN = ("drive 2 m", "then turn left 30")
THREE_STEPS = "drive 2 m, turn left 90, drive 1 m"


@pytest.fixture
def rig() -> UndoRig:
    return UndoRig("empty", None, Options(while_moving="replace"))


def said_while_driving(rig: UndoRig, *orders: str, said: str) -> tuple[list[int], int]:
    """Say the orders, two seconds apart, and then that; return the numbers of their turns."""
    turns = []
    for order in orders:
        turns.append(rig.session.say(order))
        rig.live(2.0)
    turn = rig.session.say(said)
    rig.live(40.0)
    return turns, turn


def outcomes(rig: UndoRig, turns: list[int]) -> list[str]:
    return [rig.session.results[turn].outcome for turn in turns]


def ends_at(rig: UndoRig, x_m: float, y_m: float, yaw_deg: float) -> None:
    pose = rig.pose
    assert (pose.x_m, pose.y_m) == pytest.approx((x_m, y_m), abs=0.03)
    assert math.degrees(pose.yaw_rad) == pytest.approx(yaw_deg, abs=2.0)


@pytest.mark.parametrize(
    ("orders", "said", "yaw_deg"),
    [
        (DRIVE_AND_TURN, "no, 40", 40.0),
        (DRIVE_AND_TURN, "not left, right", -30.0),
        (DRIVE_AND_TURN, "make it 45", 45.0),
        (DRIVE_AND_TURN, "twice as far", 60.0),
        (("前进2米", "然后左转30度"), "不对，40度", 40.0),
        (("前进2米", "然后左转30度"), "不是左，是右", -30.0),
        (("fahr 2 m", "dann 30 Grad nach links"), "nein, 40", 40.0),
        (("fahr 2 m", "dann 30 Grad nach links"), "nicht links, rechts", -30.0),
    ],
)
def test_a_correction_of_what_waits_leaves_what_runs(
    rig: UndoRig, orders: tuple[str, ...], said: str, yaw_deg: float
) -> None:
    (first, second), turn = said_while_driving(rig, *orders, said=said)
    assert outcomes(rig, [first, second, turn]) == ["completed", "stopped", "completed"]
    ends_at(rig, 2.0, 0.0, yaw_deg)


@pytest.mark.parametrize(
    ("orders", "said"),
    [
        (DRIVE_AND_TURN, "take that back"),
        (DRIVE_AND_TURN, "skip that one"),
        (DRIVE_AND_TURN, "leave out the turn"),
        (DRIVE_AND_TURN, "finish this and stop"),
        (DRIVE_AND_TURN, "forget the rest"),
        (("前进2米", "然后左转30度"), "最后那个不做了"),
        (("前进2米", "然后左转30度"), "做完这个就停"),
        (("fahr 2 m", "dann 30 Grad nach links"), "nimm das zurück"),
        (("fahr 2 m", "dann 30 Grad nach links"), "mach das noch fertig, dann Schluss"),
    ],
)
def test_what_waits_is_taken_back_alone(rig: UndoRig, orders: tuple[str, ...], said: str) -> None:
    (first, second), turn = said_while_driving(rig, *orders, said=said)
    assert outcomes(rig, [first, second, turn]) == ["completed", "stopped", "answered"]
    assert not rig.session.results[second].reply.startswith(("Stopped", "已停下", "Angehalten"))
    ends_at(rig, 2.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("order", "said", "end"),
    [
        (THREE_STEPS, "leave out the turn", (3.0, 0.0, 0.0)),
        (THREE_STEPS, "no, right", (2.0, -1.0, -90.0)),
        (THREE_STEPS, "I mean 45 degrees", (2.707, 0.707, 45.0)),
        (THREE_STEPS, "the last bit only 50 cm", (2.0, 0.5, 90.0)),
        (THREE_STEPS, "without the last step", (2.0, 0.0, 90.0)),
        (THREE_STEPS, "finish this and stop", (2.0, 0.0, 0.0)),
        ("前进2米，左转90度，再前进1米", "跳过转弯", (3.0, 0.0, 0.0)),
        ("前进2米，左转90度，再前进1米", "做完这步就停", (2.0, 0.0, 0.0)),
        ("fahr 2 m, dreh dich 90 Grad nach links, fahr 1 m", "lass den Rest weg", (2.0, 0.0, 0.0)),
    ],
)
def test_a_change_of_steps_to_come_goes_on_from_where_it_is(
    rig: UndoRig, order: str, said: str, end: tuple[float, float, float]
) -> None:
    said_while_driving(rig, order, said=said)
    ends_at(rig, *end)


def test_what_waits_is_still_done_after_a_change_of_what_runs(rig: UndoRig) -> None:
    said_while_driving(rig, THREE_STEPS, "and then turn right 45", said="leave out the left turn")
    ends_at(rig, 3.0, 0.0, -45.0)


def test_orders_keep_their_places_when_one_between_them_changes(rig: UndoRig) -> None:
    said_while_driving(rig, "drive 2 m", "then turn left 30", "then back 50 cm", said="not left, right")
    x_m, y_m = 2.0 - 0.5 * math.cos(math.radians(30.0)), 0.5 * math.sin(math.radians(30.0))
    ends_at(rig, x_m, y_m, -30.0)


def test_what_may_mean_the_step_under_way_stops_it(rig: UndoRig) -> None:
    (first, second), _ = said_while_driving(rig, "turn left 170", "then turn left 30", said="not left, right")
    assert outcomes(rig, [first, second]) == ["stopped", "stopped"]


def test_the_last_two_orders_that_wait_are_taken_back(rig: UndoRig) -> None:
    orders = ("drive 2 m", "then back 1 m", "then turn left")
    turns, turn = said_while_driving(rig, *orders, said="undo the last two")
    assert outcomes(rig, [*turns, turn]) == ["completed", "stopped", "stopped", "answered"]
    ends_at(rig, 2.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "said",
    [
        "turn right 90",
        "ok",
        "good",
        "how long is the table?",
        "thanks",
        "I said 40 to my friend",
        "almost 45 degrees",
    ],
)
def test_an_order_of_its_own_and_a_remark_change_nothing_that_waits(rig: UndoRig, said: str) -> None:
    (_, second), turn = said_while_driving(rig, *DRIVE_AND_TURN, said=said)
    replaced = rig.session.results[turn].outcome == "completed"
    assert outcomes(rig, [second]) == (["stopped"] if replaced else ["completed"])


@pytest.mark.parametrize("said", ["the turn comes now", "only 50 cm left", "the last bit is the hardest"])
def test_a_remark_about_a_step_to_come_changes_nothing(rig: UndoRig, said: str) -> None:
    (first,), _ = said_while_driving(rig, THREE_STEPS, said=said)
    assert outcomes(rig, [first]) == ["completed"]
    ends_at(rig, 2.0, 1.0, 90.0)


def test_a_question_about_the_rest_tells_what_waits_too(rig: UndoRig) -> None:
    _, turn = said_while_driving(rig, *DRIVE_AND_TURN, said="what's left?")
    assert "turn left 30°" in rig.session.results[turn].reply


def test_after_a_stop_the_rest_is_what_was_interrupted_and_what_waited(rig: UndoRig) -> None:
    for order in DRIVE_AND_TURN:
        rig.session.say(order)
        rig.live(2.0)
    rig.session.say("stop")
    rig.live(2.0)
    turn = rig.session.say("go on")
    rig.live(2.0)
    proposal = rig.session.results[turn].proposal
    assert proposal is not None
    assert [line.split()[0] for line in proposal.plan_text.splitlines()] == ["drive", "turn"]


def test_a_step_that_begins_while_it_is_changed_is_not_done_twice(rig: UndoRig) -> None:
    rig.session.say(THREE_STEPS)
    rig.live(2.0)
    with pytest.MonkeyPatch.context() as patch:  # it was in the turn before when the text was read
        rig.live(5.5)
        assert rig.session._resuming.under_way.step_of(1) == 2
        patch.setattr(UnderWay, "step_of", lambda *_: 1)
        turn = rig.session.say("no, right")
        rig.session.pump(0.0)
    rig.live(5.0)
    assert rig.session.results[turn].outcome == "unclear"
    assert rig.session.results[turn].proposal is not None
