"""A rule is compiled once a text comes that it may match, and skips no text that it matches."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.language.data_files import in_full, load_table
from chatrobot.language.normalise import normalise
from chatrobot.language.rules import Needed, Rule, Rules, needs_of

CORPUS = Path(__file__).parents[1] / "corpus"


def texts() -> Iterator[str]:
    for file in (*sorted(CORPUS.glob("*.yaml")), *sorted((CORPUS / "sources").glob("dev_*.yaml"))):
        for item in yaml.safe_load(file.read_text(encoding="utf-8")):
            yield from (normalise(str(turn)) for turn in item.get("turns", [item.get("text", "")]))


def patterns() -> Iterator[str]:
    named = (("rephrase", "rules"), ("rephrase", "breaks"), ("talk", "told"), ("talk", "remarked"))
    for language in ("en", "zh"):
        for name, part in named:
            table = load_table(language, name)
            for rule in table.get(part, ()):
                yield in_full(rule if isinstance(rule, str) else rule[0], table.get("parts", {}))


@pytest.mark.parametrize(
    ("pattern", "needs"),
    [
        (r"\bprior to\b", [{"prior to"}]),
        (r"\b(?:undo|revert) (?:the|that)", [{"undo", "revert"}, {"the", "that"}]),
        (r"(?:a|b)?foo", [{"foo"}]),
        (r"(?<=foo)bar(?!baz)", [{"bar"}, {"foo"}]),
        (r"x{0,3}yy+zz", [{"yy"}, {"zz"}]),
        (r"往前走(?:一)?米", [{"往前走"}, {"米"}]),
        (r"[左右](?:转|拐)[^了]", [{"左", "右"}, {"转", "拐"}]),
        (r"[a-z]\d+ ?(?:m|cm)", []),
        (r"foo|\d", []),
    ],
)
def test_what_a_pattern_needs_is_read_off_it(pattern: str, needs: list[set[str]]) -> None:
    assert list(needs_of(pattern)) == needs


def has_all(needs: tuple[Needed, ...], text: str) -> bool:
    return all(any(word in text for word in needed) for needed in needs)


def test_no_rule_skips_a_text_that_it_matches() -> None:
    said = " | ".join(texts())
    sentences = said.split(" | ")
    for pattern in patterns():
        needs = needs_of(pattern)
        compiled = re.compile(pattern)
        for sentence in sentences if needs else ():
            if not has_all(needs, sentence):
                assert compiled.search(sentence) is None, (pattern, sentence)


PIECES = st.recursive(
    st.sampled_from(
        ["a", "bc", "de ", r"\d", "[xy]", r"\b", r"\.", "前", "[前后]", "[^前]", "(?=前)", "(?<!后)"]
    ),
    lambda inner: st.one_of(
        st.lists(inner, min_size=1, max_size=3).map("".join),
        st.lists(inner, min_size=1, max_size=3).map(lambda some: f"(?:{'|'.join(some)})"),
        st.tuples(inner, st.sampled_from(["?", "*", "+", "{2}", "{0,1}"])).map(
            lambda it: f"(?:{it[0]}){it[1]}"
        ),
    ),
    max_leaves=8,
)


@given(PIECES, st.text("abcdexy.前后 1", max_size=12))
def test_it_holds_for_any_pattern(pattern: str, text: str) -> None:
    if re.search(pattern, text):
        assert has_all(needs_of(pattern), text)


WORDS = st.sampled_from(["ab", "cd", "de", "前1"])
LISTED = st.lists(st.tuples(st.one_of(WORDS, PIECES), WORDS), max_size=8)


@given(LISTED, st.text("abcdexy.前后 1", max_size=20))
def test_rules_that_are_passed_over_would_change_nothing(listed: list[tuple[str, str]], text: str) -> None:
    one_by_one = text
    for pattern, said in listed:
        one_by_one = re.sub(pattern, said, one_by_one)
    rules = Rules([Rule(pattern, said, tuple(map(tuple, needs_of(pattern)))) for pattern, said in listed])
    assert rules.applied(text) == one_by_one


@given(st.lists(PIECES, min_size=1, max_size=8), st.text("abcdexy.前后 1", max_size=20))
def test_any_rule_that_matches_is_found(patterns: list[str], text: str) -> None:
    rules = Rules([Rule(pattern, "", tuple(map(tuple, needs_of(pattern)))) for pattern in patterns])
    assert rules.any_in(text) == any(re.search(pattern, text) for pattern in patterns)
