"""What a person types while a command runs: a stop, or the answer to a question that is there to be seen."""

from __future__ import annotations

import select
import signal
import sys
import threading

from chatrobot.cli.approver import Approver
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.lines import LineSplitter, has_keyboard, read_chunk
from chatrobot.core.events import Notice
from chatrobot.core.reason import Reason, one_line
from chatrobot.reflex import is_pause, leads_with_stop


class Keyboard:
    """Reads lines in a thread of its own, so that a stop is out when it is typed, and not when there is time.

    What was typed before a question was shown is no answer to it. Without a terminal it does nothing.
    """

    def __init__(self, conversation: Conversation, approver: Approver) -> None:
        self._conversation = conversation
        self._approver = approver
        self._reading = approver.editing

    def start(self) -> None:
        """Begin to read."""
        if has_keyboard():
            signal.signal(
                signal.SIGTTIN, signal.SIG_IGN
            )  # once put in the background: the end of file, no stop
            threading.Thread(target=self._read, name="keyboard", daemon=True).start()

    def _read(self) -> None:
        splitter = LineSplitter()
        while True:
            select.select([sys.stdin], [], [])
            with self._reading:  # an editor has the terminal for itself
                if not select.select([sys.stdin], [], [], 0.0)[0]:
                    continue
                chunk = read_chunk()
            for line in splitter.take(chunk):
                self._hear(line.strip())
            if not chunk:
                if last := splitter.end().strip():
                    self._hear(last)
                self._approver.lose_keyboard()
                if self._conversation.is_paused:
                    self._conversation.stop("end of input")
                return

    def _hear(self, line: str) -> None:
        if is_pause(line) or (self._conversation.is_paused and not leads_with_stop(line)):
            self._conversation.hear(line)
        elif leads_with_stop(line):
            self._conversation.halt(line)
        elif not self._approver.type(line) and line:
            notice = Notice(0, Reason("only_stop_heard", {"text": one_line(line)}))
            self._conversation.post(lambda: self._conversation.show(notice))
