"""The thread that pumps the session: the screen never waits for the robot."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from chatrobot.core.errors import LinkError
from chatrobot.dialogue.session import Session

PUMP_S = 0.05


class Pump:
    """Runs `session.pump` until `stop`; everything that belongs to that thread is posted here.

    Args:
        on_lost: hears, on the thread, that Motion is gone; the thread ends then.
        on_end: hears that the thread has ended, for whatever reason, without `stop`.
    """

    def __init__(
        self, session: Session, on_lost: Callable[[LinkError], None], on_end: Callable[[], None]
    ) -> None:
        self._session = session
        self._on_lost = on_lost
        self._on_end = on_end
        self._jobs: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="pump", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def post(self, job: Callable[[], None]) -> None:
        """Have `job` done on the pumping thread, within `PUMP_S` or so."""
        self._jobs.put(job)

    def stop(self) -> None:
        """End the thread and wait for it."""
        self._ended.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        try:
            while not self._ended.is_set():
                while not self._jobs.empty():
                    self._jobs.get()()
                self._session.pump(PUMP_S)
        except LinkError as error:
            self._on_lost(error)
        finally:
            if not self._ended.is_set():
                self._on_end()
