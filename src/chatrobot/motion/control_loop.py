"""The control thread of a process that drives robots, one or the many of a class, and what it has once for all of them.

Each Motion ticks every `TICK_S` by a time of its own. Those of many robots are spread over the period, a few at a time:
so a tick waits for some of the others and not for all of them, and what the robots measure comes in evenly.
"""

from __future__ import annotations

import contextlib
import gc
import os
import select
import signal
import sys
import threading
import time
from collections.abc import Sequence
from operator import itemgetter
from typing import TYPE_CHECKING

from chatrobot.core.clock import PRESENCE_S, TICK_S
from chatrobot.core.errors import WireError
from chatrobot.core.process import MOTION, prefer, wake_promptly
from chatrobot.core.wiring import Wiring
from chatrobot.motion.safety.stop import remove_stop_socket, serve_stop
from chatrobot.wire.local import LocalWire
from chatrobot.wire.wire import Wire

if TYPE_CHECKING:
    from chatrobot.motion.runner import MotionRunner

SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter: the reader must get in between the lines of a rehearsal."""

TURNS = 5
TURN_S = TICK_S / TURNS
"""Many robots are ticked in so many turns, one after the other within a turn, and their wires are read as often: to be
woken for each tick and each message costs as much as many of them. For so long, at most, news of a robot of a class
counts as younger than it is."""

_FOUND = ("standing", "unseen", "waiting", "moving")
"""What `chatrobot stop` is told of many robots is what the one that is farthest from standing was found doing."""


class ControlLoop:
    """See the module. Made before the robots, which `wake` it; it takes its thread's priorities at once."""

    def __init__(self) -> None:
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        prefer(MOTION)
        wake_promptly()
        self._wake = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        self._wires: dict[int, LocalWire] = {}
        self._poller = select.epoll()
        self._poller.register(self._wake, select.EPOLLIN)
        self._due_s: dict[MotionRunner, float] = {}
        self._woken: set[MotionRunner] = set()

    def wake(self, robot: MotionRunner) -> None:
        """Have that robot ticked at once. From any thread."""
        self._woken.add(robot)
        os.eventfd_write(self._wake, 1)

    def connect(self, path: str, _wiring: Wiring, _node: str) -> Wire:
        """Open the local wire of one of many robots, and read it between the ticks: with a thread for each of them
        the interpreter would go from hand to hand at every message."""
        wire = LocalWire(path, has_thread=False)
        self._wires[wire.fileno()] = wire
        self._poller.register(wire, select.EPOLLIN)
        return wire

    def run(self, robots: Sequence[MotionRunner]) -> None:
        """Tick until all have left.

        Raises:
            WireError: a robot is gone for good. What was under way with it has been told to have failed.
        """
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGCONT, lambda *_: _thaw(robots))
        for target in (lambda: serve_stop(lambda: _stop(robots)), lambda: _look_out(robots)):
            threading.Thread(target=target, daemon=True).start()
        gc.collect()
        gc.freeze()  # what start-up has made stays: the collector need not look through it while the robot moves
        began_s = time.monotonic()
        self._due_s = {robot: began_s + place % TURNS * TURN_S for place, robot in enumerate(robots)}
        lost: WireError | None = None
        try:
            while self._due_s:
                self._listen()
                robot = self._next()
                if robot is None:
                    continue
                try:
                    self._tick(robot)
                except WireError as error:
                    del self._due_s[robot]
                    robot.give_up()
                    lost = error
        finally:
            for robot in robots:
                robot.close()
            remove_stop_socket()
        if lost is not None:
            raise lost

    def _listen(self) -> None:
        """Wait until a tick is due, a robot is woken or a wire has news; take in the news."""
        wait_s = min(self._due_s.values()) - time.monotonic()
        if wait_s > 0.0 and not self._woken:
            # By itself the poller waits for whole milliseconds.
            waited_for, longest_s = (self._wake, TURN_S) if self._wires else (self._poller, TICK_S)
            select.select([waited_for], [], [], min(wait_s, longest_s))
        for descriptor, _ in self._poller.poll(0.0):
            if descriptor == self._wake:
                os.eventfd_read(self._wake)
                continue
            wire = self._wires[descriptor]
            wire.deliver()
            if wire.is_over:
                self._poller.unregister(descriptor)

    def _next(self) -> MotionRunner | None:
        """The robot that is woken, or due first; None where none is."""
        if self._woken:
            return self._woken.pop()
        robot, due_s = min(self._due_s.items(), key=itemgetter(1))
        return robot if time.monotonic() >= due_s else None

    def _tick(self, robot: MotionRunner) -> None:
        if robot not in self._due_s:
            return  # it has left
        self._woken.discard(robot)
        robot.tick()
        due_s, now_s = self._due_s[robot], time.monotonic()
        if robot.has_left:
            del self._due_s[robot]
            robot.leave()
        elif now_s >= due_s:  # not where an event drove this tick before its time
            self._due_s[robot] = max(due_s, now_s - TICK_S) + TICK_S


def _thaw(robots: Sequence[MotionRunner]) -> None:
    for robot in robots:
        robot.thaw()


def _look_out(robots: Sequence[MotionRunner]) -> None:
    while True:
        for robot in robots:
            robot.look_out()
            time.sleep(PRESENCE_S / len(robots))


def _stop(robots: Sequence[MotionRunner]) -> str:
    found = []
    for robot in robots:
        with contextlib.suppress(WireError):  # the others are stopped all the same
            found.append(robot.stop())
    return max(found, key=_FOUND.index, default="unseen")
