"""What allows motion: the line to the guard, the detector of stalls of this process, and the interlock."""

from __future__ import annotations

import contextlib
import socket
import subprocess
from collections import deque
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

from chatrobot.core.clock import TICK_S, Clock
from chatrobot.core.process import is_machine_busy
from chatrobot.core.reason import Reason
from chatrobot.guard.watch import BEAT, ECHO_LATE_S, ECHO_LOST_S, GOODBYE, HANDSHAKE, MISSED_S, TRIPPED, Watch
from chatrobot.link.processes import spawn_with_line
from chatrobot.robots.profile import Wiring

if TYPE_CHECKING:  # the process that talks loads this module for its guard, and no numpy
    from chatrobot.governor.governor import Governor

_AT_ONCE = int(socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)


class GuardLink(Protocol):
    """Motion's line to the guard: Motion refuses to move while it has been silent for `ECHO_LOST_S`."""

    def handshake(self) -> None:
        """Begin anew: a trip that the guard has told is known."""

    def beat(self) -> None:
        """Say that Motion is there."""

    def silent_s(self) -> float:
        """Return how long the guard has been silent, as it was last heard; infinite where it is gone."""
        ...

    def was_tripped(self) -> bool:
        """Hear what the guard has answered; return whether it has tripped since the last handshake."""
        ...

    def goodbye(self) -> None:
        """Say that nothing is to be watched any more."""


class GuardLine:
    """The line to a guard in another process, whose answers come when it gets a processor.

    Args:
        line: our end of a stream socket; never blocks.
        process: the guard's, where we have started it.
    """

    def __init__(
        self, line: socket.socket, clock: Clock, process: subprocess.Popen[bytes] | None = None
    ) -> None:
        self.process = process
        self._clock = clock
        self._line = line
        self._line.setblocking(False)
        self._echo_at_s = float("-inf")
        self._is_shaking_hands = False
        self._tripped = False

    def handshake(self) -> None:
        """Say hello; what comes before the answer is about a trip that is known."""
        self._tripped, self._is_shaking_hands = False, True
        self._say(HANDSHAKE)

    def beat(self) -> None:
        self._say(BEAT)

    def silent_s(self) -> float:
        """Return how long ago the last answer came."""
        return self._clock.now_s() - self._echo_at_s

    def was_tripped(self) -> bool:
        """Read what has been answered; return whether the guard has tripped since the last handshake."""
        self._hear()
        return self._tripped

    def goodbye(self) -> None:
        """Say goodbye, and close the line."""
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
        return self.silent_s() < ECHO_LOST_S

    def _say(self, word: bytes) -> None:
        with contextlib.suppress(OSError):  # a guard that is gone shows in `silent_s`
            self._line.send(word, _AT_ONCE)

    def _hear(self) -> None:
        try:
            answers = self._line.recv(4096)
        except BlockingIOError:
            return
        except OSError:
            answers = b""
        # Its end is closed: it is dead, and nobody has to wait to see that.
        self._echo_at_s = self._clock.now_s() if answers else float("-inf")
        if self._is_shaking_hands:
            # What it said before it heard our handshake is about a trip that we know of.
            _, handshake, answers = answers.rpartition(HANDSHAKE)
            self._is_shaking_hands = not handshake
            answers = answers if handshake else b""
        self._tripped = self._tripped or TRIPPED in answers


def start_guard(
    addresses: Sequence[str], wiring: Wiring, clock: Clock, *, is_near: bool = False
) -> GuardLine:
    """Start a guard in a process and session of its own.

    Args:
        addresses: of the wires of the robots that this process drives (`chatrobot.wire.connect`).
        wiring: names the topics it halts and watches, and the namespace it lives in.
        is_near: the robots' process is on this machine.
    """
    process, line = spawn_with_line(
        "chatrobot.guard",
        *(word for address in addresses for word in ("--wire", address)),
        *("--topic", wiring.cmd_vel_topic, "--type", wiring.cmd_vel_type),
        *("--odom", wiring.odom_topic, "--odom-type", wiring.odom_type),
        *("--namespace", wiring.namespace, "--near", "yes" if is_near else "no"),
        kind=socket.SOCK_STREAM,
    )
    return GuardLine(line, clock, process)


class SharedGuard:
    """The guard of the robots of a class, whose Motions one thread ticks: one line, one beat for all of them.

    That thread's beats show that each of them is ticked, for a robot that it did not tick would have ended the process.
    A trip is told to each Motion, until it has shaken hands itself.
    """

    def __init__(self, line: GuardLine, clock: Clock) -> None:
        self.line = line
        self.shares: list[GuardShare] = []
        self._clock = clock
        self._next_s = float("-inf")

    def share(self) -> GuardShare:
        """Make the share of one robot."""
        self.shares.append(GuardShare(self))
        return self.shares[-1]

    def beat(self) -> None:
        """Beat, if nobody has within this period; hear first, so that no trip is missed."""
        now_s = self._clock.now_s()
        if now_s >= self._next_s:
            self._next_s = now_s + 0.75 * TICK_S
            self.line.beat()

    def hear(self) -> None:
        """Tell each of a trip."""
        if self.line.was_tripped():
            for share in self.shares:
                share.is_tripped = True

    def leave(self, share: GuardShare) -> None:
        """Say goodbye with the last of them."""
        self.shares.remove(share)
        if not self.shares:
            self.line.goodbye()


class GuardShare:
    """One robot's share of a `SharedGuard`. A `GuardLink`."""

    def __init__(self, shared: SharedGuard) -> None:
        self._shared = shared
        self.is_tripped = False
        """The guard has tripped since this robot's last handshake."""

    def handshake(self) -> None:
        self.is_tripped = False
        self._shared.line.handshake()

    def beat(self) -> None:
        self._shared.beat()

    def silent_s(self) -> float:
        """Return how long the guard has been silent."""
        return self._shared.line.silent_s()

    def was_tripped(self) -> bool:
        """Hear what the guard has answered; return whether it has tripped since this robot's last handshake."""
        self._shared.hear()
        return self.is_tripped

    def goodbye(self) -> None:
        """Leave it to the others."""
        self._shared.leave(self)

    def wait_until_alive(self, timeout_s: float) -> bool:
        """Block until the guard answers its first handshake."""
        return self.silent_s() < ECHO_LOST_S or self._shared.line.wait_until_alive(timeout_s)


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

    def silent_s(self) -> float:
        """Return 0: it cannot die."""
        return 0.0

    def was_tripped(self) -> bool:
        """Return whether it has tripped since the last handshake."""
        return self._tripped

    def goodbye(self) -> None:
        """Watch nothing any more."""
        self._watch = Watch()

    def must_halt(self) -> bool:
        """Return whether the guard has to halt the robot now."""
        return self._watch.must_halt(self._clock.now_s())


FROZEN_S = MISSED_S
"""A gap this long between two ticks of a moving robot means that this process stood still: the plan is over."""
LATE_S = 2.0 * TICK_S
"""A gap between two ticks up to this is nothing unusual."""
ANSWERED_TICKS = 10
"""The guard tells of a trip within so many ticks, or it is taken for dead."""


class StallDetector:
    """Looks at the clock and at the guard with every tick, before anything else is done."""

    def __init__(self, clock: Clock, guard: GuardLink, halt: Callable[[Reason], None]) -> None:
        self._clock = clock
        self._guard = guard
        self._halt = halt
        self._last_tick_s: float | None = None
        self._last_beat_s: float | None = None
        self._beat_gaps_s = deque([0.0], maxlen=ANSWERED_TICKS)
        self._suspended_s = clock.suspended_s()
        self._is_driven = False
        self._was_stopped = False

    def tick(self, now_s: float, *, is_driven: bool, is_engaged: bool) -> float:
        """Halt where this process was frozen, or the guard thinks so; then shake hands with it anew.

        Args:
            is_driven: a velocity of ours, or of others through us, moves the robot.
            is_engaged: something is being done, be it that it waits for a yes. What slept through a suspended
                machine is over, too.

        Returns:
            How late this tick is, seconds; 0 where that is nothing unusual.
        """
        suspended_s = self._suspended_since_last_tick_s()
        gap_s = suspended_s + (now_s - self._last_tick_s if self._last_tick_s is not None else 0.0)
        self._last_tick_s, self._is_driven = now_s, is_driven
        was_stopped, self._was_stopped = self._was_stopped, False
        tripped = self._guard.was_tripped()
        slept = suspended_s > FROZEN_S and is_engaged
        if slept or (is_driven and (gap_s > FROZEN_S or was_stopped)):
            is_starved = not (was_stopped or suspended_s > FROZEN_S) and is_machine_busy()
            self._halt(_late(gap_s) if is_starved else Reason("motion_froze", {"gap_s": round(gap_s, 2)}))
        elif is_driven and tripped:  # we were there, and our beats came late all the same
            beat_gap_s = max(self._beat_gaps_s)
            is_busy = beat_gap_s > LATE_S and is_machine_busy()
            self._halt(_late(beat_gap_s) if is_busy else Reason("beats_missed"))
        if tripped or gap_s > FROZEN_S:
            self._guard.handshake()
        return gap_s - TICK_S if gap_s > LATE_S else 0.0

    def beat(self, now_s: float) -> None:
        """Say to the guard that this process is there."""
        self._guard.beat()
        if self._last_beat_s is not None:
            self._beat_gaps_s.append(now_s - self._last_beat_s)
        self._last_beat_s = now_s

    def thaw(self, now_s: float) -> Reason | None:
        """Note that a signal had stopped this process; return why what is driven is over."""
        self._was_stopped = True
        since_s = now_s - self._last_tick_s if self._last_tick_s is not None else 0.0
        return Reason("motion_froze", {"gap_s": round(since_s, 2)}) if self._is_driven else None

    def _suspended_since_last_tick_s(self) -> float:
        before_s, self._suspended_s = self._suspended_s, self._clock.suspended_s()
        return self._suspended_s - before_s


def _late(gap_s: float) -> Reason:
    return Reason("motion_late", {"late_s": round(gap_s, 2)})


class Interlock:
    """Allows motion, or says why nothing may move. Belongs to the control thread but for `obstruction`."""

    def __init__(self, governor: Governor, guard: GuardLink) -> None:
        self._governor = governor
        self._guard = guard
        self.obstruction: Reason | None = None
        """Why nothing may move for now, by those who look after the wire; any thread may set it."""

    def barrier(self) -> Reason | None:
        """Return why nothing may move, whoever asks: an emergency stop, the wire, or a guard that is not there."""
        if self._governor.latched is not None:
            return self._governor.latched
        if self.obstruction is not None:
            return self.obstruction
        return None if self._guard.silent_s() < ECHO_LOST_S else Reason("guard_lost")

    def awaits_guard(self, barrier: Reason) -> bool:
        """Return whether `barrier` may be gone in a moment: a busy machine holds up a guard that is there."""
        return barrier.code == "guard_lost" and self._guard.silent_s() < ECHO_LATE_S

    def barrier_for(self, lease: str, now_s: float) -> Reason | None:
        """Return why what asks under that lease may not move."""
        barrier, leases = self.barrier(), self._governor.leases
        if barrier is not None:
            return barrier
        is_late = leases.is_late(lease, now_s)
        is_stopped = is_late and leases.is_stopped(lease)
        if leases.is_valid(lease, now_s) and not is_stopped:
            return None
        if is_late and not is_stopped and is_machine_busy():
            return leases.lateness(lease, now_s)
        return Reason("lease_lapsed", {"source": leases.source_of(lease)})
