"""Changes what is still to be done while the robot drives: “leave out the turn”, “no, 40”, “finish this and stop”.

What was said last is meant, where it waits behind what runs; else the steps of the plan under way that have not begun.
Whatever changes the step under way is none of these: it is a correction, which undoes what was done of the wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from chatrobot.dialogue.goal_client import GoalClient, RequestLog
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Instruction, Understanding
from chatrobot.dialogue.utterances import Utterance
from chatrobot.language.driven import changed as changed_in
from chatrobot.language.driven import says
from chatrobot.language.interpretation import Interpretation, planned
from chatrobot.language.phrases import say
from chatrobot.plan.base import expanded
from chatrobot.plan.steps import Plan, Step
from chatrobot.plan.text import format_plan, parse_plan


class Amendment(NamedTuple):
    """What a text makes of what is still to be done.

    `cancels` are turns that wait and are not done, `instead_of` the one whose place the plan of `meant` takes. Without
    `meant` what runs has to end first: what is left of it is known then, as measured.
    """

    meant: Interpretation | None
    cancels: tuple[int, ...] = ()
    instead_of: int | None = None


class _Rest(NamedTuple):
    """What follows the step under way, in the order of that turn: `steps`, in place of those `before`."""

    turn: int
    before: tuple[Step, ...]
    steps: tuple[Step, ...]


_Numbered = tuple[int, Instruction]
"""An order, with the number of its turn."""


@dataclass(eq=False)
class Amending:
    """Belongs to the pumping thread."""

    _goals: GoalClient
    _understanding: Understanding
    _requests: RequestLog
    _resuming: Resuming
    _rest: _Rest | None = field(default=None, init=False)

    def of(self, utterance: Utterance) -> Amendment | None:
        """Return what `utterance` changes of what is still to be done; None where it is about anything else."""
        rest, self._rest = self._rest, None
        if rest is not None and rest.turn == utterance.turn:
            return self._gone_on(rest)
        under_way = self._requests.numbered
        if not under_way or self._goals.mode == "queue" or self._resuming.paused is not None:
            return None
        if any(one.meant.plan is None for _, one in under_way):  # a program has no steps
            return None
        (turn, running), *queued = under_way
        flat, number = _steps(running), self._resuming.under_way.step_of(turn)
        if number == 0 or (not queued and number >= len(flat)):
            return None
        text = utterance.text
        if says("no_more", text, self._understanding.context()):
            return self._ended(utterance, flat[number - 1 :], queued)
        changed = self._changed(running, text)
        changes_current = changed is not None and changed[:number] != flat[:number]
        current = flat[number - 1] if changes_current else None
        amendment = self._of_waiting(text, queued, current)
        if amendment is not None or changed is None or changes_current:
            return amendment
        waiting = [step for _, one in queued for step in _steps(one)]
        before = (*flat[number:], *waiting)
        self._rest = _Rest(utterance.turn, before, (*changed[number:], *waiting))
        return Amendment(None)

    def _changed(self, instruction: Instruction, text: str) -> list[Step] | None:
        """The steps of that order with what `text` changes of them; None where it changes nothing."""
        plan, understanding = instruction.meant.plan, self._understanding
        after = understanding.context([instruction])
        if plan is None:
            return None
        return changed_in(plan, text, after, understanding.profile, understanding.read)

    def _of_waiting(self, text: str, queued: Sequence[_Numbered], current: Step | None) -> Amendment | None:
        """What `text` makes of orders that wait, of what was said last first.

        Args:
            current: the step under way, where `text` may change that as well; an order of its kind is then left alone.
        """
        for turn, waiting in reversed(queued):
            changed = self._changed(waiting, text)
            if changed is not None and not any(type(step) is type(current) for step in _steps(waiting)):
                meant = (
                    planned(changed, self._understanding.language_of(text), append=True) if changed else None
                )
                return Amendment(meant, instead_of=turn) if meant else self._dropped(text, [(turn, waiting)])
        count = self._taken_back(text)
        return self._dropped(text, queued[-count:]) if 0 < count <= len(queued) else None

    def _dropped(self, text: str, waiting: Sequence[_Numbered]) -> Amendment:
        language = self._understanding.language_of(text)
        steps = [step for _, one in waiting for step in _steps(one)]
        told = say(language, "waits_no_more", plan=self._understanding.describe(steps))
        return Amendment(Interpretation("answered", told, language), tuple(turn for turn, _ in waiting))

    def _taken_back(self, text: str) -> int:
        """How many of the last orders `text` takes back."""
        if says("last_not", text, self._understanding.context()):
            return 1
        understanding = self._understanding
        walk = understanding.read(text, understanding.context(self._requests.under_way)).walk
        return walk.count if walk is not None and walk.kind == "undo" else 0

    def _ended(self, utterance: Utterance, steps: list[Step], queued: Sequence[_Numbered]) -> Amendment:
        """What runs ends with the step under way, the first of `steps`, and nothing comes after it."""
        if len(steps) > 1:
            waiting = [step for _, one in queued for step in _steps(one)]
            self._rest = _Rest(utterance.turn, (*steps[1:], *waiting), ())
            return Amendment(None)
        language = self._understanding.language_of(utterance.text)
        told = say(language, "ends_after", plan=self._understanding.describe(steps))
        cancels = tuple(turn for turn, _ in queued)
        return Amendment(Interpretation("answered", told, language), cancels=cancels)

    def _gone_on(self, rest: _Rest) -> Amendment:
        """Go on with what was left of the step that ran, and what follows it now."""
        left = list(expanded(parse_plan(self._resuming.rest).steps)) if self._resuming.rest else []
        begun, follows = left[: -len(rest.before)], left[-len(rest.before) :]
        steps, language = [*begun, *rest.steps], self._understanding.language
        # What has begun since it was said is in part done, and cannot be changed any more.
        if not follows or format_plan(Plan(rest.before)) != format_plan(Plan(tuple(follows))) or not steps:
            stood = Interpretation("answered", say(language, self._understanding.stop_code()), language)
            return Amendment(self._resuming.offer() or stood)
        meant = planned(steps, language)
        return Amendment(replace(meant, reply=say(language, "goes_on", plan=meant.reply)))


def _steps(instruction: Instruction) -> list[Step]:
    plan = instruction.meant.plan
    return list(expanded(plan.steps)) if plan is not None else []
