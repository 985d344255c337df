"""An order that is refused ends nothing: it is tried before what is driven stops for it."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from tests.dialogue.undo_rig import UndoRig, on_its_way_to, said

from chatrobot.core.events import Finished, Started
from chatrobot.motion import plan_rehearsal

REFUSED = "drive a circle with radius 5 metres"


@pytest.fixture
def rig() -> UndoRig:
    """On its way to the sofa."""
    return on_its_way_to("sofa")


@pytest.mark.parametrize(
    ("order", "goes_on"),
    [
        (REFUSED, "“go to the sofa” goes on."),
        ("前进20米", "“go to the sofa”继续进行。"),
        ("fahr 20 m vor", "„go to the sofa“ läuft weiter."),
    ],
)
def test_the_drive_goes_on_where_a_new_order_is_refused(rig: UndoRig, order: str, goes_on: str) -> None:
    result = rig.session.results[said(rig, order, 0.3)]
    assert rig.speed_mps > 0.2
    assert (result.outcome, result.proposal) == ("refused", None)
    assert result.reply.endswith(goes_on)
    rig.live(10.0)
    assert rig.session.results[1].outcome == "completed"


def test_an_order_that_is_possible_takes_its_place(rig: UndoRig) -> None:
    turn = said(rig, "turn left 90", 10.0)
    assert [rig.session.results[each].outcome for each in (1, turn)] == ["stopped", "completed"]


def test_what_waits_goes_on_waiting_where_a_new_order_is_refused(rig: UndoRig) -> None:
    waits = said(rig, "and then turn left 90", 0.2)
    said(rig, REFUSED, 20.0)
    assert [rig.session.results[each].outcome for each in (1, waits)] == ["completed", "completed"]


def test_what_was_done_before_can_still_be_undone(rig: UndoRig) -> None:
    said(rig, REFUSED, 10.0)
    rig.do("undo")
    assert abs(rig.x_m) < 0.03


def test_a_stop_while_an_order_is_tried_ends_both(rig: UndoRig, monkeypatch: pytest.MonkeyPatch) -> None:
    held = hold_rehearsals(rig, monkeypatch)
    turn = said(rig, REFUSED, 0.1)
    said(rig, "stop", 1.0)
    for work in held:
        work()
    rig.live(1.0)
    assert rig.session.results[1].outcome == "stopped"
    assert rig.session.results[turn].outcome == "stopped"
    assert not rig.session.is_moving


def test_what_follows_an_order_that_is_tried_comes_after_it(
    rig: UndoRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        hold_rehearsals(rig, patch)
        first = said(rig, "turn left 90", 0.1)
        second = said(rig, "and then turn right 30", 0.1)
    rig.live(20.0)
    began = [event.turn for event in rig.events if isinstance(event, Started)]
    assert began == [1, first, second]


def test_an_order_whose_trial_takes_too_long_takes_its_place_untried(
    rig: UndoRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        hold_rehearsals(rig, patch)
        turn = said(rig, "turn left 90", plan_rehearsal.LONGEST_TRIAL_S + 0.1)
    rig.live(10.0)
    assert [rig.session.results[each].outcome for each in (1, turn)] == ["stopped", "completed"]


def test_an_order_that_is_tried_can_be_cancelled_alone(rig: UndoRig, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        hold_rehearsals(rig, patch)
        turn = said(rig, "turn left 90", 0.1)
        rig.session._goals.cancel(turn)
        rig.live(0.1)
    rig.live(10.0)
    assert [rig.session.results[each].outcome for each in (1, turn)] == ["completed", "stopped"]


def test_where_a_paused_drive_has_ended_for_a_refused_order_go_on_asks_for_its_rest(rig: UndoRig) -> None:
    rig.session.pause()
    rig.live(2.0)
    refused = rig.session.results[said(rig, REFUSED)]
    assert "Say “go on” for the rest of what was under way." in refused.reply
    asked = rig.session.results[said(rig, "go on")]
    assert asked.proposal is not None
    assert "sofa" in asked.proposal.plan_text


def test_a_trial_tells_one_end_of_each_turn(rig: UndoRig) -> None:
    said(rig, REFUSED, 10.0)
    assert [event.turn for event in rig.events if isinstance(event, Finished)] == [2, 1]


def hold_rehearsals(rig: UndoRig, monkeypatch: pytest.MonkeyPatch) -> list[Callable[[], None]]:
    """From now on nothing is rehearsed; what is to be done for it is returned."""
    held: list[Callable[[], None]] = []
    monkeypatch.setattr(rig.motion._inbox, "_background", held.append)
    return held
