"""A goal: one turn's plan on its way through Motion, received, rehearsed, approved, run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from chatrobot.core.events import Finished, Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.core.summed import gone_on
from chatrobot.link.approval import Approval
from chatrobot.link.envelope import Envelope, seconds
from chatrobot.motion.budgets import Account, Extent
from chatrobot.motion.plan_stream import Stream
from chatrobot.motion.planner import Planned
from chatrobot.plan.base import Step
from chatrobot.plan.lowering import Walk
from chatrobot.plan.rehearsal import Rehearsal
from chatrobot.plan.swept_path import Most


@dataclass
class Goal:
    """`epoch` is the stop epoch it was received in: a later stop makes it void. `start` is where it begins.

    `longest_s` is what the source may take: a plan that rehearsal expects to last longer is refused. `stream` holds
    what comes after `plan_text` where the plan comes in parts. `account` is what its text may drive, and has driven.
    Where the goal is the rest of a plan that was paused, `plan_start` is where the whole began and `so_far` what was
    measured of it.
    """

    turn: int
    lease: str
    plan_text: str
    approve: bool
    rehearse_only: bool
    epoch: int
    received_s: float
    longest_s: float = math.inf
    start: Pose = ORIGIN
    planned: Planned | None = None
    approval: Approval | None = None
    stream: Stream | None = None
    pauses: int | None = None
    account: Account = field(default_factory=Account)
    plan_start: Pose | None = None
    so_far: Finished | None = None

    @classmethod
    def of(cls, envelope: Envelope, epoch: int, now_s: float, account: Account | None = None) -> Goal:
        """The goal that a `plan` envelope asks for."""
        payload, account = envelope.payload, account or Account()
        longest_s = seconds(payload.get("longest_s"), math.inf)
        comes_whole = payload.get("approve") or payload.get("rehearse_only") or not payload.get("more")
        return cls(
            turn=envelope.turn,
            lease=envelope.lease,
            plan_text=str(payload.get("plan_text", "")),
            approve=bool(payload.get("approve")),
            rehearse_only=bool(payload.get("rehearse_only")),
            epoch=epoch,
            received_s=now_s,
            longest_s=longest_s,
            stream=None if comes_whole else Stream(longest_s, account),
            pauses=payload.get("pauses"),
            account=account,
        )

    @property
    def refusal(self) -> Reason | None:
        """Why what was planned may not run."""
        if self.planned is None:
            return None
        if self.planned.ok and self.planned.duration_s > self.longest_s:
            return Reason("lasts_too_long", {"duration_s": self.planned.duration_s, "max_s": self.longest_s})
        return self.planned.refusal or self.account.refusal(self.planned.certain)

    @property
    def certain(self) -> Extent:
        """What it drives at least, as far as it is there."""
        if self.stream is not None:
            return self.stream.certain
        return self.planned.certain if self.planned is not None else Extent()

    @property
    def left(self) -> Most:
        """What its budget leaves for what comes next."""
        return self.account.left(self.stream.certain if self.stream is not None else Extent())

    @property
    def length_m(self) -> float:
        """Of the whole way, as it was rehearsed."""
        if self.stream is not None:
            return self.stream.length_m
        return self.planned.length_m if self.planned is not None else 0.0

    @property
    def is_open_ended(self) -> bool:
        """The whole way is not known."""
        if self.stream is not None:
            return self.stream.is_open_ended
        return self.planned is not None and self.planned.is_open_ended

    def take(self, planned: Planned) -> Reason | None:
        """What it begins with, rehearsed; why it may not run."""
        self.planned = planned
        return self.stream.accept(planned) if self.stream is not None else self.refusal

    def walk(self) -> Walk:
        """What is to be driven; `take` has accepted its beginning."""
        if self.stream is not None and self.stream.walk is not None:
            return self.stream.walk
        assert self.planned is not None
        return self.planned.walk()

    @property
    def rehearsal(self) -> Rehearsal | None:
        """Of what it begins with."""
        return self.planned.rehearsal if self.planned is not None else None

    @property
    def steps(self) -> tuple[Step, ...]:
        """What was accepted to be driven."""
        if self.stream is not None:
            return self.stream.accepted
        return self.rehearsal.plan.steps if self.rehearsal is not None else ()

    def unmoved(self, outcome: Outcome, reason: Reason | None, pose: Pose) -> Finished:
        """Its end where nothing moved."""
        remaining = self.unread if outcome == "stopped" and not self.rehearse_only else ""
        is_blocked = outcome == "refused" and self.planned is not None and reason == self.planned.refusal
        possible = self.planned.possible if is_blocked and self.planned is not None else ""
        return self.whole(
            Finished(
                self.turn,
                outcome,
                reason,
                pose,
                pose,
                0.0,
                0.0,
                0.0,
                0.0,
                planned_m=self._left_m,
                possible=possible,
                remaining=remaining,
            )
        )

    @property
    def _left_m(self) -> float:
        """The way that was still to be driven, where a part of it was driven before a pause."""
        so_far = self.so_far
        return max(0.0, so_far.planned_m - so_far.path_m) if so_far is not None else 0.0

    def whole(self, finished: Finished) -> Finished:
        """Its end, together with what was done before it was paused."""
        return gone_on(self.so_far, finished) if self.so_far is not None else finished

    @property
    def unread(self) -> str:
        """All the plan text that came."""
        parts = self.stream.waiting if self.stream is not None else ()
        return "\n".join(part.strip("\n") for part in (self.plan_text, *parts))
