"""Corpus files, good and bad."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.cli.eval.corpus import load_corpus
from chatrobot.core.errors import CorpusError
from chatrobot.plan.text import format_plan

GOOD = """
- id: en-1
  category: sequence
  say: "forward one metre, wait, and come back"
  expect: {x: 0, y: 0.5, path_m: 2.0, pause_s: 3, closed: true, sign: {x: "+", y: "-", yaw: 0}}
  note: as an example
- id: en-2
  category: dialogue
  turns: ["forward 1 m", {say: "where are you?", expect: {answer: info, motion: none}}, "again"]
  expect: {x: 2}
"""


PLANS = """
- {id: en-1, category: metric, say: hi, plan: "drive 1 m\\n\\ngoto 1 2\\n", ask_ok: true}
- {id: en-2, category: still, say: hi, still: true}
- {id: en-3, category: shape, say: hi, plan: [drive 1 m, drive 2 m], mirror_ok: true, closed_ok: true}
"""


def load(text: str, folder: Path) -> list[object]:
    file = folder / "corpus.yaml"
    file.write_text(text, encoding="utf-8")
    return list(load_corpus(file))


def test_a_corpus_is_read_as_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "corpus.yaml"
    file.write_text(GOOD, encoding="utf-8")
    first, second = load_corpus(file)
    assert first.expect is not None
    assert first.expect.numbers == {"x": 0.0, "y": 0.5, "path_m": 2.0, "pause_s": 3.0}
    assert first.expect.sign == {"x": "+", "y": "-", "yaw": "0"}
    assert first.expect.closed
    assert [turn.say for turn in second.turns] == ["forward 1 m", "where are you?", "again"]
    assert second.turns[1].expect is not None
    assert second.turns[1].expect.answer == "info"


def test_plans_are_read_as_they_are_written(tmp_path: Path) -> None:
    file = tmp_path / "corpus.yaml"
    file.write_text(PLANS, encoding="utf-8")
    order, still, shape = load_corpus(file)
    assert order.meant is not None
    assert shape.meant is not None
    assert [format_plan(plan) for plan in order.meant.plans] == ["drive 1 m\ngo to 1 2"]
    assert order.ask_ok
    assert not order.must_stand
    assert still.must_stand
    assert len(shape.meant.plans) == 2
    assert shape.meant.mirror_ok
    assert shape.meant.closed_ok
    assert [item.number for item in (order, still, shape)] == [1, 2, 3]


def test_the_everyday_sets_are_valid() -> None:
    files = sorted((Path(__file__).parent.parent / "corpus" / "everyday").glob("*.yaml"))
    assert sum(len(load_corpus(file)) for file in files) >= 600


@pytest.mark.parametrize(
    ("item", "said"),
    [
        ("{id: a, category: metric, say: hi}", "expect is missing"),
        ("{id: a, category: nonsense, say: hi, expect: {x: 1}}", "category is 'nonsense' (primitive, metric"),
        ("{id: a, category: metric, expect: {x: 1}}", "needs either say or turns"),
        ("{id: a, category: metric, say: hi, turns: [hi], expect: {x: 1}}", "needs either say or turns"),
        ("{id: a, category: metric, say: no, expect: {x: 1}}", "False is not text (put it in quotes)"),
        ("{id: a, category: metric, say: hi, expect: {}}", "expect is empty"),
        ("{id: a, category: metric, say: hi, expect: {z: 1}}", "unknown field 'z' (x, y, yaw_deg"),
        ("{id: a, category: metric, say: hi, expect: {x: one}}", "x is 'one' (a number)"),
        ("{id: a, category: metric, say: hi, expect: {x: .nan}}", "x is nan (a number)"),
        ("{id: a, category: metric, say: hi, expect: {sign: {x: up}}}", "sign.x is 'up'"),
        ("{id: a, category: metric, say: hi, expect: {motion: some}}", "motion is 'some' (none)"),
        ("{id: a, category: info, say: hi, expect: {answer: yes}}", "answer is True (clarify, refuse, info)"),
        ("{id: a, category: metric, say: hi, expect: {closed: 1}}", "closed is 1 (true or false)"),
        ("{id: a, category: metric, says: hi, expect: {x: 1}}", "unknown field 'says'"),
        ("{id: a, category: metric, say: hi, plan: drive 1 parsec}", "plan cannot be read"),
        ("{id: a, category: metric, say: hi, plan: []}", "plan is empty"),
        ("{id: a, category: metric, say: hi, plan: [1]}", "plan is 1"),
        ("{id: a, category: metric, say: hi, plan: drive 1 m, still: true}", "either a plan or still"),
        ("{id: a, category: metric, say: hi, plan: drive 1 m, expect: {x: 1}}", "either expect or a plan"),
        ("{id: a, category: metric, say: hi, still: yes please}", "still is 'yes please'"),
    ],
)
def test_a_mistake_is_named_with_its_item_and_what_is_allowed(item: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(CorpusError) as error:
        load(f"- {item}\n", tmp_path)
    assert said in str(error.value)
    assert "corpus.yaml: " in str(error.value)


@pytest.mark.parametrize("text", ["", "42", "{a: 1}", "- [", "- {category: metric}", "- 3", "[]", "\x00"])
def test_what_is_no_corpus_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(CorpusError):
        load(text, tmp_path)


def test_an_id_may_be_used_once(tmp_path: Path) -> None:
    item = "- {id: a, category: metric, say: hi, expect: {x: 1}}\n"
    with pytest.raises(CorpusError, match="used twice"):
        load(item + item, tmp_path)


def test_a_missing_file_is_a_corpus_error(tmp_path: Path) -> None:
    with pytest.raises(CorpusError, match="cannot be read"):
        load_corpus(tmp_path / "none.yaml")


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["id", "category", "say", "turns", "expect", "x", "sign", "motion", "closed", "answer"]
            ),
            inner,
            max_size=5,
        )
    ),
)


@given(data=st.lists(VALUES, max_size=3))
def test_whatever_the_file_holds_it_is_read_or_refused(
    data: list[object], tmp_path_factory: pytest.TempPathFactory
) -> None:
    import yaml

    file = tmp_path_factory.mktemp("corpus") / "corpus.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    with contextlib.suppress(CorpusError):
        load_corpus(file)
