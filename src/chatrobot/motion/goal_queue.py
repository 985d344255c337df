"""What waits for the control thread: goals in their order, actions, and ends to be told."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from typing import TypeVar

from chatrobot.core.events import Event, Finished, Outcome
from chatrobot.core.reason import Reason
from chatrobot.link.envelope import QUEUE_LIMIT, Envelope
from chatrobot.motion.goal import Goal
from chatrobot.motion.governed_robot import GovernedRobot

_COUNTED_APART = ("beat", "steer")
"""Said by threads of their own, many times a second."""


class GoalQueue:
    """Keeps goals in their order, and who may still join them. Any thread may call `void_turn` and `pause`."""

    def __init__(self) -> None:
        self.goals: deque[Goal] = deque()
        self._sequences: dict[tuple[str, str], int] = {}
        self._void_turns: dict[str, int] = {}
        self._pauses: dict[str, int] = {}

    def void_turn(self, lease: str, turn: int) -> None:
        """Make void that turn and earlier ones, before a stop: plans of them may still be on their way."""
        self._void_turns[lease] = max(turn, self._void_turns.get(lease, turn))

    def pause(self, lease: str) -> None:
        """Count a pause of that source: what it asked for before may still come, and must not begin after it."""
        self._pauses[lease] = self._pauses.get(lease, 0) + 1

    def resume(self, goal: Goal) -> None:
        """Put the rest of a plan that was paused before all others."""
        self.goals.appendleft(goal)

    def forget(self, lease: str) -> None:
        """Forget that lease."""
        self._void_turns.pop(lease, None)
        self._pauses.pop(lease, None)
        for word in ("", *_COUNTED_APART):
            self._sequences.pop((lease, word), None)

    def is_old(self, envelope: Envelope) -> bool:
        """Return whether a later one of the same lease was here before. What other threads send counts apart."""
        kind = (envelope.lease, envelope.word if envelope.word in _COUNTED_APART else "")
        if envelope.sequence <= self._sequences.get(kind, -1):
            return True
        self._sequences[kind] = envelope.sequence
        return False

    def is_void(self, goal: Goal, epoch: int) -> bool:
        """Return whether a stop has overtaken it."""
        is_paused = goal.pauses is not None and goal.pauses < self._pauses.get(goal.lease, 0)
        return goal.epoch != epoch or is_paused or goal.turn <= self._void_turns.get(goal.lease, -1)

    def add(self, goal: Goal) -> Reason | None:
        """Queue `goal`; return why not where too many wait."""
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

    def take_turn(self, lease: str, turn: int) -> list[Goal]:
        """Remove and return what waits of that turn."""
        return self.take([goal for goal in self.goals if (goal.lease, goal.turn) == (lease, turn)])

    def put_instead(self, goal: Goal, turn: int) -> list[Goal]:
        """Put `goal` in the place of what waits of that turn of its source; return what it takes the place of."""
        for number, waiting in enumerate(self.goals):
            if (waiting.lease, waiting.turn) == (goal.lease, turn):
                self.goals[number] = goal
                return [waiting]
        return []

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
        """Have `work` done off the control thread, and `take` what it gives on it, with a tick to come."""

        def run() -> None:
            result = work()
            self.post(lambda: take(result))

        self._background(run)

    def take(self) -> Callable[[], None] | None:
        """Return the next action, None where there is none."""
        return self._actions.popleft() if self._actions else None

    def __bool__(self) -> bool:
        return bool(self._actions)


class OutcomeQueue:
    """Tells ends in their order. An end is made when it is told, so that it says what was measured by then.

    Of a robot without odometry no end is told as measured, and be it of what never moved.
    """

    def __init__(self, robot: GovernedRobot, emit: Callable[[Event], None]) -> None:
        self._robot = robot
        self._emit = emit
        self._untold: deque[Callable[[], Finished]] = deque()

    @property
    def are_told(self) -> bool:
        """True where none waits to be told."""
        return not self._untold

    def tell(self, end: Callable[[], Finished]) -> None:
        """Tell it now, or after those that wait."""
        if self._untold:
            self._untold.append(end)
        else:
            self._tell(end)

    def tell_unmoved(self, goal: Goal, outcome: Outcome, reason: Reason | None) -> None:
        """Tell the end of a goal that has not moved."""
        self.tell(lambda: goal.unmoved(outcome, reason, self._robot.pose))

    def tell_all_unmoved(self, goals: Iterable[Goal], outcome: Outcome, reason: Reason | None) -> None:
        """Tell the ends of goals that have not moved."""
        for goal in goals:
            self.tell_unmoved(goal, outcome, reason)

    def tell_later(self, end: Callable[[], Finished]) -> None:
        """Tell it once the robot stands."""
        self._untold.append(end)

    def tell_all(self) -> None:
        """Tell all that wait: the robot stands, or nobody sees whether it does."""
        while self._untold:
            self._tell(self._untold.popleft())

    def _tell(self, end: Callable[[], Finished]) -> None:
        finished = end()
        self._emit(finished if self._robot.profile.has_odometry else replace(finished, measured=False))
