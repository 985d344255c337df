"""Google's generateContent and streamGenerateContent."""

from __future__ import annotations

import json
import re
from typing import Any

from chatrobot.models.fake.script import HttpError, ToolCall
from chatrobot.models.fake.wires import Asked, Counted, Whole, new_id, plain_text, sse

_REASONS = {"stop": "STOP", "length": "MAX_TOKENS", "tool_calls": "STOP", "content_filter": "SAFETY"}
_STATUS = {
    400: "INVALID_ARGUMENT", 401: "UNAUTHENTICATED", 403: "PERMISSION_DENIED", 404: "NOT_FOUND",
    429: "RESOURCE_EXHAUSTED", 503: "UNAVAILABLE",
}  # fmt: skip


class GoogleGenerate:
    """POST …/models/NAME:generateContent, or :streamGenerateContent?alt=sse."""

    def __init__(self) -> None:
        self._id = new_id("gen")
        self._model = ""

    def read(self, body: dict[str, Any], path: str) -> Asked:
        turns, images = [], 0
        if isinstance(system := body.get("systemInstruction"), dict):
            turns.append(("system", plain_text(system.get("parts"))[0]))
        for content in body.get("contents") or []:
            text, more = plain_text(content.get("parts"))
            turns.append(("assistant" if content.get("role") == "model" else "user", text))
            images += more
        found = re.search(r"/models/([^/:]+):", path)
        return Asked(found[1] if found else "", "streamGenerateContent" in path, tuple(turns), images)

    def start(self, asked: Asked) -> bytes:
        self._model = asked.model
        return b""

    def token(self, text: str) -> bytes:
        return sse(self._body([{"text": text}]))

    def tool(self, index: int, call: ToolCall) -> bytes:  # noqa: ARG002 - part of the form
        return sse(self._body([_function(call)]))

    def refuse(self, text: str) -> bytes:  # noqa: ARG002 - it blocks without a word
        return b""

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        return sse(self._body([], _REASONS.get(reason, reason), counted))

    def whole(self, asked: Asked, reply: Whole) -> dict[str, Any]:
        self._model = asked.model
        parts: list[dict[str, Any]] = [{"text": reply.text}] if reply.text else []
        return self._body(
            parts + [_function(call) for call in reply.tools], _REASONS[reply.finish], reply.counted
        )

    def error(self, error: HttpError) -> dict[str, Any]:
        status = error.code or _STATUS.get(error.status, "INTERNAL")
        details = []
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
        if finish is not None:
            candidate["finishReason"] = finish
        body: dict[str, Any] = {
            "candidates": [candidate],
            "modelVersion": self._model,
            "responseId": self._id,
        }
        if counted is not None:
            body["usageMetadata"] = {
                "promptTokenCount": counted.prompt,
                "cachedContentTokenCount": counted.cached,
                "candidatesTokenCount": counted.reply,
                "totalTokenCount": counted.prompt + counted.reply,
            }
        return body


def _function(call: ToolCall) -> dict[str, Any]:
    return {"functionCall": {"name": call.name, "args": json.loads(call.arguments)}}
