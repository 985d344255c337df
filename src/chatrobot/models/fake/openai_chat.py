"""OpenAI's Chat Completions, as all its imitators speak it, too."""

from __future__ import annotations

import time
from typing import Any

from chatrobot.models.fake.script import HttpError, ToolCall
from chatrobot.models.fake.wires import Asked, Counted, Whole, new_id, sse, turns_of


class OpenAIChat:
    """POST …/chat/completions."""

    def __init__(self) -> None:
        self._id = new_id("chatcmpl")
        self._model = ""

    def read(self, body: dict[str, Any], path: str) -> Asked:  # noqa: ARG002 - part of the form
        turns, images = turns_of(body.get("messages"))
        return Asked(str(body.get("model", "")), bool(body.get("stream")), turns, images)

    def start(self, asked: Asked) -> bytes:
        self._model = asked.model
        return self._chunk({"role": "assistant", "content": ""})

    def token(self, text: str) -> bytes:
        return self._chunk({"content": text})

    def tool(self, index: int, call: ToolCall) -> bytes:
        function = {"name": call.name, "arguments": call.arguments}
        return self._chunk(
            {"tool_calls": [{"index": index, "id": new_id("call"), "type": "function", "function": function}]}
        )

    def refuse(self, text: str) -> bytes:
        return self._chunk({"refusal": text})

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        end = self._chunk({}, finish=reason)
        if counted is not None:
            end += sse({**self._head("chat.completion.chunk"), "choices": [], "usage": _usage(counted)})
        return end + sse("[DONE]")

    def whole(self, asked: Asked, reply: Whole) -> dict[str, Any]:
        self._model = asked.model
        message: dict[str, Any] = {"role": "assistant", "content": reply.text or None}
        if reply.refusal:
            message["refusal"] = reply.refusal
        if reply.tools:
            message["tool_calls"] = [
                {
                    "id": new_id("call"),
                    "type": "function",
                    "function": {"name": call.name, "arguments": call.arguments},
                }
                for call in reply.tools
            ]
        body: dict[str, Any] = {
            **self._head("chat.completion"),
            "choices": [{"index": 0, "message": message, "finish_reason": reply.finish}],
        }
        return {**body, "usage": _usage(reply.counted)} if reply.counted is not None else body

    def error(self, error: HttpError) -> dict[str, Any]:
        return openai_error(error)

    def _head(self, kind: str) -> dict[str, Any]:
        return {"id": self._id, "object": kind, "created": int(time.time()), "model": self._model}

    def _chunk(self, delta: dict[str, Any], finish: str | None = None) -> bytes:
        choice = {"index": 0, "delta": delta, "finish_reason": finish}
        return sse({**self._head("chat.completion.chunk"), "choices": [choice]})


def openai_error(error: HttpError) -> dict[str, Any]:
    """OpenAI's form of an error."""
    kind = "invalid_request_error" if error.status < 500 else "server_error"
    return {"error": {"message": error.message, "type": kind, "param": None, "code": error.code or None}}


def _usage(counted: Counted) -> dict[str, Any]:
    return {
        "prompt_tokens": counted.prompt,
        "completion_tokens": counted.reply,
        "total_tokens": counted.prompt + counted.reply,
        "prompt_tokens_details": {"cached_tokens": counted.cached},
    }
