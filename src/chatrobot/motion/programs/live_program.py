"""A running program as Motion's control loop polls it: in real time, or in step with a simulated clock."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from chatrobot.core.reason import Reason
from chatrobot.governor.tick import TICK_S
from chatrobot.motion.programs.program_senses import Senses, stamped
from chatrobot.programs.events import ENDS, AsksTime, Beat, Died, Listens, ProgramEvent
from chatrobot.programs.sandboxed import SandboxedProgram

POLLS_A_TICK = 8
"""A flood is read on with the next tick: the control loop has other work."""
STEP_LIMIT_S = 5.0
"""A program on virtual time that computes for so long here, without its time going on, is ended."""
_WAIT_S = 0.2
_SLACK_S = 1e-9


class RealTimeProgram:
    """It runs by itself; what it said since the last tick is read, what sensors said is passed on."""

    def __init__(self, program: SandboxedProgram, senses: Senses) -> None:
        self._program = program
        self._senses = senses

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        found: list[ProgramEvent] = []
        for _ in range(POLLS_A_TICK):
            events = self._program.poll()
            found += events
            for event in events:
                if isinstance(event, Listens):
                    self._senses.listen(event.sensor, event.depth)
            if not events:
                break
        for words in self._senses.take():
            sensor, *values = stamped(words, now_s)
            self._program.tell(sensor, values)
        return found

    def close(self) -> None:
        self._program.close()


class InStepProgram:
    """It lives on virtual time: it gets as much of it as has passed, and what sensors said meanwhile."""

    def __init__(self, program: SandboxedProgram, senses: Senses) -> None:
        self._program = program
        self._senses = senses
        self._coming: deque[ProgramEvent] = deque()
        self._asking: AsksTime | None = None

    def poll_until(self, now_s: float) -> Sequence[ProgramEvent]:
        found: list[ProgramEvent] = []
        waited_s = 0.0
        while True:
            while self._coming and _time_of(self._coming[0], now_s) <= now_s + _SLACK_S:
                event = self._coming.popleft()
                if isinstance(event, Listens):
                    self._senses.listen(event.sensor, event.depth)
                elif isinstance(event, AsksTime):
                    self._asking = event
                else:
                    found.append(event)
            if found and isinstance(found[-1], ENDS):
                return found
            if self._coming or not self._may_go_on(now_s):
                return [*found, Beat(now_s)]
            events = self._program.poll(_WAIT_S)
            self._coming.extend(events)
            waited_s = 0.0 if events else waited_s + _WAIT_S
            if waited_s > STEP_LIMIT_S:
                self._program.close()
                return [*found, Died(Reason("program_too_busy", {"limit_s": STEP_LIMIT_S}), "")]

    def close(self) -> None:
        self._program.close()

    def _may_go_on(self, now_s: float) -> bool:
        """Answer what it asks, if there is an answer by now; True where it computes."""
        asking = self._asking
        if asking is None:
            return self._program.end is None
        messages = self._senses.take() if asking.wakes or asking.until_s <= now_s + _SLACK_S else []
        if not messages and asking.until_s > now_s + _SLACK_S:
            return False
        reached_s = min(now_s, asking.until_s) if asking.until_s <= now_s + _SLACK_S else now_s
        self._asking = None
        told = [stamped(words, reached_s) for words in messages]
        self._program.let_pass(max(reached_s, asking.t_s), now_s + TICK_S, told)
        return True


def _time_of(event: ProgramEvent, now_s: float) -> float:
    return now_s if isinstance(event, Died) else event.t_s
