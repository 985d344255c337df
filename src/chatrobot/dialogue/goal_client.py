"""Sends the goals of a session to Motion: plans and programs, under its options."""

from __future__ import annotations

from typing import Any, Literal

from chatrobot.dialogue.options import Options
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
