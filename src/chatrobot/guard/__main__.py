"""The guard's process: `python -m chatrobot.guard --topic cmd_vel --odom odom --near yes --wire ADDRESS --fd N`.

Started by Motion in a session of its own, so that neither Ctrl-C, Ctrl-Z nor a closed terminal reaches it. Where one
process holds the Motions of several robots, `--wire ADDRESS --fd N` comes once for each: a line and a wire of its own.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import sys
from collections.abc import Callable, Sequence
from functools import partial

from chatrobot.core.clock import TICK_S, awake_or_not_s
from chatrobot.core.errors import WireError
from chatrobot.core.process import GUARD, prefer, wake_promptly
from chatrobot.core.wiring import Wiring
from chatrobot.guard.watch import GOODBYE, HANDSHAKE, TRIPPED, Departure, Watch
from chatrobot.wire.connect import connect_wire
from chatrobot.wire.messages import ZERO, Odometry, TwistMessage
from chatrobot.wire.wire import Wire

STANDING_S = 1.0
"""A robot whose Motion is dead has been seen standing this long: the guard's work is done."""

GIVE_UP_S = 30.0
"""Without odometry nobody can see it standing; after this long of zeros nobody is left to serve."""


class Standing:
    """Since when odometry has shown the robot standing."""

    def __init__(self) -> None:
        self._since_s: float | None = None

    def on_odometry(self, message: Odometry) -> None:
        """Take in what the robot tells of its motion."""
        if abs(message.vx_mps) + abs(message.vy_mps) + abs(message.wz_radps) > 0.01:
            self._since_s = None
        elif self._since_s is None:
            self._since_s = awake_or_not_s()

    def for_s(self, now_s: float) -> float:
        """Return how long it has stood."""
        return 0.0 if self._since_s is None else now_s - self._since_s


class Guard:
    """Reads Motion's words from `line`, halts over `wire`."""

    def __init__(
        self, line: socket.socket, wire: Wire, cmd_vel_topic: str, odom_topic: str, *, is_near: bool = False
    ) -> None:
        self._line = line
        self._wire = wire
        self._topic = cmd_vel_topic
        self._watch = Watch()
        self._standing = Standing()
        self._departure = Departure(wire, cmd_vel_topic, odom_topic, is_near=is_near)
        self._motion_is_gone = False
        self._tripped_at_s: float | None = None
        self.on_loss: Callable[[], None] = lambda: None
        """Called once when Motion is gone without a goodbye."""
        wire.advertise(cmd_vel_topic, TwistMessage)
        self._unheard_odom_topic = odom_topic

    def run(self) -> None:
        """Until Motion says goodbye, or is gone and the robot stands or is gone, too."""
        guard_all([self])

    @property
    def line(self) -> socket.socket | None:
        """Return where Motion speaks; None once it is gone."""
        return None if self._motion_is_gone else self._line

    def seconds_left(self, now_s: float) -> float:
        """Return how long until `halt_where_due` may have something to do."""
        return TICK_S if self._motion_is_gone else self._watch.seconds_left(now_s)

    def halt_where_due(self, now_s: float) -> bool:
        """Halt a robot whose Motion misses its beats; True once the work is done."""
        if not self._watch.must_halt(now_s):
            self._tripped_at_s = None
            return False
        self._tripped_at_s = now_s if self._tripped_at_s is None else self._tripped_at_s
        self._halt()
        return self._motion_is_gone and self._may_leave(now_s, self._tripped_at_s)

    def let_go(self) -> None:
        """Close the line: Motion takes a guard that is gone for what it is."""
        self._line.close()

    def _halt(self) -> None:
        try:
            self._wire.publish(self._topic, ZERO)
        except WireError:
            if not self._wire.comes_back:
                raise

    def _may_leave(self, now_s: float, tripped_at_s: float) -> bool:
        self._hear_odometry()
        halted_s = now_s - tripped_at_s
        return (
            halted_s > GIVE_UP_S
            or (halted_s > STANDING_S and self._standing.for_s(now_s) > STANDING_S)
            or self._departure.is_over(now_s)
        )

    def _hear_odometry(self) -> None:
        """From the first question on: hearing what nobody asks would cost more than all else the guard does."""
        topic, self._unheard_odom_topic = self._unheard_odom_topic, ""
        if topic:
            self._wire.subscribe(topic, Odometry, self._standing.on_odometry)

    def hear(self) -> bool:
        """Take in what Motion has said; True for a goodbye."""
        try:
            words = self._line.recv(256)
        except OSError:
            words = b""
        if not words:
            self._motion_is_gone = True
            self.on_loss()
            self._watch.lose()
            return self._watch.state == "idle"
        if GOODBYE in words:
            return True
        for word in words:
            self._watch.hear(bytes([word]), awake_or_not_s())
        if not self._wire.is_connected:
            return False  # Motion takes our silence for what it is: nobody would halt the robot in its place
        echo = HANDSHAKE if HANDSHAKE in words else words[-1:]
        answer = TRIPPED if self._watch.state == "tripped" else echo
        with contextlib.suppress(OSError):
            self._line.send(answer, socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
        return False


def guard_all(guards: Sequence[Guard]) -> None:
    """Until the work of each is done. One that cannot halt its robot any more lets go of its Motion, which then stops.

    Raises:
        WireError: a robot's end was gone, and its wire does not come back.
    """
    watched, lost = list(guards), list[WireError]()
    while watched:
        now_s = awake_or_not_s()
        done = [guard for guard in watched if _is_done(guard, partial(guard.halt_where_due, now_s), lost)]
        watched = [guard for guard in watched if guard not in done]
        lines = {guard.line: guard for guard in watched if guard.line is not None}
        timeout_s = min((guard.seconds_left(now_s) for guard in watched), default=0.0)
        readable, _, _ = select.select(list(lines), [], [], timeout_s)
        done = [lines[line] for line in readable if _is_done(lines[line], lines[line].hear, lost)]
        watched = [guard for guard in watched if guard not in done]
    if lost:
        raise lost[0]


def _is_done(guard: Guard, act: Callable[[], bool], lost: list[WireError]) -> bool:
    try:
        return act()
    except WireError as error:
        lost.append(error)
        guard.let_go()
        return True


def _let_go_of_output() -> None:
    """Whoever reads what Motion wrote, `ros2 launch` say, waits for the end of it, and must not wait for us."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):
        os.dup2(nowhere, number)
    os.close(nowhere)


def _wiring(options: dict[str, str]) -> Wiring:
    return Wiring(
        cmd_vel_topic=options["--topic"],
        cmd_vel_type="TwistStamped" if options.get("--type") == "TwistStamped" else "Twist",
        odom_topic=options.get("--odom", ""),
        odom_type="turtlesim/Pose" if options.get("--odom-type") == "turtlesim/Pose" else "Odometry",
        namespace=options.get("--namespace", ""),
    )


def main(arguments: list[str]) -> int:
    """Guard until there is nothing left to do; the exit code."""
    given = list(zip(arguments[::2], arguments[1::2]))
    options = dict(given)
    wires, numbers = ([value for name, value in given if name == wanted] for wanted in ("--wire", "--fd"))
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGTTIN", "SIGTTOU", "SIGPIPE", "SIGTERM"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    prefer(*GUARD)
    wake_promptly()
    wiring, is_near = _wiring(options), options.get("--near") == "yes"
    try:
        with contextlib.ExitStack() as opened:
            guards = []
            for address, number in zip(wires, numbers):
                wire = connect_wire(address, wiring, "chatrobot_guard")
                opened.callback(wire.close)  # else its node stays on the graph until its lease ends
                line = socket.socket(fileno=int(number))
                guards.append(Guard(line, wire, wiring.cmd_vel_topic, wiring.odom_topic, is_near=is_near))
                guards[-1].on_loss = _let_go_of_output
            guard_all(guards)
    except WireError:
        return 1  # the robot's end is gone: there is nothing left to halt
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
