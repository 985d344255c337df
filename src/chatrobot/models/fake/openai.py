"""Speaks OpenAI's two forms: Chat Completions, and Responses with conversations that the server holds."""

from __future__ import annotations

import time
from typing import Any

from chatrobot.models.fake.script import Answer, ToolCall
from chatrobot.models.fake.wires import Asked, Conversations, Counted, Wire, new_id, read_asked, sse


class _Chat(Wire):
    """OpenAI's Chat Completions, as all its imitators speak it, too: POST …/chat/completions."""

    prefix = "chatcmpl"

    def _read(self, body: dict[str, Any], path: str) -> Asked:
        del path
        return read_asked(body, body.get("messages"))

    def start(self) -> bytes:
        return self._chunk({"role": "assistant", "content": ""})

    def token(self, text: str) -> bytes:
        return self._chunk({"content": text})

    def tool(self, index: int, call: ToolCall) -> bytes:
        return self._chunk({"tool_calls": [{"index": index, **_function(call)}]})

    def refuse(self, text: str) -> bytes:
        return self._chunk({"refusal": text})

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        end = self._chunk({}, reason)
        if counted is not None:
            end += sse({**self._head("chat.completion.chunk"), "choices": [], **_chat_usage(counted)})
        return end + sse("[DONE]")

    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        message: dict[str, Any] = {"role": "assistant", "content": text or None}
        message.update({"refusal": answer.refusal} if answer.refusal else {})
        message.update({"tool_calls": list(map(_function, answer.tool_calls))} if answer.tool_calls else {})
        choice = {"index": 0, "message": message, "finish_reason": answer.reason}
        usage = _chat_usage(counted) if counted is not None else {}
        return {**self._head("chat.completion"), "choices": [choice], **usage}

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


class _Responses(Wire):
    """OpenAI's Responses, with conversations that the server holds: POST …/responses."""

    prefix = "resp"

    def __init__(self, body: dict[str, Any], path: str, held: Conversations) -> None:
        self._item = new_id("msg")
        self._text = ""
        self._tools: list[dict[str, Any]] = []
        self._number = -1
        super().__init__(body, path, held)

    def _read(self, body: dict[str, Any], path: str) -> Asked:
        del path
        given = body.get("conversation")
        self._conversation = str(given.get("id", "") if isinstance(given, dict) else given or "")
        before = self._conversation or str(body.get("previous_response_id") or "")
        said = body.get("input")
        new = read_asked(body, [{"role": "user", "content": said}] if isinstance(said, str) else said)
        self._turns = (*(self._held.known(before) if before else ()), *new.turns)
        system = read_asked(body, [], body.get("instructions")).turns
        return Asked(new.model, new.stream, (*system, *self._turns), new.images)

    def start(self) -> bytes:
        part = {"type": "output_text", "text": "", "annotations": []}
        item = {**self._message([]), "status": "in_progress"}
        begun = self._event("response.created", response=self._response("in_progress", []))
        begun += self._event("response.output_item.added", output_index=0, item=item)
        return begun + self._part("response.content_part.added", part=part)

    def token(self, text: str) -> bytes:
        self._text += text
        return self._part("response.output_text.delta", delta=text, logprobs=[])

    def tool(self, index: int, call: ToolCall) -> bytes:
        self._tools.append(item := _response_function(call))
        done = ("response.output_item.added", "response.output_item.done")
        return b"".join(self._event(kind, output_index=index + 1, item=item) for kind in done)

    def refuse(self, text: str) -> bytes:
        return self._part("response.refusal.delta", delta=text) + self._part(
            "response.refusal.done", refusal=text
        )

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        status = "incomplete" if reason == "length" else "completed"
        return self._event(f"response.{status}", response=self._ended(status, counted))

    def whole(self, text: str, answer: Answer, counted: Counted | None) -> dict[str, Any]:
        self._text = text
        self._tools = list(map(_response_function, answer.tool_calls))
        return self._ended("completed", counted, answer.refusal)

    def _ended(self, status: str, counted: Counted | None, refusal: str = "") -> dict[str, Any]:
        """Keep what was said, and return the whole response."""
        turns = (*self._turns, ("assistant", self._text))
        for name in filter(None, (self._id, self._conversation)):
            self._held.keep(name, turns)
        part = {"type": "output_text", "text": self._text, "annotations": [], "logprobs": []}
        content = {"type": "refusal", "refusal": refusal} if refusal else part
        return self._response(status, [self._message([content]), *self._tools], counted)

    def _message(self, content: list[dict[str, Any]]) -> dict[str, Any]:
        head = {"id": self._item, "type": "message", "role": "assistant", "status": "completed"}
        return {**head, "content": content}

    def _response(
        self, status: str, output: list[dict[str, Any]], counted: Counted | None = None
    ) -> dict[str, Any]:
        body: dict[str, Any] = {
            "id": self._id, "object": "response", "created_at": int(time.time()), "model": self.asked.model,
            "status": status, "output": output, "parallel_tool_calls": True, "tool_choice": "auto",
            "tools": [], "error": None, "usage": None,
            "incomplete_details": {"reason": "max_output_tokens"} if status == "incomplete" else None,
        }  # fmt: skip
        if self._conversation:
            body["conversation"] = {"id": self._conversation}
        if counted is not None:
            body["usage"] = {
                "input_tokens": counted.prompt_tokens, "input_tokens_details": {"cached_tokens": counted.cached_tokens},
                "output_tokens": counted.reply_tokens, "output_tokens_details": {"reasoning_tokens": 0},
                "total_tokens": counted.prompt_tokens + counted.reply_tokens,
            }  # fmt: skip
        return body

    def _part(self, kind: str, **values: Any) -> bytes:
        return self._event(kind, output_index=0, content_index=0, item_id=self._item, **values)

    def _event(self, kind: str, **values: Any) -> bytes:
        self._number += 1
        return sse({"type": kind, "sequence_number": self._number, **values}, event=kind)


def _response_function(call: ToolCall) -> dict[str, Any]:
    return {
        "type": "function_call", "id": new_id("fc"), "call_id": new_id("call"), "name": call.name,
        "arguments": call.arguments, "status": "completed",
    }  # fmt: skip


WIRES: dict[str, type[Wire]] = {"/chat/completions": _Chat, "/responses": _Responses}
"""By the end of their paths."""
