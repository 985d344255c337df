"""“Slower”, said while a plan is driven or paused: it goes on at another speed, on its path and without a stop."""

from __future__ import annotations

from dataclasses import dataclass, replace

from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import say
from chatrobot.plan.base import expanded
from chatrobot.plan.speed_scaling import SpeedScaling, speed_scaling
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan


@dataclass(eq=False)
class SpeedChange:
    """Has Motion change the speed of the session's own plan. Belongs to the pumping thread."""

    _goals: GoalClient
    _understanding: Understanding
    _requests: RequestLog
    _resuming: Resuming

    def answer(self, text: str) -> Interpretation | None:
        """Change the speed as `text` says, and return the reply; None where it says anything else or nothing drives."""
        running = self._requests.first_with_motion
        if running is None or self._goals.mode != "replace":
            return None
        turn, plan = running[0], running[1].meant.plan
        paused = self._resuming.paused
        if paused is not None and paused.turn == turn:
            plan = parse_plan(paused.plan_text)
        step = 1 if paused is not None else self._resuming.under_way.step_of(turn)
        if plan is None or step == 0:
            return None
        after = self._understanding.amended(plan, text, is_agreed=False)
        scaling = (
            speed_scaling(plan, after, self._understanding.profile, step=step) if after is not None else None
        )
        if after is None or scaling is None:
            return None
        self._understanding.hear_language(text)
        language = self._understanding.language
        refusal = self._refusal(plan, scaling)
        if refusal:
            return Interpretation("refused", say(language, refusal), language)
        self._goals.rescale(turn, scaling)
        if paused is not None:
            self._resuming.paused = replace(paused, plan_text=format_plan(after))
        else:
            self._requests.replace_plan(turn, after)
        left = after.steps if paused is not None else self._resuming.under_way.left(turn, after.steps)
        code = "paused_now" if paused is not None else "goes_on"
        told = say(language, code, plan=self._understanding.describe(left))
        return Interpretation("answered", told, language)

    def _refusal(self, plan: Plan, scaling: SpeedScaling) -> str:
        """The code of why it may not be faster; slower is always allowed."""
        if not scaling.is_faster:
            return ""
        if self._goals.options.approve:
            return "faster_than_approved"
        is_timed = any(getattr(step, "duration_s", None) is not None for step in expanded(plan.steps))
        return "faster_than_timed" if is_timed else ""
