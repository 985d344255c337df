"""A program is found in whatever a model wraps it in."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.programs.extract import MAX_DESCRIPTION_CHARS, extract
from tests.programs.replies import NO_PROGRAM, NODE, REPLIES


def squeezed(code: str) -> str:
    return re.sub(r"\n{2,}", "\n", code)


@pytest.mark.parametrize("reply", REPLIES.values(), ids=REPLIES.keys())
def test_the_program_is_found(reply: str) -> None:
    found = extract(reply)
    assert found is not None
    assert squeezed(found.source) == squeezed(NODE)


@pytest.mark.parametrize("reply", NO_PROGRAM.values(), ids=NO_PROGRAM.keys())
def test_where_there_is_no_program_none_is_found(reply: str) -> None:
    assert extract(reply) is None


def test_prose_around_the_code_is_its_description() -> None:
    found = extract(REPLIES["prose before and after"])
    assert found is not None
    assert found.description == "Sure! Here's a node that does it:\nRun it with `ros2 run`."


def test_thoughts_and_other_files_are_no_description() -> None:
    found = extract(REPLIES["thinking aloud first"])
    assert found is not None
    assert found.description == ""


def test_a_program_that_is_wrong_python_is_still_the_program() -> None:
    broken = NODE.replace("def go(self):", "def go(self)")
    found = extract(f"```python\n{broken}```")
    assert found is not None
    assert found.source == broken


PROSE = st.text(
    st.characters(blacklist_characters="`~<>{}", blacklist_categories=("Cs",)), max_size=200
).filter(lambda text: extract(text) is None)


@given(
    before=PROSE,
    after=PROSE,
    fence=st.sampled_from(["```", "````", "~~~"]),
    info=st.sampled_from(["python", "py", ""]),
)
def test_whatever_words_stand_around_a_fence_the_code_comes_out_whole(
    before: str, after: str, fence: str, info: str
) -> None:
    found = extract(f"{before}\n{fence}{info}\n{NODE}{fence}\n{after}")
    assert found is not None
    assert found.source == NODE


@given(st.text(max_size=300) | st.text("`~\n python{}<>'\"import ", max_size=300))
def test_any_text_at_all_is_taken(text: str) -> None:
    found = extract(text)
    assert found is None or (found.source.strip() and len(found.description) <= MAX_DESCRIPTION_CHARS)
