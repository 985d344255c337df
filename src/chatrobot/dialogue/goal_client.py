"""Sends the goals of a session to Motion, under its options, and logs what becomes of each request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

from chatrobot.core.event import Proposal
from chatrobot.core.events import Event, Finished, Notice, Outcome, Rehearsed, Result
from chatrobot.core.reason import Reason
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Instruction, Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.link.motion_link import MotionLink
from chatrobot.plan.speed_scaling import SpeedScaling


class GoalClient:
    """Sends goals to Motion. `options` may be replaced: those hold for what is sent from then on."""

    def __init__(self, link: MotionLink, options: Options, resuming: Resuming) -> None:
        self._link = link
        self.options = options
        self._resuming = resuming
        self.pauses = 0
        """How many there were before what is sent now was taken up."""

    @property
    def mode(self) -> Literal["queue", "replace"]:
        """Return what a new instruction does to one that is under way; what is paused, it replaces."""
        return "replace" if self._resuming.paused is not None else self.options.while_moving

    def resume(self, turn: int) -> None:
        """Have Motion go on with what is paused."""
        self._link.send("resume", turn)

    def rescale(self, turn: int, scaling: SpeedScaling) -> None:
        """Have Motion go on at another speed with a plan that it has."""
        self._link.send("rescale", turn, **vars(scaling))

    def cancel(self, turn: int) -> None:
        """Have Motion end that turn alone."""
        self._link.send("cancel", turn)

    def plan(
        self,
        turn: int,
        plan_text: str,
        mode: Literal["queue", "replace", "append"],
        *,
        asks: bool = False,
        instead_of: int | None = None,
        tries: bool = False,
    ) -> None:
        """Have Motion rehearse and drive a plan.

        Args:
            asks: it waits for a yes whatever the options.
            instead_of: the turn whose place it takes; it is refused where that waits no more.
            tries: what is driven goes on where this plan is refused.
        """
        place = {} if instead_of is None else {"instead_of": instead_of}
        trial = {"tries": True} if tries else {}
        self._send("plan", turn, asks, mode=mode, plan_text=plan_text, **place, **trial)

    def program(
        self,
        turn: int,
        payload: dict[str, Any],
        *,
        is_new: bool,
        by_model: bool,
        is_led_elsewhere: bool,
        asks: bool,
    ) -> None:
        """Have Motion rehearse and run a program, asking where the options say so.

        Args:
            payload: code, name, remap and strict of the envelope.
            is_new: it was written just now.
            by_model: a model wrote it.
            is_led_elsewhere: its topics are led to the robot's, and it has not run like that before.
            asks: it waits for a yes whatever the options.
        """
        options = self.options
        asks_new = is_new and (options.ask_new or (by_model and options.approve_models))
        asks = asks or asks_new or (is_led_elsewhere and options.ask_findings)
        self._send("program", turn, asks, mode=self.mode, ask_findings=options.ask_findings, **payload)

    def _send(self, word: Literal["plan", "program"], turn: int, asks: bool, **payload: Any) -> None:
        approve, rehearse_only = self.options.approve or asks, self.options.rehearse_only
        self._link.send(
            word, turn, approve=approve, rehearse_only=rehearse_only, pauses=self.pauses, **payload
        )


class RequestLog:
    """Logs which turns Motion has, and their results. Any thread may read `is_any_with_motion`."""

    def __init__(self, understanding: Understanding, emit: Callable[[Event], None]) -> None:
        self._understanding = understanding
        self._emit = emit
        self._with_motion: dict[int, Instruction] = {}
        self._left_out: dict[int, Reason] = {}
        self.results: dict[int, Result] = {}

    @property
    def is_any_with_motion(self) -> bool:
        """True while Motion has a turn of ours."""
        return bool(self._with_motion)

    @property
    def numbered(self) -> tuple[tuple[int, Instruction], ...]:
        """Return what Motion has, each with the number of its turn, in the order it was said."""
        return tuple(self._with_motion.items())

    @property
    def under_way(self) -> tuple[Instruction, ...]:
        """Return what Motion has, in the order it was said."""
        return tuple(self._with_motion.values())

    def texts_but(self, turn: int) -> tuple[str, ...]:
        """Return the texts that Motion has besides that turn, in the order they were said."""
        return tuple(one.text for number, one in self._with_motion.items() if number != turn)

    @property
    def first_with_motion(self) -> tuple[int, Instruction] | None:
        """Return the turn that Motion is at, and what it is about."""
        return next(iter(self._with_motion.items()), None)

    def has(self, turn: int) -> bool:
        """Return whether that turn is with Motion."""
        return turn in self._with_motion

    def track(self, turn: int, text: str, meant: Interpretation, instead_of: int | None = None) -> None:
        """Note that Motion has that turn, in the place of another one; its `finished` ends it."""
        before = list(self._with_motion)
        at = before.index(instead_of) + 1 if instead_of in self._with_motion else len(before)
        self._with_motion[turn] = Instruction(text, meant, self._understanding.pose)
        self._with_motion = {each: self._with_motion[each] for each in (*before[:at], turn, *before[at:])}

    def rescale(self, turn: int, scaling: SpeedScaling) -> None:
        """Note that Motion goes on at another speed with the plan of that turn."""
        instruction = self._with_motion[turn]
        plan = instruction.meant.plan
        plan = scaling.plan(plan, self._understanding.profile) if plan is not None else None
        self._with_motion[turn] = instruction._replace(meant=replace(instruction.meant, plan=plan))

    def hear(self, event: Event) -> None:
        """Note what rehearsal leaves out of a turn: its result says so, for whoever sees no more than that."""
        if isinstance(event, Rehearsed):
            found = (each.reason for each in event.findings if each.reason.code == "turn_left_out")
            self._left_out.update((event.turn, reason) for reason in found)

    def take(self, turn: int) -> Instruction | None:
        """Return what a turn was about that Motion is done with, None where Motion never had it."""
        return self._with_motion.pop(turn, None)

    def conclude(
        self,
        turn: int,
        outcome: Outcome,
        reply: str,
        finished: Finished | None = None,
        reason: Reason | None = None,
        proposal: Proposal | None = None,
    ) -> None:
        """End that turn: `finished` is what was measured, None where nothing moved; the reply asks about `proposal`."""
        self.take(turn)
        understanding = self._understanding
        unkept, left_out = understanding.take_unkept(), self._left_out.pop(turn, None)
        if unkept is not None:
            self._emit(Notice(turn, unkept))
        reason = reason or (finished.reason if finished is not None else None)
        if outcome in ("completed", "answered"):
            reason = reason or left_out or unkept
        if finished is None:
            measured = understanding.is_measured
            result = Result(
                turn, outcome, reply, understanding.pose, 0.0, 0.0, 0.0, 0.0, reason, proposal, measured
            )
        else:
            moved = (
                finished.pose,
                finished.turned_rad,
                finished.path_m,
                finished.duration_s,
                finished.paused_s,
            )
            result = Result(turn, outcome, reply, *moved, reason, proposal, finished.measured)
        self.results[turn] = result
        self._emit(result)
