"""Messages survive being bytes, and bytes that are no message never do harm."""

from __future__ import annotations

import json
import math
from typing import get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.wire.codec import decode, encode, topic_of
from chatrobot.wire.messages import MESSAGE_TYPES, LaserScan, Message, Number, TwistMessage

NUMBERS = st.floats(allow_nan=False)
FIELDS: dict[object, st.SearchStrategy[object]] = {
    float: NUMBERS,
    list[float]: st.lists(NUMBERS, max_size=20),
    str: st.text(),
    bool: st.booleans(),
    int: st.integers(),
    bytes: st.binary(max_size=20),
}
TOPICS = st.text(st.characters(codec="utf-8", exclude_characters="\0"))


@st.composite
def messages(draw: st.DrawFn) -> Message:
    kind = draw(st.sampled_from(MESSAGE_TYPES))
    return kind(*[draw(FIELDS[hint]) for hint in get_type_hints(kind).values()])


@given(TOPICS, messages())
def test_a_message_comes_back_as_it_was(topic: str, message: Message) -> None:
    packet = encode(topic, message)
    assert topic_of(packet) == topic
    back = decode(packet)
    assert back == message
    assert type(back) is type(message)


def test_what_is_not_a_number_comes_back_as_that() -> None:
    back = decode(encode("topic", Number(math.nan)))
    assert isinstance(back, Number)
    assert math.isnan(back.data)


@given(st.binary())
def test_any_bytes_are_decoded_to_a_message_or_to_nothing(packet: bytes) -> None:
    topic_of(packet)
    assert decode(packet) is None or type(decode(packet)) in MESSAGE_TYPES


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=8) | st.dictionaries(st.text(), inner, max_size=8),
)


@given(st.sampled_from(MESSAGE_TYPES), JSON)
def test_what_is_decoded_has_the_types_its_fields_declare(kind: type[Message], body: object) -> None:
    message = decode(f"topic\0{kind.__name__}\0{json.dumps(body)}".encode())
    if message is None:
        return
    for value, hint in zip(message, get_type_hints(kind).values()):
        if hint == list[float]:
            assert isinstance(value, list)
            assert all(type(item) is float for item in value)
        else:
            assert type(value) is hint


@given(messages(), st.data())
def test_a_message_with_a_broken_byte_does_no_harm(message: Message, data: st.DataObject) -> None:
    packet = bytearray(encode("topic", message))
    at = data.draw(st.integers(0, len(packet) - 1))
    packet[at] = data.draw(st.integers(0, 255))
    back = decode(bytes(packet))
    assert back is None or type(back) in MESSAGE_TYPES


def test_whole_numbers_become_floats() -> None:
    back = decode(b"cmd_vel\0TwistMessage\0[1,0,-2]")
    assert back == TwistMessage(1.0, 0.0, -2.0)
    assert back is not None
    assert {type(value) for value in back} == {float}


@pytest.mark.parametrize("message", [TwistMessage(0.1, 0.0, 0.0), LaserScan(0.0, 0.0, 0.1, 0.1, 8.0, [1.0])])
def test_numbers_that_are_cut_off_or_go_on_are_nothing(message: Message) -> None:
    packet = encode("topic", message)
    assert decode(packet) == message
    assert decode(packet[:-1]) is None
    assert decode(packet + b"\0") is None


@pytest.mark.parametrize("size", [1, 10_000])
def test_nesting_without_end_is_nothing(size: int) -> None:
    assert decode(b"topic\0Text\0" + b"[" * size) is None
