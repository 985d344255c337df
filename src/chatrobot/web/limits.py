"""How much anybody may ask of the server: connections, messages, guesses at tokens."""

from __future__ import annotations

import asyncio
import ipaddress
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

MOST_CONNECTIONS, MOST_AN_ADDRESS = 100, 20
MESSAGES_HZ = 60
"""Of one page; what keeps a stick or a page alive is counted apart."""
WRONG_TOKENS, WRONG_TOKENS_S = 10, 60.0
FIRST_REQUEST_S = 5.0
"""Whoever connects and has asked for nothing by then is gone."""
_MOST_ADDRESSES = 1000

Now = Callable[[], float]


class Rate:
    """A bucket of tokens: `MESSAGES_HZ` a second, and as many at once."""

    def __init__(self, now: Now = time.monotonic) -> None:
        self._now = now
        self._left, self._at_s = float(MESSAGES_HZ), now()

    def allows(self, cost: int = 1) -> bool:
        """Count one that costs as much as so many; return whether it is not too many."""
        now_s = self._now()
        self._left = min(float(MESSAGES_HZ), self._left + (now_s - self._at_s) * MESSAGES_HZ)
        self._at_s = now_s
        self._left -= cost
        return self._left >= 0.0


class Guesses:
    """Counts wrong tokens by address."""

    def __init__(self, now: Now = time.monotonic) -> None:
        self._now = now
        self._wrong: dict[str, deque[float]] = {}

    def note_wrong(self, address: str) -> None:
        """Count one."""
        now_s = self._now()
        if len(self._wrong) >= _MOST_ADDRESSES:
            self._wrong.pop(next(iter(self._wrong)))
        times = self._wrong.setdefault(address, deque(maxlen=WRONG_TOKENS))
        times.append(now_s)

    def has_to_wait(self, address: str) -> bool:
        """Return whether the next one has to wait: there were so many within a minute."""
        times = self._wrong.get(address, ())
        now_s = self._now()
        return sum(now_s - at_s < WRONG_TOKENS_S for at_s in times) >= WRONG_TOKENS


class LimitedProtocol(H11Protocol):
    """HTTP as uvicorn speaks it, for so many connections; whoever asks for nothing is not waited for."""

    most_connections = MOST_CONNECTIONS
    _impatience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Take a connection, or close it where there are too many."""
        super().connection_made(transport)
        others: Iterable[Any] = self.connections
        by_address = Counter(one.client[0] for one in others if one.client is not None)
        address = self.client[0] if self.client is not None else ""
        is_one_too_many = by_address[address] > MOST_AN_ADDRESS and not is_loopback_address(address)
        if len(self.connections) > self.most_connections or is_one_too_many:
            transport.abort()
            return
        self._impatience = self.loop.call_later(FIRST_REQUEST_S, self._give_up)

    def _give_up(self) -> None:
        has_asked = getattr(self, "scope", None) is not None
        if not has_asked:
            self.transport.abort()


ABORT = "chatrobot.abort"
"""The extension of a scope that ends its connection at once, unread as it may be."""


class AbortableWebSocket(WebSocketsSansIOProtocol):
    """A WebSocket as uvicorn speaks it, which need not wait for its reader to end."""

    def handle_connect(self, event: Any) -> None:
        """Begin to serve it."""
        super().handle_connect(event)
        scope: Any = getattr(self, "scope", None)
        if scope is not None:
            scope["extensions"][ABORT] = self.transport.abort


def is_loopback_address(address: str) -> bool:
    """Return whether it is of this machine: all people at it have the same, and all pages of a class tried out."""
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False
