"""What reaches Motion is an envelope or nothing."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.link.envelope import Envelope


def test_an_envelope_survives_its_bytes() -> None:
    envelope = Envelope("plan", "console", "abc", 7, 2, {"plan_text": "drive 1 m", "mode": "queue"})
    assert Envelope.from_bytes(envelope.to_bytes()) == envelope


@given(st.binary(max_size=200))
def test_garbage_is_dropped_and_never_raises(packet: bytes) -> None:
    assert Envelope.from_bytes(packet) is None


@pytest.mark.parametrize(
    "packet",
    [
        b'{"word":"fly","source":"x","lease":"y","sequence":1}',
        b'{"word":"plan","source":"x","lease":"y","sequence":"1"}',
        b'{"word":"plan","source":"x","lease":"y","sequence":1,"payload":[]}',
        b'{"word":"plan","source":"x","lease":"y","sequence":1,"extra":1}',
        b'{"word":"stop","word":"plan","source":"x","lease":"y","sequence":1}',
        b'{"word":"plan","source":"agent","source":"console","lease":"y","sequence":1}',
        b'{"word":"plan","source":"x","lease":"y","sequence":1,"payload":{"approve":true,"approve":false}}',
        b"[]",
        b"null",
    ],
)
def test_a_malformed_envelope_is_dropped(packet: bytes) -> None:
    assert Envelope.from_bytes(packet) is None


def test_a_stop_that_says_something_twice_is_a_stop() -> None:
    packet = b'{"word":"stop","source":"x","lease":"y","sequence":1,"turn":1,"turn":2}'
    envelope = Envelope.from_bytes(packet)
    assert envelope is not None
    assert envelope.word == "stop"
