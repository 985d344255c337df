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


class InProcessLink(MotionLink):
    """Motion in the caller's process, on a virtual clock that runs only while someone waits for an event.

    Args:
        build: makes Motion, given where its events go.
        advance: lets the simulated robot live for a while (seconds).
        guard_wire: the guard's own end of the wire.
        cmd_vel_topic: where the guard sends its zeros.
    """

    is_simulated = True

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
        self._end = _End(source, ClientLine(0))
        self._ends = [self._end]
        self._motion = build(self._tell)
        self._clock = clock
        self._advance = advance
        self._guard = guard
        self._guard_wire = guard_wire
        self._cmd_vel_topic = cmd_vel_topic
        self._sender = self._end.sender
        self._stepping = threading.RLock()
        self._closed = False
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
        end = _End(source, ClientLine(1))
        self._ends.append(end)
        return SecondInProcessLink(self, end)

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self.send_from(self._end, word, turn, **payload)

    def send_from(self, end: _End, word: Word, turn: int = 0, **payload: Any) -> None:
        """Say a word in the name of the client at that end."""
        envelope = end.line.inward(end.sender.envelope(word, turn, **payload))
        if envelope is None:
            return
        if (ordered := end.line.ordered(envelope)) is not None:
            self._end.events.append(ordered)
        self._motion.receive(envelope)

    def next_event(self, timeout_s: float) -> Event | None:
        return self.next_event_at(self._end, timeout_s)

    def next_event_at(self, end: _End, timeout_s: float) -> Event | None:
        """Return the next event for the client at that end; time passes meanwhile."""
        until_s = self._clock.now_s() + timeout_s
        while not end.events and self._clock.now_s() < until_s - 1e-9:
            self.step()
        return end.events.popleft() if end.events else None

    def wake(self) -> None:
        """Nothing waits here: simulated time passes in the caller's thread."""

    def step(self) -> None:
        """One period: the sources beat, Motion ticks, the robot moves. Threads take turns."""
        with self._stepping:
            if self.beats:
                self.send("beat", age_s=self.age_s())
            for end in self._ends[1:]:
                if end.beats:
                    self.send_from(end, "beat")
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
        self._end.events.extendleft(reversed(notices))

    def abandon(self) -> None:
        self.beats = False
        self._closed = True
        self._motion.lose(self._sender.lease)

    def abandon_second(self, end: _End) -> None:
        """The client at that end is gone without a goodbye."""
        self._motion.lose_second(end.sender.lease)

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


class _End:
    """What the link keeps for one client."""

    def __init__(self, source: str, line: ClientLine) -> None:
        self.sender = Sender(source)
        self.line = line
        self.events: deque[Event] = deque()
        self.beats = True


class SecondInProcessLink(MotionLink):
    """The link of another client to the Motion of an `InProcessLink`; whoever waits for an event lets time pass."""

    is_simulated = True

    def __init__(self, first: InProcessLink, end: _End) -> None:
        self._first, self._end = first, end
        self._closed = False
        self.send("hello")

    @property
    def beats(self) -> bool:
        """Whether the source keeps its lease."""
        return self._end.beats

    @beats.setter
    def beats(self, beats: bool) -> None:
        self._end.beats = beats

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self._first.send_from(self._end, word, turn, **payload)

    def next_event(self, timeout_s: float) -> Event | None:
        return self._first.next_event_at(self._end, timeout_s)

    def wake(self) -> None:
        """Nothing waits here, as at the first link."""

    def abandon(self) -> None:
        self._closed, self._end.beats = True, False
        self._first.abandon_second(self._end)

    def close(self) -> None:
        if not self._closed:
            self._closed, self._end.beats = True, False
            self.send("goodbye")
