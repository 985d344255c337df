"""The guard's process: `python -m chatrobot.guard --wire ADDRESS --topic cmd_vel --odom odom --near yes --fd N`.

Started by Motion in a session of its own, so that neither Ctrl-C, Ctrl-Z nor a closed terminal reaches it. Where one
process drives the robots of a class, `--wire` comes once for each: one line, and all of them are halted together.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import sys
import time
from collections.abc import Callable, Sequence

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


class HaltedRobot:
    """One robot that the guard can halt, and whether it stands."""

    def __init__(self, wire: Wire, cmd_vel_topic: str, odom_topic: str, *, is_near: bool = False) -> None:
        self._wire = wire
        self._topic = cmd_vel_topic
        self._standing = Standing()
        self._departure = Departure(wire, cmd_vel_topic, odom_topic, is_near=is_near)
        wire.advertise(cmd_vel_topic, TwistMessage)
        self._unheard_odom_topic = odom_topic

    @property
    def is_within_reach(self) -> bool:
        """Return whether its wire is there."""
        return self._wire.is_connected

    def halt(self) -> bool:
        """Send it a zero; False where it is gone for good."""
        try:
            self._wire.publish(self._topic, ZERO)
        except WireError:
            return self._wire.comes_back
        return True

    def needs_no_zeros(self, now_s: float, halted_s: float) -> bool:
        """Return whether it has been seen standing, or gone, after zeros for so long."""
        self._hear_odometry()
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


class Guard:
    """Reads Motion's words from `line`, halts `robots`."""

    def __init__(self, line: socket.socket, robots: Sequence[HaltedRobot]) -> None:
        self._line = line
        self._robots = list(robots)
        self._watch = Watch()
        self._motion_is_gone = False
        self.on_loss: Callable[[], None] = lambda: None
        """Called once when Motion is gone without a goodbye."""

    def run(self) -> None:
        """Until Motion says goodbye, or is gone and the robot stands or is gone, too."""
        tripped_at_s: float | None = None
        while True:
            now_s = awake_or_not_s()
            if self._watch.must_halt(now_s):
                tripped_at_s = now_s if tripped_at_s is None else tripped_at_s
                self._halt()
                if self._motion_is_gone and self._may_leave(now_s, tripped_at_s):
                    return
            else:
                tripped_at_s = None
            if self._listen(self._watch.seconds_left(now_s)):
                return

    def _halt(self) -> None:
        self._robots = [robot for robot in self._robots if robot.halt()]
        if not self._robots:
            raise WireError("every robot's end is gone")

    def _may_leave(self, now_s: float, tripped_at_s: float) -> bool:
        halted_s = now_s - tripped_at_s
        done = [
            robot.needs_no_zeros(now_s, halted_s) for robot in self._robots
        ]  # each begins to look at once
        return all(done)

    def _listen(self, timeout_s: float) -> bool:
        """Take in Motion's words for up to `timeout_s`; True for a goodbye."""
        if self._motion_is_gone:
            time.sleep(TICK_S)
            return False
        readable, _, _ = select.select([self._line], [], [], timeout_s)
        if not readable:
            return False
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
        if not all(robot.is_within_reach for robot in self._robots):
            return False  # Motion takes our silence for what it is: nobody would halt the robot in its place
        echo = HANDSHAKE if HANDSHAKE in words else words[-1:]
        answer = TRIPPED if self._watch.state == "tripped" else echo
        with contextlib.suppress(OSError):
            self._line.send(answer, socket.MSG_DONTWAIT | socket.MSG_NOSIGNAL)
        return False


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
    options = dict(zip(arguments[::2], arguments[1::2]))
    addresses = [value for name, value in zip(arguments[::2], arguments[1::2]) if name == "--wire"]
    for name in ("SIGINT", "SIGTSTP", "SIGHUP", "SIGTTIN", "SIGTTOU", "SIGPIPE", "SIGTERM"):
        signal.signal(getattr(signal, name), signal.SIG_IGN)
    prefer(*GUARD)
    wake_promptly()
    line = socket.socket(fileno=int(options["--fd"]))
    wiring, is_near = _wiring(options), options.get("--near") == "yes"
    try:
        with contextlib.ExitStack() as opened:
            robots = []
            for address in addresses:
                wire = connect_wire(address, wiring, "chatrobot_guard")
                opened.callback(wire.close)  # else its node stays on the graph until its lease ends
                robots.append(HaltedRobot(wire, wiring.cmd_vel_topic, wiring.odom_topic, is_near=is_near))
            guard = Guard(line, robots)
            guard.on_loss = _let_go_of_output
            guard.run()
    except WireError:
        return 1  # the robot's end is gone: there is nothing left to halt
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
