"""The keys of the chat that are not plain editing."""

from __future__ import annotations

from collections.abc import Callable

from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent


def chat_keys(
    *, interrupt: Callable[[], None], leave: Callable[[], None], suspend: Callable[[], None]
) -> KeyBindings:
    """Ctrl-C, Ctrl-D and Ctrl-Z. The first acts before anything is drawn."""
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

    return keys
