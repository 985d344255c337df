"""Speaks each provider's form: reads what a request asks, writes the events and bodies of a reply.

A wire serves one call. Bytes that `start`, `token`, `tool`, `refuse` and `finish` return go out as they are; `whole` is
the reply to a request that wants no stream.
"""

from __future__ import annotations

import itertools
import json
import threading
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from chatrobot.models.fake.script import Answer, HttpError, ToolCall

Turns = tuple[tuple[str, str], ...]
_ids = itertools.count(1)


def new_id(prefix: str) -> str:
    """Return an identifier that no other call has."""
    return f"{prefix}_{next(_ids):08d}"


@dataclass(frozen=True)
class Counted:
    """Tokens of one call."""

    prompt_tokens: int = 0
    cached_tokens: int = 0
    reply_tokens: int = 0


@dataclass(frozen=True)
class Asked:
    """Request as it was read. `turns` are all turns as (role, text)."""

    model: str
    stream: bool
    turns: Turns
    images: int = 0

    @property
    def said(self) -> str:
        """Return what the user said last."""
        return next((text for role, text in reversed(self.turns) if role == "user"), "")


class UnknownConversationError(Exception):
    """Raised for a request that goes on from something this server never said."""


class Conversations:
    """Holds what was said: turns by response id and by conversation id."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._turns: dict[str, Turns] = {}

    def begin(self) -> str:
        """Begin a conversation without a word in it, and return its id."""
        self.keep(conversation := new_id("conv"), ())
        return conversation

    def known(self, name: str) -> Turns:
        """Return the turns of that response or conversation.

        Raises:
            UnknownConversationError: there is none.
        """
        with self._lock:
            if name not in self._turns:
                raise UnknownConversationError(name)
            return self._turns[name]

    def keep(self, name: str, turns: Turns) -> None:
        """Keep them under that id."""
        with self._lock:
            self._turns[name] = turns


class Wire(ABC):
    """One call in one provider's form.

    Raises:
        UnknownConversationError: it goes on from what `held` does not hold.
    """

    prefix = ""

    def __init__(self, body: dict[str, Any], path: str, held: Conversations) -> None:
        self._held = held
        self._id = new_id(self.prefix)
        self.asked = self._read(body, path)

    @abstractmethod
    def _read(self, body: dict[str, Any], path: str) -> Asked: ...

    def start(self) -> bytes:
        """Write what comes before the first token."""
        return b""

    @abstractmethod
    def token(self, text: str) -> bytes:
        """Write a piece of text."""

    @abstractmethod
    def tool(self, index: int, call: ToolCall) -> bytes:
        """Write a call of a tool, the `index`-th of this reply."""

    def refuse(self, text: str) -> bytes:
        """Write why it declines."""
        return self.token(text)

    @abstractmethod
    def finish(self, reason: str, counted: Counted | None) -> bytes:
        """Write the end; `reason` in OpenAI's words."""

    @abstractmethod
    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        """Return the body of a reply in one piece; `text` is that of `answer`."""

    @staticmethod
    def error(error: HttpError) -> dict[str, Any]:
        """Return the body of an error, in OpenAI's form unless the provider has another."""
        kind = "invalid_request_error" if error.status < 500 else "server_error"
        return {"error": {"message": error.message, "type": kind, "param": None, "code": error.code or None}}


def sse(data: dict[str, Any] | str, event: str = "") -> bytes:
    """Return one server-sent event."""
    text = data if isinstance(data, str) else json.dumps(data, ensure_ascii=False)
    return ((f"event: {event}\n" if event else "") + f"data: {text}\n\n").encode()


def read_asked(body: dict[str, Any], messages: Any, system: Any = None) -> Asked:
    """Return what is asked with those messages, each of them a role with a text or a list of parts."""
    turns, images = [("system", plain_text(system)[0])] if system else [], 0
    for message in messages if isinstance(messages, list) else []:
        if isinstance(message, dict) and "role" in message:
            text, more = plain_text(message.get("content"))
            turns.append((str(message["role"]), text))
            images += more
    return Asked(str(body.get("model", "")), bool(body.get("stream")), tuple(turns), images)


def plain_text(content: Any) -> tuple[str, int]:
    """Return the text of a message's content, and how many pictures are in it."""
    if isinstance(content, str):
        return content, 0
    parts = content if isinstance(content, list) else []
    texts = [str(part["text"]) for part in parts if isinstance(part, dict) and "text" in part]
    return "\n".join(texts), len(parts) - len(texts)
