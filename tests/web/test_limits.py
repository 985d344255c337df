"""Frames that are none, too many of them, readers that do not read: whoever sends them loses, and nobody else."""

from __future__ import annotations

import contextlib
import json
import socket
import time
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from chatrobot.core.events import Interpreted, Result, Telemetry
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.web import limits
from chatrobot.web.limits import Rate
from chatrobot.web.protocol import FIELDS, MalformedError, read_message
from tests.processes import wait_until
from tests.web.rig import Client, WebRig

TELEMETRY = Telemetry(0, ORIGIN, Twist(), 0.0)


def close_code(client: Client) -> int:
    """Read until the server closes; why."""
    try:
        while True:
            client.socket.recv(5.0)
    except ConnectionClosed as error:
        return error.rcvd.code if error.rcvd is not None else 0


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "null", "{}", '{"do":7}', '{"do":"fly"}', '{"do":{}}', "{" * 5000, '{"do":"say"}',
        '{"do":"say","text":7}', '{"do":"say","text":"a","by":"teacher"}', '{"do":"approve","turn":1.5,"yes":true}',
        '{"do":"approve","turn":1,"yes":1}', '{"do":"approve","turn":true,"yes":true}',
        '{"do":"steer","vx_mps":NaN,"vy_mps":0,"wz_radps":0}', '{"do":"steer","vx_mps":1e400,"vy_mps":0,"wz_radps":0}',
        '{"do":"steer","vx_mps":"1","vy_mps":0,"wz_radps":0}', '{"do":"go","x_m":1e9,"y_m":0}',
        '{"do":"go","x_m":1,"y_m":0,"place":"a\\nstop"}',
        '{"do":"language","code":"fr"}', '{"do":"say","text":"' + "x" * 5000 + '"}',
    ],
)  # fmt: skip
def test_what_is_no_message_is_not_done_not_even_in_part(text: str) -> None:
    with pytest.raises(MalformedError):
        read_message(text)


def test_every_message_with_its_fields_is_read() -> None:
    samples: dict[str, Any] = {
        "text": "hi", "plan_text": "drive 1 m", "turn": 1, "yes": True, "x_m": 1, "y_m": 2.5, "vx_mps": 0.1,
        "vy_mps": 0, "wz_radps": -1, "name": "square", "source": "pass", "code": "zh", "held": False, "ask": True,
        "yaw_rad": None, "radius_m": 0.2, "place": "desk",
    }  # fmt: skip
    for do, fields in FIELDS.items():
        message = {"do": do, **{name.rstrip("?"): samples[name.rstrip("?")] for name in fields}}
        assert read_message(json.dumps(message)) == message


def test_malformed_messages_are_told_and_too_many_end_it(rig: WebRig) -> None:
    page = rig.page()
    page.socket.send("{")
    assert page.wait_for("refused")["why"] == "malformed"
    page.say("stop")
    rig.session.wait_for("stop", "the Stop button")
    for _ in range(20):
        with contextlib.suppress(ConnectionClosed):
            page.socket.send('{"do":"fly"}')
    assert close_code(page) == 1008


def test_bytes_and_oversized_messages_end_it(rig: WebRig) -> None:
    page = rig.page(beats=False)
    page.socket.send(b"\x00\x01")
    assert close_code(page) == 1003
    page = rig.page(beats=False)
    page.socket.send(json.dumps({"do": "say", "text": "x" * 70_000}))
    assert close_code(page) == 1009
    line = rig.stop_line()
    line.socket.send(b"\x00")
    assert close_code(line) == 1003
    line = rig.stop_line()
    line.socket.send("x" * 70_000)
    assert close_code(line) == 1009
    assert rig.page().heard[0]["is"] == "hello", "the next one is served"


def test_too_many_messages_end_it_and_beats_are_counted_apart(rig: WebRig) -> None:
    page = rig.page(beats=False)
    for _ in range(50):
        page.say("beat")
        page.say("steer", vx_mps=0.1, vy_mps=0.0, wz_radps=0.0)
        page.say("language", code="en")
    page.say("history")
    page.wait_for("history")
    with contextlib.suppress(ConnectionClosed):
        for _ in range(20):
            page.say("history")
    assert close_code(page) == 1008


def test_a_flood_of_stops_is_a_stop(rig: WebRig) -> None:
    page = rig.page(beats=False)
    with contextlib.suppress(ConnectionClosed):
        for _ in range(200):
            page.say("stop")
    wait_until(lambda: len(rig.session.log) == 200)


def test_a_rate_refills() -> None:
    now = [0.0]
    rate = Rate(lambda: now[0])
    assert sum(rate.allows() for _ in range(100)) == 60
    now[0] = 10.0
    assert sum(rate.allows() for _ in range(100)) == 60


def unread(rig: WebRig) -> socket.socket:
    """A page that is let in and reads nothing."""
    line = socket.create_connection(("127.0.0.1", rig.access.port), 5.0)
    line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    line.sendall(
        f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{rig.access.port}\r\nOrigin: {rig.origin}\r\n"
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
    )
    return line


def test_a_reader_that_is_slow_loses_telemetry_and_holds_up_nobody(rig: WebRig) -> None:
    page = rig.page()
    slow = unread(rig)
    wait_until(lambda: len(rig.room._faces) == 2)
    big = Interpreted(1, "offline", "x" * 50_000, "")
    began_s = time.monotonic()
    for _ in range(30):
        rig.tell(big)  # fills every buffer on the way
    for _ in range(1000):
        rig.tell(TELEMETRY)
    assert time.monotonic() - began_s < 2.0, "whoever tells does not wait"
    rig.tell(Result(1, "completed", "Done."))
    page.wait_for_event("result")
    waiting = [face.outbox._waiting for face in rig.room._faces.values() if face.outbox._waiting]  # type: ignore[attr-defined]
    assert all(len(one) <= 60 for one in waiting)
    slow.close()


def test_a_reader_that_never_reads_is_let_go(rig: WebRig) -> None:
    page = rig.page()
    slow = unread(rig)
    wait_until(lambda: len(rig.room._faces) == 2)
    for number in range(1000):
        rig.tell(Interpreted(number, "offline", "x" * (60_000 if number < 100 else 10), ""))
        page.wait_for_event("interpreted")
    wait_until(lambda: len(rig.room._faces) == 1)
    rig.tell(Result(1, "completed", "Done."))
    page.wait_for_event("result")
    slow.close()


def test_a_hundred_slow_clients_keep_nobody_out(rig: WebRig, monkeypatch: pytest.MonkeyPatch) -> None:
    """They connect, begin a request and never end it; the page that is in goes on, and so does its stop."""
    monkeypatch.setattr(limits, "FIRST_REQUEST_S", 1.0)
    page, line = rig.page(), rig.stop_line()
    slow = []
    for port in (rig.access.port, rig.access.stop_port):
        for _ in range(100):
            one = socket.create_connection(("127.0.0.1", port), 5.0)
            one.sendall(b"GET / HTTP/1.1\r\nHost: 127")
            slow.append(one)
    page.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    line.say("stop")
    line.wait_for("stopped", timeout_s=1.0)
    wait_until(lambda: can_connect(rig), 8.0)
    for one in slow:
        one.close()


def can_connect(rig: WebRig) -> bool:
    """Somebody else is let in, once those who ask for nothing have been given up."""
    try:
        return rig.http(timeout=0.5).get("/").status_code == 200
    except httpx.TransportError:
        return False
