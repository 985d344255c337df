"""Sorts the errors of the model library, whatever the provider: one clear `Reason` for each call that failed."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from urllib.parse import urlsplit

from chatrobot.core.reason import Reason, Value
from chatrobot.models.providers import Provider
from chatrobot.models.secret import PieceScrubber, Secret, scrub

SAID_CHARS = 200
MOST_CHARS = 5000
SUGGESTED_WAIT_S = 30
"""After a refusal for too many calls that does not say how long."""
_TAG = re.compile(r"<(?:script|style).*?</|<[^>]*>", re.DOTALL | re.IGNORECASE)
_UNREACHABLE = frozenset(
    {"ConnectError", "ConnectTimeout", "PoolTimeout", "ProxyError", "UnsupportedProtocol"}
)
_BROKEN_OFF = frozenset({"ReadError", "RemoteProtocolError", "WriteError", "CloseError", "StreamClosed"})
_SLOW = frozenset({"ReadTimeout", "WriteTimeout"})
_NO_CREDIT = ("insufficient_quota", "billing", "credit balance", "insufficient balance", "arrearage")
_BAD_KEY = ("api key", "api_key", "apikey")


@dataclass(frozen=True)
class Place:
    """Address of a call: for the sentences about it. `secret` is taken out of whatever is quoted."""

    provider: Provider
    model: str
    address: str
    secret: Secret | None

    @property
    def values(self) -> dict[str, Value]:
        """Return the values of every reason about it."""
        host = urlsplit(self.address).netloc.rpartition("@")[2]
        variable = self.provider.key_variables[0] if self.provider.key_variables else ""
        return {
            "provider": self.provider.name, "model": self.model, "host": host or self.provider.name,
            "variable": variable, "key_page": self.provider.key_page,
        }  # fmt: skip

    def reason(self, code: str, said: str = "", **values: Value) -> Reason:
        """Return a reason about it, quoting what was `said`."""
        if said:
            values["said"] = self.quote(said)
        return Reason(code, {**self.values, **values})

    def quote(self, text: str) -> str:
        """Return what a provider said: one line, short, without the key and without the tags of a web page."""
        whole = PieceScrubber(self.secret).feed(
            text[:MOST_CHARS]
        )  # a key that was cut is none that scrub knows
        line = " ".join(scrub(_TAG.sub(" ", whole), self.secret).split())
        return line if len(line) <= SAID_CHARS else line[: SAID_CHARS - 1] + "…"


def reason_of(error: BaseException, place: Place) -> Reason:
    """Return the one reason for whatever the library raised."""
    chain = list(_chain(error))
    names = {type(link).__name__ for link in chain}
    if "TooManyBytesError" in names:
        return place.reason("model_too_long")
    if "NotAStreamError" in names:
        kind = next(str(link) for link in chain if type(link).__name__ == "NotAStreamError")
        return place.reason("model_broken_reply", said=kind)
    for link in chain:
        status = getattr(link, "status_code", None)
        if isinstance(status, int) and status >= 300:
            return _of_status(status, link, place)
    if names & _UNREACHABLE:
        return place.reason("model_no_network", said=_deepest(chain))
    if names & _SLOW:
        return place.reason("model_timeout")
    if names & _BROKEN_OFF:
        return place.reason("model_cut_off")
    if "ContentFilterError" in names:
        return place.reason("model_refused")
    if "UserError" in names:  # the library itself will not send this
        return place.reason("model_rejected", said=_deepest(chain), status=0)
    if getattr(error, "in_stream", False):
        return place.reason("model_server_error", said=_said(error), status=200)
    return place.reason("model_broken_reply", said=_deepest(chain))


def _of_status(status: int, error: BaseException, place: Place) -> Reason:
    said = _said(error) or f"HTTP {status}"
    lower = f"{said} {getattr(error, 'body', '')}".lower()
    if status == 402 or (status in (400, 403, 429) and any(word in lower for word in _NO_CREDIT)):
        return place.reason("model_no_credit", said)
    if status in (401, 403) or (status == 400 and any(word in lower for word in _BAD_KEY)):
        return place.reason("model_wrong_key", said, status=status)
    if status == 404:
        return place.reason("model_not_found", said)
    if status == 429:
        after_s = _retry_after_s(error)
        return place.reason(
            "model_rate_limit", said, retry_after_s=SUGGESTED_WAIT_S if after_s is None else after_s
        )
    if status >= 500 or status == 408:
        return place.reason("model_server_error", said, status=status)
    if status < 400:
        return place.reason("model_broken_reply", said=f"HTTP {status}")
    return place.reason("model_rejected", said, status=status)


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    for _ in range(10):
        if error is None:
            return
        yield error
        error = error.__cause__ or error.__context__


def _deepest(chain: list[BaseException]) -> str:
    return next((str(link) for link in reversed(chain) if str(link)), type(chain[-1]).__name__)


def _said(error: BaseException) -> str:
    """Return the sentence in a provider's error body, where there is one."""
    body = getattr(error, "body", None)
    if isinstance(body, str):
        try:
            body = json.loads(body)
        except ValueError:
            return body
    if isinstance(body, list) and body:
        body = body[0]
    if isinstance(body, dict):
        inner = body.get("error", body)
        if isinstance(inner, dict):
            return str(inner.get("message") or inner.get("detail") or inner)
        return str(inner)
    return str(body or error)


def _retry_after_s(error: BaseException) -> float | None:
    """Return the seconds that the provider asked us to wait."""
    told = getattr(error, "retry_after", None)
    if told is None:
        headers = getattr(error, "headers", None) or {}
        told = headers.get("retry-after")
    try:
        wait_s = round(float(told), 1) if told is not None else None
    except ValueError:
        return None
    return int(wait_s) if wait_s is not None and wait_s.is_integer() else wait_s
