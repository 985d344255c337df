"""Motion's end of the line to its guard."""

from __future__ import annotations

import contextlib
import socket
from typing import Protocol

from chatrobot.core.clock import Clock
from chatrobot.guard.watch import BEAT, ECHO_LOST_S, GOODBYE, HANDSHAKE, TRIPPED, Watch
from chatrobot.link.processes import spawn_with_line
from chatrobot.robots.profile import Wiring


class GuardLink(Protocol):
    """Motion refuses to move while `is_alive` is false."""

    def handshake(self) -> None: ...

    def beat(self) -> None: ...

    def is_alive(self) -> bool:
        """True while the guard answers, as it was last heard."""
        ...

    def was_tripped(self) -> bool:
        """Hear what the guard has answered, at the beginning of each tick. True from when it has tripped until the
        handshake that is then due."""
        ...

    def goodbye(self) -> None: ...


class GuardLine:
    """The line to a guard in another process, whose answers come when it gets a processor.

    Args:
        line: our end of a stream socket; never blocks.
    """

    def __init__(self, line: socket.socket, clock: Clock) -> None:
        self._clock = clock
        self._line = line
        self._line.setblocking(False)
        self._echo_at_s = float("-inf")
        self._is_shaking_hands = False
        self._tripped = False

    def handshake(self) -> None:
        self._tripped, self._is_shaking_hands = False, True
        self._say(HANDSHAKE)

    def beat(self) -> None:
        self._say(BEAT)

    def is_alive(self) -> bool:
        return self._clock.now_s() - self._echo_at_s < ECHO_LOST_S

    def was_tripped(self) -> bool:
        self._hear()
        return self._tripped

    def goodbye(self) -> None:
        self._say(GOODBYE)
        self._line.close()

    def wait_until_alive(self, timeout_s: float) -> bool:
        """Block until the guard answers its first handshake. For start-up only."""
        self.handshake()
        self._line.settimeout(timeout_s)
        try:
            self._line.recv(1, socket.MSG_PEEK)
        except OSError:
            return False
        finally:
            self._line.setblocking(False)
        self._hear()
        return self.is_alive()

    def _say(self, word: bytes) -> None:
        with contextlib.suppress(OSError):  # a guard that is gone shows in `is_alive`
            self._line.send(word, socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)

    def _hear(self) -> None:
        try:
            answers = self._line.recv(4096)
        except BlockingIOError:
            return
        except OSError:
            answers = b""
        # Its end is closed: it is dead, and nobody has to wait to see that.
        self._echo_at_s = self._clock.now_s() if answers else float("-inf")
        if (
            self._is_shaking_hands
        ):  # what it said before it heard our handshake is about a trip that we know of
            _, handshake, answers = answers.rpartition(HANDSHAKE)
            self._is_shaking_hands = not handshake
            answers = answers if handshake else b""
        self._tripped = self._tripped or TRIPPED in answers


class GuardProcess(GuardLine):
    """A guard in a process and session of its own.

    Args:
        wire_address: the robot's wire (`chatrobot.wire.connect`).
        wiring: names the topics it halts and watches, and the namespace it lives in.
        is_near: the robot's process is on this machine.
    """

    def __init__(self, wire_address: str, wiring: Wiring, clock: Clock, *, is_near: bool = False) -> None:
        self.process, line = spawn_with_line(
            "chatrobot.guard",
            *("--wire", wire_address),
            *("--topic", wiring.cmd_vel_topic, "--type", wiring.cmd_vel_type),
            *("--odom", wiring.odom_topic, "--odom-type", wiring.odom_type),
            *("--namespace", wiring.namespace, "--near", "yes" if is_near else "no"),
            kind=socket.SOCK_STREAM,
        )
        super().__init__(line, clock)


class SimulatedGuard:
    """The guard's rule on the clock of a simulation: whoever drives that clock asks `must_halt`."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._watch = Watch()
        self._tripped = False

    def handshake(self) -> None:
        self._tripped = False
        self._watch.hear(HANDSHAKE, self._clock.now_s())

    def beat(self) -> None:
        self._watch.hear(BEAT, self._clock.now_s())
        self._tripped = self._tripped or self._watch.state == "tripped"

    def is_alive(self) -> bool:
        return True

    def was_tripped(self) -> bool:
        return self._tripped

    def goodbye(self) -> None:
        self._watch = Watch()

    def must_halt(self) -> bool:
        return self._watch.must_halt(self._clock.now_s())
