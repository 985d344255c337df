"""Questions that wait for a yes: about a rehearsed plan, and about a plan that the last reply offered.

Motion decides what a yes to a rehearsed plan is worth, and how long (`link/approval.py`). A yes to an offer may say how
fast: `sure, but slowly`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from chatrobot.core.event import Proposal
from chatrobot.core.events import Event, Finished, Paused, Rehearsed, Result, Started, Telemetry
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from chatrobot.dialogue.places import ends_alike
from chatrobot.dialogue.resuming import Resuming
from chatrobot.dialogue.understanding import Understanding
from chatrobot.dialogue.utterances import Utterance, UtteranceQueue
from chatrobot.language.consent import read_consent
from chatrobot.language.interpretation import Interpretation
from chatrobot.language.phrases import render_reason, say
from chatrobot.language.resuming import wants_to_resume
from chatrobot.link.motion_link import Approval
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import parse_plan

if TYPE_CHECKING:
    from chatrobot.dialogue.session import Session


class Question:
    """Knows which plan waits for a person's yes. `hear` every event; answer from any thread."""

    def __init__(self) -> None:
        self._asked: Rehearsed | None = None

    @property
    def turn(self) -> int | None:
        """Return the turn of the plan that waits; None where none does."""
        asked = self._asked
        return asked.turn if asked is not None else None

    def hear(self, event: Event) -> bool:
        """Take an event in; return whether it is a question."""
        if isinstance(event, Rehearsed) and event.needs_approval:
            self._asked = event
            return True
        if isinstance(event, (Started, Paused, Finished)) and event.turn == self.turn:
            self._asked = None
        return False

    def forget(self, turn: int) -> None:
        """Note that the plan of that turn has been answered."""
        if self.turn == turn:
            self._asked = None

    def answer(self, session: Session, yes: bool, *, edited: bool = False) -> bool:
        """Answer it, once; return whether something waited. `edited`: another plan takes its place.

        Raises:
            LinkError: Motion is gone.
        """
        asked, self._asked = self._asked, None
        if asked is None:
            return False
        session.approve(asked.turn, yes, edited=edited)
        return True


class _Offered(NamedTuple):
    """`turn` offered the plan; `approval` says until when, and from where, a yes counts."""

    turn: int
    proposal: Proposal
    approval: Approval
    is_placed: bool  # whether the robot had said where it is; until then nobody can see that it was moved
    is_driven: bool  # whether the robot is on its way, and so will be elsewhere when the yes comes
    voids: int  # how many stops there had been, with the one that it was asked beside

    def lapsed(self, plan: Plan, now_s: float, pose: Pose) -> Reason | None:
        """Return why a yes to `plan` is worth nothing any more; None where it counts."""
        is_anywhere = self.is_driven and ends_alike(plan)
        return self.approval.lapsed(now_s, self.approval.start if is_anywhere else pose)


class Proposals:
    """Keeps the plan that waits for an answer. Belongs to the pumping thread.

    Args:
        utterances: knows how many stops there were.
        resuming: knows whether `go on` means what was stopped; else it is asked whether it means the offer.
        approve: answers a rehearsed plan that waits for a yes, by its turn.
    """

    def __init__(
        self,
        understanding: Understanding,
        utterances: UtteranceQueue,
        resuming: Resuming,
        approve: Callable[[int, bool], None],
    ) -> None:
        self._understanding, self._approve = understanding, approve
        self.rehearsed, self._asked_at_s = Question(), 0.0
        self._utterances, self._resuming = utterances, resuming
        self._offered: _Offered | None = None
        self.is_left_unasked = False
        """The last text was understood as a plan that no yes counts for: that yes, or a `go`, is no order, either."""
        self._driving: frozenset[int] = frozenset()

    @property
    def _voids(self) -> int:
        """How many stops there were, pauses not counted."""
        return self._utterances.stops - self._utterances.pauses

    def declines_motion(self, text: str) -> bool:
        """Return whether `text` says no to what moves, and not to an offer, or a plan that waits. From any thread."""
        waits = self.rehearsed.turn is not None and not self._driving
        is_asked = self._offered is not None or self.is_left_unasked or waits
        return not is_asked and read_consent(text) is False

    def hear(self, event: Event) -> None:
        """Keep the plan that a result offers; drop it when something moves.

        What a later text asks back about is what a yes then answers, and no rehearsed plan that waits for one.
        """
        waiting = self.rehearsed.turn
        asks = isinstance(event, Result) and event.outcome in ("unclear", "refused")
        if asks and waiting is not None and event.turn > waiting:
            self._approve(waiting, False)
        if self.rehearsed.hear(event):
            self._asked_at_s = time.monotonic()
        if isinstance(event, Result) and event.proposal is not None:
            approval = Approval(time.monotonic(), event.pose or self._understanding.pose)
            known = self._understanding.known_pose
            is_driven = bool(self._driving)
            self._offered = _Offered(
                event.turn, event.proposal, approval, known is not None, is_driven, self._voids
            )
        elif isinstance(event, Telemetry) and self._offered is not None and not self._offered.is_placed:
            if (here := self._understanding.known_pose) is not None:
                approval = replace(self._offered.approval, start=here)
                self._offered = self._offered._replace(approval=approval, is_placed=True)
        elif isinstance(event, Started):
            self._offered, self.is_left_unasked = None, False
        if isinstance(event, Started):
            self._driving |= {event.turn}
        elif isinstance(event, Finished):
            self._driving -= {event.turn}
            if self._offered is not None and not self._driving and self._offered.is_driven:
                approval = replace(self._offered.approval, start=event.pose)
                self._offered = self._offered._replace(approval=approval, is_driven=False)

    def awaits(self, utterance: Utterance) -> bool:
        """Return whether it answers a rehearsed plan that waits for a yes: said after the question, or next after what
        the plan was made of."""
        turn = self.rehearsed.turn
        if turn is None or self._offered is not None or utterance.kind != "text":
            return False
        is_next = utterance.turn == turn + 1
        return (is_next or not self._is_early(utterance)) and read_consent(utterance.text) is not None

    def _is_early(self, utterance: Utterance) -> bool:
        return utterance.at_s < self._asked_at_s

    def answered(self, utterance: Utterance, *, in_turn: bool = False) -> Interpretation | None:
        """Return what `utterance` means as the answer to the offer; None where it is none. The offer is then over.

        A yes that was said before its plan was shown is none, unless it counts `in_turn`.
        """
        language = self._understanding.language
        if self.awaits(utterance):  # a `go` is no order to drive then
            agrees = read_consent(utterance.text) is True
            if agrees and self._is_early(utterance) and not in_turn:
                return Interpretation("answered", say(language, "yes_too_early"), language)
            self._approve(self.rehearsed.turn or 0, agrees)
            code = "approved" if agrees else "offer_declined"
            return Interpretation("answered", say(language, code), language)
        offered, self._offered = self._offered, None
        is_left, self.is_left_unasked = self.is_left_unasked, False
        yes = read_consent(utterance.text) if utterance.kind == "text" else None
        if is_left and yes is not None:
            code = "approval_robot_moved" if yes else "offer_declined"
            return Interpretation("refused" if yes else "answered", say(language, code), language)
        if offered is None or utterance.kind != "text" or offered.voids != self._voids:
            return None
        if yes is None and not self._resuming.is_about_this and wants_to_resume(utterance.text):
            asked = offered.proposal
            return Interpretation("unclear", asked.say, language, code="did_you_mean", proposal=asked)
        plan = parse_plan(offered.proposal.plan_text)
        changed = self._understanding.amended(plan, utterance.text) if yes is None else plan
        if changed is None:
            return None
        if yes is False:
            return Interpretation("answered", say(language, "offer_declined"), language)
        lapse = offered.lapsed(changed, utterance.at_s, self._understanding.pose)
        if lapse is not None:
            return Interpretation("refused", render_reason(lapse, language), language)
        return self._understanding.accept(changed)
