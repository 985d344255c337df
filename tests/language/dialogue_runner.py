"""Runs corpus items through the interpreter with an ideal robot: what a session does, without one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from chatrobot.language.context import Context, Dialogue, Place, RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.language.ledger import TurnRecord
from chatrobot.plan.text import format_plan
from tests.language.ideal_motion import Track, judge
from tests.language.profiles import MECANUM

Verdict = Literal["correct", "wrong", "abstained"]
ANSWERS = {"clarify": "unclear", "refuse": "refused", "info": "answered"}


class Conversation:
    """A dialogue with an ideal robot."""

    def __init__(self) -> None:
        self.interpreter = OfflineInterpreter(MECANUM)
        self.track = Track()
        self.dialogue = Dialogue()

    @property
    def context(self) -> Context:
        """What the next turn is said in."""
        state = RobotState(pose=self.track.pose, path_m=self.track.path_m, battery_percent=None)
        return Context(self.dialogue, state)

    def say(self, text: str) -> Interpretation:
        """One turn, done at once."""
        meant = self.interpreter.interpret(text, self.context)
        start = self.track.pose
        if meant.plan is not None:
            trial = Track(pose=start)
            trial.run(meant.plan)
            if trial.too_fast:
                meant = Interpretation("refused", "too fast", meant.language)
        if meant.plan is not None:
            self.track.run(meant.plan)
        self._remember(text, meant, start)
        return meant

    def _remember(self, text: str, meant: Interpretation, start: Any) -> None:
        def called(name: str) -> str:
            return meant.renamed.get(name, name)

        places = {called(name): place for name, place in self.dialogue.places.items() if called(name)}
        words = {called(name): plan for name, plan in self.dialogue.words.items() if called(name)}
        if meant.remember_place:
            places[meant.remember_place] = Place(self.track.pose)
        places.update({name: Place(pose) for name, pose in self.track.places.items()})
        self.track.places.clear()
        outcome: Any = {"plan": "completed", "stop": "stopped"}.get(meant.outcome, meant.outcome)
        record = TurnRecord(
            text,
            outcome,
            meant.plan,
            start,
            self.track.pose,
            executed=meant.plan,
            walk=meant.walk,
            corrects=meant.corrects,
        )
        self.dialogue = Dialogue(
            (*self.dialogue.turns, record),
            places,
            {**words, **meant.define},
            self.dialogue.usual.changed(meant.usual),
            pending=meant.open_text or text if meant.outcome == "unclear" and not meant.is_held else "",
            held=meant.held_plan,
            offered=meant.offered_plan,
        )


def conversation(*turns: str) -> Conversation:
    """A dialogue in which these were said, one after the other."""
    talk = Conversation()
    for turn in turns:
        talk.say(turn)
    return talk


def check_nothing_done(*turns: str) -> None:
    """Assert that the last of these turns is asked about, answered or refused, and teaches nothing."""
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.outcome in ("unclear", "answered", "refused")
    assert meant.plan is None
    assert not meant.remember_place
    assert not meant.define


def run_item(item: Mapping[str, Any]) -> tuple[Verdict, str]:
    """The verdict on one corpus item and why."""
    talk = Conversation()
    for text in item.get("turns") or [item["say"]]:
        meant = talk.say(text)
    expect = item["expect"]
    if isinstance(text, dict):
        raise ValueError("turns with their own expect are not used in this corpus")
    wrong = judge(talk.track, expect)
    why = "; ".join(wrong) or f"{meant.outcome}: {meant.reply}"
    if "answer" in expect:
        if wrong:
            return "wrong", why
        return ("correct" if meant.outcome == ANSWERS[expect["answer"]] else "abstained"), why
    if meant.outcome in ("unclear", "refused", "answered") and expect.get("motion") != "none":
        return (
            "abstained" if not talk.track.moved or wrong else "correct"
        ), f"{meant.outcome}: {meant.reply}"
    return ("wrong" if wrong else "correct"), why + (f" | {meant.plan}" if wrong else "")


def plan_of(*turns: str) -> str:
    """What the last turn drives, in the plan language; its reply, where it drives nothing."""
    meant = conversation(*turns[:-1]).say(turns[-1])
    return format_plan(meant.plan) if meant.plan is not None else meant.reply
