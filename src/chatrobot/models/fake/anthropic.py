"""Anthropic's Messages."""

from __future__ import annotations

import json
from typing import Any

from chatrobot.models.fake.script import HttpError, ToolCall
from chatrobot.models.fake.wires import Asked, Counted, Whole, new_id, plain_text, sse, turns_of

_REASONS = {"stop": "end_turn", "length": "max_tokens", "tool_calls": "tool_use", "content_filter": "refusal"}
_ERRORS = {
    400: "invalid_request_error", 401: "authentication_error", 403: "permission_error", 404: "not_found_error",
    429: "rate_limit_error", 529: "overloaded_error",
}  # fmt: skip


class AnthropicMessages:
    """POST …/v1/messages."""

    def __init__(self) -> None:
        self._id = new_id("msg")
        self._open = -1
        self._is_text = False

    def read(self, body: dict[str, Any], path: str) -> Asked:  # noqa: ARG002 - part of the form
        turns, images = turns_of(body.get("messages"))
        system = plain_text(body.get("system"))[0]
        turns = ((("system", system),) if system else ()) + turns
        return Asked(str(body.get("model", "")), bool(body.get("stream")), turns, images)

    def start(self, asked: Asked) -> bytes:
        message = {**self._head(asked), "content": [], "stop_reason": None, "usage": _usage(Counted(0, 0, 0))}
        return _event("message_start", message=message)

    def token(self, text: str) -> bytes:
        begin = b"" if self._is_text else self._begin({"type": "text", "text": ""})
        self._is_text = True
        return begin + _event(
            "content_block_delta", index=self._open, delta={"type": "text_delta", "text": text}
        )

    def tool(self, index: int, call: ToolCall) -> bytes:  # noqa: ARG002 - part of the form
        begin = self._begin({"type": "tool_use", "id": new_id("toolu"), "name": call.name, "input": {}})
        self._is_text = False
        delta = {"type": "input_json_delta", "partial_json": call.arguments}
        return begin + _event("content_block_delta", index=self._open, delta=delta)

    def refuse(self, text: str) -> bytes:
        return self.token(text)

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        usage = _usage(counted or Counted(0, 0, 0))
        delta = {"stop_reason": _REASONS.get(reason, reason), "stop_sequence": None}
        return self._close() + _event("message_delta", delta=delta, usage=usage) + _event("message_stop")

    def whole(self, asked: Asked, reply: Whole) -> dict[str, Any]:
        content: list[dict[str, Any]] = [{"type": "text", "text": reply.text or reply.refusal}]
        content += [
            {
                "type": "tool_use",
                "id": new_id("toolu"),
                "name": call.name,
                "input": json.loads(call.arguments),
            }
            for call in reply.tools
        ]
        return {
            **self._head(asked),
            "content": content,
            "stop_reason": _REASONS.get(reply.finish, reply.finish),
            "usage": _usage(reply.counted or Counted(0, 0, 0)),
        }

    def error(self, error: HttpError) -> dict[str, Any]:
        kind = error.code or _ERRORS.get(error.status, "api_error")
        return {"type": "error", "error": {"type": kind, "message": error.message}}

    def _head(self, asked: Asked) -> dict[str, Any]:
        return {
            "id": self._id,
            "type": "message",
            "role": "assistant",
            "model": asked.model,
            "stop_sequence": None,
        }

    def _begin(self, block: dict[str, Any]) -> bytes:
        close = self._close()
        self._open += 1
        return close + _event("content_block_start", index=self._open, content_block=block)

    def _close(self) -> bytes:
        return _event("content_block_stop", index=self._open) if self._open >= 0 else b""


def _event(kind: str, **values: Any) -> bytes:
    return sse({"type": kind, **values}, event=kind)


def _usage(counted: Counted) -> dict[str, Any]:
    return {
        "input_tokens": counted.prompt - counted.cached,
        "cache_read_input_tokens": counted.cached,
        "cache_creation_input_tokens": 0,
        "output_tokens": counted.reply,
    }
