"""The link in real time: words go out at once, a thread takes in what sensors say, another one beats."""

from __future__ import annotations

import socket
import threading
import time
from typing import Any

from chatrobot.programs.inside.link import Link
from chatrobot.programs.settings import ProgramSettings

BEAT_S = 0.1


class LiveLink(Link):
    """`start` starts the two threads."""

    def __init__(self, channel: socket.socket, settings: ProgramSettings) -> None:
        super().__init__(channel, settings)
        self._began_ns = time.monotonic_ns()
        self._sending = threading.Lock()

    def start(self) -> None:
        for name, work in (("beat", self._beat), ("take in", self._take_in)):
            threading.Thread(target=work, name=name, daemon=True).start()

    def now_ns(self) -> int:
        return time.monotonic_ns() - self._began_ns

    def look(self) -> int:
        return self.now_ns()

    def wall_ns(self) -> int:
        return time.time_ns()

    def send(self, word: str, *values: Any) -> None:
        frame = self._encoded(word, values)
        with self._sending:
            self._channel.sendall(frame)

    def flush(self) -> None:
        """Nothing is kept back."""

    def _beat(self) -> None:
        while True:
            self.send("beat")
            time.sleep(BEAT_S)

    def _take_in(self) -> None:
        while True:
            for _, messages in self._read():
                self._deliver(messages)
