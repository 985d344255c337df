"""The thread that pumps a session: whoever draws a screen or calls from a program never waits for the robot."""

from __future__ import annotations

import gc
import queue
import threading
from collections.abc import Callable

from chatrobot.dialogue.session import Session

PUMP_S = 0.05


class Pump:
    """Runs `session.pump` until `stop`; everything that belongs to that thread is posted here.

    Args:
        on_end: hears, on the thread, which error has ended it without `stop`.
        on_step: called after each pump.
    """

    def __init__(
        self,
        session: Session,
        on_end: Callable[[Exception], None],
        on_step: Callable[[], None] = lambda: None,
    ) -> None:
        self._session = session
        self._on_end = on_end
        self._on_step = on_step
        self._jobs: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._is_stopped = False
        self._thread = threading.Thread(target=self._run, name="pump", daemon=True)

    def start(self) -> None:
        """Begin to pump."""
        gc.freeze()  # the words are many, and stay: a stop would wait 0.1 s while the collector looks through them
        self._thread.start()

    def post(self, job: Callable[[], None]) -> None:
        """Have `job` done on the pumping thread, within `PUMP_S` or so."""
        self._jobs.put(job)

    def stop(self) -> None:
        """End the thread and wait for it."""
        self._is_stopped = True
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        try:
            while not self._is_stopped:
                while not self._jobs.empty():
                    self._jobs.get()()
                self._session.pump(PUMP_S)
                self._on_step()
        except Exception as error:  # noqa: BLE001  # the outermost boundary of a thread: who waits for it is told
            if not self._is_stopped:
                self._on_end(error)
