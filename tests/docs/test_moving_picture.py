"""The moving picture of the README plays in an <img>, where a code host shows it, and says what the program says."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import pytest
from scripts.moving_picture import FILE, FRAME_S, HOLD_S, SAID, Run, draw

from tests.cli.running import Command, chatrobot

__all__ = ["chatrobot"]
SVG = "{http://www.w3.org/2000/svg}"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
INK, PAPER = (214, 219, 227), (24, 27, 33)


def test_it_is_small_and_needs_nothing_but_itself() -> None:
    assert FILE.stat().st_size < 1_500_000
    text = FILE.read_text(encoding="utf-8")
    assert not re.search(r"<script|href|<foreignObject|url\(|@import", text)
    assert len(ElementTree.fromstring(text).findall(f".//{SVG}animate")) > 50


def test_every_row_is_timed_as_svg_wants_it() -> None:
    root = ElementTree.fromstring(FILE.read_text(encoding="utf-8"))
    for animate in root.iter(f"{SVG}animate"):
        times = [float(at) for at in animate.attrib["keyTimes"].split(";")]
        assert len(times) == len(animate.attrib["values"].split(";"))
        assert times[0] == 0.0
        assert times == sorted(times)
        assert times[-1] < 1.0


def test_a_row_shows_in_its_frames_and_the_last_one_where_nothing_moves() -> None:
    first, last = ((Run(0, 5, word, INK, PAPER, False),) for word in ("first", "later"))
    root = ElementTree.fromstring(draw([[first], [last]]))
    shown = {"".join(group.itertext()).strip(): group for group in root.iter(f"{SVG}g")}
    assert {word: group.attrib["visibility"] for word, group in shown.items()} == {
        "first": "hidden",
        "later": "visible",
    }
    animate = shown["later"].find(f"{SVG}animate")
    assert animate is not None
    assert animate.attrib["values"] == "hidden;visible"
    assert float(animate.attrib["keyTimes"].split(";")[1]) == pytest.approx(
        FRAME_S / (2 * FRAME_S + HOLD_S), abs=1e-4
    )


def test_it_says_what_the_program_says_today(chatrobot: Command) -> None:
    text = "\n".join(ElementTree.fromstring(FILE.read_text(encoding="utf-8")).itertext())
    done = chatrobot("do", *SAID, "--fast", "--json")
    for result in done.named("result")[:1]:
        assert NUMBER.sub("#", result["reply"]) in NUMBER.sub("#", text), "make pictures"
    assert done.code == 0
