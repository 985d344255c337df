"""Control between foreign text and plans of ours: who gives way, and what was said before a stop."""

from __future__ import annotations

from typing import Any

from chatrobot.link.envelope import Envelope
from chatrobot.link.motion_link import Sender
from chatrobot.nodes.control import ControlNode
from chatrobot.nodes.foreign import Foreign
from chatrobot.wire.messages import Text


class Runner:
    """What control and the judge of foreign text see of Motion."""

    def __init__(self) -> None:
        self.received: list[tuple[Envelope, int | None]] = []
        self.notices: list[str] = []
        self.stops = 0

    @property
    def motion(self) -> Runner:
        return self

    def receive(self, envelope: Envelope, said_in_epoch: int | None = None) -> None:
        self.received.append((envelope, said_in_epoch))

    def notice(self, reason: Any) -> None:
        self.notices.append(reason.code)

    def in_background(self, goal: Any) -> None:
        goal()


def control_with(runner: Any, foreign: Foreign) -> ControlNode:
    """Without its wire."""
    control = object.__new__(ControlNode)
    control._runner, control._foreign, control._ours, control._is_leaving = runner, foreign, set(), False
    return control


def test_the_next_part_of_our_plan_stays_a_part_of_it_while_foreign_text_gives_way() -> None:
    runner: Any = Runner()
    foreign = Foreign(runner, lambda: False)
    control = control_with(runner, foreign)
    foreign.hear("drive 1 m")
    assert foreign.has_work
    base = Sender("base")
    for plan_text, mode in (("turn left 90 deg", "queue"), ("drive 1 m", "extend")):
        envelope = base.envelope("plan", 1, plan_text=plan_text, mode=mode, more=True)
        control._hear(Text(envelope.to_bytes().decode()))
    modes = [envelope.payload["mode"] for envelope, _ in runner.received if envelope.source == "base"]
    assert modes == ["replace", "extend"], "the foreign text is replaced, the turn to the left is not"


def test_nobody_changes_the_motion_budget_over_topics_whatever_the_source_is_called() -> None:
    runner: Any = Runner()
    control = control_with(runner, Foreign(runner, lambda: False))
    for source in ("console", "base", "agent"):
        envelope = Sender(source).envelope("limit", max_distance_m="none")
        control._hear(Text(envelope.to_bytes().decode()))
    assert runner.received == []
    assert runner.notices == ["limit_refused_here"] * 3


def test_foreign_text_of_before_a_stop_belongs_to_before_it() -> None:
    runner: Any = Runner()
    runner.stops = 7
    Foreign(runner, lambda: False).hear("drive 1 m")
    ((_, _), (plan, said_in_epoch)) = runner.received
    assert (plan.word, said_in_epoch) == ("plan", 7)
