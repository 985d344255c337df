"""OpenAI's Chat Completions from the server's side: reads a request, writes the events and bodies of a reply."""

from __future__ import annotations

import itertools
import json
import time
from dataclasses import dataclass
from typing import Any

from chatrobot.models.fake.script import Answer, HttpError, ToolCall

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
    turns: tuple[tuple[str, str], ...]
    images: int = 0

    @property
    def said(self) -> str:
        """Return what the user said last."""
        return next((text for role, text in reversed(self.turns) if role == "user"), "")


class Chat:
    """One call. What `start`, `token`, `tool`, `refuse` and `finish` return goes out as it is."""

    prefix = "chatcmpl"

    def __init__(self, body: dict[str, Any], path: str) -> None:
        self._id = new_id(self.prefix)
        self.asked = self._read(body, path)

    def _read(self, body: dict[str, Any], path: str) -> Asked:
        del path
        return read_asked(body, body.get("messages"))

    def start(self) -> bytes:
        """Write what comes before the first token."""
        return self._chunk({"role": "assistant", "content": ""})

    def token(self, text: str) -> bytes:
        """Write a piece of text."""
        return self._chunk({"content": text})

    def tool(self, index: int, call: ToolCall) -> bytes:
        """Write a call of a tool, the `index`-th of this reply."""
        return self._chunk({"tool_calls": [{"index": index, **_function(call)}]})

    def refuse(self, text: str) -> bytes:
        """Write why it declines."""
        return self._chunk({"refusal": text})

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        """Write the end; `reason` in OpenAI's words."""
        end = self._chunk({}, reason)
        if counted is not None:
            end += sse({**self._head("chat.completion.chunk"), "choices": [], **_chat_usage(counted)})
        return end + sse("[DONE]")

    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        """Return the body of a reply in one piece; `text` is that of `answer`."""
        message: dict[str, Any] = {"role": "assistant", "content": text or None}
        message.update({"refusal": answer.refusal} if answer.refusal else {})
        message.update({"tool_calls": list(map(_function, answer.tool_calls))} if answer.tool_calls else {})
        choice = {"index": 0, "message": message, "finish_reason": answer.reason}
        usage = _chat_usage(counted) if counted is not None else {}
        return {**self._head("chat.completion"), "choices": [choice], **usage}

    @staticmethod
    def error(error: HttpError) -> dict[str, Any]:
        """Return the body of an error."""
        kind = "invalid_request_error" if error.status < 500 else "server_error"
        return {"error": {"message": error.message, "type": kind, "param": None, "code": error.code or None}}

    def _head(self, kind: str) -> dict[str, Any]:
        return {"id": self._id, "object": kind, "created": int(time.time()), "model": self.asked.model}

    def _chunk(self, delta: dict[str, Any], finish: str | None = None) -> bytes:
        choice = {"index": 0, "delta": delta, "finish_reason": finish}
        return sse({**self._head("chat.completion.chunk"), "choices": [choice]})


def _function(call: ToolCall) -> dict[str, Any]:
    function = {"name": call.name, "arguments": call.arguments}
    return {"id": new_id("call"), "type": "function", "function": function}


def _chat_usage(counted: Counted) -> dict[str, Any]:
    return {
        "usage": {
            "prompt_tokens": counted.prompt_tokens,
            "completion_tokens": counted.reply_tokens,
            "total_tokens": counted.prompt_tokens + counted.reply_tokens,
            "prompt_tokens_details": {"cached_tokens": counted.cached_tokens},
        }
    }


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
