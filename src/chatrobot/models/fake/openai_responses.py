"""OpenAI's Responses, with conversations that the server holds (previous response or conversation)."""

from __future__ import annotations

import threading
import time
from typing import Any

from chatrobot.models.fake.openai_chat import openai_error
from chatrobot.models.fake.script import HttpError, ToolCall
from chatrobot.models.fake.wires import Asked, Counted, Whole, new_id, plain_text, sse, turns_of

Turns = tuple[tuple[str, str], ...]


class UnknownConversationError(Exception):
    """A request goes on from something this server never said."""


class Conversations:
    """What the server holds: turns by response id and by conversation id."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._turns: dict[str, Turns] = {}

    def begin(self) -> str:
        """A new conversation without a word in it."""
        with self._lock:
            self._turns[conversation := new_id("conv")] = ()
            return conversation

    def drop(self) -> None:
        """Forget everything, as servers do after some weeks."""
        with self._lock:
            self._turns.clear()

    def known(self, name: str) -> Turns:
        with self._lock:
            if name not in self._turns:
                raise UnknownConversationError(name)
            return self._turns[name]

    def keep(self, name: str, turns: Turns) -> None:
        with self._lock:
            self._turns[name] = turns


class OpenAIResponses:
    """POST …/responses."""

    def __init__(self, conversations: Conversations) -> None:
        self._conversations = conversations
        self._id = new_id("resp")
        self._item = new_id("msg")
        self._conversation = ""
        self._model = ""
        self._turns: Turns = ()
        self._text = ""
        self._output: list[dict[str, Any]] = []
        self._number = -1

    def read(self, body: dict[str, Any], path: str) -> Asked:  # noqa: ARG002 - part of the form
        """Raises UnknownConversationError."""
        given = body.get("conversation")
        self._conversation = str(given.get("id", "") if isinstance(given, dict) else given or "")
        before = self._conversation or str(body.get("previous_response_id") or "")
        known = self._conversations.known(before) if before else ()
        said = body.get("input")
        new, images = (((("user", said),), 0)) if isinstance(said, str) else turns_of(said)
        self._turns = known + new
        system = ((("system", plain_text(body.get("instructions"))[0]),)) if body.get("instructions") else ()
        return Asked(str(body.get("model", "")), bool(body.get("stream")), system + self._turns, images)

    def start(self, asked: Asked) -> bytes:
        self._model = asked.model
        item = {
            "id": self._item,
            "type": "message",
            "role": "assistant",
            "status": "in_progress",
            "content": [],
        }
        part = {"type": "output_text", "text": "", "annotations": []}
        return (
            self._event("response.created", response=self._response("in_progress"))
            + self._event("response.output_item.added", output_index=0, item=item)
            + self._event(
                "response.content_part.added", output_index=0, content_index=0, item_id=self._item, part=part
            )
        )

    def token(self, text: str) -> bytes:
        self._text += text
        return self._event(
            "response.output_text.delta",
            output_index=0,
            content_index=0,
            item_id=self._item,
            delta=text,
            logprobs=[],
        )

    def tool(self, index: int, call: ToolCall) -> bytes:
        item = _function(call)
        self._output.append(item)
        return self._event("response.output_item.added", output_index=index + 1, item=item) + self._event(
            "response.output_item.done", output_index=index + 1, item=item
        )

    def refuse(self, text: str) -> bytes:
        return self._event(
            "response.refusal.delta", output_index=0, content_index=0, item_id=self._item, delta=text
        ) + self._event(
            "response.refusal.done", output_index=0, content_index=0, item_id=self._item, refusal=text
        )

    def finish(self, reason: str, counted: Counted | None) -> bytes:
        self._keep(self._text)
        self._output.insert(0, self._message(self._text, ""))
        if reason == "length":
            return self._event("response.incomplete", response=self._response("incomplete", counted))
        return self._event("response.completed", response=self._response("completed", counted))

    def whole(self, asked: Asked, reply: Whole) -> dict[str, Any]:
        self._model = asked.model
        self._keep(reply.text)
        self._output = [self._message(reply.text, reply.refusal), *map(_function, reply.tools)]
        return self._response("completed", reply.counted)

    def error(self, error: HttpError) -> dict[str, Any]:
        return openai_error(error)

    def _keep(self, text: str) -> None:
        turns = (*self._turns, ("assistant", text))
        self._conversations.keep(self._id, turns)
        if self._conversation:
            self._conversations.keep(self._conversation, turns)

    def _message(self, text: str, refusal: str) -> dict[str, Any]:
        part = {"type": "output_text", "text": text, "annotations": [], "logprobs": []}
        content = {"type": "refusal", "refusal": refusal} if refusal else part
        return {
            "id": self._item,
            "type": "message",
            "role": "assistant",
            "status": "completed",
            "content": [content],
        }

    def _response(self, status: str, counted: Counted | None = None) -> dict[str, Any]:
        body: dict[str, Any] = {
            "id": self._id, "object": "response", "created_at": int(time.time()), "model": self._model,
            "status": status, "output": self._output, "parallel_tool_calls": True, "tool_choice": "auto",
            "tools": [], "error": None, "usage": None,
            "incomplete_details": {"reason": "max_output_tokens"} if status == "incomplete" else None,
        }  # fmt: skip
        if self._conversation:
            body["conversation"] = {"id": self._conversation}
        if counted is not None:
            body["usage"] = {
                "input_tokens": counted.prompt,
                "input_tokens_details": {"cached_tokens": counted.cached},
                "output_tokens": counted.reply,
                "output_tokens_details": {"reasoning_tokens": 0},
                "total_tokens": counted.prompt + counted.reply,
            }
        return body

    def _event(self, kind: str, **values: Any) -> bytes:
        self._number += 1
        return sse({"type": kind, "sequence_number": self._number, **values}, event=kind)


def _function(call: ToolCall) -> dict[str, Any]:
    return {
        "type": "function_call", "id": new_id("fc"), "call_id": new_id("call"), "name": call.name,
        "arguments": call.arguments, "status": "completed",
    }  # fmt: skip
