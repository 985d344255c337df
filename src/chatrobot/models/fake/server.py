"""The fake model as an HTTP server: loopback and free of charge.

Tests use it as `with FakeModel(script) as fake: … fake.url …`; `fake.calls` tells what was asked and when.
"""

from __future__ import annotations

import hmac
import json
import select
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any
from urllib.parse import parse_qs, urlsplit

from chatrobot.models.fake.anthropic import AnthropicMessages
from chatrobot.models.fake.google import GoogleGenerate
from chatrobot.models.fake.openai_chat import OpenAIChat
from chatrobot.models.fake.openai_responses import Conversations, OpenAIResponses, UnknownConversationError
from chatrobot.models.fake.script import Answer, HttpError, Script
from chatrobot.models.fake.wires import Asked, Whole, WireFormat, count

BODY_BYTES = 32_000_000


@dataclass
class Call:
    """One request as it came, and what became of it. Times are `time.monotonic()`."""

    path: str
    headers: dict[str, str]
    body: dict[str, Any]
    at_s: float
    asked: Asked | None = None
    sent_s: list[float] = field(default_factory=list)
    """When each token left."""
    gone_s: float | None = None
    """When the client hung up before the end."""


class FakeModel:
    """The server. It listens once it has been entered (or `start`ed) and ends with every connection on leaving."""

    def __init__(
        self,
        script: Script,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        on_call: Callable[[Call], None] = lambda _: None,
    ) -> None:
        self.script = script
        self.calls: list[Call] = []
        self.conversations = Conversations()
        self.closing = threading.Event()
        self.on_call = on_call
        self._place = (host, port)
        self._server: _Server | None = None

    @property
    def url(self) -> str:
        """`http://HOST:PORT`, without a path."""
        assert self._server is not None
        host, port = self._server.server_address[:2]
        return f"http://{host!s}:{port}"

    def start(self) -> None:
        """Listen, and serve in threads of its own.

        Raises:
            OSError: the port is taken.
        """
        self._server = _Server(self._place, self)
        threading.Thread(
            target=self._server.serve_forever, args=(0.05,), name="fake-model", daemon=True
        ).start()

    def stop(self) -> None:
        """End it and every call under way."""
        assert self._server is not None
        self.closing.set()
        self._server.shutdown()
        self._server.server_close()

    def __enter__(self) -> FakeModel:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False

    def __init__(self, place: tuple[str, int], fake: FakeModel) -> None:
        self.fake = fake
        super().__init__(place, _Handler)


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    server: _Server

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: a header in a log is a key in a log."""

    def do_GET(self) -> None:
        path = urlsplit(self.path).path.rstrip("/")
        models = self.server.fake.script.models
        if path.endswith("/api/tags"):
            self._json(200, {"models": [{"name": name, "model": name, "details": {}} for name in models]})
        elif path.endswith("/api/version"):
            self._json(200, {"version": "0.0.0-fake"})
        elif path.endswith("/models"):
            rows = [
                {"id": name, "object": "model", "created": 0, "owned_by": "fake-model"} for name in models
            ]
            self._json(200, {"object": "list", "data": rows})
        elif path in ("", "/health"):
            self._json(200, {"status": "ok"})
        else:
            self._json(404, {"error": {"message": f"nothing at {path}"}})

    def do_POST(self) -> None:
        path = urlsplit(self.path).path.rstrip("/")
        body = self._read_body()
        if body is None:
            self._json(400, {"error": {"message": "the body is no JSON object"}})
            return
        fake = self.server.fake
        wire = self._wire(path)
        call = Call(
            self.path, {name.lower(): value for name, value in self.headers.items()}, body, time.monotonic()
        )
        if wire is None and not path.endswith("/conversations"):
            self._json(404, {"error": {"message": f"nothing at {path}"}})
        elif not self._may():
            error = HttpError(401, f"Incorrect API key provided: {self._key()}", "invalid_api_key")
            self._json(401, (wire or OpenAIChat()).error(error))
        elif wire is None:
            self._json(200, {"id": fake.conversations.begin(), "object": "conversation"})
        else:
            fake.calls.append(call)
            self._answer(wire, call)

    def _answer(self, wire: WireFormat, call: Call) -> None:
        script = self.server.fake.script
        try:
            asked = call.asked = wire.read(call.body, self.path)
        except UnknownConversationError as error:
            message = f"Previous response with id '{error}' not found."
            self._json(400, wire.error(HttpError(400, message, "previous_response_not_found")))
            return
        self.server.fake.on_call(call)
        if asked.model not in script.models:
            message = f"The model `{asked.model}` does not exist"
            self._json(404, wire.error(HttpError(404, message, "model_not_found")))
            return
        answer = script.answer(asked.said)
        if not self._wait(answer.first_piece_s, call):
            return
        if answer.error is not None:
            self._error(wire, answer.error)
        elif answer.raw is not None:
            self._send(200, answer.raw.encode(), answer.content_type)
        elif asked.stream:
            self._stream(wire, asked, answer, call)
        else:
            self._whole(wire, asked, answer, call)

    def _error(self, wire: WireFormat, error: HttpError) -> None:
        headers = {"Retry-After": f"{error.retry_after_s:g}"} if error.retry_after_s is not None else {}
        if error.body is not None:
            self._send(error.status, error.body.encode(), "text/html", headers)
        else:
            self._json(error.status, wire.error(error), headers)

    def _whole(self, wire: WireFormat, asked: Asked, answer: Answer, call: Call) -> None:
        tokens = answer.tokens(asked.said)
        if answer.hang_after is not None:
            self._wait(float("inf"), call)
            return
        if answer.tokens_per_s and not self._wait(len(tokens) / answer.tokens_per_s, call):
            return
        reply = Whole(
            "".join(tokens), answer.tool_calls, answer.refusal, answer.reason, count(asked, answer, tokens)
        )
        self._json(200, wire.whole(asked, reply))
        call.sent_s.append(time.monotonic())

    def _stream(self, wire: WireFormat, asked: Asked, answer: Answer, call: Call) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()
        try:
            tokens = self._stream_tokens(wire, asked, answer, call)
            if tokens is None:
                self.close_connection = (
                    True  # without the last chunk: the other side sees that it was cut off
                )
                return
            end = b"".join(wire.tool(index, tool) for index, tool in enumerate(answer.tool_calls))
            end += wire.refuse(answer.refusal) if answer.refusal else b""
            self._chunk(end + wire.finish(answer.reason, count(asked, answer, tokens)))
            self.wfile.write(b"0\r\n\r\n")
        except OSError:
            call.gone_s = time.monotonic()
            self.close_connection = True

    def _stream_tokens(self, wire: WireFormat, asked: Asked, answer: Answer, call: Call) -> list[str] | None:
        """Send the text; None where the reply ends before its end."""
        self._chunk(wire.start(asked))
        begun_s = time.monotonic()
        sent: list[str] = []
        for token in answer.tokens(asked.said):
            if answer.hang_after == len(sent):
                self._wait(float("inf"), call)
                return None
            if answer.cut_off_after == len(sent):
                return None
            due_s = begun_s + len(sent) / answer.tokens_per_s if answer.tokens_per_s else begun_s
            if not self._wait(due_s - time.monotonic(), call):
                return None
            self._chunk(wire.token(token))
            call.sent_s.append(time.monotonic())
            sent.append(token)
        if answer.hang_after is not None:
            self._wait(float("inf"), call)
        return None if answer.hang_after is not None or answer.cut_off_after is not None else sent

    def _wait(self, duration_s: float, call: Call) -> bool:
        """Wait; False where the client hung up, or the server ends, meanwhile."""
        ends_s = time.monotonic() + duration_s
        while (left_s := ends_s - time.monotonic()) > 0:
            if self.server.fake.closing.is_set():
                self.close_connection = True
                return False
            if select.select([self.connection], [], [], min(left_s, 0.2))[0] and self._has_gone():
                call.gone_s = time.monotonic()
                self.close_connection = True
                return False
        return True

    def _has_gone(self) -> bool:
        try:
            return not self.connection.recv(1, socket.MSG_PEEK)
        except OSError:
            return True

    def _chunk(self, data: bytes) -> None:
        if data:
            self.wfile.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")

    def _json(self, status: int, body: dict[str, Any], headers: dict[str, str] | None = None) -> None:
        self._send(status, json.dumps(body, ensure_ascii=False).encode(), "application/json", headers)

    def _send(self, status: int, data: bytes, kind: str, headers: dict[str, str] | None = None) -> None:
        try:
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(data)))
            for name, value in (headers or {}).items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(data)
        except OSError:
            self.close_connection = True

    def _read_body(self) -> dict[str, Any] | None:
        try:
            length = int(self.headers.get("Content-Length", "0"))
            body = json.loads(self.rfile.read(min(max(length, 0), BODY_BYTES)) or b"{}")
        except ValueError:
            return None
        return body if isinstance(body, dict) else None

    def _wire(self, path: str) -> WireFormat | None:
        if path.endswith("/chat/completions"):
            return OpenAIChat()
        if path.endswith("/responses"):
            return OpenAIResponses(self.server.fake.conversations)
        if path.endswith("/messages"):
            return AnthropicMessages()
        return GoogleGenerate() if path.endswith((":generateContent", ":streamGenerateContent")) else None

    def _key(self) -> str:
        bearer = self.headers.get("Authorization", "").removeprefix("Bearer ")
        given = bearer or self.headers.get("x-api-key") or self.headers.get("x-goog-api-key")
        return given or next(iter(parse_qs(urlsplit(self.path).query).get("key", [])), "")

    def _may(self) -> bool:
        keys = self.server.fake.script.keys
        return not keys or any(hmac.compare_digest(self._key().encode(), key.encode()) for key in keys)
