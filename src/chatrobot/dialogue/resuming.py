"""What is under way, and what may be gone on with: what is paused, or what is left of what was stopped last.

Motion keeps a paused plan and goes on with it on a word; the rest of a stopped one is offered as a plan of its own.
"""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.event import Proposal
from chatrobot.core.events import Event, Finished, Paused
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import describe_left
from chatrobot.dialogue.under_way import UnderWay
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation, planned
from chatrobot.language.phrases import describe_text, say
from chatrobot.plan.steps import Drive


class Resuming:
    """Belongs to the pumping thread; `paused` may be read from any. It hears the events of its own turns."""

    def __init__(self, understanding: Understanding) -> None:
        self._understanding = understanding
        self._rest = ""
        self._was_stopped = False
        self.ended_by = Reason("cause_unknown")
        """Why the plan that was paused last is not gone on with."""
        self.paused: Paused | None = None
        """The plan that is paused, until it is gone on with or has ended."""
        self.under_way = UnderWay()

    def hear(self, event: Event) -> None:
        self.under_way.hear(event)
        if isinstance(event, Paused):
            self.paused = event
        elif isinstance(event, Finished):
            if self.paused is not None and self.paused.turn == event.turn:
                self.paused = None
                self.ended_by = event.reason or Reason("cause_unknown")
            self._was_stopped = event.outcome == "stopped"
            self._rest = event.remaining if event.outcome == "stopped" else ""

    @property
    def is_about_this(self) -> bool:
        """To go on would be to go on with what was paused or stopped, be anything left of it or not."""
        return self.paused is not None or self._was_stopped

    def take_paused(self) -> Paused | None:
        """The plan that is paused: from now on it is Motion's again."""
        paused, self.paused = self.paused, None
        return paused

    def offer(self) -> Interpretation | None:
        """The question whether to drive what is left of the plan that was stopped last; None where nothing is."""
        if not self._rest:
            return None
        language = self._understanding.language
        rest = describe_text(self._rest, language)
        ask = say(language, "ask_rest", plan=rest)
        reply = f"{say(language, 'was_stopped')} {ask}"
        return Interpretation("unclear", reply, language, code="ask_rest", proposal=Proposal(self._rest, ask))

    def more(self, meant: Interpretation, *, is_under_way: bool) -> Interpretation:
        """“Keep going” where nothing was paused or stopped: `meant`, in the direction of the drive before it.

        It is asked about where the last motion was no drive, and moves nothing where a motion goes on anyway.
        """
        if is_under_way:
            return Interpretation("answered", say(meant.language, "is_going_on"), meant.language)
        asked = meant.plan.steps if meant.plan is not None else ()
        last, drives = self._understanding.last_done, [step for step in asked if isinstance(step, Drive)]
        if not isinstance(last, Drive) or len(drives) < len(asked):
            reply = say(meant.language, "how_to_go_on")
            return Interpretation("unclear", reply, meant.language, code="how_to_go_on")
        direction_rad, speed_mps = last.direction_rad, last.speed_mps
        steps = [replace(step, direction_rad=direction_rad, speed_mps=speed_mps) for step in drives]
        return planned([*steps], meant.language)

    def told(self, paused: Paused | None, code: str) -> str:
        """What is left of a paused plan, in the phrase of that code; that it stands, where nothing is paused."""
        language = self._understanding.language
        if paused is None:
            is_measured = self._understanding.is_measured
            return say(language, "stopped_now" if is_measured else "stopped_now_unmeasured")
        return say(language, code, plan=describe_left(paused, language))
