"""A goal: one turn's plan on its way through Motion; and what waits for the control thread: goals, and actions."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from typing import TypeVar

from chatrobot.core.events import Finished, Outcome
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason
from chatrobot.core.summed import gone_on
from chatrobot.link.approval import Approval
from chatrobot.link.envelope import QUEUE_LIMIT, Envelope, seconds
from chatrobot.motion.budgets import Account
from chatrobot.motion.plan_stream import Stream
from chatrobot.motion.planner import Planned
from chatrobot.plan.free_part import Most


@dataclass
class Goal:
    """`epoch` is the stop epoch it was received in: a later stop makes it void. `start` is where it begins.

    `longest_s` is what the source may take: a plan that rehearsal expects to last longer is refused. `stream` holds
    its parts: one that begins with `plan_text`, and those that follow while it runs. `planned` is the first of them.
    `account` is what its text may drive, and has driven. Where the goal is the rest of a plan that was paused,
    `plan_start` is where the whole began and `so_far` what was measured of it.
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
    stream: Stream = field(default_factory=Stream)
    pauses: int | None = None
    account: Account = field(default_factory=Account)
    plan_start: Pose | None = None
    so_far: Finished | None = None

    @classmethod
    def of(cls, envelope: Envelope, epoch: int, now_s: float, account: Account | None = None) -> Goal:
        """Make the goal that a `plan` envelope asks for."""
        payload = envelope.payload
        approve, rehearse_only = bool(payload.get("approve")), bool(payload.get("rehearse_only"))
        return cls(
            turn=envelope.turn,
            lease=envelope.lease,
            plan_text=str(payload.get("plan_text", "")),
            approve=approve,
            rehearse_only=rehearse_only,
            epoch=epoch,
            received_s=now_s,
            longest_s=seconds(payload.get("longest_s"), math.inf),
            stream=Stream(is_open=bool(payload.get("more")) and not (approve or rehearse_only)),
            pauses=payload.get("pauses"),
            account=account or Account(),
        )

    @property
    def refusal(self) -> Reason | None:
        """Why what was planned may not run."""
        return self.stream.refusal

    @property
    def length_m(self) -> float:
        """The length of the whole way, as it was rehearsed."""
        return self.stream.length_m

    @property
    def is_open_ended(self) -> bool:
        """True where the whole way is not known."""
        return self.stream.is_open_ended

    @property
    def left(self) -> Most:
        """What its budget leaves for what comes next."""
        return self.account.left(self.stream.certain)

    def take(self, planned: Planned) -> Reason | None:
        """Append the next part as it was rehearsed; return why it may not run."""
        self.planned = self.planned or planned
        return self.stream.accept(planned, self.account, self.longest_s)

    def unmoved(self, outcome: Outcome, reason: Reason | None, pose: Pose) -> Finished:
        """Return its end where nothing moved."""
        is_blocked = outcome == "refused" and reason == self.stream.refusal
        # The way that was still to be driven, where a part of it was driven before a pause.
        left_m = max(0.0, self.so_far.planned_m - self.so_far.path_m) if self.so_far is not None else 0.0
        unmoved = Finished(self.turn, outcome, reason, pose, pose, 0.0, 0.0, 0.0, 0.0, planned_m=left_m)
        possible = self.stream.possible if is_blocked else ""
        remaining = self._unread if outcome == "stopped" and not self.rehearse_only else ""
        return self.whole(replace(unmoved, possible=possible, remaining=remaining))

    def whole(self, finished: Finished) -> Finished:
        """Return its end together with what was done before it was paused."""
        return gone_on(self.so_far, finished) if self.so_far is not None else finished

    @property
    def _unread(self) -> str:
        """All the plan text that came."""
        return "\n".join(part.strip("\n") for part in (self.plan_text, *self.stream.waiting))


class GoalQueue:
    """The queue of goals, and who may still join it. `void_turn` and `pause` may be called from any thread."""

    def __init__(self) -> None:
        self.goals: deque[Goal] = deque()
        self._sequences: dict[tuple[str, bool], int] = {}
        self._void_turns: dict[str, int] = {}
        self._pauses: dict[str, int] = {}

    def void_turn(self, lease: str, turn: int) -> None:
        """A stop said after that turn: plans of it and of earlier ones may still be on their way."""
        self._void_turns[lease] = max(turn, self._void_turns.get(lease, turn))

    def pause(self, lease: str) -> None:
        """A pause of that source: what it asked for before may still be on its way, and must not begin after it."""
        self._pauses[lease] = self._pauses.get(lease, 0) + 1

    def resume(self, goal: Goal) -> None:
        """Put the rest of a plan that was paused before all others."""
        self.goals.appendleft(goal)

    def forget(self, lease: str) -> None:
        """Nothing is to be known of that lease any more."""
        self._void_turns.pop(lease, None)
        self._pauses.pop(lease, None)
        for is_beat in (True, False):
            self._sequences.pop((lease, is_beat), None)

    def is_old(self, envelope: Envelope) -> bool:
        """A later one of the same lease was here before. Beats, sent by a thread of their own, count for themselves."""
        kind = (envelope.lease, envelope.word == "beat")
        if envelope.sequence <= self._sequences.get(kind, -1):
            return True
        self._sequences[kind] = envelope.sequence
        return False

    def is_void(self, goal: Goal, epoch: int) -> bool:
        """A stop has overtaken it."""
        is_paused = goal.pauses is not None and goal.pauses < self._pauses.get(goal.lease, 0)
        return goal.epoch != epoch or is_paused or goal.turn <= self._void_turns.get(goal.lease, -1)

    def add(self, goal: Goal) -> Reason | None:
        """Queue `goal`, or say why not: too many wait."""
        if len(self.goals) >= QUEUE_LIMIT:
            return Reason("queue_full", {"limit": QUEUE_LIMIT})
        self.goals.append(goal)
        return None

    def take_void(self, epoch: int) -> list[Goal]:
        """Remove and return what was received before the stop that began `epoch`; what came after it stays."""
        void = [goal for goal in self.goals if goal.epoch != epoch]
        for goal in void:
            self.goals.remove(goal)
        return void

    def take(self, goals: Collection[Goal]) -> list[Goal]:
        """Remove and return those of `goals` that wait."""
        taken = [goal for goal in self.goals if any(goal is one for one in goals)]
        for goal in taken:
            self.goals.remove(goal)
        return taken

    def take_all(self) -> list[Goal]:
        """Remove and return everything."""
        goals = list(self.goals)
        self.goals.clear()
        return goals


T = TypeVar("T")


class Inbox:
    """Keeps the actions that wait for the next tick. All but `post` belongs to the control thread.

    Args:
        background: runs a function off the control thread; a simulation runs it at once.
    """

    def __init__(self, background: Callable[[Callable[[], None]], None]) -> None:
        self._background = background
        self._actions: deque[Callable[[], None]] = deque()

    def post(self, action: Callable[[], None]) -> None:
        """Have `action` done with the next tick."""
        self._actions.append(action)

    def fetch(self, work: Callable[[], T], take: Callable[[T], None]) -> None:
        """Have `work` done off the control thread; what it gives is taken on it, with a tick to come."""

        def run() -> None:
            result = work()
            self.post(lambda: take(result))

        self._background(run)

    def take(self) -> Callable[[], None] | None:
        """The next action, None where there is none."""
        return self._actions.popleft() if self._actions else None

    def __bool__(self) -> bool:
        return bool(self._actions)
