"""What is said of a plan that is driven or paused: “slower” changes its speed, “how much longer?” asks for its rest.

It goes on at another speed on its path, and without a stop. “Don't turn” stops it: whoever says so hears no promise
that the motion breaks.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from chatrobot.core.event import Proposal
from chatrobot.core.events import Finished
from chatrobot.core.reason import Reason
from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.places import ends_alike
from chatrobot.dialogue.replies import with_offer
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.driven import drops, rescaled, says
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.inverse import inverse
from chatrobot.language.phrases import describe_text, render_reason, say
from chatrobot.language.proposals import proposed
from chatrobot.language.resuming import only_starts
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import expanded
from chatrobot.plan.speed_scaling import SpeedScaling
from chatrobot.plan.steps import Go, Plan, Step, Wait
from chatrobot.plan.text import format_plan, parse_plan

_LEAST_M, _LEAST_S = 0.05, 0.5
"""What is less than that to go is not told in figures."""


class _Motion(NamedTuple):
    """What Motion has of the session; `step_number` is that of the step under way, repeats counted."""

    turn: int
    plan: Plan
    step_number: int


@dataclass(eq=False)
class WhileDriving:
    """Answers what is said of the session's own plan that Motion has. Belongs to the pumping thread."""

    _goals: GoalClient
    _understanding: Understanding
    _requests: RequestLog
    _resuming: Resuming

    @property
    def is_any(self) -> bool:
        """True while a plan of the session is driven or paused."""
        return self._motion() is not None

    def concerns(self, text: str) -> bool:
        """Return whether `text` changes the speed of what is driven or paused, forbids it, or asks for what is left."""
        motion = self._motion()
        if motion is None:
            return False
        asks = says("left", text, self._understanding.context())
        return asks or self._changed(motion, text) is not None or self._forbids(text)

    def _forbids(self, text: str) -> bool:
        """Return whether all that `text` says, while the robot is on its way, is against that."""
        if self._resuming.paused is not None:
            return False
        understanding, motion = self._understanding, self._motion()
        is_wrong = says("wrong", text, understanding.context())
        if is_wrong or understanding.would_mean(text).code in ("only_forbidden", "taken_back"):
            return True
        return motion is not None and drops(motion.plan, text, understanding.context())

    def answer(self, text: str) -> Interpretation | None:
        """Do what `text` says of the speed of the motion, or tell what is left; None where it says anything else."""
        motion = self._motion()
        if motion is None:
            return None
        if says("left", text, self._understanding.context()):
            return self._left(text)
        changed = self._changed(motion, text)
        if changed is None:
            return None
        asked, scaling = changed
        self._understanding.hear_language(text)
        refusal = self._refusal(motion.plan, asked, scaling)
        if refusal is not None:
            language = self._understanding.language
            return Interpretation("refused", render_reason(refusal, language), language)
        after = scaling.plan(motion.plan, self._understanding.profile)
        self._goals.rescale(motion.turn, scaling)
        self._requests.rescale(motion.turn, scaling)
        self._resuming.under_way.rescale(scaling)
        paused = self._resuming.paused
        if paused is not None:
            self._resuming.paused = replace(paused, plan_text=format_plan(after))
            return self._told("paused_now", after.steps)
        return self._told("goes_on", self._resuming.under_way.left(motion.turn, after.steps))

    def interpret(self, text: str) -> Interpretation:
        """Return what `text` means now. `Go!` lets go on what is driven, and `again` comes after it."""
        if self._motion() is not None and self._resuming.paused is None and only_starts(text):
            self._understanding.hear_language(text)
            language = self._understanding.language
            return Interpretation("answered", say(language, "is_going_on"), language)
        return self._understanding.interpret(text, self._requests.under_way)

    def stop(self, text: str) -> Interpretation | None:
        """Return the stop that `text` is, where it is against what is driven."""
        if self._motion() is None or not self._forbids(text):
            return None
        self._understanding.hear_language(text)
        language, asked = self._understanding.language, self.behind_stop(text)
        stopped = Interpretation("stop", say(language, self._understanding.stop_code()), language)
        if asked is None:
            return stopped
        return replace(stopped, reply=f"{stopped.reply} {asked.reply}", proposal=asked.proposal)

    def behind_stop(self, text: str) -> Interpretation | None:
        """Return the question about what `text`, a stop, orders beside it; None where that is nothing.

        What depends on how far the stopped motion came is not asked about: that is not known yet.
        """
        understanding = self._understanding
        meant = understanding.read(text, understanding.context(self._requests.under_way))
        steps = meant.plan.steps if meant.plan is not None and not meant.append else ()
        while steps and isinstance(steps[0], Wait):  # the stop word, read as one: `halt, turn left`
            steps = steps[1:]
        if meant.is_about_turn_before:  # `no wait, the kitchen` goes there from wherever the robot stands
            steps = steps if all(isinstance(step, Go) for step in steps) else ()
        elif meant.walk is not None:
            steps = ()
        return proposed(replace(meant, plan=Plan(steps)), meant.language) if steps else None

    def _motion(self) -> _Motion | None:
        """What is driven or paused; None where there is nothing, or it has not set out."""
        running = self._requests.first_with_motion
        if running is None or running[1].meant.plan is None:
            return None
        turn, paused = running[0], self._resuming.paused
        if paused is not None and paused.turn == turn:
            return _Motion(turn, parse_plan(paused.plan_text), 1)
        number = self._resuming.under_way.step_of(turn)
        return _Motion(turn, running[1].meant.plan, number) if number > 0 else None

    def _changed(self, motion: _Motion, text: str) -> tuple[Plan, SpeedScaling] | None:
        """The plan at the speed that `text` says, and what makes it of the one before; None for any other text."""
        understanding = self._understanding
        return rescaled(motion.plan, text, motion.step_number, understanding.context(), understanding.profile)

    def _left(self, text: str) -> Interpretation:
        self._understanding.hear_language(text)
        paused = self._resuming.paused
        if paused is not None:
            return self._told("paused_now", parse_plan(paused.plan_text).steps)
        language = self._understanding.language
        return Interpretation("answered", self._to_go(language) or self.told(language), language)

    def _to_go(self, language: str) -> str:
        """The metres and seconds to go, and what is still to be done; "" where nobody knows how far it is."""
        turn, steps = self._all_steps()
        left_m, left_s = self._resuming.under_way.to_go(turn)
        left = self._resuming.under_way.left(turn, steps)
        if left_s < _LEAST_S or not left:
            return ""
        code = "answer_to_go" if left_m >= _LEAST_M else "answer_to_go_s"
        plan = self._understanding.describe(left)
        return say(language, code, left_m=left_m, left_s=f"{math.ceil(left_s)}", plan=plan)

    def _all_steps(self) -> tuple[int, list[Step]]:
        """The turn that runs, and the steps of all that are under way."""
        running = self._requests.first_with_motion
        plans = [one.meant.plan for one in self._requests.under_way]
        return running[0] if running else 0, [
            step for plan in plans if plan is not None for step in plan.steps
        ]

    def _told(self, code: str, steps: Sequence[Step]) -> Interpretation:
        language = self._understanding.language
        plan = self._understanding.describe(steps) or say(language, "nothing_left")
        return Interpretation("answered", say(language, code, plan=plan), language)

    def told(self, language: str) -> str:
        """Return the motion that runs, what is left of it and what waits; "" where no plan of ours runs."""
        running = self._requests.first_with_motion
        if running is None or running[1].meant.plan is None:
            return ""
        turn, steps = self._all_steps()
        return self._resuming.under_way.told(turn, steps, language, self._understanding.speed_mps)

    def beside(self, meant: Interpretation) -> Interpretation:
        """`I did nothing`, said while the robot drives: what it does goes on. What waits for a yes does not.

        What is asked about is left to be said in full, where a yes would have it done from another pose.
        """
        goes_on = self._goes_on(meant.language)
        asked = meant.proposal
        if not goes_on or (asked is not None and ends_alike(parse_plan(asked.plan_text))):
            return meant
        reply = meant.reply
        if asked is not None:
            instead = say(meant.language, "say_in_full", text=describe_text(asked.plan_text, meant.language))
            reply = f"{reply.removesuffix(asked.say)}{instead}"
        return replace(meant, reply=f"{reply} {goes_on}", proposal=None)

    def with_offer(self, reply: str, ended: Finished | None, language: str) -> tuple[str, Proposal | None]:
        """Return the reply to what has ended with what goes on beside it, or else what can be done instead of it."""
        if ended is not None and ended.outcome == "refused":
            goes_on = self._goes_on(language)
            if goes_on:
                return f"{reply} {goes_on}", None
            if self._resuming.was_replaced:
                reply = f"{reply} {say(language, 'rest_is_kept')}"
        return with_offer(reply, ended, language)

    def _goes_on(self, language: str) -> str:
        """What is driven goes on; "" where nothing is."""
        running = self._requests.first_with_motion
        if running is None or self._resuming.under_way.step_of(running[0]) == 0:
            return ""
        return say(language, "drives_on", text=running[1].text)

    def goes_back(self, meant: Interpretation) -> bool:
        """Return whether it takes back all of what is driven, and takes its place: so far a part of that is done."""
        running = self._requests.first_with_motion
        plan = running[1].meant.plan if running is not None and self._goals.mode == "replace" else None
        if plan is None or meant.plan is None or meant.append:
            return False
        try:
            return meant.plan.steps == tuple(inverse(list(plan.steps), None))
        except Unclear:  # a way to a place has no inverse of its own
            return False

    def _refusal(self, plan: Plan, asked: Plan, scaling: SpeedScaling) -> Reason | None:
        """Why it may not be faster; slower is always allowed."""
        if not scaling.is_faster:
            return None
        most_mps = self._understanding.profile.limits.max_speed_mps
        speed_mps = max(
            (getattr(step, "speed_mps", None) or 0.0 for step in expanded(asked.steps)), default=0.0
        )
        if speed_mps > most_mps * (1.0 + 1e-9):
            return Reason("speed_above_limit", {"asked_mps": speed_mps, "max_mps": most_mps})
        if self._goals.options.approve:
            return Reason("faster_than_approved")
        moving = (step for step in expanded(plan.steps) if not isinstance(step, Wait))
        is_timed = any(getattr(step, "duration_s", None) is not None for step in moving)
        return Reason("faster_than_timed") if is_timed else None
