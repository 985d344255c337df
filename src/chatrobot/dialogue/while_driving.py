"""What is said of a plan that is driven or paused: “slower” changes its speed, “how much longer?” asks for its rest.

It goes on at another speed on its path, and without a stop.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.inverse import inverse
from chatrobot.language.phrases import say
from chatrobot.plan.base import expanded
from chatrobot.plan.speed_scaling import SpeedScaling, speed_scaling
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan


@dataclass(eq=False)
class WhileDriving:
    """Answers what is said of the session's own plan that Motion has. Belongs to the pumping thread."""

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
        if self._understanding.asks_what_is_left(text):
            self._understanding.hear_language(text)
            language = self._understanding.language
            paused_told = say(language, "paused_now", plan=self._understanding.describe(plan.steps))
            told = self.told(language) if paused is None else paused_told
            return Interpretation("answered", told, language)
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

    def told(self, language: str) -> str:
        """Return the motion that runs and what is left of it; an empty string where no plan of ours runs."""
        running = self._requests.first_with_motion
        if running is None or running[1].meant.plan is None:
            return ""
        turn, steps = running[0], running[1].meant.plan.steps
        return self._resuming.under_way.told(turn, steps, language, self._understanding.speed_mps)

    def beside(self, meant: Interpretation) -> Interpretation:
        """`I did nothing`, said while the robot drives: what it does goes on."""
        running = self._requests.first_with_motion
        if running is None:
            return meant
        told = say(meant.language, "drives_on", text=running[1].text)
        return replace(meant, reply=f"{meant.reply} {told}")

    def goes_back(self, meant: Interpretation) -> bool:
        """Return whether it takes back all of what is driven, and takes its place: so far a part of that is done."""
        running = self._requests.first_with_motion
        plan = running[1].meant.plan if running is not None and self._goals.mode == "replace" else None
        way_back = tuple(inverse(list(plan.steps), None)) if plan is not None else ()
        return meant.plan is not None and not meant.append and meant.plan.steps == way_back

    def _refusal(self, plan: Plan, scaling: SpeedScaling) -> str:
        """The code of why it may not be faster; slower is always allowed."""
        if not scaling.is_faster:
            return ""
        if self._goals.options.approve:
            return "faster_than_approved"
        is_timed = any(getattr(step, "duration_s", None) is not None for step in expanded(plan.steps))
        return "faster_than_timed" if is_timed else ""
