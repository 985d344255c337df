"""The files of the page: every language whole, nothing from outside, small, nothing that a strict policy refuses."""

from __future__ import annotations

import json
import re
from importlib import resources
from pathlib import Path

import pytest

from chatrobot.language.data_files import REPLY_LANGUAGES

PAGE = Path(str(resources.files("chatrobot.web") / "page"))
FILES = sorted(PAGE.iterdir())
CODE = [file for file in FILES if file.suffix in (".js", ".html")]
MOST_BYTES = 200_000
NAMESPACE = "http://www.w3.org/2000/svg"


def words(code: str) -> dict[str, str]:
    found: dict[str, str] = json.loads((PAGE / f"words.{code}.json").read_text("utf-8"))
    return found


def gaps(code: str) -> dict[str, list[str]]:
    return {key: sorted(re.findall(r"\{\w+\}", text)) for key, text in words(code).items()}


@pytest.mark.parametrize("code", REPLY_LANGUAGES)
def test_every_language_has_the_same_words_with_the_same_gaps(code: str) -> None:
    assert gaps(code) == gaps("en")
    assert f"  {code}: " in (PAGE / "words.js").read_text("utf-8")


def test_every_word_is_used_and_every_word_that_is_used_is_there() -> None:
    code = "\n".join(file.read_text("utf-8") for file in CODE)
    known = words("en").keys()
    assert [key for key in known if f'"{key}"' not in code] == []
    asked = re.findall(r'\bt\("(\w+)"', code) + re.findall(r'data-t(?:-label|-placeholder)?="(\w+)"', code)
    assert set(asked) <= known


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_nothing_comes_from_outside(file: Path) -> None:
    text = file.read_text("utf-8").replace(NAMESPACE, "")
    assert re.findall(r"https?://|[\"'(]//|@import", text) == []


@pytest.mark.parametrize("file", CODE, ids=lambda file: file.name)
def test_no_markup_is_made_of_text_and_no_style_or_script_is_inline(file: Path) -> None:
    text = file.read_text("utf-8")
    markup = (
        r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|setAttribute\(\"style"
    )
    assert re.findall(markup, text) == []
    assert re.findall(r"\sstyle=|\son\w+=\"|<style|<script(?![^>]*\ssrc=)|javascript:", text) == []


def test_the_whole_page_is_smaller_than_200_kb_uncompressed() -> None:
    assert sum(file.stat().st_size for file in FILES) < MOST_BYTES


def test_every_module_is_short_and_begins_by_saying_what_it_is() -> None:
    for file in FILES:
        if file.suffix == ".js":
            text = file.read_text("utf-8")
            assert text.startswith("/**"), file.name
            assert text.count("\n") <= 300, file.name
