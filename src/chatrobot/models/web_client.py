"""Makes the HTTP client of the model library: no redirects with a key in hand, no endless replies, no proxy here.

Imports the library's HTTP client: only from the background thread.
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextvars import ContextVar
from functools import cache
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import httpx2

from chatrobot.models.discovery import LOOPBACK
from chatrobot.models.seam import CallLimits

if TYPE_CHECKING:
    import ssl

CONNECT_S = 10.0
ERROR_BYTES = 65_536
"""An error's text is read so far; what follows is left unread."""
BYTES_PER_CHAR = 100
"""Event streams wrap a token of a few characters in two or three hundred bytes of JSON."""
SPARE_BYTES = 262_144
reply_bytes: ContextVar[int] = ContextVar("reply_bytes")
"""How many bytes the reply of the call under way may have."""


class TooManyBytesError(Exception):
    """Raised where the reply is larger than the text that may be in it could ever need."""


class NotAStreamError(Exception):
    """Raised where something answered that is no model server: a login page, a proxy, a web site."""


class _Capped(httpx2.AsyncByteStream):
    """Body of a response, cut off after so many bytes: silently (an error's text), or with an error."""

    def __init__(self, stream: httpx2.AsyncByteStream, limit_bytes: int, *, silent: bool) -> None:
        self._stream = stream
        self._left_bytes = limit_bytes
        self._silent = silent

    async def __aiter__(self) -> AsyncIterator[bytes]:
        async for chunk in self._stream:
            self._left_bytes -= len(chunk)
            if self._left_bytes < 0:
                if self._silent:
                    yield chunk[: self._left_bytes]
                    return
                raise TooManyBytesError
            yield chunk

    async def aclose(self) -> None:
        await self._stream.aclose()


def allow(limits: CallLimits) -> None:
    """Set how large the reply of the call under way may be."""
    reply_bytes.set(limits.reply_chars * BYTES_PER_CHAR + SPARE_BYTES)


@cache
def _trusted(*, by_environment: bool) -> ssl.SSLContext:
    """The authorities of this machine, read once: that takes longer than all else of a client."""
    return httpx2.create_ssl_context(trust_env=by_environment)


def web_client(base_url: str) -> httpx2.AsyncClient:
    """Return a client for one model; connections are kept between its calls. Each request brings its own time limit."""
    may_trust_environment = urlsplit(base_url).hostname not in LOOPBACK
    return httpx2.AsyncClient(
        verify=_trusted(by_environment=may_trust_environment),
        timeout=httpx2.Timeout(CallLimits().total_s, connect=CONNECT_S),
        follow_redirects=False,  # not every provider's key header is dropped when a redirect leads elsewhere
        trust_env=may_trust_environment,
        headers={"User-Agent": "chatrobot", "Accept-Encoding": "identity"},
        event_hooks={"request": [_hurry], "response": [_look_at]},
    )


async def _hurry(request: httpx2.Request) -> None:
    """Let connecting take no minute, though a call may: the libraries give one number for both."""
    timeout = dict(request.extensions.get("timeout") or {})
    request.extensions = {**request.extensions, "timeout": {**timeout, "connect": CONNECT_S}}


async def _look_at(response: httpx2.Response) -> None:
    assert isinstance(response.stream, httpx2.AsyncByteStream)
    if response.status_code != 200:
        response.stream = _Capped(response.stream, ERROR_BYTES, silent=True)
        return
    kind = response.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "text/event-stream" and kind.startswith(("text/", "image/", "application/json")):
        raise NotAStreamError(kind)
    response.stream = _Capped(response.stream, reply_bytes.get(), silent=False)
