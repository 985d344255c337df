"""What pages are told: messages, who is told them, and what waits to be sent to one page.

That is bounded, and never waited for by whoever puts something in.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from chatrobot.core.event import strict_json
from chatrobot.language.interpretation import LanguageCode
from chatrobot.web.access import Pass

MOST_DROPPABLE = 40
"""So many messages wait before the oldest telemetry and scans are left out."""
MOST_WAITING = 400
"""A page that reads as little as this is not there any more."""


class Message:
    """One thing to be told to pages. It is written once a language, however many pages read it.

    Args:
        make: gives the object for a page in that language.
        is_droppable: the next of its kind says all that this one does.
    """

    __slots__ = ("_make", "_texts", "is_droppable")

    def __init__(self, make: Callable[[LanguageCode], dict[str, Any]], *, is_droppable: bool = False) -> None:
        self._make = make
        self._texts: dict[LanguageCode, str] = {}
        self.is_droppable = is_droppable

    def object_in(self, language: LanguageCode) -> dict[str, Any]:
        """Return the object itself, to be part of another."""
        return self._make(language)

    def text_in(self, language: LanguageCode) -> str:
        """Return it as it is sent."""
        text = self._texts.get(language)
        if text is None:
            text = self._texts[language] = strict_json(self._make(language), is_compact=True)
        return text


class Face(Protocol):
    """Somebody who is told what happens: a page."""

    id: str
    name: str
    language: LanguageCode
    pass_: Pass

    @property
    def is_local(self) -> bool:
        """It is at this machine."""
        ...

    def unread_bytes(self) -> int:
        """Return how much has come from it that the event loop has not read yet. From any thread."""
        ...

    def put(self, message: Message) -> None:
        """Tell it. Called on any thread; returns at once."""
        ...


class Outbox:
    """Filled from any thread, emptied by the event loop that it was made in.

    Args:
        on_overfull: called in that event loop once a page has read too slowly to be worth keeping.
    """

    def __init__(self, on_overfull: Callable[[], None]) -> None:
        self._loop = asyncio.get_running_loop()
        self._has_more = asyncio.Event()
        self._waiting: deque[Message] = deque()
        self._lock = threading.Lock()
        self._is_awake = False
        self._on_overfull = on_overfull

    def put(self, message: Message) -> None:
        """Have it sent when the page reads; a page that does not loses telemetry first, then its connection."""
        with self._lock:
            if len(self._waiting) >= MOST_DROPPABLE and not self._make_room(message):
                return
            self._waiting.append(message)
            is_overfull = len(self._waiting) > MOST_WAITING
            if is_overfull:
                self._waiting.clear()
            wakes, self._is_awake = not self._is_awake, True
        if is_overfull or wakes:
            with contextlib.suppress(RuntimeError):  # the loop has ended, and with it the page
                self._loop.call_soon_threadsafe(self._on_overfull if is_overfull else self._has_more.set)

    def _make_room(self, message: Message) -> bool:
        """Leave out the oldest that may be left out; False where that is the new one itself."""
        for number, one in enumerate(self._waiting):
            if one.is_droppable:
                del self._waiting[number]
                return True
        return not message.is_droppable

    async def take(self) -> list[Message]:
        """Wait for what is to be sent, and take it all."""
        await self._has_more.wait()
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
            self._is_awake = False
            self._has_more.clear()
        return taken
