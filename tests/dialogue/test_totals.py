"""How far of how much: the total is that of the whole plan, and what has no known end has none."""

from __future__ import annotations

import io
from pathlib import Path
from unittest.mock import patch

import pytest
from tests.dialogue.scripted_model import ModelTalk
from tests.dialogue.talk import Talk
from tests.link.link_rigs import SimulatedRig, events_until, finished, send_plan
from tests.motion.test_stream import stream, wait_s

from chatrobot.cli.human import HumanPrinter
from chatrobot.cli.json_lines import Output
from chatrobot.core.events import Finished, Progress, Rehearsed, Started
from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.dialogue.observations import measured


def stopped_at(text: str, driven_m: float) -> tuple[str, float, float]:
    """The reply, the way that was rehearsed, and the way that was driven until the stop."""
    talk = Talk()
    talk.session.say(text)
    talk.pump_until(lambda: talk.session.understanding._state.path_m > driven_m)
    talk.session.stop("test")
    talk.pump_until(lambda: 1 in talk.results())
    (rehearsed,) = [event for event in talk.events if isinstance(event, Rehearsed)]
    return talk.results()[1].reply, rehearsed.length_m, talk.results()[1].path_m


@pytest.mark.parametrize(
    "text",
    [
        "forward 4 m",
        "forward 2 m, turn left 90 degrees, forward 2.47 m",
        "drive a square with sides of 1 m",
        "drive in a circle with a radius of 50 cm",
        "turn left 90 degrees, wait 2 s, then forward 3 m",
    ],
)
def test_the_total_after_a_stop_is_the_whole_way(text: str) -> None:
    reply, planned_m, path_m = stopped_at(text, 1.0)
    assert path_m < planned_m - 0.5
    assert f"drove {path_m:.2f} m of {planned_m:.2f} m" in reply


def test_the_total_after_a_fault_is_the_whole_way() -> None:
    reply = (
        Talk(sim="stuck_after_m=0.5,blocked=stall").session.do("forward 1 m, turn left, forward 2 m").reply
    )
    assert " of 3.00 m" in reply


def test_a_condition_that_came_true_is_no_rest() -> None:
    rig = SimulatedRig(Path())
    send_plan(rig, 1, "drive 0.5 m")
    end = finished(rig, 1)
    assert (end.planned_m, end.open_ended) == (pytest.approx(0.5), False)


def test_a_way_up_to_an_obstacle_that_nobody_knows_has_no_total() -> None:
    talk = Talk()
    talk.session.say("drive forward until a wall is within 50 cm")
    talk.pump_until(
        lambda: any(isinstance(event, Progress) and event.pose.x_m > 1.0 for event in talk.events)
    )
    talk.session.stop("test")
    talk.pump_until(lambda: 1 in talk.results())
    result = talk.results()[1]
    assert result.reply.endswith(f"So far: drove {result.path_m:.2f} m.")
    assert {event.fraction for event in talk.events if isinstance(event, Progress)} == {None}


def test_a_way_up_to_an_obstacle_that_is_known_has_one() -> None:
    talk = Talk(world="home")
    talk.session.do("drive forward until a wall is within 50 cm")
    assert None not in {event.fraction for event in talk.events if isinstance(event, Progress)}


def test_a_plan_that_is_still_coming_in_has_no_share_and_then_one() -> None:
    rig = SimulatedRig(Path())
    stream(rig, 1, "drive 1 m", close=False)
    open_shares = {event.fraction for event in wait_s(rig, 1.0) if isinstance(event, Progress)}
    send_plan(rig, 1, "drive 2 m", "extend", more=False)
    events_until(rig, lambda event: isinstance(event, Progress) and event.fraction is not None)
    rig.link.send("stop", 1, why="test")
    end = finished(rig, 1)
    assert open_shares == {None}
    assert (end.planned_m, end.open_ended) == (pytest.approx(3.0, abs=0.01), False)


def test_a_plan_that_was_still_coming_in_when_it_was_stopped_has_no_total() -> None:
    rig = SimulatedRig(Path())
    stream(rig, 1, "drive 2 m", close=False)
    wait_s(rig, 1.0)
    rig.link.send("stop", 1, why="test")
    end = finished(rig, 1)
    assert end.open_ended
    assert measured(end).startswith(f"drove {end.path_m:.2f} m, turned")


def test_a_models_runs_are_summed() -> None:
    model = ModelTalk("drive 0.5 m\nlook pose", "drive 0.3 m")
    assert "drove 0.80 m of 0.80 m" in model.do("please do something nice").reply


def status(fraction: float | None, driven_m: float) -> str:
    printer, told = HumanPrinter(Output()), io.StringIO()
    told.isatty = lambda: True  # type: ignore[method-assign]
    with patch("sys.stderr", told), patch.dict("os.environ", TERM="xterm"):
        printer.show(Rehearsed(1, True, 60.0, 6.0, ORIGIN), "en")
        printer.show(Started(1), "en")
        printer.show(Progress(1, 1, 1, fraction, Pose(driven_m), Twist(0.3)), "en")
    return told.getvalue().rpartition("\x1b[K")[2]


def test_a_person_sees_a_total_only_where_there_is_one() -> None:
    assert "3.00 / 6.00 m" in status(0.5, 3.0)
    assert "50%" in status(0.5, 3.0)
    assert status(None, 35.01).split() == ["35.01", "m", "0°"]


def test_the_way_of_the_whole_plan_is_in_the_event_too() -> None:
    rig = SimulatedRig(Path())
    send_plan(rig, 1, "drive 4 m")
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 1.0)
    rig.link.send("stop", 1, why="test")
    end = events_until(rig, lambda event: isinstance(event, Finished))[-1]
    assert isinstance(end, Finished)
    assert end.planned_m == pytest.approx(4.0, abs=0.001)
