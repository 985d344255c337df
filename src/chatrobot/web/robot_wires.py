"""One more end of the wire of each robot of a class, all of them read by one thread, in turns.

A thread for each would have the interpreter go from hand to hand at every message (decision 47).
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

from chatrobot.core.errors import WireError
from chatrobot.wire.local import LocalWire
from chatrobot.wire.messages import Message

Kind = TypeVar("Kind", bound=Message)
TURN_S = 0.02


class RobotWires:
    """Subscribe, then `start`. Callbacks come from the one thread, or from whoever calls `bring_up_to_date`.

    Args:
        paths: where the wire of each robot is served, by the robot's name.

    Raises:
        WireError: nobody serves one of them.
    """

    def __init__(self, paths: Mapping[str, Path]) -> None:
        self._wires = {name: LocalWire(path, has_thread=False) for name, path in paths.items()}
        self._locks = {name: threading.Lock() for name in paths}
        self._has_ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="wires", daemon=True)

    def subscribe(self, name: str, topic: str, kind: type[Kind], callback: Callable[[Kind], None]) -> None:
        """Hear what that robot is told, or says, on a topic."""
        with contextlib.suppress(WireError):  # that robot is gone, and Motion says so
            self._wires[name].subscribe(topic, kind, callback)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def bring_up_to_date(self, name: str) -> None:
        """Have everything delivered that has come from that robot by now. From any thread that holds no lock."""
        with self._locks[name]:
            if not self._wires[name].is_over:
                self._wires[name].deliver()

    def close(self) -> None:
        """Hear no more."""
        self._has_ended.set()
        if self._thread.ident is not None:
            self._thread.join()
        for wire in self._wires.values():
            wire.close()

    def _run(self) -> None:
        while not self._has_ended.wait(TURN_S):
            for name in self._wires:
                self.bring_up_to_date(name)
