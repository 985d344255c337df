"""The link to a Motion in the caller's process, on simulated time. The one module that sees both halves."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.core.errors import LinkError
from chatrobot.core.events import Event, Notice
from chatrobot.link.envelope import Word
from chatrobot.link.motion_link import ClientLine, MotionLink, Sender
from chatrobot.wire.messages import ZERO
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.motion.motion import Motion
    from chatrobot.motion.safety.watchdog import SimulatedGuard


class _End(MotionLink):
    """One client's end of the link."""

    is_simulated = True

    def __init__(self, source: str, number: int) -> None:
        self.sender = Sender(source)
        self.line = ClientLine(number)
        self.events: deque[Event] = deque()
        self._closed = False

    def wake(self) -> None:
        """Nothing waits here: simulated time passes in the caller's thread."""


class InProcessLink(_End):
    """Motion in the caller's process, on a virtual clock that runs only while someone waits for an event.

    Args:
        build: makes Motion, given where its events go.
        advance: lets the simulated robot live for a while (seconds).
        guard_wire: the guard's own end of the wire.
        cmd_vel_topic: where the guard sends its zeros.
    """

    def __init__(
        self,
        build: Callable[[Callable[[Event], None]], Motion],
        wire: Wire,
        clock: VirtualClock,
        advance: Callable[[float], None],
        guard: SimulatedGuard,
        guard_wire: Wire,
        cmd_vel_topic: str,
        source: str = "console",
    ) -> None:
        super().__init__(source, 0)
        self._ends: list[_End] = [self]
        self._motion = build(self._tell)
        self._clock = clock
        self._advance = advance
        self._guard = guard
        self._guard_wire = guard_wire
        self._cmd_vel_topic = cmd_vel_topic
        self._stepping = threading.RLock()
        self._motion.start(wire)
        self.send("hello")

    def second(self, source: str) -> SecondInProcessLink:
        """Return a link of another client, an agent, to the same Motion. There is one at a time.

        Raises:
            LinkError: there was one already.
        """
        if len(self._ends) > 1:
            raise LinkError(
                "this robot's second line is taken: end its session and start again to get another"
            )
        second = SecondInProcessLink(self, source)
        self._ends.append(second)
        second.send("hello")
        return second

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self.send_from(self, word, turn, **payload)

    def send_from(self, end: _End, word: Word, turn: int = 0, **payload: Any) -> None:
        """Say a word in the name of the client at that end."""
        envelope = end.line.inward(end.sender.envelope(word, turn, **payload))
        if envelope is None:
            return
        if (ordered := end.line.ordered(envelope)) is not None:
            self.events.append(ordered)
        self._motion.receive(envelope)

    def next_event(self, timeout_s: float) -> Event | None:
        return self.next_event_at(self, timeout_s)

    def next_event_at(self, end: _End, timeout_s: float) -> Event | None:
        """Return the next event for the client at that end; time passes meanwhile."""
        until_s = self._clock.now_s() + timeout_s
        while not end.events and self._clock.now_s() < until_s - 1e-9:
            self.step()
        return end.events.popleft() if end.events else None

    def step(self) -> None:
        """One period: the sources beat, Motion ticks, the robot moves. Threads take turns."""
        with self._stepping:
            if self.beats:
                self.send("beat", age_s=self.age_s())
            for end in self._ends[1:]:
                if end.beats:
                    end.send("beat")
            self._motion.tick()
            if self._guard.must_halt():
                self._guard_wire.publish(self._cmd_vel_topic, ZERO)
            self._clock.advance(TICK_S)
            self._advance(TICK_S)

    def live(self, duration_s: float) -> None:
        """Let time pass; of what is told meanwhile only notices are kept, for who asks next."""
        until_s = self._clock.now_s() + duration_s
        notices: list[Event] = []
        while (left_s := until_s - self._clock.now_s()) > TICK_S / 2.0:
            event = self.next_event(left_s)
            notices += [event] if isinstance(event, Notice) else []
        self.events.extendleft(reversed(notices))

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        self.send("goodbye")
        while self._motion.is_busy:
            self.step()

    def _tell(self, event: Event) -> None:
        for end in self._ends:
            if (heard := end.line.outward(event)) is not None:
                end.events.append(heard)


class SecondInProcessLink(_End):
    """The link of another client to the Motion of an `InProcessLink`; whoever waits for an event lets time pass."""

    def __init__(self, first: InProcessLink, source: str) -> None:
        super().__init__(source, 1)
        self._first = first

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self._first.send_from(self, word, turn, **payload)

    def next_event(self, timeout_s: float) -> Event | None:
        return self._first.next_event_at(self, timeout_s)

    def close(self) -> None:
        if not self._closed:
            self._closed, self.beats = True, False
            self.send("goodbye")
