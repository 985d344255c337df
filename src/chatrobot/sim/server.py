"""The simulated robot in real time, on a local wire whose hub it runs, or as a ROS node; and obstacles that come and go
by messages."""

from __future__ import annotations

import math
import signal
from collections.abc import Sequence
from operator import itemgetter
from types import FrameType

from chatrobot.core.clock import Clock
from chatrobot.sim.network_wire import MarshalledWire
from chatrobot.sim.robot import TICK_S, SimRobot
from chatrobot.wire.local import LocalHub, LocalHubs

LAST_CLIENT_GONE_S = 2.0
"""It ends so long after its last client has left."""
FIRST_CLIENT_S = 15.0
"""It ends if nobody comes within this time."""
GAP_S = 0.5
"""A pause this long was a frozen process (Ctrl-Z, a sleeping laptop): physics resumes where it was. A shorter
one was a busy machine: physics catches up, and heeds each command of meanwhile from when it came."""
_SLACK = 1e-6
"""Sums of steps and multiples of ticks differ by rounding; of a tick."""


class SimServer:
    """Lets a simulated robot live in real time: on a hub as long as somebody is there, on another wire until it is
    told to end, by Ctrl-C too."""

    def __init__(self, robot: SimRobot, hub: LocalHub | MarshalledWire, clock: Clock) -> None:
        self._robot = robot
        self.hub = hub
        self._clock = clock
        self._alone_since_s = clock.now_s()

    def catch_up(self, ago_s: float = 0.0) -> None:
        """Bring the robot to the present, or to where it was `ago_s` ago, so that what happens next happens then."""
        behind_s = self._clock.now_s() - self._robot.now_s
        if behind_s > GAP_S:
            self._robot.skip(behind_s)
            self._alone_since_s += behind_s
        elif behind_s > ago_s:
            self._robot.step(behind_s - ago_s)

    @property
    def next_tick_s(self) -> float:
        """Return when its sensors measure next, by the clock."""
        lived_s = self._robot.now_s - self._robot.start_s
        return self._robot.start_s + (math.floor(lived_s / TICK_S + _SLACK) + 1) * TICK_S

    @property
    def is_deserted(self) -> bool:
        """True where everybody has left, or nobody came."""
        if not isinstance(self.hub, LocalHub):
            return False
        now_s = self._clock.now_s()
        if self.hub.client_count:
            self._alone_since_s = now_s
            return False
        patience_s = LAST_CLIENT_GONE_S if self.hub.ever_connected else FIRST_CLIENT_S
        return now_s - self._alone_since_s > patience_s


class Simulation:
    """The simulated robots of this process: one, or those of a class, each on a hub of its own."""

    def __init__(self, servers: Sequence[SimServer], clock: Clock) -> None:
        self._clock = clock
        self._due_s = {server: server.next_tick_s for server in servers}
        self._hubs = LocalHubs([server.hub for server in servers if isinstance(server.hub, LocalHub)])
        self._is_terminated = False

    def run(self) -> None:
        """Run until everybody has left, nobody came or SIGTERM; the hubs are closed then.

        A terminal's signals are for whoever talks to a person: the robot goes on, as a real one would. Only where
        nobody has to be there, it is a person who ends it.
        """
        for ignored in (signal.SIGINT, signal.SIGTSTP, signal.SIGHUP):
            signal.signal(ignored, signal.SIG_IGN)
        has_hub = all(isinstance(server.hub, LocalHub) for server in self._due_s)
        for ending in [signal.SIGTERM] if has_hub else [signal.SIGTERM, signal.SIGINT, signal.SIGHUP]:
            signal.signal(ending, self._on_terminate)
        try:
            while self._due_s and not self._is_terminated:
                self._live()
        finally:
            for server in self._due_s:
                server.hub.close()

    def _live(self) -> None:
        """Step the robot that is due most, if any is, then route what has been said: who commands does not wait for
        all the others' physics."""
        server, due_s = min(self._due_s.items(), key=itemgetter(1))
        if due_s <= self._clock.now_s():
            server.hub.poll(0.0)  # a robot's motors heed what came meanwhile, however busy this machine is
            server.catch_up()
            self._due_s[server] = server.next_tick_s
            if server.is_deserted:
                server.hub.close()
                del self._due_s[server]
                return
        wait_s = min(self._due_s.values()) - self._clock.now_s()
        (server.hub if len(self._due_s) == 1 else self._hubs).poll(wait_s)

    def _on_terminate(self, _signal: int, _frame: FrameType | None) -> None:
        self._is_terminated = True
