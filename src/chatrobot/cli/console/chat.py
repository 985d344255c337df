"""The chat on a real terminal: one line to type in, one status bar below it, everything else scrolls above.

One prompt_toolkit application lives as long as the conversation. It runs in the main thread; the session is pumped
in another, whose output goes through `StdoutProxy`, and whose news of the robot only invalidates the status bar.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import TextIO, cast

from prompt_toolkit import PromptSession, search
from prompt_toolkit.application import run_in_terminal
from prompt_toolkit.application.current import set_app
from prompt_toolkit.buffer import Buffer
from prompt_toolkit.document import Document
from prompt_toolkit.filters import Condition
from prompt_toolkit.formatted_text import FormattedText
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.keys import Keys
from prompt_toolkit.patch_stdout import StdoutProxy
from prompt_toolkit.styles import Style
from rich.console import Console, RenderableType

from chatrobot.cli.console.completion import ChatCompleter
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.pasted import LONGEST_CHARS, clean
from chatrobot.cli.console.status_bar import STYLES
from chatrobot.reflex import is_stop

BUNDLE_S = 0.02
"""Output that comes within this time is written at once, so that the prompt is not repainted line by line."""

COUNTED_EVERY_S = 0.25
"""How often the seconds that a model thinks are looked at."""

HANGUP_CODE = 129
_LEAVING_SIGNALS = (signal.SIGHUP, signal.SIGTERM)


class Chat:
    """A `Display`.

    Args:
        history: the file of what was typed; None keeps it for this conversation only.
        hang_up: stops the robot and ends what was started, for when the terminal is gone.
    """

    def __init__(self, controller: ChatController, history: Path | None, hang_up: Callable[[], None]) -> None:
        self._controller = controller
        self._hang_up = hang_up
        self._loop: asyncio.AbstractEventLoop | None = None
        self._code = 0
        self._is_editing = self._has_left = False
        self._proxy = StdoutProxy(sleep_between_writes=BUNDLE_S, raw=True)
        self._console = Console(
            file=cast(TextIO, self._proxy), force_terminal=True, highlight=False, markup=False, emoji=False
        )
        self._prompt: PromptSession[str] = PromptSession(
            message=self._message,
            history=_history(history),
            completer=ChatCompleter(
                controller.words,
                controller.session.understanding.place_names,
                controller.session.understanding.can_do,
                controller.commands,
            ),
            complete_in_thread=True,  # a stop is typed while it looks for what may follow
            complete_while_typing=Condition(lambda: self._prompt.default_buffer.text.startswith("/")),
            reserve_space_for_menu=5,
            multiline=Condition(lambda: self._is_editing),
            bottom_toolbar=self._status_bar,
            style=Style.from_dict(STYLES),
            key_bindings=self._keys(),
            prompt_continuation="  ",
            erase_when_done=True,
        )
        buffer = self._prompt.default_buffer
        buffer.accept_handler = self._accept
        buffer.on_text_changed += _tidy

    def run(self) -> int:
        """Talk until somebody leaves; the exit code."""
        try:
            asyncio.run(self._run())
        except EOFError:  # the terminal has gone without a word
            self._hang_up()
            self._code = HANGUP_CODE
        finally:
            with contextlib.suppress(OSError):
                self._proxy.close()
        return self._code

    async def _run(self) -> None:
        self._loop = asyncio.get_running_loop()
        for number in _LEAVING_SIGNALS:
            self._loop.add_signal_handler(number, self._on_leaving_signal)
        self._loop.add_signal_handler(signal.SIGINT, self._interrupt)
        self._loop.add_signal_handler(signal.SIGTSTP, self._suspend)
        self._controller.pump.start()
        counting = asyncio.create_task(self._count_seconds())
        try:
            await self._prompt.prompt_async(handle_sigint=False, pre_run=self._leave_if_told)
        finally:
            counting.cancel()
            await asyncio.to_thread(self._controller.pump.stop)
            self._loop = None

    async def _count_seconds(self) -> None:
        """Have the status bar drawn anew while a model thinks: no event of the robot's does, and it may be long."""
        was_thinking = False
        while True:
            await asyncio.sleep(COUNTED_EVERY_S)
            is_thinking = self._controller.session.model_wait_s is not None
            if is_thinking or was_thinking:
                self.refresh()
            was_thinking = is_thinking

    # --- what the display does for the controller ---

    @property
    def echoes(self) -> bool:
        """What was typed goes when it is sent."""
        return False

    @property
    def width(self) -> int:
        """Columns."""
        return shutil.get_terminal_size().columns

    def print(self, *lines: RenderableType) -> None:
        """Show lines above the prompt."""
        self._console.print(*lines, sep="\n")

    def refresh(self) -> None:
        """Draw anew; never in the caller's thread: prompt_toolkit looks its loop up twice, and may end in between."""
        self._soon(self._prompt.app.invalidate)

    def edit(self, plan_text: str) -> None:
        """Put a plan into the line."""
        self._soon(lambda: self._begin_editing(plan_text))

    def leave(self, code: int) -> None:
        """End the conversation."""
        self._code, self._has_left = max(self._code, code), True
        self._soon(self._exit)

    def _soon(self, act: Callable[[], None]) -> None:
        loop = self._loop
        if loop is not None:
            loop.call_soon_threadsafe(act)

    def _exit(self) -> None:
        if self._prompt.app.is_running and not self._prompt.app.is_done:
            self._prompt.app.exit(result="")

    def _leave_if_told(self) -> None:
        """Leave if it was told before there was a prompt to leave."""
        if self._has_left:
            self._soon(self._exit)

    # --- typing ---

    def _keys(self) -> KeyBindings:
        """Bind Ctrl-C, Ctrl-D and Ctrl-Z, pasted text, and Enter where more is coming; eager: before drawing."""
        keys = KeyBindings()
        keys.add("c-c", eager=True)(lambda _: self._interrupt())
        keys.add("<sigint>", eager=True)(lambda _: self._interrupt())
        keys.add("c-d", eager=True)(self._delete_or_leave)
        keys.add("c-z", eager=True)(lambda _: self._suspend())
        keys.add(Keys.BracketedPaste, eager=True)(self._paste)
        # While a plan is edited, Enter begins a new line.
        keys.add("enter", eager=True, filter=Condition(lambda: not self._is_editing))(self._enter)
        return keys

    def _delete_or_leave(self, event: KeyPressEvent) -> None:
        if event.current_buffer.text:
            event.current_buffer.delete()
        else:
            self._controller.leave()

    def _paste(self, event: KeyPressEvent) -> None:
        """Hear what is pasted before it is shown and long before it is sent."""
        text = event.data.replace("\r\n", "\n").replace("\r", "\n")
        self._stop_for_paste(text)
        event.current_buffer.insert_text(text if self._is_editing else text.rstrip("\n"))

    def _enter(self, event: KeyPressEvent) -> None:
        """Keep lines together that come at once: some terminals do not tell a paste from typing."""
        buffer = event.current_buffer
        if event.app.layout.is_searching:
            self._accept_search(buffer.text)
        elif any(_is_text(key.key) for key in event.key_processor.input_queue):
            self._stop_for_paste(f"{buffer.document.current_line}\n")
            buffer.insert_text("\n")
        else:
            buffer.validate_and_handle()

    def _accept_search(self, typed: str) -> None:
        """Put what Ctrl-R found into the line; a stop that was typed while it searched is none to look for."""
        if is_stop(typed):
            search.stop_search()
            self._controller.enter(typed)
        else:
            search.accept_search()

    def _message(self) -> FormattedText:
        return FormattedText([("class:prompt", "plan› " if self._is_editing else "› ")])

    def _status_bar(self) -> FormattedText:
        controller = self._controller
        wait_s = controller.session.model_wait_s
        return FormattedText(controller.status_bar.fragments(self.width, controller.latched, wait_s))

    def _accept(self, buffer: Buffer) -> bool:
        """Enter. False clears the line."""
        if self._is_editing:
            self._is_editing = False
            self._controller.take_edited(buffer.text)
        else:
            self._controller.enter(buffer.text)
        return False

    def _stop_for_paste(self, text: str) -> None:
        """Act on a whole line that says stop before it is sent, as if it had been typed."""
        if not self._is_editing:
            self._controller.stop_for_paste(text[: text.rfind("\n") + 1])

    def _begin_editing(self, plan_text: str) -> None:
        self._is_editing = True
        self._prompt.default_buffer.document = Document(plan_text)
        self._controller.tell("edit_plan")

    # --- keys and signals ---

    def _interrupt(self) -> None:
        self._controller.interrupt()
        self._is_editing = False
        with set_app(self._prompt.app):  # a signal comes from outside of it
            search.stop_search()
        self._prompt.default_buffer.reset()

    def _suspend(self) -> None:
        """Stop the robot, then really go to sleep, with the whole job that the shell started."""
        self._controller.stop("Ctrl-Z")
        run_in_terminal(self._sleep)

    def _sleep(self) -> None:
        loop = self._loop
        assert loop is not None
        loop.remove_signal_handler(signal.SIGTSTP)
        os.kill(0, signal.SIGTSTP)
        loop.add_signal_handler(signal.SIGTSTP, self._suspend)
        self._controller.tell("suspended")

    def _on_leaving_signal(self) -> None:
        """End at once: the terminal is gone, or somebody wants us gone; nothing is drawn any more."""
        self._hang_up()
        os._exit(HANGUP_CODE)


def _is_text(key: Keys | str) -> bool:
    """Text that came in one piece with Enter waits behind it; what the terminal answers to our questions is none."""
    return not isinstance(key, Keys) or key in (Keys.Enter, Keys.BracketedPaste)


def _history(path: Path | None) -> History:
    if path is None:
        return InMemoryHistory()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch(mode=0o600)
    except OSError:
        return InMemoryHistory()  # a read-only home is no reason not to drive
    return FileHistory(str(path))


def _tidy(buffer: Buffer) -> None:
    """Whatever is typed or pasted stays printable, and no longer than one character too long."""
    text = buffer.text
    tidy = clean(text[: LONGEST_CHARS + 1])
    if tidy != text:
        buffer.document = Document(tidy, min(buffer.cursor_position, len(tidy)))
