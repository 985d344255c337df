"""The other protocols of providers from the server's side, and a scripted server that speaks them all.

OpenAI's Responses with conversations that the server holds, Anthropic's Messages, Google's generateContent.
"""

from __future__ import annotations

import json
import re
import threading
import time
from typing import Any, ClassVar, cast
from urllib.parse import parse_qs, urlsplit

from chatrobot.models.fake.chat import Asked, Chat, Counted, new_id, read_asked, sse
from chatrobot.models.fake.script import Answer, HttpError, Script, ToolCall
from chatrobot.models.fake.server import Call, FakeModel, Handler

Turns = tuple[tuple[str, str], ...]


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

    def drop(self) -> None:
        """Forget everything, as servers do after some weeks."""
        with self._lock:
            self._turns.clear()

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


class Responses(Chat):
    """OpenAI's Responses, with conversations that the server holds: POST …/responses."""

    prefix = "resp"

    def __init__(self, body: dict[str, Any], path: str, held: Conversations) -> None:
        self._held = held
        self._item = new_id("msg")
        self._text = ""
        self._tools: list[dict[str, Any]] = []
        self._number = -1
        super().__init__(body, path)

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


class Messages(Chat):
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

    def refuse(self, text: str) -> bytes:
        return self.token(text)

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


class Generate(Chat):
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

    def start(self) -> bytes:
        return b""

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


class AllWires(Handler):
    """Serves every protocol, and the conversations of Responses."""

    wires: ClassVar[dict[str, type[Chat]]] = {
        **Handler.wires,
        "/responses": Responses,
        "/messages": Messages,
        ":generateContent": Generate,
        ":streamGenerateContent": Generate,
    }

    def do_POST(self) -> None:  # noqa: N802
        if urlsplit(self.path).path.endswith("/conversations") and self._may():
            self._read_body()
            self._json(200, {"id": self._held.begin(), "object": "conversation"})
        else:
            super().do_POST()

    def _answer(self, kind: type[Chat], call: Call) -> None:
        try:
            super()._answer(kind, call)
        except UnknownConversationError as error:
            message = f"Previous response with id '{error}' not found."
            self._json(400, kind.error(HttpError(400, message, "previous_response_not_found")))

    def _open(self, kind: type[Chat], call: Call) -> Chat:
        return Responses(call.body, self.path, self._held) if kind is Responses else super()._open(kind, call)

    def _key(self) -> str:
        given = super()._key() or self.headers.get("x-api-key") or self.headers.get("x-goog-api-key")
        return given or next(iter(parse_qs(urlsplit(self.path).query).get("key", [])), "")

    @property
    def _held(self) -> Conversations:
        return cast(FakeProvider, self.server.fake).conversations


class FakeProvider(FakeModel):
    """A `FakeModel` in the form of any provider."""

    handler = AllWires

    def __init__(self, script: Script) -> None:
        super().__init__(script)
        self.conversations = Conversations()
