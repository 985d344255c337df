"""Queues the goals that reach Motion: envelopes in order, each judged by the stops that came before and after it."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection

from chatrobot.core.reason import Reason
from chatrobot.link.envelope import QUEUE_LIMIT, Envelope
from chatrobot.motion.goal import Goal


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
