"""Speaks Anthropic's and Google's form."""

from __future__ import annotations

import json
import re
from typing import Any

from chatrobot.models.fake.script import Answer, HttpError, ToolCall
from chatrobot.models.fake.wires import Asked, Counted, Wire, new_id, read_asked, sse

_MESSAGES_ENDS = {
    "stop": "end_turn", "length": "max_tokens", "tool_calls": "tool_use", "content_filter": "refusal",
}  # fmt: skip
_MESSAGES_ERRORS = {
    400: "invalid_request_error", 401: "authentication_error", 403: "permission_error", 404: "not_found_error",
    429: "rate_limit_error", 529: "overloaded_error",
}  # fmt: skip
_GENERATE_ENDS = {"stop": "STOP", "length": "MAX_TOKENS", "tool_calls": "STOP", "content_filter": "SAFETY"}
_GENERATE_ERRORS = {
    400: "INVALID_ARGUMENT", 401: "UNAUTHENTICATED", 403: "PERMISSION_DENIED", 404: "NOT_FOUND",
    429: "RESOURCE_EXHAUSTED", 503: "UNAVAILABLE",
}  # fmt: skip


class _Messages(Wire):
    """Anthropic's Messages: POST …/v1/messages."""

    prefix = "msg"
    _open = -1
    _is_text = False

    def _read(self, body: dict[str, Any], path: str) -> Asked:
        del path
        return read_asked(body, body.get("messages"), body.get("system"))

    def start(self) -> bytes:
        return self._event("message_start", message=self._message([], None, None))

    def token(self, text: str) -> bytes:
        begin = b"" if self._is_text else self._begin({"type": "text", "text": ""})
        self._is_text = True
        return begin + self._delta({"type": "text_delta", "text": text})

    def tool(self, index: int, call: ToolCall) -> bytes:
        del index
        begin = self._begin({"type": "tool_use", "id": new_id("toolu"), "name": call.name, "input": {}})
        self._is_text = False
        return begin + self._delta({"type": "input_json_delta", "partial_json": call.arguments})

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        delta = {"stop_reason": _MESSAGES_ENDS.get(reason, reason), "stop_sequence": None}
        end = self._event("message_delta", delta=delta, usage=self._usage(counted))
        return self._close() + end + self._event("message_stop")

    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        content: list[dict[str, Any]] = [{"type": "text", "text": text or answer.refusal}]
        for call in answer.tool_calls:
            made = {"id": new_id("toolu"), "name": call.name, "input": json.loads(call.arguments)}
            content.append({"type": "tool_use", **made})
        return self._message(content, _MESSAGES_ENDS.get(answer.reason, answer.reason), counted)

    @staticmethod
    def error(error: HttpError) -> dict[str, Any]:
        kind = error.code or _MESSAGES_ERRORS.get(error.status, "api_error")
        return {"type": "error", "error": {"type": kind, "message": error.message}}

    def _message(
        self, content: list[dict[str, Any]], reason: str | None, counted: Counted | None
    ) -> dict[str, Any]:
        return {
            "id": self._id, "type": "message", "role": "assistant", "model": self.asked.model, "content": content,
            "stop_reason": reason, "stop_sequence": None, "usage": self._usage(counted),
        }  # fmt: skip

    def _begin(self, block: dict[str, Any]) -> bytes:
        close = self._close()
        self._open += 1
        return close + self._event("content_block_start", index=self._open, content_block=block)

    def _delta(self, delta: dict[str, Any]) -> bytes:
        return self._event("content_block_delta", index=self._open, delta=delta)

    def _close(self) -> bytes:
        return self._event("content_block_stop", index=self._open) if self._open >= 0 else b""

    @staticmethod
    def _event(kind: str, **values: Any) -> bytes:
        return sse({"type": kind, **values}, event=kind)

    @staticmethod
    def _usage(counted: Counted | None) -> dict[str, Any]:
        counted = counted or Counted()
        return {
            "input_tokens": counted.prompt_tokens - counted.cached_tokens,
            "cache_read_input_tokens": counted.cached_tokens,
            "cache_creation_input_tokens": 0, "output_tokens": counted.reply_tokens,
        }  # fmt: skip


class _Generate(Wire):
    """Google's generateContent: POST …/models/NAME:generateContent, or :streamGenerateContent?alt=sse."""

    prefix = "gen"

    def _read(self, body: dict[str, Any], path: str) -> Asked:
        found = re.search(r"/models/([^/:]+):", path)
        said = [
            {"role": "assistant" if row.get("role") == "model" else "user", "content": row.get("parts")}
            for row in body.get("contents") or []
        ]
        system = (body.get("systemInstruction") or {}).get("parts")
        head = {"model": found[1] if found else "", "stream": "streamGenerateContent" in path}
        return read_asked(head, said, system)

    def token(self, text: str) -> bytes:
        return sse(self._body([{"text": text}]))

    def tool(self, index: int, call: ToolCall) -> bytes:
        del index
        return sse(self._body([self._function(call)]))

    def refuse(self, text: str) -> bytes:
        del text  # it blocks without a word
        return b""

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        return sse(self._body([], _GENERATE_ENDS.get(reason, reason), counted))

    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        parts: list[dict[str, Any]] = [{"text": text}] if text else []
        parts += map(self._function, answer.tool_calls)
        return self._body(parts, _GENERATE_ENDS.get(answer.reason, answer.reason), counted)

    @staticmethod
    def error(error: HttpError) -> dict[str, Any]:
        status, details = error.code or _GENERATE_ERRORS.get(error.status, "INTERNAL"), []
        if error.retry_after_s is not None:
            kind = "type.googleapis.com/google.rpc.RetryInfo"
            details.append({"@type": kind, "retryDelay": f"{error.retry_after_s:g}s"})
        return {
            "error": {"code": error.status, "message": error.message, "status": status, "details": details}
        }

    def _body(
        self, parts: list[dict[str, Any]], finish: str | None = None, counted: Counted | None = None
    ) -> dict[str, Any]:
        candidate: dict[str, Any] = {"content": {"role": "model", "parts": parts}, "index": 0}
        candidate.update({"finishReason": finish} if finish is not None else {})
        body = {"candidates": [candidate], "modelVersion": self.asked.model, "responseId": self._id}
        if counted is None:
            return body
        usage = {
            "promptTokenCount": counted.prompt_tokens, "cachedContentTokenCount": counted.cached_tokens,
            "candidatesTokenCount": counted.reply_tokens,
            "totalTokenCount": counted.prompt_tokens + counted.reply_tokens,
        }  # fmt: skip
        return {**body, "usageMetadata": usage}

    @staticmethod
    def _function(call: ToolCall) -> dict[str, Any]:
        return {"functionCall": {"name": call.name, "args": json.loads(call.arguments)}}


WIRES: dict[str, type[Wire]] = {
    "/messages": _Messages, ":generateContent": _Generate, ":streamGenerateContent": _Generate,
}  # fmt: skip
"""By the end of their paths."""
