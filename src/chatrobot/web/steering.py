"""Who steers a robot, and whether they are still there: beats of their page, and a watchdog that misses them.

The stick is the page's own source at joystick rank: only what the page sends keeps it alive. Nothing here ever beats
for it, or lets go of it in its page's place: Motion itself stops a stick that is silent, and after a stop it drives
again only once the hand that holds it has let go.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from chatrobot.core.errors import LinkError
from chatrobot.core.geometry import ZERO_TWIST, Twist
from chatrobot.core.process import wake_promptly

if TYPE_CHECKING:
    from chatrobot.dialogue.session import Session
    from chatrobot.web.outbox import Face

LOST_S, LOST_AFAR_S = 0.2, 0.3
"""A page of which nothing is heard for so long is lost, while it steers and something that it said is not done: where
it is at this machine, and where it is not."""
FIRST_BEAT_S = 1.0
"""Whoever begins to steer has so long until the first beat: the page may have to be loaded."""
UNREAD_S = 0.5
"""What lies unread of a page, while the event loop is late, shows for so long that the page is there."""
NOBODY = "nobody steers any more"
UNWATCHED = "the web console broke"
LOOK_S, STALL_S = 0.02, 0.05
"""How often the watchdog looks; and from when on it was itself kept waiting, so that beats may lie unread."""


class Steering:
    """Of one robot; from any thread. Nothing that a stop needs waits here.

    Args:
        has_work: whether anything that the steering page said is not done.
        on_lost: told, after the robot was stopped, that the steering page is gone.
    """

    def __init__(
        self,
        robot: Session,
        has_work: Callable[[], bool],
        on_lost: Callable[[], None],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._robot = robot
        self._has_work = has_work
        self._on_lost = on_lost
        self._now = now
        self._lock = threading.Lock()
        self.steerer: Face | None = None
        self._beat_s = self._unread_s = 0.0
        self._unread_bytes = 0
        self._is_held = self._was_lost = False
        self._is_watched = True

    @property
    def is_alive(self) -> bool:
        """Tell whether beats of the steering page come: without them nothing that it says would go on."""
        is_here = self.steerer is None or self.steerer.is_local
        most_s = LOST_S if is_here else LOST_AFAR_S
        return self._is_watched and self._now() <= max(self._beat_s, self._unread_s) + most_s

    def take(self, page: Face | None, why: str = NOBODY) -> None:
        """Have `page` steer, or nobody: the stick is let go, and what was said goes on under the new one, or ends.

        `why` is told where it ends. A page that steers already wins nothing: only its beats say that it is there.
        """
        with self._lock:
            if page is self.steerer:
                return
            if self._is_held:
                self._robot.steer(ZERO_TWIST)
            self.steerer, self._is_held = page, False
            self._beat_s, self._was_lost = self._now() + FIRST_BEAT_S, False
            self._unread_s, self._unread_bytes = 0.0, 0
        if page is None and self._has_work():
            self._robot.stop(why)

    def beat(self, page: Face) -> None:
        """Note that something was heard of that page."""
        if page is self.steerer:
            self._beat_s, self._was_lost = self._now(), False

    def stick(self, page: Face, twist: Twist) -> bool:
        """Have the robot move as the stick of that page says; return whether it is the one that steers."""
        with self._lock:
            if page is not self.steerer:
                return False
            self._is_held = not twist.is_zero
            self._robot.steer(twist)
        return True

    def leave(self, page: Face) -> bool:
        """Take note that the connection of that page has ended: it steers no more. Return whether it did."""
        with self._lock:
            if page is not self.steerer:
                return False
            was_held, self._is_held = self._is_held, False
            self.steerer = None
        if was_held or self._has_work():
            self._lose()
        return True

    def look(self) -> None:
        """Stop the robot where nothing is heard of the page whose words it follows."""
        self._note_unread()
        if self.steerer is not None and not (self.is_alive or self._was_lost) and self._has_work():
            self._was_lost = True
            self._lose()

    def end_watch(self) -> None:
        """Stop what a page said, and have none say more: nobody would notice that it is gone."""
        self._is_watched = False
        if self._has_work():
            self._robot.stop(UNWATCHED)

    def _note_unread(self) -> None:
        """Take what comes while more lies unread for a sign of life: the event loop is late, not the page."""
        steerer, now_s = self.steerer, self._now()
        unread_bytes = 0 if steerer is None else steerer.unread_bytes()
        if 0 < self._unread_bytes < unread_bytes and now_s - self._beat_s < UNREAD_S:
            self._unread_s = now_s
        self._unread_bytes = unread_bytes

    def _lose(self) -> None:
        self._robot.stop("the steering page is gone")
        self._on_lost()


class Watchdog:
    """A thread that looks after the steering of every robot of a server."""

    def __init__(self, robots: Callable[[], Iterable[Steering]]) -> None:
        self._robots = robots
        self._is_stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="steering watchdog", daemon=True)

    def start(self) -> None:
        """Begin to look."""
        self._thread.start()

    def stop(self) -> None:
        """End, and wait for the end."""
        self._is_stopped.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            self._watch()
        finally:  # an error of ours ends no more than what pages say
            if not self._is_stopped.is_set():
                self._for_each(Steering.end_watch)

    def _watch(self) -> None:
        wake_promptly()
        looked_s, has_waited = time.monotonic(), False
        while not self._is_stopped.wait(LOOK_S):
            before_s, looked_s = looked_s, time.monotonic()
            # Once: this process stood still, and Motion's leases held meanwhile; what lies unread is read first.
            has_waited = not has_waited and looked_s - before_s > LOOK_S + STALL_S
            if has_waited:
                continue
            self._for_each(Steering.look)

    def _for_each(self, act: Callable[[Steering], None]) -> None:
        for robot in tuple(self._robots()):
            with contextlib.suppress(LinkError):  # Motion is gone, and its guard halts the robot
                act(robot)
