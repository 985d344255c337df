"""Lines come as they are typed; a list that is pasted with its heading is one text."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from chatrobot.cli import lines
from chatrobot.cli.lines import LineReader


@pytest.fixture
def pipe(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    reads, writes = os.pipe()
    monkeypatch.setattr(lines, "STDIN", reads)
    yield writes
    os.close(reads)


def heard(pipe: int, *chunks: str) -> list[str]:
    texts: list[str] = []
    for chunk in chunks:
        os.write(pipe, chunk.encode())
    os.close(pipe)
    reader = LineReader(texts.append)
    reader.start()
    reader.wait(10.0)
    assert reader.has_ended
    return texts


def test_every_line_is_a_text(pipe: int) -> None:
    assert heard(pipe, "forward 1 m\n\n  turn left\nstop") == ["forward 1 m", "turn left", "stop"]


def test_a_heading_and_its_list_are_one_text(pipe: int) -> None:
    said = "Do as follows:\n\n1, forward 1 m\n\n2. turn left;\n- and rest\nforward 2 m\n"
    assert heard(pipe, said) == ["Do as follows:\n1, forward 1 m\n2. turn left;\n- and rest", "forward 2 m"]


def test_a_list_without_a_heading_is_line_by_line(pipe: int) -> None:
    assert heard(pipe, "1. forward 1 m\n2. turn left\n") == ["1. forward 1 m", "2. turn left"]


def test_a_stop_after_a_heading_is_a_stop(pipe: int) -> None:
    assert heard(pipe, "Do this:\nstop\n") == ["Do this:", "stop"]


def test_a_heading_alone_is_handed_on_when_nothing_follows(pipe: int) -> None:
    texts: list[str] = []
    os.write(pipe, "看这里：\n".encode())
    reader = LineReader(texts.append)
    reader.start()
    while not texts:
        reader.wait(0.01)
    assert texts == ["看这里："]
    os.close(pipe)
    reader.wait(10.0)
