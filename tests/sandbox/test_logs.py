"""Output is kept whole up to a limit, and harmless to show."""

from __future__ import annotations

import os

from chatrobot.sandbox.process import LogDrain


def drained(written: list[bytes], limit_bytes: int = 1000) -> LogDrain:
    reading, writing = os.pipe()
    drain = LogDrain(reading, limit_bytes)
    drain.start()
    for each in written:
        os.write(writing, each)
    os.close(writing)
    drain.finish(5.0)
    return drain


def test_what_is_taken_is_gone() -> None:
    drain = drained([b"one\n", b"two\n"])
    assert drain.take() == "one\ntwo\n"
    assert drain.take() == ""


def test_what_is_too_much_is_counted() -> None:
    assert drained([b"x" * 1500]).take() == "x" * 1000 + "\n[… 500 bytes more]\n"


def test_a_character_in_two_parts_is_one() -> None:
    reading, writing = os.pipe()
    drain = LogDrain(reading, 1000)
    drain._kept += "a中".encode()[:3]
    assert drain.take() == "a"
    drain._kept += "中".encode()[2:]
    assert drain.take() == "中"
    os.close(writing)
    drain.close()


def test_bytes_that_are_no_text_are_replaced() -> None:
    assert drained([b"a\xffb"]).take() == "a\ufffdb"


def test_a_terminal_has_nothing_to_obey() -> None:
    said = "\x1b]52;c;x\x07\x1b[2J\x9b31m\r\u202eabc\u2066\n\t"
    assert drained([said.encode()]).take() == "]52;c;x[2J31mabc\n\t"
