"""What reaches Motion: envelopes in order, each judged by the stops that came before and after it."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection

from chatrobot.core.reason import Reason
from chatrobot.link.envelope import QUEUE_LIMIT, Envelope
from chatrobot.motion.job import Job


class Intake:
    """The queue of jobs, and who may still join it. `void_turn` and `pause` may be called from any thread."""

    def __init__(self) -> None:
        self.jobs: deque[Job] = deque()
        self._sequences: dict[tuple[str, bool], int] = {}
        self._void_turns: dict[str, int] = {}
        self._pauses: dict[str, int] = {}

    def void_turn(self, lease: str, turn: int) -> None:
        """A stop said after that turn: plans of it and of earlier ones may still be on their way."""
        self._void_turns[lease] = max(turn, self._void_turns.get(lease, turn))

    def pause(self, lease: str) -> None:
        """A pause of that source: what it asked for before may still be on its way, and must not begin after it."""
        self._pauses[lease] = self._pauses.get(lease, 0) + 1

    def resume(self, job: Job) -> None:
        """Put the rest of a plan that was paused before all others."""
        self.jobs.appendleft(job)

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

    def is_void(self, job: Job, epoch: int) -> bool:
        """A stop has overtaken it."""
        is_paused = job.pauses is not None and job.pauses < self._pauses.get(job.lease, 0)
        return job.epoch != epoch or is_paused or job.turn <= self._void_turns.get(job.lease, -1)

    def add(self, job: Job) -> Reason | None:
        """Queue `job`, or say why not: too many wait."""
        if len(self.jobs) >= QUEUE_LIMIT:
            return Reason("queue_full", {"limit": QUEUE_LIMIT})
        self.jobs.append(job)
        return None

    def take_void(self, epoch: int) -> list[Job]:
        """Remove and return what was received before the stop that began `epoch`; what came after it stays."""
        void = [job for job in self.jobs if job.epoch != epoch]
        for job in void:
            self.jobs.remove(job)
        return void

    def take(self, jobs: Collection[Job]) -> list[Job]:
        """Remove and return those of `jobs` that wait."""
        taken = [job for job in self.jobs if any(job is one for one in jobs)]
        for job in taken:
            self.jobs.remove(job)
        return taken

    def take_all(self) -> list[Job]:
        """Remove and return everything."""
        jobs = list(self.jobs)
        self.jobs.clear()
        return jobs
