"""Knows what is under way, and what may be resumed: what is paused, or left of what was stopped last.

Motion keeps a paused plan and goes on with it on a word; the rest of a stopped one is offered as a plan of its own.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import replace

from chatrobot.core.event import Proposal
from chatrobot.core.events import Event, Finished, Paused, Progress, Rehearsed, Started
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.replies import describe_left
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation, planned
from chatrobot.language.phrases import describe_steps, describe_text, say
from chatrobot.plan.base import expanded
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.steps import Drive, Step, Turn

_LEAST = 0.05
"""Metres or radians: less of a step is not worth naming."""


class UnderWay:
    """Hears the events of the session's own turns. Used by the pumping thread."""

    def __init__(self) -> None:
        self._turn = 0
        self._step = 0
        self._began_at = ORIGIN
        self._pose = ORIGIN
        self._turned_rad = 0.0
        self._rehearsed: dict[int, Rehearsed] = {}
        self._length_m = self._duration_s = 0.0
        self._driven_m = self._fraction = 0.0

    def hear(self, event: Event) -> None:
        """Follow the motion by its events."""
        if isinstance(event, Rehearsed):
            self._rehearsed[event.turn] = event
        elif isinstance(event, Started):
            self._turn, self._step = event.turn, 0
            self._at(event.pose)
            self._expect(self._rehearsed.get(event.turn))
        elif isinstance(event, Progress):
            if (event.turn, event.step) != (self._turn, self._step):
                self._turn, self._step = event.turn, event.step
                self._at(event.pose)
            turned_rad = math.remainder(event.pose.yaw_rad - self._pose.yaw_rad, 2 * math.pi)
            self._turned_rad += turned_rad
            self._driven_m += math.hypot(event.pose.x_m - self._pose.x_m, event.pose.y_m - self._pose.y_m)
            self._fraction = event.fraction if event.fraction is not None else 1.0
            self._pose = event.pose

    def _expect(self, rehearsed: Rehearsed | None) -> None:
        """Take in how far and how long the turn that begins will drive; zeros where nobody knows."""
        is_known = rehearsed is not None and not rehearsed.open_ended
        self._length_m = rehearsed.length_m if rehearsed is not None and is_known else 0.0
        self._duration_s = rehearsed.duration_s if rehearsed is not None and is_known else 0.0
        self._driven_m = self._fraction = 0.0
        self._rehearsed.clear()

    def rescale(self, scaling: SpeedScaling) -> None:
        """Take in that the rest is driven at another speed, as Motion's executor does."""
        factor = scaling.linear_factor if scaling.linear_factor != 1.0 else scaling.angular_factor
        self._duration_s += self._duration_s * (1.0 - self._fraction) * (1.0 / factor - 1.0)

    def to_go(self, turn: int) -> tuple[float, float]:
        """Return the metres and seconds that are left of that turn; zeros where nobody knows."""
        if self.step_of(turn) == 0:
            return 0.0, 0.0
        return max(0.0, self._length_m - self._driven_m), self._duration_s * (1.0 - self._fraction)

    def _at(self, pose: Pose) -> None:
        self._began_at = self._pose = pose
        self._turned_rad = 0.0

    def step_of(self, turn: int) -> int:
        """Return the number of the step that runs, repeats counted; 0 where that turn does not."""
        return self._step if turn == self._turn else 0

    def left(self, turn: int, steps: Sequence[Step]) -> list[Step]:
        """Return what is left of the step that runs, and those after it; all where that is not known."""
        flat = list(expanded(steps))
        number = self.step_of(turn)
        if not 0 < number <= len(flat):
            return list(steps)
        return [step for step in (self._left(flat[number - 1]), *flat[number:]) if step is not None]

    def told(self, turn: int, steps: Sequence[Step], language: str, speed_mps: float) -> str:
        """Return the step that runs, what is left of it and comes after it; empty where that is not known."""
        flat = list(expanded(steps))
        number = self.step_of(turn)
        if not 0 < number <= len(flat):
            return ""
        left, now = self.left(turn, steps), describe_steps(flat[number - 1 : number], language)
        plan = describe_steps(left, language) if left else say(language, "nothing_left")
        return say(language, "answer_under_way", now=now, plan=plan, speed_mps=speed_mps)

    def _left(self, step: Step) -> Step | None:
        if isinstance(step, Drive) and step.distance_m is not None:
            moved = self._pose.relative_to(self._began_at)
            left_m = round(step.distance_m - math.hypot(moved.x_m, moved.y_m), 2)
            return dataclasses.replace(step, distance_m=left_m) if left_m >= _LEAST else None
        if isinstance(step, Turn) and step.angle_rad is not None:
            left_rad = math.radians(round(math.degrees(step.angle_rad - abs(self._turned_rad))))
            return dataclasses.replace(step, angle_rad=left_rad) if left_rad >= _LEAST else None
        return step


class Resuming:
    """Hears the events of its own turns. Belongs to the pumping thread; any thread may read `paused`."""

    def __init__(self, understanding: Understanding) -> None:
        self._understanding = understanding
        self.rest = ""
        """Plan text of what was left of the plan that was stopped last, as measured."""
        self._was_stopped = False
        self._stopped_by: Reason | None = None
        self.was_replaced = False
        """An order that came after it has ended what is left."""
        self.ended_by = Reason("cause_unknown")
        """Why the plan that was paused last is not gone on with."""
        self.paused: Paused | None = None
        """The plan that is paused, until it is gone on with or has ended."""
        self.under_way = UnderWay()

    def hear(self, event: Event) -> None:
        """Follow what is paused and what is left of what was stopped."""
        self.under_way.hear(event)
        if isinstance(event, Paused):
            self.paused = event
        elif isinstance(event, Finished):
            if self.paused is not None and self.paused.turn == event.turn:
                self.paused = None
                self.ended_by = event.reason or Reason("cause_unknown")
            self._note_rest(event)
        elif isinstance(event, Rehearsed):
            self._stopped_by = None

    def _note_rest(self, event: Finished) -> None:
        """Note what is left; what waited behind what one stop ended is left after it."""
        if event.outcome == "refused" and not event.executed:
            return  # it changes nothing of what was stopped before
        self._was_stopped = event.outcome == "stopped"
        waited = self._was_stopped and self._stopped_by is not None and event.reason == self._stopped_by
        left = event.remaining if self._was_stopped else ""
        self.rest = "\n".join(filter(None, (self.rest if waited else "", left)))
        self._stopped_by = why = event.reason if self._was_stopped else None
        self.was_replaced = bool(self.rest) and why is not None and why.code == "replaced"

    @property
    def is_about_this(self) -> bool:
        """True where “go on” means what was paused or stopped, be anything left of it or not."""
        return self.paused is not None or self._was_stopped

    def take_paused(self) -> Paused | None:
        """Return the plan that is paused: from now on it is Motion's again."""
        paused, self.paused = self.paused, None
        return paused

    def offer(self) -> Interpretation | None:
        """Ask whether to drive what is left of the plan that was stopped last; None where nothing is."""
        if not self.rest:
            return None
        language = self._understanding.language
        rest = describe_text(self.rest, language)
        ask = say(language, "ask_rest", plan=rest)
        reply = f"{say(language, 'was_stopped')} {ask}"
        return Interpretation("unclear", reply, language, code="ask_rest", proposal=Proposal(self.rest, ask))

    def more(self, meant: Interpretation, *, is_under_way: bool) -> Interpretation:
        """Read “keep going” where nothing was paused or stopped: `meant`, in the direction of the drive before it.

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
        """Return what is left of a paused plan, in the phrase of that code; that it stands, where nothing is paused."""
        language = self._understanding.language
        if paused is None:
            return say(language, self._understanding.stop_code())
        return say(language, code, plan=describe_left(paused, language))
