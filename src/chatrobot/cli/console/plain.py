"""The console where a terminal can do little: lines in, lines out, no colours and no status bar."""

from __future__ import annotations

import contextlib
import os
import select
import shutil
import signal
import sys
from collections.abc import Callable

from rich.console import Console, RenderableType

from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.lines import PASTE_S, LineSplitter
from chatrobot.reflex import is_stop

LEAST_WIDTH, READABLE_WIDTH = 40, 16
_SIGNALS = (signal.SIGINT, signal.SIGTSTP, signal.SIGHUP, signal.SIGTERM)
HANGUP_CODE = 129
READ_BYTES = 65536


class Plain:
    """A `Display`. Signals are only noted by their handlers and acted on where lines are read, a moment later, so that
    they never meet a lock that their own thread holds."""

    def __init__(self, controller: ChatController, hang_up: Callable[[], None]) -> None:
        self._controller = controller
        self._hang_up = hang_up
        self._code: int | None = None
        self._wake_read, self._wake_write = os.pipe()
        os.set_blocking(self._wake_write, False)
        self._splitter = LineSplitter()
        self._edited_lines: list[str] | None = None
        self._edit_ends_with = ""
        self._pasted: list[str] = []
        self._is_at_prompt = False
        self._console = Console(
            file=sys.stdout, no_color=True, force_terminal=False, highlight=False, markup=False, emoji=False,
            width=max(READABLE_WIDTH, self.width),
        )  # fmt: skip

    def run(self) -> int:
        """Talk until somebody leaves; the exit code."""
        before = {number: signal.signal(number, _noted) for number in _SIGNALS}
        wake_before = signal.set_wakeup_fd(self._wake_write, warn_on_full_buffer=False)
        self._controller.pump.start()
        try:
            self._show_prompt()
            while self._code is None:
                self._wait()
        finally:
            self._controller.pump.stop()
            signal.set_wakeup_fd(wake_before)
            for number, handler in before.items():
                signal.signal(number, handler)
        return self._code

    # --- what the display does for the controller ---

    @property
    def echoes(self) -> bool:
        """What was typed stays to be seen."""
        return True

    @property
    def width(self) -> int:
        """Columns."""
        return shutil.get_terminal_size().columns

    def print(self, *lines: RenderableType) -> None:
        """Show lines; where the prompt stood, it stands below them."""
        was_at_prompt, self._is_at_prompt = self._is_at_prompt, False
        if was_at_prompt:
            sys.stdout.write("\r")  # what is printed begins with blanks, or a mark of its own
        self._console.print(*lines, sep="\n")
        if was_at_prompt:
            self._show_prompt()

    def refresh(self) -> None:
        """Nothing here shows what has changed; a standing robot is worth a new prompt."""
        if not self._controller.motion_view.is_moving:
            self._show_prompt()

    def edit(self, plan_text: str) -> None:  # noqa: ARG002  # what it was has just been printed
        """Take the lines that come as the plan."""
        is_program = self._controller.motion_view.program is not None
        self._edited_lines, self._edit_ends_with = [], "." if is_program else ""
        self._controller.tell("edit_program_lines" if is_program else "edit_plan_lines")

    def leave(self, code: int) -> None:
        """End the conversation."""
        self._code = max(self._code or 0, code)
        with contextlib.suppress(OSError):
            os.write(self._wake_write, b"\0")

    def _show_prompt(self) -> None:
        if not self._is_at_prompt:
            self._is_at_prompt = True
            sys.stdout.write("> ")
            sys.stdout.flush()

    # --- waiting for lines and signals ---

    def _wait(self) -> None:
        timeout_s = PASTE_S if self._pasted else None
        ready, _, _ = select.select([sys.stdin.fileno(), self._wake_read], [], [], timeout_s)
        if self._wake_read in ready:
            for number in os.read(self._wake_read, 64):
                self._on_signal(number)
        elif ready:
            self._read()
        else:
            self._hand_on()

    def _read(self) -> None:
        try:
            data = os.read(sys.stdin.fileno(), READ_BYTES)
        except OSError:  # the terminal is gone
            self._leave_at_once()
            return
        if not data:
            if last := self._splitter.end():
                self._take(last)
            self._hand_on()
            self._controller.leave()
            return
        self._is_at_prompt = False
        for line in self._splitter.take(data):
            self._take(line)
        if len(self._pasted) == 1 and not self._may_go_on():
            self._hand_on()

    def _may_go_on(self) -> bool:
        """Tell whether more may come. A terminal hands pasted lines on one by one, and all are there by then."""
        return self._pasted[0].rstrip().endswith((":", "：")) or bool(
            select.select([sys.stdin], [], [], 0.0)[0]
        )

    def _hand_on(self) -> None:
        lines, self._pasted = self._pasted, []
        if lines:
            self._controller.enter("\n".join(lines))

    def _take(self, line: str) -> None:
        if self._edited_lines is None:
            self._pasted.append(line)
            if is_stop(line) and not line.lstrip().startswith("/"):
                self._hand_on()
        elif line.strip() != self._edit_ends_with:
            self._edited_lines.append(line)
        else:
            edited, self._edited_lines = "\n".join(self._edited_lines), None
            self._controller.take_edited(edited)

    def _on_signal(self, number: int) -> None:
        if number == signal.SIGINT:
            self._edited_lines = None
            self._pasted.clear()
            self._controller.interrupt()
        elif number == signal.SIGTSTP:
            self._controller.stop("Ctrl-Z")
            self._sleep()
        elif number in (signal.SIGHUP, signal.SIGTERM):
            self._leave_at_once()

    def _sleep(self) -> None:
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(0, signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, _noted)
        self._controller.tell("suspended")

    def _leave_at_once(self) -> None:
        self._hang_up()
        self._code = HANGUP_CODE


def _noted(*_: object) -> None:
    """Do nothing: the wake-up descriptor has the signal's number."""
