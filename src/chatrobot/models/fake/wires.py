"""How each provider writes things down: what a request asks, and the events and bodies of a reply.

A new instance serves one call. Bytes that `start`, `token`, `tool`, `refuse` and `finish` return go out as they are.
"""

from __future__ import annotations

import itertools
import json
from dataclasses import dataclass
from typing import Any, Protocol

from chatrobot.models.fake.script import Answer, HttpError, ToolCall

CHARS_PER_TOKEN = 4
_ids = itertools.count(1)


def new_id(prefix: str) -> str:
    return f"{prefix}_{next(_ids):08d}"


@dataclass(frozen=True)
class Counted:
    """Tokens of one call."""

    prompt: int
    cached: int
    reply: int


@dataclass(frozen=True)
class Asked:
    """What a request asks for. `said` is what the user said last; `turns` are all turns as (role, text)."""

    model: str
    stream: bool
    turns: tuple[tuple[str, str], ...]
    images: int = 0

    @property
    def said(self) -> str:
        return next((text for role, text in reversed(self.turns) if role == "user"), "")


@dataclass(frozen=True)
class Whole:
    """A reply in one piece."""

    text: str
    tools: tuple[ToolCall, ...]
    refusal: str
    finish: str
    counted: Counted | None


class WireFormat(Protocol):
    """One call in one provider's form."""

    def read(self, body: dict[str, Any], path: str) -> Asked: ...

    def start(self, asked: Asked) -> bytes: ...

    def token(self, text: str) -> bytes: ...

    def tool(self, index: int, call: ToolCall) -> bytes: ...

    def refuse(self, text: str) -> bytes: ...

    def finish(self, reason: str, counted: Counted | None) -> bytes: ...

    def whole(self, asked: Asked, reply: Whole) -> dict[str, Any]: ...

    def error(self, error: HttpError) -> dict[str, Any]: ...


def sse(data: dict[str, Any] | str, event: str = "") -> bytes:
    """One server-sent event."""
    text = data if isinstance(data, str) else json.dumps(data, ensure_ascii=False)
    return ((f"event: {event}\n" if event else "") + f"data: {text}\n\n").encode()


def count(asked: Asked, answer: Answer, tokens: list[str]) -> Counted | None:
    """Prompt tokens as the script says, or one for four characters; None where nothing is to be counted."""
    if answer.uncounted:
        return None
    chars = sum(len(text) for _, text in asked.turns)
    prompt = answer.prompt_tokens if answer.prompt_tokens is not None else -(-chars // CHARS_PER_TOKEN)
    return Counted(prompt, min(answer.cached_tokens, prompt), len(tokens))


def plain_text(content: Any) -> tuple[str, int]:
    """The text of a message's content, which may be a string or a list of parts, and how many pictures are in it."""
    if isinstance(content, str):
        return content, 0
    parts = content if isinstance(content, list) else []
    texts = [str(part["text"]) for part in parts if isinstance(part, dict) and "text" in part]
    return "\n".join(texts), len(parts) - len(texts)


def turns_of(messages: Any) -> tuple[tuple[tuple[str, str], ...], int]:
    """(role, text) of each message with a role, and how many pictures there are in all."""
    turns, images = [], 0
    for message in messages if isinstance(messages, list) else []:
        if isinstance(message, dict) and "role" in message:
            text, more = plain_text(message.get("content"))
            turns.append((str(message["role"]), text))
            images += more
    return tuple(turns), images
