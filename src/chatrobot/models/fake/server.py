"""Serves a script over HTTP: loopback and free of charge.

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
from typing import Any
from urllib.parse import parse_qs, urlsplit

from chatrobot.models.fake import openai, others
from chatrobot.models.fake.script import Answer, HttpError, Script
from chatrobot.models.fake.wires import Asked, Conversations, Counted, UnknownConversationError, Wire

BODY_BYTES = 32_000_000
CHARS_PER_TOKEN = 4
_WIRES = {**openai.WIRES, **others.WIRES}
_CONVERSATIONS = "/conversations"


@dataclass
class Call:
    """One request as it came, and what became of it. Times are `time.monotonic()`."""

    path: str
    headers: dict[str, str]
    body: dict[str, Any]
    asked: Asked | None = None
    sent_s: list[float] = field(default_factory=list)
    """When each token left."""
    gone_s: float | None = None
    """When the client hung up before the end."""


class FakeModel:
    """Server that listens once it has been entered (or `start`ed), and ends with every connection on leaving."""

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
        """End the server and every call under way."""
        assert self._server is not None
        self.closing.set()
        self._server.shutdown()
        self._server.server_close()

    def __enter__(self) -> FakeModel:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
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
        """Log nothing: a header in a log is a key in a log."""

    def do_GET(self) -> None:
        """List the models, as OpenAI and Ollama do."""
        path = urlsplit(self.path).path.rstrip("/")
        models = self.server.fake.script.models
        rows = [{"id": name, "object": "model", "created": 0, "owned_by": "fake-model"} for name in models]
        if path.endswith("/api/tags"):
            self._json(200, {"models": [{"name": name, "model": name, "details": {}} for name in models]})
        elif path.endswith("/api/version"):
            self._json(200, {"version": "0.0.0-fake"})
        elif path.endswith("/models"):
            self._json(200, {"object": "list", "data": rows})
        elif path in ("", "/health"):
            self._json(200, {"status": "ok"})
        else:
            self._json(404, {"error": {"message": f"nothing at {path}"}})

    def do_POST(self) -> None:
        """Answer a call with what the script says."""
        fake, path, body = self.server.fake, urlsplit(self.path).path.rstrip("/"), self._read_body()
        wire = next((wire for end, wire in _WIRES.items() if path.endswith(end)), None)
        if body is None:
            self._json(400, {"error": {"message": "the body is no JSON object"}})
        elif wire is None and not path.endswith(_CONVERSATIONS):
            self._json(404, {"error": {"message": f"nothing at {path}"}})
        elif not self._may():
            error = HttpError(401, f"Incorrect API key provided: {self._key()}", "invalid_api_key")
            self._json(401, (wire or Wire).error(error))
        elif wire is None:
            self._json(200, {"id": fake.conversations.begin(), "object": "conversation"})
        else:
            headers = {name.lower(): value for name, value in self.headers.items()}
            call = Call(self.path, headers, body)
            fake.calls.append(call)
            self._answer(wire, call)

    def _answer(self, kind: type[Wire], call: Call) -> None:
        fake = self.server.fake
        try:
            wire = kind(call.body, self.path, fake.conversations)
        except UnknownConversationError as error:
            message = f"Previous response with id '{error}' not found."
            self._json(400, kind.error(HttpError(400, message, "previous_response_not_found")))
            return
        asked = call.asked = wire.asked
        fake.on_call(call)
        if asked.model not in fake.script.models:
            message = f"The model `{asked.model}` does not exist"
            self._json(404, wire.error(HttpError(404, message, "model_not_found")))
            return
        answer = fake.script.answer(asked.said)
        if not self._wait(answer.first_piece_s, call):
            return
        if answer.error is not None:
            self._error(wire, answer.error)
        elif answer.raw is not None:
            self._send(200, answer.raw.encode(), answer.content_type)
        elif asked.stream:
            self._stream(wire, answer, call)
        else:
            self._whole(wire, answer, call)

    def _error(self, wire: Wire, error: HttpError) -> None:
        headers = {"Retry-After": f"{error.retry_after_s:g}"} if error.retry_after_s is not None else {}
        if error.body is not None:
            self._send(error.status, error.body.encode(), "text/html", headers)
        else:
            self._json(error.status, wire.error(error), headers)

    def _whole(self, wire: Wire, answer: Answer, call: Call) -> None:
        tokens = answer.tokens(wire.asked.said)
        waits_s = len(tokens) / answer.tokens_per_s if answer.tokens_per_s else 0.0
        if self._wait(waits_s if answer.hang_after is None else float("inf"), call):
            self._json(200, wire.whole("".join(tokens), answer, _count(wire.asked, answer, tokens)))
            call.sent_s.append(time.monotonic())

    def _stream(self, wire: Wire, answer: Answer, call: Call) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()
        try:
            tokens = self._stream_tokens(wire, answer, call)
            if tokens is None:  # without the last chunk: the other side sees that it was cut off
                self.close_connection = True
                return
            end = b"".join(wire.tool(index, tool) for index, tool in enumerate(answer.tool_calls))
            end += wire.refuse(answer.refusal) if answer.refusal else b""
            self._chunk(end + wire.finish(answer.reason, _count(wire.asked, answer, tokens)))
            self.wfile.write(b"0\r\n\r\n")
        except OSError:
            call.gone_s = time.monotonic()
            self.close_connection = True

    def _stream_tokens(self, wire: Wire, answer: Answer, call: Call) -> list[str] | None:
        """Send the text; None where the reply ends before its end."""
        self._chunk(wire.start())
        begun_s = time.monotonic()
        tokens = answer.tokens(wire.asked.said)
        ends = [after for after in (answer.hang_after, answer.cut_off_after) if after is not None]
        for number, token in enumerate(tokens[: min(ends, default=len(tokens))]):
            due_s = begun_s + number / answer.tokens_per_s if answer.tokens_per_s else begun_s
            if not self._wait(due_s - time.monotonic(), call):
                return None
            self._chunk(wire.token(token))
            call.sent_s.append(time.monotonic())
        if answer.hang_after is not None and answer.hang_after == min(ends):
            self._wait(float("inf"), call)
        if ends:
            return None
        return tokens

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

    def _key(self) -> str:
        bearer = self.headers.get("Authorization", "").removeprefix("Bearer ")
        given = bearer or self.headers.get("x-api-key") or self.headers.get("x-goog-api-key")
        return given or next(iter(parse_qs(urlsplit(self.path).query).get("key", [])), "")

    def _may(self) -> bool:
        keys = self.server.fake.script.keys
        return not keys or any(hmac.compare_digest(self._key().encode(), key.encode()) for key in keys)


def _count(asked: Asked, answer: Answer, tokens: list[str]) -> Counted | None:
    """Count prompt tokens as the script says, or one for four characters; None where nothing is to be counted."""
    if answer.uncounted:
        return None
    chars = sum(len(text) for _, text in asked.turns)
    prompt = answer.prompt_tokens if answer.prompt_tokens is not None else -(-chars // CHARS_PER_TOKEN)
    return Counted(prompt, min(answer.cached_tokens, prompt), len(tokens))
