"""Sends the goals of a session to Motion, under its options, and logs what becomes of each request."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from chatrobot.core.events import Event, Finished, Notice, Outcome, Result
from chatrobot.core.proposal import Proposal
from chatrobot.core.reason import Reason
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.understanding import Instruction, Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.link.motion_link import MotionLink


class GoalClient:
    """Sends them. `options` may be replaced: those hold for what is sent from then on."""

    def __init__(self, link: MotionLink, options: Options) -> None:
        self._link = link
        self.options = options
        self.is_paused = False
        self.pauses = 0
        """How many there were before what is sent now was taken up."""

    @property
    def mode(self) -> Literal["queue", "replace"]:
        """What a new instruction does to one that is under way; what is paused, it replaces."""
        return "replace" if self.is_paused else self.options.while_moving

    def resume(self, turn: int) -> None:
        """Have Motion go on with what is paused."""
        self._link.send("resume", turn)

    def plan(
        self, turn: int, plan_text: str, mode: Literal["queue", "replace", "append"], *, asks: bool = False
    ) -> None:
        """Have Motion rehearse and drive a plan. `asks`: it waits for a yes whatever the options."""
        options = self.options
        self._link.send(
            "plan",
            turn,
            plan_text=plan_text,
            mode=mode,
            approve=options.approve or asks,
            rehearse_only=options.rehearse_only,
            pauses=self.pauses,
        )

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
        self._link.send(
            "program",
            turn,
            mode=self.mode,
            approve=options.approve or asks,
            ask_findings=options.ask_findings,
            rehearse_only=options.rehearse_only,
            pauses=self.pauses,
            **payload,
        )


class RequestLog:
    """Used by the session's pumping thread; `is_any_with_motion` may be read from any thread."""

    def __init__(self, understanding: Understanding, emit: Callable[[Event], None]) -> None:
        self._understanding = understanding
        self._emit = emit
        self._with_motion: dict[int, Instruction] = {}
        self.results: dict[int, Result] = {}

    @property
    def is_any_with_motion(self) -> bool:
        return bool(self._with_motion)

    @property
    def under_way(self) -> tuple[Instruction, ...]:
        """What Motion has, in the order it was said."""
        return tuple(self._with_motion.values())

    def texts_but(self, turn: int) -> tuple[str, ...]:
        """What Motion has besides that turn, in the order it was said."""
        return tuple(one.text for number, one in self._with_motion.items() if number != turn)

    @property
    def first_with_motion(self) -> tuple[int, Instruction] | None:
        """The turn that Motion is at, and what it is about."""
        return next(iter(self._with_motion.items()), None)

    def has(self, turn: int) -> bool:
        """That turn is with Motion."""
        return turn in self._with_motion

    def track(self, turn: int, text: str, meant: Interpretation) -> None:
        """That turn is now Motion's; its `finished` ends it."""
        self._with_motion[turn] = Instruction(text, meant, self._understanding.pose)

    def take(self, turn: int) -> Instruction | None:
        """Motion is done with that turn: what it was about, None where Motion never had it."""
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
        pose = understanding.pose
        unkept = understanding.places.take_unkept()
        if unkept:
            self._emit(Notice(turn, Reason("places_not_kept", {"why": unkept})))
        result = Result(
            turn, outcome, reply, pose, reason=reason, proposal=proposal, measured=understanding.is_measured
        )
        if finished is not None:
            result = Result(
                turn,
                outcome,
                reply,
                finished.pose,
                finished.turned_rad,
                finished.path_m,
                finished.duration_s,
                finished.paused_s,
                reason or finished.reason,
                proposal,
                finished.measured,
            )
        self.results[turn] = result
        self._emit(result)
