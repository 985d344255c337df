"""The keys of the chat that are not plain editing."""

from __future__ import annotations

import select
import sys
from collections.abc import Callable

from prompt_toolkit.filters import Condition
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.keys import Keys


def chat_keys(
    *,
    interrupt: Callable[[], None],
    leave: Callable[[], None],
    suspend: Callable[[], None],
    paste: Callable[[str], None],
    is_editing: Callable[[], bool],
) -> KeyBindings:
    """Ctrl-C, Ctrl-D and Ctrl-Z, pasted text, and Enter where more is coming. The first acts before all drawing.

    Args:
        paste: hears what is pasted, before it is shown and long before it is sent.
        is_editing: Enter begins a new line then, and does nothing else.
    """
    keys = KeyBindings()

    @keys.add("c-c", eager=True)
    @keys.add("<sigint>", eager=True)
    def _interrupt(_: KeyPressEvent) -> None:
        interrupt()

    @keys.add("c-d", eager=True)
    def _leave(event: KeyPressEvent) -> None:
        if event.current_buffer.text:
            event.current_buffer.delete()
        else:
            leave()

    @keys.add("c-z", eager=True)
    def _suspend(_: KeyPressEvent) -> None:
        suspend()

    @keys.add(Keys.BracketedPaste, eager=True)
    def _paste(event: KeyPressEvent) -> None:
        text = event.data.replace("\r\n", "\n").replace("\r", "\n")
        paste(text)
        event.current_buffer.insert_text(text if is_editing() else text.rstrip("\n"))

    @keys.add("enter", eager=True, filter=Condition(lambda: not is_editing()))
    def _enter(event: KeyPressEvent) -> None:
        """A terminal that does not tell a paste from typing sends its lines at once: they stay together."""
        buffer = event.current_buffer
        if more_is_there(event):
            paste(f"{buffer.document.current_line}\n")
            buffer.insert_text("\n")
        else:
            buffer.validate_and_handle()

    return keys


def more_is_there(event: KeyPressEvent) -> bool:
    """Whether text that was typed or pasted waits behind this key."""
    if any(_is_text(key.key) for key in event.key_processor.input_queue):
        return True
    return bool(select.select([sys.stdin], [], [], 0.0)[0])


def _is_text(key: Keys | str) -> bool:
    return not isinstance(key, Keys) or key in (Keys.Enter, Keys.BracketedPaste)
