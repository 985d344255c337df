"""The link to a Motion in the caller's thread, on simulated time. The one module that sees both halves."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from chatrobot.core.clock import TICK_S, VirtualClock
from chatrobot.core.events import Event, Notice
from chatrobot.link.envelope import Word
from chatrobot.motion.safety.watchdog import SimulatedGuard
from chatrobot.transports.transport import ZERO
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.motion.motion import Motion

from chatrobot.link.motion_link import Sender


class InProcessLink:
    """Motion in the caller's thread, on a virtual clock that runs only while someone waits for an event.

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
        self._events: deque[Event] = deque()
        self._motion = build(self._events.append)
        self._clock = clock
        self._advance = advance
        self._guard = guard
        self._guard_wire = guard_wire
        self._cmd_vel_topic = cmd_vel_topic
        self._sender = Sender(source)
        self._closed = False
        self.beats = True
        self.is_simulated = True
        self._motion.start(wire)
        self.send("hello")

    def send(self, word: Word, turn: int = 0, **payload: Any) -> None:
        self._motion.receive(self._sender.envelope(word, turn, **payload))

    def next_event(self, timeout_s: float) -> Event | None:
        until_s = self._clock.now_s() + timeout_s
        while not self._events and self._clock.now_s() < until_s - 1e-9:
            self.step()
        return self._events.popleft() if self._events else None

    def wake(self) -> None:
        """Nothing waits here: simulated time passes in the caller's thread."""

    @property
    def is_lost(self) -> bool:
        return False

    def step(self) -> None:
        """One period: the source beats, Motion ticks, the robot moves."""
        if self.beats:
            self._motion.receive(self._sender.envelope("beat"))
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
        self._events.extendleft(reversed(notices))

    def abandon(self) -> None:
        self.beats = False
        self._closed = True
        self._motion.lose(self._sender.lease)

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        self.send("goodbye")
        while not self._motion.has_left:
            self.step()
